// SPDX-License-Identifier: GPL-2.0-only
/*
 * SoE and VoE: answers to an access in one message or in fragments, requests in fragments, and
 * headers both ways. Input: what is asked for (write and drive, IDN, elements), room for the data
 * (16 bits), bytes of a message of the master, then messages of the slave, each behind its length.
 */
#include "fuzz.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"

#define ASKED	7
#define MOST	4095	/* bytes of data */

const struct fuzz_seed fuzz_seeds[] = {
	SEED("\x20\x0F\0\x40\4\0\x10" "\6\x22\x40\x0F\0\7\0"),
	SEED("\x21\x0F\0\x40\4\0\x10" "\4\x24\x40\x0F\0"),
	SEED("\x00\x96\x80\x40\2\0\x10" "\6\x12\x40\x96\x80\1\x10"),
	SEED("\x01\x96\x80\x40\2\0\x10" "\6\x14\x40\x96\x80\4\x70"),
	/* three fragments */
	SEED("\x00\x11\0\x40\x20\0\x08" "\6\x0A\x40\2\0ab\6\x0A\x40\1\0cd\5\x02\x40\x11\0e"),
	/* the count does not go down; an error in the middle; a notification between them */
	SEED("\x00\x11\0\x42\x20\0\x08" "\6\x0A\x42\2\0ab\6\x0A\x42\2\0cd\5\x02\x42\x11\0e"),
	SEED("\x00\x11\0\x40\x20\0\x08" "\6\x0A\x40\2\0ab\6\x12\x40\x11\0\1\x70"),
	SEED("\x00\x11\0\x40\x20\0\x08" "\6\x0A\x40\1\0ab\6\x05\1\x94\0\3\0\5\x02\x40\x11\0e"),
	SEED("\x00\x11\0\x40\x20\0\x08" "\6\x0A\x40\1\0ab\5\x02\x40\x12\0e\5\x02\x40\x11\0f"),
	SEED("\x01\x11\0\x40\x20\0\x08" "\6\x1C\x40\1\0\1\x70"),
	SEED("\x00\0\0\0\0\0\0" "\7\xAD\xDE\xEF\xBE\x34\x12x"),
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
		MUST(ec_soe_is_unasked(p, len) == (soe.opcode == 5 || soe.opcode == 6));
		ec_soe_error_text(soe.idn);
		MUST(ec_soe_command_text(soe.idn));
	} else {
		MUST(!ec_soe_is_unasked(p, len));
	}
	r = ec_rbuf(p, len);
	w = ec_wbuf(out, sizeof(out));
	if (!ec_voe_hdr_decode(&r, &voe)) {
		MUST(ec_rbuf_left(&r) == len - EC_VOE_HDR);
		ec_voe_hdr_encode(&w, &voe);
		MUST(!memcmp(out, p, EC_VOE_HDR));
	}
}

/* All fragments of a request: they count down, have all data once, the last one has the IDN. */
static void request(struct ec_soe_access *a, size_t cap)
{
	size_t at = 0, room = cap > EC_SOE_HDR ? cap - EC_SOE_HDR : 0;
	u16 left = 0;
	u8 tx[256];

	for (bool first = true;; first = false) {
		int n = ec_soe_tx(a, tx, cap);
		struct ec_rbuf r = ec_rbuf(tx, n < 0 ? 0 : (size_t)n);
		struct ec_soe_hdr h;

		if (n < 0) {
			MUST(first && (cap < EC_SOE_HDR || (a->write && !room && a->size)));
			return;
		}
		MUST((size_t)n <= cap && !ec_soe_hdr_decode(&r, &h));
		MUST(h.drive == a->drive && h.elements == a->elements && !h.error);
		MUST(a->write || (n == EC_SOE_HDR && !h.incomplete));
		n -= EC_SOE_HDR;
		MUST(!a->write || !memcmp(a->data + at, tx + EC_SOE_HDR, (size_t)n));
		at += (size_t)n;
		MUST(h.incomplete == !ec_soe_awaits(a));
		if (!h.incomplete) {
			MUST(h.idn == a->idn && (first || left == 1));
			MUST(!a->write || at == a->size);
			return;
		}
		MUST((size_t)n == room && h.idn && (first || h.idn + 1 == left));
		left = h.idn;
	}
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_soe_access a = { .drive = 0 };
	int ret = EC_STALE;

	if (len < ASKED)
		return 0;
	a.write = data[0] & 1;
	a.drive = data[0] >> 5;
	a.idn = get_unaligned_le16(data + 1);
	a.elements = data[3];
	a.cap = a.size = get_unaligned_le16(data + 4) & MOST;
	a.data = calloc(1, a.cap + 1);
	memset(a.data, 0x5a, a.cap + 1);
	/* what the slave says after the first fragment, or after all */
	if (data[0] & 2) {
		u8 tx[256];

		ec_soe_tx(&a, tx, data[6]);
	} else {
		request(&a, data[6]);
	}
	for (size_t at = ASKED; at < len && (ret == EC_STALE || ret == EC_WAIT);) {
		size_t n = min((size_t)data[at], len - at - 1);

		headers(data + at + 1, n);
		ret = ec_soe_rx(&a, data + at + 1, n);
		MUST(ret == EC_STALE || ret == EC_WAIT || ret <= 0);
		MUST(ret != EC_WAIT || (!a.write && a.begun && a.left && n > EC_SOE_HDR));
		MUST(a.at <= a.cap && (a.write || !a.begun || a.left || a.wrong));
		MUST(ret || a.write || (a.size == a.at && !a.wrong && !a.left));
		MUST(!a.error || ret == -EIO);
		MUST(ret != -EPROTO || a.wrong == -EPROTO);
		at += 1 + n;
	}
	MUST(a.data[a.cap] == 0x5a);
	free(a.data);
	return 0;
}
