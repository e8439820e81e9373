// SPDX-License-Identifier: GPL-2.0-only
/* Mailbox header, error reply, CoE header, emergency; and all code tables. */
#include "fuzz.h"
#include "../../master/wire/al.h"
#include "../../devices/sim/mbox_encode.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\x0A\0\0\0\0\x13\0\x10\x10\x42\x09\1\2\3\4\5"),
	SEED("\x04\0\xE9\3\xC0\x70\1\0\2\0"),
	SEED("\x0A\0\0\0\0\x23\0\x30\x60\x12\x1C\0\0\0\0\0"),
	SEED("\x06\0\0\0\0\x55uint16"),
	{ NULL, 0 }
};

static void tables(const uint8_t *data, size_t len)
{
	u32 code;

	if (len < 4)
		return;
	code = get_unaligned_le32(data);
	ec_coe_abort_text(code);
	MUST(ec_al_code_text((u16)code));
	MUST(ec_mbox_error_text((u16)code));
	MUST(ec_al_timeout_ms(data[0], data[1]));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_rbuf r = ec_rbuf(data, len);
	struct ec_mbox_hdr h;
	struct ec_coe_hdr ch;
	struct ec_coe_emergency e;
	u8 out[16];
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));
	u16 detail;

	tables(data, len);
	if (ec_mbox_hdr_decode(&r, &h))
		return 0;
	MUST(h.len <= ec_rbuf_left(&r));
	ec_mbox_hdr_encode(&w, &h);
	MUST(!memcmp(out, data, 5) && out[5] == (data[5] & 0x7F));
	MUST(ec_mbox_next_counter(h.counter) >= 1 && ec_mbox_next_counter(h.counter) <= 7);
	r = ec_rbuf(r.p, h.len);
	switch (h.type) {
	case EC_MBOX_ERR:
		ec_mbox_error_decode(&r, &detail);
		break;
	case EC_MBOX_COE:
		if (!ec_coe_emergency_decode(r.p, h.len, &e)) {
			MUST(ec_coe_emergency_encode(out, sizeof(out), &e) == 10);
			MUST(!memcmp(out + 2, r.p + 2, 8));
		}
		ec_coe_hdr_decode(&r, &ch);
		break;
	}
	return 0;
}
