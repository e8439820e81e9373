// SPDX-License-Identifier: GPL-2.0-only
/* A message of the diagnosis history, whole, and each of its parameters. */
#include "fuzz.h"
#include "../../master/wire/diag.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\0\xE8\x34\x12\2\5\x10\0" "\x8\7\6\5\4\3\2\1" "\6\0\x42\1" "\3\x10zzz"
	     "\2\x20zz" "\2\x30z\0" "\0\x40\x21\0"),
	SEED("\0\xE0\0\0\1\1\x34\x12" "\x40\x42\xF\0\0\0\0\0" "\x15\0zzzzzzzz"),
	SEED("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"),
	{ NULL, 0 }
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_diag_param p;
	struct ec_diag_msg m;
	int ret, n, all;

	ret = ec_diag_msg_decode(data, len, &m);
	MUST(!ret || ret == -ENOMSG || ret == -EMSGSIZE);
	if (ret)
		return 0;
	MUST(len >= EC_DIAG_HDR);
	all = m.params;
	for (n = 0; (ret = ec_diag_param_decode(&m, &p)) == 1; n++) {
		MUST(p.kind <= EC_DIAG_TEXT_ID && (p.size || p.kind != EC_DIAG_VALUE));
		MUST(p.data >= data + EC_DIAG_HDR + 2 && p.data + p.size <= data + len);
	}
	MUST(ret == -EBADMSG ? n < all && !p.data : !ret && n == all);
	MUST(!ec_diag_param_decode(&m, &p));
	return 0;
}
