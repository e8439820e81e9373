// SPDX-License-Identifier: GPL-2.0-only
/*
 * Frames into a segment: whatever they hold, slaves change only what they may.
 * The input is a row of frames, each with its length in two bytes before it; with bit 15
 * of it an Ethernet frame, otherwise what follows its EtherType.
 */
#include "fuzz_sim.h"

#define FR(n, bytes)	n "\0" bytes

const struct fuzz_seed fuzz_seeds[] = {
	/* station addresses, BRD of the AL status, mailbox of the axis */
	SEED(FR("\x10", "\x0E\x10\2\1\0\0\x10\0\2\0\0\0\xE9\3\0\0")
	     FR("\x10", "\x0E\x10\2\1\xFF\xFF\x10\0\2\0\0\0\xEA\3\0\0")
	     FR("\x10", "\x0E\x10\2\1\xFE\xFF\x10\0\2\0\0\0\xEB\3\0\0")
	     FR("\x10", "\x0E\x10\7\1\0\0\x30\1\2\0\0\0\0\0\0\0")
	     FR("\x16", "\x14\x10\5\1\xEB\3\0\x08\x08\0\0\0\0\x10\0\1\x26\0\1\0\0\0")
	     FR("\x16", "\x14\x10\5\1\xEB\3\x08\x08\x08\0\0\0\0\x11\0\1\x22\0\1\0\0\0")
	     FR("\x10", "\x0E\x10\5\1\xEB\3\x20\1\2\0\0\0\2\0\0\0")
	     FR("\x1E", "\x1C\x10\5\1\xEB\3\0\x10\x10\0\0\0\x0A\0\0\0\0\x13\0\x20\x40\x18\x10\1\0\0\0\0\0\0")),
	/* FMMU, LRW; receive times; EEPROM read; ARMW */
	SEED(FR("\x1E", "\x1C\x10\2\1\0\0\0\6\x10\0\0\0\0\0\1\0\4\0\0\7\0\x11\0\3\1\0\0\0\0\0")
	     FR("\x12", "\x10\x10\x0C\1\0\0\1\0\4\0\0\0\1\2\3\4\0\0")
	     FR("\x12", "\x10\x10\x08\1\0\0\0\x09\4\0\0\0\0\0\0\0\0\0")
	     FR("\x14", "\x12\x10\x08\1\0\0\2\5\6\0\0\0\0\1\x08\0\0\0\0\0")
	     FR("\x1A", "\x18\x10\x07\1\0\0\2\5\x0C\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0")
	     FR("\x16", "\x14\x10\x0D\1\0\0\x10\x09\x08\0\0\0\0\0\0\0\0\0\0\0\0\0")),
	/* tagged UDP; direct */
	SEED("\x3E\x80" "\xFF\xFF\xFF\xFF\xFF\xFF\0\1\2\3\4\5\x81\0\x60\5\x08\0"
	     "\x45\0\0\x2C\0\1\0\0\x40\x11\xAA\xBB\xC0\xA8\0\1\xC0\xA8\0\xFF"
	     "\x88\xA4\x88\xA4\0\x18\x12\x34\x0E\x10\7\1\0\0\x30\1\2\0\0\0\0\0\0\0"
	     "\x1E\x80" "\xFF\xFF\xFF\xFF\xFF\xFF\0\1\2\3\4\5\x88\xA4"
	     "\x0E\x10\7\1\0\0\x30\1\2\0\0\0\0\0\0\0"),
	{ NULL, 0 }
};

/* what a slave may not change: command, index, length; and where it ends */
static void sound(const u8 *sent, u8 *back, size_t len)
{
	struct ec_frame_iter a, b;
	struct ec_dgram d, e;
	u8 copy[1600];
	int ret;

	memcpy(copy, sent, len);
	if (len < 14 || get_unaligned_le16(sent) >> 12 != 1) {
		MUST(!memcmp(sent, back, len));
		return;
	}
	/* whatever length the header says: by the "more" bits, to the end of the frame */
	MUST(!memcmp(sent, back, 2));
	a = (struct ec_frame_iter){ copy + 2, copy + len, true };
	b = (struct ec_frame_iter){ back + 2, back + len, true };
	while (a.more && (ret = ec_frame_iter_next(&a, &d)) == 1) {
		MUST(ec_frame_iter_next(&b, &e) == 1);
		MUST(d.cmd == e.cmd && d.idx == e.idx && d.len == e.len && d.more == e.more);
		MUST((u16)(ec_dgram_wkc(&e) - ec_dgram_wkc(&d)) <= 9);
		if (!ec_cmd_reads(d.cmd))
			MUST(!memcmp(d.data, e.data, d.len));
	}
	MUST(a.more == b.more && b.p - back == a.p - copy);
	MUST(!memcmp(a.p, b.p, (size_t)(a.end - a.p)));
}

/* a whole Ethernet frame; what holds no EtherCAT does not come back and stays as it is */
static void ethernet(struct ec_sim *sim, const u8 *sent, u8 *eth, size_t len, u64 now)
{
	bool ethercat = ec_sim_eth_is_ethercat(eth, len);
	struct ec_sim_result res;
	s64 delay = ec_sim_eth(sim, 0, eth, len, now, &res);

	MUST(ethercat ? !(delay < 0) == !!res.copies : delay < 0);
	MUST(ethercat || !memcmp(sent, eth, len));
	MUST(len < 14 || (!memcmp(sent, eth, 6) && (sent[6] | 2) == (eth[6] | 2) &&
			  !memcmp(sent + 7, eth + 7, 7)));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t len)
{
	const char *text = ec_sim_builtin("three");
	struct ec_sim *sim = fuzz_describe(text, strlen(text), NULL, -1);
	u64 now = 0;
	u8 frame[1600];

	MUST(sim);
	/* at once, or from slave to slave */
	ec_sim_set_under_way(sim, (enum ec_sim_under_way)(len % 3));
	while (len > 2) {
		size_t n = min_t(size_t, get_unaligned_le16(data) & 0x7FF, len - 2);

		n = min(n, sizeof(frame));
		memcpy(frame, data + 2, n);
		if (data[1] & 0x80)
			ethernet(sim, data + 2, frame, n, now);
		else if (ec_sim_frame(sim, 0, frame, n, now) >= 0)
			sound(data + 2, frame, n);
		now += 500000;
		data += 2 + n;
		len -= 2 + n;
	}
	ec_sim_advance(sim, now + 3000000000);
	fuzz_release(sim);
	return 0;
}
