/* SPDX-License-Identifier: GPL-2.0-only */
/* Frames of one datagram that are on their way, and a segment for them. */
#ifndef SIM_FLIGHT_KUNIT_H
#define SIM_FLIGHT_KUNIT_H

#include "sim_cable_kunit.h"

#define US	1000ull
#define SECOND	1000000000ull
#define WIRE	(72 * 80)	/* first to last bit of the shortest frame */
#define MARK	0x0f80		/* user RAM, which shows who executed a write */

/**
 * struct air - a frame of one datagram
 * @fl: its state
 * @eth: the frame
 */
struct air {
	struct ec_sim_flight fl;
	u8 eth[64];
};

static inline void send(struct bed *b, struct air *a, u64 at, u8 cmd, u16 adp, u16 ado,
			u64 val, u16 len)
{
	struct ec_frame_buf f;
	size_t n;
	u8 v[8];

	memset(a->eth, 0xff, 14);
	a->eth[12] = 0x88;
	a->eth[13] = 0xa4;
	ec_frame_begin(&f, a->eth + 14, sizeof(a->eth) - 14);
	put_unaligned_le64(val, v);
	memcpy(ec_frame_add(&f, cmd, 1, adp, ado, len), v, len);
	n = ec_frame_end(&f);
	ec_sim_send(b->sim, &a->fl, 0, a->eth, 14 + n, at);
}

/* each slave that executes it writes @val */
static inline void mark(struct bed *b, struct air *a, u64 at, u8 val)
{
	send(b, a, at, EC_CMD_BWR, 0, MARK, val, 1);
}

static inline u16 wkc(const struct air *a)
{
	return get_unaligned_le16(a->eth + 14 + 2 + 10 + get_unaligned_le16(a->eth + 22) % 2048);
}

/* a bit for each slave that has @val */
static inline u32 marked(struct bed *b, u8 val)
{
	u32 v = 0;

	for (u32 i = 0; i < ec_sim_count(b->sim); i++)
		v |= (u32)(ec_sim_slave(b->sim, i)->mem[MARK] == val) << i;
	return v;
}

static inline void plan(struct kunit *test, struct bed *b, u64 at, enum ec_sim_fault_type type,
			int slave, int port)
{
	const struct ec_sim_fault f = { .at_ns = at, .type = type, .slave = slave, .port = port };

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
}

/*
 * Slaves 0 to 5 in a line; 6 is at port 2 of slave 2, so it comes after 3 to 5. Between 3 and 4
 * there are @far ns of cable. The first bit reaches slave 2 after 1300 ns and leaves port 1 at
 * 1800, is at slave 3 at 1900, at slave 4 at 2400 + @far, back at slave 2 at 4700 + 2 * @far,
 * and at slave 6 600 ns later.
 */
static inline struct bed *line(struct kunit *test, u32 far)
{
	struct bed *b = bed_new(test, 7, 0);

	for (int i = 0; i < 7; i++) {
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, i < 6 ? i - 1 : 2, i < 6 ? 1 : 2, i, 0,
						  i == 4 ? far : 100), 0);
	}
	/* port 2 comes before port 0, but after port 1: 0, 1, 2, 3, 4, 5, 6 */
	for (int i = 0; i < 7; i++)
		KUNIT_ASSERT_EQ(test, bed_station(b, (u16)-i, (u16)(1001 + i)), 1);
	b->now = 10000000;
	return b;
}

#endif
