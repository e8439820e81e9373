// SPDX-License-Identifier: GPL-2.0-only
/* Fragments of EoE: messages one after the other, each with its length before it. */
#include "fuzz.h"
#include "../../master/wire/eoe_frame.h"

#define Z32 "0123456789abcdef0123456789abcdef"

const struct fuzz_seed fuzz_seeds[] = {
	/* mailbox 128; whole frame; frame of two fragments with a time stamp */
	SEED("\x80" "\x40\0\0\1\x80\0" Z32 "0123456789abcdef0123456789ab"
	     "\x44\0\0\0\xc0\x10" Z32 Z32 "\x0e\0\x10\3\x81\x10" "012345\1\2\3\4"),
	/* mailbox 48; three fragments, offsets 0, 32, 64; another service between */
	SEED("\x30" "\x24\0\0\0\xc0\0" Z32 "\x24\0\0\0\x41\0" Z32 "\4\0\3\1\0\0" "\x14\0\0\1\x82\0"
	     "0123456789abcdef"),
	/* EtherCAT in UDP behind a tag */
	SEED("\x80" "\x34\0\0\1\x80\0" "012345012345\x81\0\0\5\x08\0\x45\0\0\x1e\0\0\0\0\x40\x11\0\0"
	     "01234567\1\2\x88\xa4\0\x0a\0\0\0\x10"),
	{ NULL, 0 }
};

/* What was received is sent again in another mailbox: the same frame comes out. */
static void again(const u8 *data, u16 len, u8 frame, unsigned int mailbox)
{
	struct ec_eoe_fragment f = { .frame = frame }, in;
	u8 *out = malloc(len), msg[2048], number = 0;
	struct ec_eoe_part p = { 0 };
	u16 at = 0;
	int ret;

	MUST(out);
	do {
		unsigned int n = ec_eoe_fragment_cut(&f, data, len, at, number, mailbox);

		if (!n) {
			MUST(mailbox < 42);
			break;
		}
		at = (u16)(at + n);
		ret = ec_eoe_fragment_encode(msg, mailbox - 6, &f);
		MUST(ret == (int)(EC_EOE_HDR + n) && f.last == (at == len));
		MUST(!ec_eoe_fragment_decode(msg, (size_t)ret, &in) && in.number == number++);
		ret = ec_eoe_part_add(&p, out, len, &in);
		MUST(ret == (at == len ? len : 0));
	} while (!ret);
	MUST(at < len || !memcmp(out, data, len));
	free(out);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	struct ec_rbuf r = ec_rbuf(data, len);
	unsigned int mailbox = ec_rbuf_u8(&r);
	size_t cap = EC_EOE_FRAME_MAX;
	struct ec_eoe_part p = { 0 };
	u8 *frame;

	if (mailbox & 1)	/* little memory */
		cap = 64;
	frame = malloc(cap);
	MUST(frame);
	while (!r.bad && ec_rbuf_left(&r)) {
		size_t n = ec_rbuf_le16(&r);
		const u8 *msg = ec_rbuf_take(&r, min(n, ec_rbuf_left(&r)));
		struct ec_eoe_fragment f;
		int ret, type;

		if (!msg)
			break;
		n = (size_t)(r.p - msg);
		type = ec_eoe_type_decode(msg, n);
		ret = ec_eoe_fragment_decode(msg, n, &f);
		MUST(ret != -ENOMSG || type > 0);
		MUST(ret || (type == EC_EOE_FRAGMENT && f.data == msg + EC_EOE_HDR &&
			     f.len + (size_t)EC_EOE_HDR <= n));
		if (ret)
			continue;
		MUST(f.port < 16 && f.frame < 16 && f.number < 64 && f.units < 64);
		ret = ec_eoe_part_add(&p, frame, cap, &f);
		MUST(p.len <= p.room && p.room <= cap && p.open == !ret);
		MUST(ret <= 0 || (ret == p.len && f.last && p.port == f.port));
		MUST(ret <= 0 || !ec_eoe_is_ethercat(frame, (size_t)ret) || ret >= 14);
		if (ret > 0)
			again(frame, (u16)ret, f.frame, mailbox);
	}
	free(frame);
	return 0;
}
