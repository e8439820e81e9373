// SPDX-License-Identifier: GPL-2.0-only
/*
 * SoE and VoE: answers to an access, and headers both ways. Input: what is
 * asked for (write, drive, IDN), room for the value, then one message.
 */
#include "fuzz.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\x20\x0F\0\4" "\x22\x40\x0F\0\7\0"),
	SEED("\x21\x0F\0\4" "\x24\x40\x0F\0"),
	SEED("\x00\x96\x80\2" "\x12\x40\x96\x80\1\x10"),
	SEED("\x01\x96\x80\2" "\x14\x40\x96\x80\4\x70"),
	SEED("\x00\x96\x80\2" "\x0A\x40\3\0zzzz"),
	SEED("\x00\0\0\0" "\xAD\xDE\xEF\xBE\x34\x12x"),
	{ NULL, 0 }
};

static void headers(const uint8_t *p, size_t len)
{
	struct ec_rbuf r = ec_rbuf(p, len);
	struct ec_soe_hdr soe;
	struct ec_voe_hdr voe;
	u8 out[8];
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));

	if (!ec_soe_hdr_decode(&r, &soe)) {
		ec_soe_hdr_encode(&w, &soe);
		MUST(!memcmp(out, p, EC_SOE_HDR));
		ec_soe_error_text(soe.idn);
	}
	r = ec_rbuf(p, len);
	w = ec_wbuf(out, sizeof(out));
	if (!ec_voe_hdr_decode(&r, &voe)) {
		MUST(ec_rbuf_left(&r) == len - EC_VOE_HDR);
		ec_voe_hdr_encode(&w, &voe);
		MUST(!memcmp(out, p, EC_VOE_HDR));
	}
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_soe_access a = { .element = EC_SOE_VALUE };
	u8 tx[300];
	int ret;

	if (len < 4)
		return 0;
	a.write = data[0] & 1;
	a.drive = data[0] >> 5;
	a.idn = get_unaligned_le16(data + 1);
	a.cap = a.size = data[3];
	a.data = calloc(1, a.cap + 1);
	MUST(ec_soe_tx(&a, tx, sizeof(tx)) == (a.write ? 4 + data[3] : 4));
	ret = ec_soe_rx(&a, data + 4, len - 4);
	MUST(ret <= 0 || ret == EC_STALE);
	if (!ret && !a.write)
		MUST(a.size <= a.cap && a.size == len - 8 && !memcmp(a.data, data + 8, a.size));
	MUST(!a.error || ret == -EIO);
	free(a.data);
	headers(data + 4, len - 4);
	return 0;
}
