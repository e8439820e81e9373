// SPDX-License-Identifier: GPL-2.0-only
/* FoE: messages of a slave during a transfer. Input: direction, size, then messages with length. */
#include "fuzz.h"
#include "../../master/wire/foe.h"

#define CAP	20
#define ROOM	(CAP - EC_FOE_HDR)

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\0\0" "\x09\3\0\1\0\0\0abc"),
	SEED("\0\0" "\x14\3\0\1\0\0\0abcdefghijklmn" "\6\3\0\2\0\0\0"),
	SEED("\1\3" "\6\4\0\0\0\0\0" "\6\4\0\1\0\0\0"),
	SEED("\1\x20" "\6\4\0\0\0\0\0" "\6\6\0\1\0\2\0" "\6\4\0\1\0\0\0" "\6\4\0\2\0\0\0"),
	SEED("\1\3" "\x08\5\0\3\x80\0\0no"),
	{ NULL, 0 }
};

/* what a message changes must fit to what it is */
static int one(struct ec_foe *f, const uint8_t *msg, size_t len)
{
	struct ec_foe was = *f;
	int ret = ec_foe_rx(f, msg, len, ROOM);

	switch (ret) {
	case 0:
		MUST(f->write && f->last && f->at + f->n == f->size);
		break;
	case EC_MORE:
		if (f->busy)
			MUST(f->packet == was.packet && f->size == was.size);
		else if (f->write)
			MUST(f->at <= f->size && f->packet == was.packet + 1);
		else
			MUST(f->n <= ROOM && f->size == was.size + f->n && f->at == was.size);
		break;
	case EC_STALE:
	case EC_WAIT:
		MUST(f->packet == was.packet && f->at == was.at && f->size == was.size);
		break;
	default:
		MUST(ret == -EREMOTEIO || ret == -EBADMSG);
		MUST(memchr(f->text, 0, sizeof(f->text)));
	}
	return ret;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_foe f = { .name = "n", .name_len = 1 };
	int ret = EC_MORE;
	u8 tx[CAP];

	if (len < 2)
		return 0;
	f.write = data[0] & 1;
	f.size = f.write ? data[1] : 0;
	data += 2;
	len -= 2;
	while (len && ret > 0) {
		size_t n = min((size_t)data[0], len - 1);

		if (ret == EC_MORE) {
			MUST(ec_foe_tx(&f, tx, CAP) >= EC_FOE_HDR);
			if (!f.write && f.last)
				break;
		}
		ret = one(&f, data + 1, n);
		ec_foe_error_text(f.error);
		data += 1 + n;
		len -= 1 + n;
	}
	return 0;
}
