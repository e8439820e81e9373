// SPDX-License-Identifier: GPL-2.0-only
#include "sim_esc_kunit.h"

#define MIN_NS	(72 * 80)	/* shortest frame, preamble to last bit */

static void fault(struct kunit *test, struct bed *b,
		  enum ec_sim_fault_type type, int slave, int port, u32 arg,
		  u32 arg2, u64 value)
{
	struct ec_sim_fault f = {
		.at_ns = b->now, .type = type, .slave = slave, .port = port,
		.arg = arg, .arg2 = arg2, .value = value,
	};

	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
}

static int count(struct bed *b, int port)
{
	u8 v[2] = {};

	return bed_tx_port(b, port, EC_CMD_BRD, 0, 0, v, 2);
}

static void sim_segment_frame_takes_its_time(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);
	u8 *v = kunit_kzalloc(test, 1000, GFP_KERNEL);

	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	/* to the last slave and back: its own 500 ns are paid once */
	KUNIT_EXPECT_EQ(test, b->delay, (s64)(6 * 100 + 5 * 500 + MIN_NS));
	bed_tx(b, EC_CMD_NOP, 0, 0, v, 1000);
	KUNIT_EXPECT_EQ(test, b->delay, (s64)(6 * 100 + 5 * 500 +
			(8 + 14 + 2 + 12 + 1000 + 4) * 80));
}

static void sim_segment_without_slaves_there_is_no_link(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 0);

	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
}

static void sim_segment_foreign_frames_pass_unchanged(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 2);
	u8 v[64] = { 0x10, 0x40, 1, 2, 3 }, w[64];

	memcpy(w, v, 64);
	KUNIT_EXPECT_GT(test, ec_sim_frame(b->sim, 0, v, 64, b->now), (s64)0);
	KUNIT_EXPECT_MEMEQ(test, v, w, 64);
	memset(v, 0xff, 64);
	v[0] = 0x20;
	v[1] = 0x10;
	KUNIT_EXPECT_GT(test, ec_sim_frame(b->sim, 0, v, 64, b->now), (s64)0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x30c, 1), 1ull);
}

/* slaves go by the datagrams and their "more" bits, whatever the header says */
static void sim_segment_header_length_is_ignored(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 2);
	static const u16 say[] = { 0, 1, 12, 14, 15, 28, 46, 0x7FF };

	for (u32 i = 0; i < ARRAY_SIZE(say); i++) {
		u8 f[64] = {
			0, 0, EC_CMD_BRD, 1, 0, 0, 0x30, 1, 2, 0x80, 0, 0, 0, 0, 0, 0,
			EC_CMD_APRD, 1, 0xFF, 0xFF, 0x10, 0, 2, 0, 0, 0, 0, 0, 0, 0,
			EC_CMD_BRD, 1, 0, 0, 0x30, 1, 2, 0, 0, 0, 0, 0, 0, 0,
		};

		put_unaligned_le16(0x1000 | say[i], f);
		KUNIT_EXPECT_GT(test, ec_sim_frame(b->sim, 0, f, 60, b->now), (s64)0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(f), 0x1000 | say[i]);
		KUNIT_EXPECT_EQ_MSG(test, get_unaligned_le16(f + 14), 2, "length %u", say[i]);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(f + 26), 1002);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(f + 28), 1);
		KUNIT_EXPECT_EQ_MSG(test, get_unaligned_le16(f + 42), 0, "behind the last one");
		/* cut in the second one: the first counts, slave 1 counts an error */
		put_unaligned_le16(0, f + 14);
		put_unaligned_le16(0, f + 28);
		KUNIT_EXPECT_GT(test, ec_sim_frame(b->sim, 0, f, 29, b->now), (s64)0);
		KUNIT_EXPECT_EQ(test, get_unaligned_le16(f + 14), 2);
		KUNIT_EXPECT_EQ(test, f[28], 0);
		KUNIT_EXPECT_EQ(test, bed_get(b, 1001, EC_REG_ERR_PU, 1), i + 1);
	}
}

static void sim_segment_dl_status_shows_links_and_loops(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 2);

	/* port 0 and 1 linked and open, 2 and 3 closed */
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x110, 2), 0x5a33ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x110, 2), 0x5613ull);
	/* close port 1 of the first */
	bed_put(b, 1001, 0x101, 0x0c, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x110, 2), 0x5e33ull);
	/* port 0 cannot be closed for good */
	bed_put(b, 1001, 0x101, 0x03, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	/* held open without a link: frames are lost */
	bed_put(b, 1002, 0x101, 0x08, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
}

static void sim_segment_loop_setting_may_be_temporary(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 2);

	bed_put(b, 1001, 0x100, 0x0c03, 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	b->now += 1000000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	bed_put(b, 1001, 0x100, 0x0c01, 2);	/* this one stays */
	b->now += 2000000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
}

static void sim_segment_slaves_with_same_address_both_answer(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);
	u8 v[2];

	bed_station(b, (u16)-2, 1001);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x130, v, 2), 2);
	bed_station(b, 0, 1003);
	bed_station(b, (u16)-1, 1001);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, 0x130, v, 2), 2);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1003, 0x130, v, 2), 1);
}

static void sim_segment_auto_close_waits_for_write(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 2);

	bed_put(b, 1001, 0x101, 0x04, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	fault(test, b, EC_SIM_FAULT_CUT, 1, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	fault(test, b, EC_SIM_FAULT_HEAL, 1, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	bed_put(b, 1001, 0x101, 0x04, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
}

static void sim_segment_cut_cable_shortens_line(struct kunit *test)
{
	struct bed *b = bed_new(test, 4, 4);

	bed_get(b, 1002, 0x110, 2);
	bed_put(b, 1002, 0x200, 4, 2);
	fault(test, b, EC_SIM_FAULT_CUT, 1, 1, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->irq, 4);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x310, 4), 0x100ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x110, 2), 0x5613ull);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
	fault(test, b, EC_SIM_FAULT_HEAL, 2, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	/* it kept its address */
	KUNIT_EXPECT_EQ(test, bed_get(b, 1004, 0x10, 2), 1004ull);
	fault(test, b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), -1);
	KUNIT_EXPECT_FALSE(test, ec_sim_link(b->sim, 0));
}

static void sim_segment_power_loss_forgets_registers(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);

	fault(test, b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	fault(test, b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x10, 2), ~0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0x10, 2), 1003ull);
}

/*
 * 0 -3- 1 -1- 2
 *   -1- 3 -2- 4
 *       3 -3- 5
 *   -2- 6
 */
static struct bed *tree(struct kunit *test)
{
	static const int w[][4] = {
		{ -1, 0, 0, 0 }, { 0, 3, 1, 0 }, { 1, 1, 2, 0 }, { 0, 1, 3, 0 },
		{ 3, 2, 5, 0 }, { 3, 3, 4, 0 }, { 0, 2, 6, 0 },
	};
	struct bed *b = bed_new(test, 8, 0);
	u32 i;

	for (i = 0; i < 7; i++) {
		b->cfg.clock_start = i * 123456789ull;
		ec_sim_add(b->sim, &b->cfg);
	}
	for (i = 0; i < 7; i++)
		KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, w[i][0], w[i][1],
						  w[i][2], w[i][3], 100), 0);
	for (i = 0; i < 7; i++)
		bed_station(b, (u16)-i, (u16)(1001 + i));
	return b;
}

static void sim_segment_tree_is_walked_in_port_order(struct kunit *test)
{
	struct bed *b = tree(test);
	u32 i;

	KUNIT_EXPECT_EQ(test, count(b, 0), 7);
	for (i = 0; i < 7; i++)
		KUNIT_EXPECT_EQ(test,
			ec_esc_system_time(ec_sim_slave(b->sim, i), 0),
			i * 123456789ull);
	/* numbered as added, which is the order of the ports 3, 1, 2 */
	for (i = 0; i < 7; i++) {
		struct ec_esc *esc = ec_sim_slave(b->sim, i);

		KUNIT_EXPECT_EQ(test,
			get_unaligned_le16(esc->mem + EC_REG_STATION),
			(u16)(1001 + i));
	}
	/* 7 cables twice; slaves pass 13 times */
	KUNIT_EXPECT_EQ(test, b->delay, (s64)(14 * 100 + 13 * 500 + MIN_NS));
}

static void sim_segment_wiring_is_checked(struct kunit *test)
{
	struct bed *b = bed_new(test, 4, 2);

	b->cfg.ports[2] = EC_PORT_TYPE_NONE;
	ec_sim_add(b->sim, &b->cfg);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, 0, 1, 2, 0, 0), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, 1, 1, 2, 2, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, 1, 1, 3, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, -3, 1, 2, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, 1, 4, 2, 0, 0), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, 2, 1, 2, 1, 0), -EINVAL);
	b->cfg.sms = 17;
	KUNIT_EXPECT_NULL(test, ec_sim_add(b->sim, &b->cfg));
	b->cfg.sms = 8;
	KUNIT_EXPECT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
	KUNIT_EXPECT_NULL(test, ec_sim_add(b->sim, &b->cfg));
}

/* ---- ring */

static struct bed *ring(struct kunit *test, u32 n)
{
	struct bed *b = bed_new(test, n, n);

	KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, EC_SIM_MASTER1, 0,
					  (int)n - 1, 1, 100), 0);
	return b;
}

static void sim_segment_whole_ring_comes_out_at_other_port(struct kunit *test)
{
	struct bed *b = ring(test, 4);

	KUNIT_EXPECT_EQ(test, count(b, 0), 4);
	KUNIT_EXPECT_EQ(test, b->out, 1);
	KUNIT_EXPECT_EQ(test, b->delay, (s64)(5 * 100 + 4 * 500 + MIN_NS));
	/* the other way nobody processes it */
	KUNIT_EXPECT_EQ(test, count(b, 1), 0);
	KUNIT_EXPECT_EQ(test, b->out, 0);
	KUNIT_EXPECT_FALSE(test, b->circ);
}

static void sim_segment_cut_ring_answers_from_both_sides(struct kunit *test)
{
	struct bed *b = ring(test, 5);
	u8 v[2] = {};

	fault(test, b, EC_SIM_FAULT_CUT, 2, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->out, 0);
	KUNIT_EXPECT_FALSE(test, b->circ);
	KUNIT_EXPECT_EQ(test, count(b, 1), 3);
	KUNIT_EXPECT_EQ(test, b->out, 1);
	KUNIT_EXPECT_TRUE(test, b->circ);
	/* order from the far side: the one at the break is first */
	KUNIT_EXPECT_EQ(test, bed_tx_port(b, 1, EC_CMD_APRD, 0, 0x10, v, 2), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(v), 1003);
	fault(test, b, EC_SIM_FAULT_HEAL, 1, 1, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 5);
	KUNIT_EXPECT_EQ(test, b->out, 1);
}

static void sim_segment_circulating_frame_is_destroyed(struct kunit *test)
{
	struct bed *b = ring(test, 3);
	struct ec_frame_buf f;
	u8 *p;
	size_t n;

	fault(test, b, EC_SIM_FAULT_CUT, 1, 0, 0, 0, 0);
	ec_frame_begin(&f, b->frame, sizeof(b->frame));
	p = ec_frame_add(&f, EC_CMD_BWR, 1, 0, 0xf80, 2);
	memset(p, 0x5a, 2);
	b->frame[9] |= 0x40;
	n = ec_frame_end(&f);
	KUNIT_EXPECT_EQ(test, ec_sim_frame(b->sim, 1, b->frame, n, b->now),
			(s64)-ENOLINK);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 1)->mem[0xf80], 0);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 2)->mem[0xf80], 0);
	/* with a link at port 0 nobody minds */
	KUNIT_EXPECT_GT(test, ec_sim_frame(b->sim, 0, b->frame, n, b->now),
			(s64)0);
}

static void sim_segment_frame_opens_auto_closed_port(struct kunit *test)
{
	struct bed *b = ring(test, 3);

	bed_put(b, 1002, 0x101, 0x04, 1);
	fault(test, b, EC_SIM_FAULT_CUT, 1, 1, 0, 0, 0);
	fault(test, b, EC_SIM_FAULT_HEAL, 1, 1, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->out, 0);
	KUNIT_EXPECT_EQ(test, count(b, 1), -1);	/* heard, but destroyed */
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, b->out, 1);
}

/* ---- faults */

static void sim_segment_nth_frame_is_lost(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 2);
	u8 v[1] = { 9 };

	fault(test, b, EC_SIM_FAULT_LOSE, 0, -1, 3, 0, 0);
	fault(test, b, EC_SIM_FAULT_LOSE, 0, 0, 4, 0, 1);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, 0xf80, v, 1), -1);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 0)->mem[0xf80], 0);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, 0xf80, v, 1), -1);
	KUNIT_EXPECT_EQ(test, ec_sim_slave(b->sim, 0)->mem[0xf80], 9);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
}

static void sim_segment_frames_are_lost_by_chance(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 2);
	int i, lost = 0;

	fault(test, b, EC_SIM_FAULT_LOSE, 0, -1, 0, 100000, 0);
	for (i = 0; i < 2000; i++)
		lost += count(b, 0) < 0;
	KUNIT_EXPECT_GT(test, lost, 150);
	KUNIT_EXPECT_LT(test, lost, 250);
	fault(test, b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0, 0);
	for (lost = 0, i = 0; i < 500; i++)
		lost += count(b, 0) < 0;
	KUNIT_EXPECT_EQ(test, lost, 0);
}

static void sim_segment_fates_are_reported(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 2);
	struct ec_sim_result res;
	struct ec_frame_buf f;
	u8 copy[64];
	size_t n;

	fault(test, b, EC_SIM_FAULT_DUPLICATE, 0, -1, 1, 0, 2);
	fault(test, b, EC_SIM_FAULT_DELAY, 0, -1, 1, 0, 5000);
	fault(test, b, EC_SIM_FAULT_MANGLE, 0, -1, 2, 0, 0);
	ec_frame_begin(&f, b->frame, sizeof(b->frame));
	memset(ec_frame_add(&f, EC_CMD_NOP, 1, 0, 0, 40), 0, 40);
	n = ec_frame_end(&f);
	memcpy(copy, b->frame, n);
	ec_sim_frame_result(b->sim, 0, b->frame, n, b->now, &res);
	KUNIT_EXPECT_EQ(test, res.copies, 3);
	KUNIT_EXPECT_EQ(test, res.delay_ns, (s64)(3 * 500 + 4 * 100 + 5000 + 80 * 80));
	KUNIT_EXPECT_TRUE(test, res.induced);
	KUNIT_EXPECT_FALSE(test, res.mangled);
	KUNIT_EXPECT_MEMEQ(test, copy, b->frame, n);
	ec_sim_frame_result(b->sim, 0, b->frame, n, b->now, &res);
	KUNIT_EXPECT_EQ(test, res.copies, 1);
	KUNIT_EXPECT_TRUE(test, res.mangled);
	KUNIT_EXPECT_MEMNEQ(test, copy, b->frame, n);
	ec_sim_frame_result(b->sim, 0, copy, n, b->now, &res);
	KUNIT_EXPECT_FALSE(test, res.induced);
}

static void sim_segment_slaves_misbehave_on_request(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);

	fault(test, b, EC_SIM_FAULT_DEAD, 1, 0, 1, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, b->adp, 3);
	fault(test, b, EC_SIM_FAULT_DEAD, 1, 0, 0, 0, 0);
	fault(test, b, EC_SIM_FAULT_MISS_BROADCAST, 1, 0, 1, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x10, 2), 1002ull);
	fault(test, b, EC_SIM_FAULT_WKC, 2, 0, 1, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	fault(test, b, EC_SIM_FAULT_EEPROM_NOACK, 0, 0, 1, 0, 0);
	bed_put(b, 1001, 0x502, 0x0100, 6);
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x2040ull);
	bed_put(b, 1001, 0x502, 0x0100, 6);
	b->now += 1000000;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
	fault(test, b, EC_SIM_FAULT_EEPROM_BUSY, 0, 0, 1, 0, 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x8040ull);
	ec_sim_clear_faults(b->sim);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x502, 2), 0x40ull);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
}

static void sim_segment_faults_happen_when_due(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 3);
	struct ec_sim_fault f = { .at_ns = 500000000, .slave = 1, .port = 0 };

	f.type = EC_SIM_FAULT_HEAL;
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	f.at_ns = 300000000;
	f.type = EC_SIM_FAULT_CUT;
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), 0);
	f.slave = 3;
	KUNIT_EXPECT_EQ(test, ec_sim_add_fault(b->sim, &f), -EINVAL);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), 300000000ull);
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	b->now = 300000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 1);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), 500000000ull);
	b->now = 500000000;
	KUNIT_EXPECT_EQ(test, count(b, 0), 3);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

static void sim_segment_every_fault_and_bug_has_name(struct kunit *test)
{
	int i;

	for (i = 0; i < EC_SIM_FAULT_TYPES; i++)
		KUNIT_EXPECT_NOT_NULL(test, ec_sim_fault_name(i));
	for (i = 0; i < EC_SIM_BUGS; i++)
		KUNIT_EXPECT_NOT_NULL(test, ec_sim_bug_name(i));
	KUNIT_EXPECT_NULL(test, ec_sim_bug_name(EC_SIM_BUGS));
	KUNIT_EXPECT_NULL(test, ec_sim_fault_name(EC_SIM_FAULT_TYPES));
}

/* ---- the shortcuts change nothing */

struct rnd {
	u64 state;
};

static u32 rnd(struct rnd *r, u32 n)
{
	r->state = r->state * 6364136223846793005ULL + 1442695040888963407ULL;
	return (u32)(r->state >> 33) % n;
}

static size_t random_frame(struct rnd *r, u8 *buf, size_t cap)
{
	static const u16 ados[] = {
		0x000, 0x010, 0x012, 0x100, 0x110, 0x120, 0x130, 0x200, 0x210,
		0x300, 0x400, 0x420, 0x500, 0x502, 0x508, 0x600, 0x610, 0x800,
		0x808, 0x810, 0x900, 0x910, 0x920, 0x930, 0xf80, 0x1000,
		0x1080, 0x1100, 0x1180, 0x2ff8,
	};
	struct ec_frame_buf f;
	u32 n = 1 + rnd(r, 6), i;

	ec_frame_begin(&f, buf, cap);
	while (n--) {
		u8 cmd = (u8)rnd(r, 16);
		u16 len = (u16)(1 + rnd(r, 20)), ado;
		u16 adp = (u16)(rnd(r, 2) ? 1000 + rnd(r, 12) :
				rnd(r, 4) ? -rnd(r, 10) : rnd(r, 3));
		u8 *p;

		ado = ados[rnd(r, ARRAY_SIZE(ados))];
		if (cmd >= EC_CMD_LRD && cmd <= EC_CMD_LRW) {
			adp = (u16)rnd(r, 64);
			ado = 0;
		}
		p = ec_frame_add(&f, cmd, 3, adp, ado, len);
		for (i = 0; i < len; i++)
			p[i] = (u8)(rnd(r, 3) ? 0 : rnd(r, 256));
		/* keep most of them reachable */
		if (ec_cmd_writes(cmd) && ado == 0x100 && len > 1)
			p[1] &= rnd(r, 20) ? 0 : 0x54;
		if (cmd != EC_CMD_NOP && ado == 0x010 && len > 1) {
			p[0] = (u8)(0xe8 + rnd(r, 12));
			p[1] = 3;
		}
		if (ado == 0x600 && len > 12) {
			p[1] = p[2] = p[3] = p[5] = 0;
			p[9] = 0x10;
			p[12] = 1;
		}
	}
	return ec_frame_end(&f);
}

static void sim_segment_shortcuts_do_not_change_results(struct kunit *test)
{
	struct bed *a = tree(test), *b = tree(test);
	u8 *fa = a->frame, *fb = b->frame;
	struct rnd r = { 1 };
	u32 i, s;

	ec_sim_set_slow(b->sim, true);
	for (i = 0; i < 20000; i++) {
		struct ec_sim_result ra, rb;
		struct ec_sim_fault f = { .type = rnd(&r, 4),
			.slave = (int)rnd(&r, 7), .port = (int)rnd(&r, 4) };
		u64 now = a->now + i * 30000ull;
		size_t len = random_frame(&r, fa, sizeof(a->frame));

		memcpy(fb, fa, len);
		if (!rnd(&r, 100)) {
			ec_sim_add_fault(a->sim, &f);
			ec_sim_add_fault(b->sim, &f);
		}
		if (!rnd(&r, 30)) {
			f.type = rnd(&r, 2) ? EC_SIM_FAULT_HEAL :
					      EC_SIM_FAULT_POWER_ON;
			for (s = 0; s < 28; s++) {
				f.slave = (int)s / 4;
				f.port = (int)s % 4;
				ec_sim_add_fault(a->sim, &f);
				ec_sim_add_fault(b->sim, &f);
			}
		}
		ec_sim_frame_result(a->sim, 0, fa, len, now, &ra);
		ec_sim_frame_result(b->sim, 0, fb, len, now, &rb);
		KUNIT_ASSERT_EQ(test, ra.delay_ns, rb.delay_ns);
		KUNIT_ASSERT_EQ(test, ra.out_port, rb.out_port);
		KUNIT_ASSERT_MEMEQ(test, fa, fb, len);
	}
	for (s = 0; s < 7; s++)
		KUNIT_EXPECT_MEMEQ(test, ec_sim_slave(a->sim, s)->mem,
				   ec_sim_slave(b->sim, s)->mem,
				   ec_sim_slave(a->sim, s)->mem_len);
	ec_sim_free(a->sim);
}

static void sim_segment_long_line_is_processed(struct kunit *test)
{
	struct bed *b = bed_new(test, 3000, 0);
	u8 v[2] = {};
	int i;

	b->cfg.ram_kib = 1;
	for (i = 0; i < 3000; i++) {
		KUNIT_ASSERT_NOT_NULL(test, ec_sim_add(b->sim, &b->cfg));
		KUNIT_ASSERT_EQ(test, ec_sim_wire(b->sim, i - 1, 1, i, 0, 100), 0);
	}
	KUNIT_EXPECT_EQ(test, count(b, 0), 3000);
	KUNIT_EXPECT_EQ(test, b->delay,
			(s64)(3000 * 200 + 5999 * 500 + MIN_NS));
	KUNIT_EXPECT_EQ(test, bed_station(b, (u16)-2999, 7), 1);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 7, 0x10, v, 2), 1);
	fault(test, b, EC_SIM_FAULT_CUT, 1500, 0, 0, 0, 0);
	KUNIT_EXPECT_EQ(test, count(b, 0), 1500);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_segment_frame_takes_its_time),
	KUNIT_CASE(sim_segment_without_slaves_there_is_no_link),
	KUNIT_CASE(sim_segment_foreign_frames_pass_unchanged),
	KUNIT_CASE(sim_segment_header_length_is_ignored),
	KUNIT_CASE(sim_segment_dl_status_shows_links_and_loops),
	KUNIT_CASE(sim_segment_loop_setting_may_be_temporary),
	KUNIT_CASE(sim_segment_slaves_with_same_address_both_answer),
	KUNIT_CASE(sim_segment_auto_close_waits_for_write),
	KUNIT_CASE(sim_segment_cut_cable_shortens_line),
	KUNIT_CASE(sim_segment_power_loss_forgets_registers),
	KUNIT_CASE(sim_segment_tree_is_walked_in_port_order),
	KUNIT_CASE(sim_segment_wiring_is_checked),
	KUNIT_CASE(sim_segment_whole_ring_comes_out_at_other_port),
	KUNIT_CASE(sim_segment_cut_ring_answers_from_both_sides),
	KUNIT_CASE(sim_segment_circulating_frame_is_destroyed),
	KUNIT_CASE(sim_segment_frame_opens_auto_closed_port),
	KUNIT_CASE(sim_segment_nth_frame_is_lost),
	KUNIT_CASE(sim_segment_frames_are_lost_by_chance),
	KUNIT_CASE(sim_segment_fates_are_reported),
	KUNIT_CASE(sim_segment_slaves_misbehave_on_request),
	KUNIT_CASE(sim_segment_faults_happen_when_due),
	KUNIT_CASE(sim_segment_every_fault_and_bug_has_name),
	KUNIT_CASE(sim_segment_shortcuts_do_not_change_results),
	KUNIT_CASE(sim_segment_long_line_is_processed),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_segment",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
