// SPDX-License-Identifier: GPL-2.0-only
#include "sim_esc_kunit.h"

#define MS	1000000ull

static s64 error_ns(struct bed *b, u32 slave)
{
	return (s64)(ec_esc_system_time(ec_sim_slave(b->sim, slave), b->now) -
		     ec_esc_system_time(ec_sim_slave(b->sim, 0), b->now));
}

static s64 abs64(s64 v)
{
	return v < 0 ? -v : v;
}

/* worked example of four slaves: the ways to them take 0, 500, 1700 and 2000 ns */
static struct bed *example(struct kunit *test)
{
	static const int w[4][4] = {
		{ -1, 0, 0, 100 }, { 0, 3, 1, 200 }, { 0, 1, 2, 400 },
		{ 2, 1, 3, 0 },
	};
	static const u64 local[4] = { 1000, 80000, 5000000, 123456 };
	static const u64 path[4] = { 0, 500, 1700, 2000 };
	struct bed *b = bed_new(test, 4, 0);
	int i;

	b->now = 10 * MS;
	for (i = 0; i < 4; i++) {
		b->cfg.process_ns = 300;
		b->cfg.forward_ns = 300;
		b->cfg.clock_start = local[i] - (10 * MS + 100 + path[i]);
		ec_sim_add(b->sim, &b->cfg);
		KUNIT_EXPECT_EQ(test, ec_sim_wire(b->sim, w[i][0], w[i][1], i,
						  0, (u32)w[i][3]), 0);
	}
	return b;
}

static void sim_esc_dc_worked_example_gives_published_result(struct kunit *test)
{
	struct bed *b = example(test);
	u8 v[32] = {};
	int i;

	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, 0x900, v, 4), 4);
	for (i = 0; i < 4; i++)
		bed_station(b, (u16)-i, (u16)(1001 + i));
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x900, 4), 1000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x90c, 4), 2000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x904, 4), 4000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1002, 0x900, 4), 80000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0x900, 4), 5000000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0x904, 4), 5000600ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1004, 0x900, 4), 123456ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0x918, 8), 5000000ull);

	/* with these offsets all copies of the system time agree */
	bed_put(b, 1001, 0x920, 999999000, 8);
	bed_put(b, 1002, 0x920, 999920500, 8);
	bed_put(b, 1003, 0x920, 995001700, 8);
	bed_put(b, 1004, 0x920, 999878544, 8);
	for (i = 1; i < 4; i++)
		KUNIT_EXPECT_EQ(test, error_ns(b, (u32)i), (s64)0);

	/* with the delays the comparison gives 0 */
	bed_put(b, 1002, 0x928, 500, 4);
	bed_put(b, 1003, 0x928, 1700, 4);
	bed_put(b, 1004, 0x928, 2000, 4);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 8), 4);
	for (i = 1; i < 4; i++)
		KUNIT_EXPECT_EQ(test, bed_get(b, (u16)(1001 + i), 0x92c, 4),
				0x80000000ull);
}

static void sim_esc_dc_receive_times_jitter_by_their_noise(struct kunit *test)
{
	struct bed *b = bed_new(test, 2, 0);
	u32 min_d = ~0u, max_d = 0;
	u8 v[16];
	int i;

	b->cfg.dc_noise_ns = 10;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	ec_sim_wire(b->sim, 0, 1, 1, 0, 100);
	bed_station(b, 0, 1001);
	for (i = 0; i < 200; i++) {
		u32 d;

		bed_tx(b, EC_CMD_BWR, 0, 0x900, v, 1);
		bed_rd(b, 1001, 0x900, v, 16);
		d = get_unaligned_le32(v + 4) - get_unaligned_le32(v);
		min_d = min(min_d, d);
		max_d = max(max_d, d);
	}
	KUNIT_EXPECT_GE(test, min_d, 1190u);
	KUNIT_EXPECT_LT(test, min_d, 1195u);
	KUNIT_EXPECT_LE(test, max_d, 1210u);
	KUNIT_EXPECT_GT(test, max_d, 1205u);
}

static void sim_esc_dc_slaves_without_dc_stay_out(struct kunit *test)
{
	struct bed *b = bed_new(test, 3, 1);
	u8 v[8] = {};

	b->cfg.features = 0;
	ec_sim_add(b->sim, &b->cfg);
	b->cfg.features = EC_FEAT_DC;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, 0, 1, 1, 0, 100);
	ec_sim_wire(b->sim, 1, 1, 2, 0, 100);
	bed_station(b, 0xffff, 1002);
	bed_station(b, 0xfffe, 1003);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, 0x900, v, 4), 2);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 8), 2);
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, 0x910, v, 8), 0);
	/* 32 bits only */
	b->now = 6000 * MS;
	KUNIT_EXPECT_EQ(test, bed_get(b, 1003, 0x910, 8) >> 32, 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x910, 8) >> 32, 1ull);
}

/* as a real EL1004, read with SOEM: receive times, nothing else of a clock */
static void sim_esc_dc_delay_only_slaves_have_receive_times(struct kunit *test)
{
	static const u16 absent[] = { 0x910, 0x918, 0x920, 0x928, 0x92c, 0x930, 0x934, 0x981 };
	struct bed *b = bed_new(test, 2, 1);
	u8 v[32] = {};
	size_t i;

	b->cfg.dc_delay_only = true;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, 0, 1, 1, 0, 100);
	bed_station(b, 0xffff, 1002);
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, 0x900, v, 4), 2);
	KUNIT_EXPECT_NE(test, bed_get(b, 1002, 0x900, 4), 0ull);
	for (i = 0; i < ARRAY_SIZE(absent); i++) {
		KUNIT_EXPECT_EQ(test, bed_rd(b, 1001, absent[i], v, 1), 1);
		KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, absent[i], v, 1), 0);
		KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_BWR, 0, absent[i], v, 1), 1);
	}
	KUNIT_EXPECT_EQ(test, bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 8), 1);
	/* one byte that exists makes a datagram count; the others stay 0 */
	memset(v, 0, sizeof(v));
	KUNIT_EXPECT_EQ(test, bed_rd(b, 1002, 0x900, v, 32), 1);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(v + 0x10), 0ull);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(v + 0x18), 0ull);
}

static void sim_esc_dc_write_never_sets_time(struct kunit *test)
{
	struct bed *b = bed_new(test, 1, 1);
	u64 t0, t1, n0 = b->now;
	int i;

	t0 = bed_get(b, 1001, 0x910, 8);
	bed_put(b, 1001, 0x910, t0 + 1000 * MS, 8);
	t1 = bed_get(b, 1001, 0x910, 8);
	KUNIT_EXPECT_GE(test, t1 - t0, 2 * b->gap);
	KUNIT_EXPECT_LE(test, t1 - t0, 2 * b->gap * 11 / 10);
	for (i = 0; i < 100; i++)
		bed_put(b, 1001, 0x910, 0, 8);
	t1 = bed_get(b, 1001, 0x910, 8);
	KUNIT_EXPECT_GE(test, t1 - t0, (b->now - b->gap - n0) * 89 / 100);
}

/* a reference and a slave with @ppb of drift, @phase ns off */
static struct bed *pair(struct kunit *test, s32 ppb, s64 phase)
{
	struct bed *b = bed_new(test, 2, 0);

	b->cfg.dc_noise_ns = 10;
	b->cfg.clock_start = 5000000000ull;
	ec_sim_add(b->sim, &b->cfg);
	b->cfg.drift_ppb = ppb;
	b->cfg.clock_start += (u64)phase;
	ec_sim_add(b->sim, &b->cfg);
	ec_sim_wire(b->sim, -1, 0, 0, 0, 100);
	ec_sim_wire(b->sim, 0, 1, 1, 0, 100);
	bed_station(b, 0, 1001);
	bed_station(b, 0xffff, 1002);
	bed_put(b, 1002, 0x928, 600, 4);
	bed_put(b, 1002, 0x930, 0x1000, 2);
	return b;
}

/* @n FRMW every @gap ns; time of the last one with an error above 100 ns */
static u64 settle(struct bed *b, u32 n, u64 gap)
{
	u64 t0 = b->now, last = 0;
	u8 v[8] = {};

	b->gap = gap;
	while (n--) {
		bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 8);
		if (abs64(error_ns(b, 1)) > 100)
			last = b->now - t0;
	}
	return last;
}

static void sim_esc_dc_burst_settles_faster_than_cycle(struct kunit *test)
{
	static const s32 ppb[] = { 5000, -20000, 50000 };
	size_t i;

	for (i = 0; i < ARRAY_SIZE(ppb); i++) {
		struct bed *burst = pair(test, ppb[i], 3000);
		struct bed *cycle = pair(test, ppb[i], 3000);
		u64 a, c;

		a = settle(burst, 15000, 10000);
		c = settle(cycle, 20000, MS);
		kunit_info(test, "%d ppb: burst %llu us, 1 kHz %llu us",
			   ppb[i], (unsigned long long)a / 1000,
			   (unsigned long long)c / 1000);
		KUNIT_EXPECT_LT(test, a, 150 * MS);
		KUNIT_EXPECT_GT(test, c, 1000 * MS);
		KUNIT_EXPECT_LT(test, c, 19000 * MS);
		/* and stays so in the cycle */
		KUNIT_EXPECT_LT(test, settle(burst, 2000, MS), 100 * MS);
		ec_sim_free(burst->sim);
		if (i + 1 < ARRAY_SIZE(ppb))
			ec_sim_free(cycle->sim);
	}
}

static void sim_esc_dc_without_comparisons_clocks_drift_apart(struct kunit *test)
{
	struct bed *b = pair(test, 20000, 0);

	b->now += 1000 * MS;
	KUNIT_EXPECT_GT(test, error_ns(b, 1), (s64)20000);
	KUNIT_EXPECT_LT(test, error_ns(b, 1), (s64)20100);
}

static void sim_esc_dc_difference_is_sign_and_magnitude(struct kunit *test)
{
	struct bed *b = pair(test, 0, 5000);
	u8 v[8] = {};
	u64 diff;

	bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 8);
	diff = bed_get(b, 1002, 0x92c, 4);
	KUNIT_EXPECT_GE(test, diff, 0x80000000ull + 4990);
	KUNIT_EXPECT_LE(test, diff, 0x80000000ull + 5010);
	bed_put(b, 1002, 0x920, (u64)-10000, 8);
	bed_tx(b, EC_CMD_FRMW, 1001, 0x910, v, 4);
	diff = bed_get(b, 1002, 0x92c, 4);
	KUNIT_EXPECT_GE(test, diff, 4900ull);
	KUNIT_EXPECT_LE(test, diff, 5200ull);
}

/* ---- SYNC unit */

static int syncs[2];
static u64 sync_at[2];

static void on_sync(struct ec_esc *esc, int which, u64 now)
{
	syncs[which]++;
	sync_at[which] = ec_esc_system_time(esc, now);
}

static const struct ec_esc_app_ops app_ops = { .sync = on_sync };

static void sim_esc_dc_sync_pulses_are_on_grid(struct kunit *test)
{
	struct bed *b = bed_new(test, 1, 1);
	u64 start;
	u8 v[8];

	memset(syncs, 0, sizeof(syncs));
	ec_sim_slave(b->sim, 0)->app_ops = &app_ops;
	ec_sim_slave(b->sim, 0)->cfg.drift_ppb = 30000;
	bed_put(b, 1001, 0x920, 777000000000000000ull, 8);
	start = bed_get(b, 1001, 0x910, 8) + 20 * MS;
	start -= start % MS;
	put_unaligned_le32(1000000, v);
	put_unaligned_le32(250000, v + 4);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x9a0, v, 8);
	bed_put(b, 1001, 0x990, start, 8);
	bed_put(b, 1001, 0x980, 0x0700, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 3ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x990, 8), start);
	ec_sim_advance(b->sim, b->now += 10 * MS);
	KUNIT_EXPECT_EQ(test, syncs[0], 0);
	ec_sim_advance(b->sim, b->now += 110 * MS);
	KUNIT_EXPECT_GE(test, syncs[0], 100);
	KUNIT_EXPECT_LE(test, syncs[0], 102);
	KUNIT_EXPECT_LE(test, abs64(syncs[0] - syncs[1]), (s64)1);
	KUNIT_EXPECT_EQ(test, sync_at[0] % MS / 10, 0ull);
	KUNIT_EXPECT_EQ(test, sync_at[1] % MS / 10, 25000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 0ull);
	KUNIT_EXPECT_EQ(test, (bed_get(b, 1001, 0x990, 8) - start) % MS, 0ull);
	KUNIT_EXPECT_GT(test, bed_get(b, 1001, 0x990, 8),
			bed_get(b, 1001, 0x910, 8));
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x998, 8) % MS, 250000ull);
	bed_put(b, 1001, 0x980, 0, 2);
	memset(syncs, 0, sizeof(syncs));
	ec_sim_advance(b->sim, b->now += 10 * MS);
	KUNIT_EXPECT_EQ(test, syncs[0], 0);
	KUNIT_EXPECT_EQ(test, ec_sim_next_event(b->sim), EC_ESC_NEVER);
}

static void sim_esc_dc_sync1_may_be_slower(struct kunit *test)
{
	struct bed *b = bed_new(test, 1, 1);
	u8 v[8];

	memset(syncs, 0, sizeof(syncs));
	ec_sim_slave(b->sim, 0)->app_ops = &app_ops;
	put_unaligned_le32(1000000, v);
	put_unaligned_le32(3000000, v + 4);
	bed_tx(b, EC_CMD_FPWR, 1001, 0x9a0, v, 8);
	bed_put(b, 1001, 0x990, 10 * MS, 8);
	bed_put(b, 1001, 0x980, 0x0700, 2);
	/* the first one after all of its time */
	ec_sim_advance(b->sim, b->now = 12 * MS + 500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 3);
	KUNIT_EXPECT_EQ(test, syncs[1], 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 2ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x998, 8), 13 * MS);
	ec_sim_advance(b->sim, b->now = 13 * MS + 500000);
	KUNIT_EXPECT_EQ(test, syncs[1], 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 0ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x998, 8), 17 * MS);
	ec_sim_advance(b->sim, b->now = 49 * MS + 500000);
	KUNIT_EXPECT_EQ(test, syncs[0], 40);
	KUNIT_EXPECT_EQ(test, syncs[1], 10);
}

static void sim_esc_dc_start_in_past_gives_no_pulse(struct kunit *test)
{
	struct bed *b = bed_new(test, 1, 1);

	memset(syncs, 0, sizeof(syncs));
	ec_sim_slave(b->sim, 0)->app_ops = &app_ops;
	b->now = 1000 * MS;
	bed_put(b, 1001, 0x9a0, 1000000, 4);
	bed_put(b, 1001, 0x990, 900 * MS, 8);
	bed_put(b, 1001, 0x980, 0x0300, 2);
	ec_sim_advance(b->sim, b->now += 50 * MS);
	KUNIT_EXPECT_EQ(test, syncs[0], 0);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 1ull);
	bed_put(b, 1001, 0x980, 0, 2);
	bed_put(b, 1001, 0x980, 0x2300, 2);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x984, 1), 5ull);
}

static void sim_esc_dc_latches_keep_time_of_edge(struct kunit *test)
{
	struct bed *b = bed_new(test, 1, 1);
	struct ec_esc *esc = ec_sim_slave(b->sim, 0);

	bed_get(b, 1001, 0x110, 2);
	bed_put(b, 1001, 0x200, 1, 2);
	bed_put(b, 1001, 0x9a8, 1, 1);
	ec_esc_latch(esc, 0, true, 12345678);
	ec_esc_latch(esc, 0, true, 12345999);	/* single event: ignored */
	ec_esc_latch(esc, 0, false, 12346000);
	ec_esc_latch(esc, 0, false, 12347000);	/* continuous */
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9ae, 1), 3ull);
	KUNIT_EXPECT_EQ(test, b->irq, 1);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9b0, 8), 12345678ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9ae, 1), 2ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9b8, 8), 12347000ull);
	KUNIT_EXPECT_EQ(test, bed_get(b, 1001, 0x9ae, 1), 0ull);
	KUNIT_EXPECT_EQ(test, b->irq, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_esc_dc_worked_example_gives_published_result),
	KUNIT_CASE(sim_esc_dc_receive_times_jitter_by_their_noise),
	KUNIT_CASE(sim_esc_dc_slaves_without_dc_stay_out),
	KUNIT_CASE(sim_esc_dc_delay_only_slaves_have_receive_times),
	KUNIT_CASE(sim_esc_dc_write_never_sets_time),
	KUNIT_CASE(sim_esc_dc_burst_settles_faster_than_cycle),
	KUNIT_CASE(sim_esc_dc_without_comparisons_clocks_drift_apart),
	KUNIT_CASE(sim_esc_dc_difference_is_sign_and_magnitude),
	KUNIT_CASE(sim_esc_dc_sync_pulses_are_on_grid),
	KUNIT_CASE(sim_esc_dc_sync1_may_be_slower),
	KUNIT_CASE(sim_esc_dc_start_in_past_gives_no_pulse),
	KUNIT_CASE(sim_esc_dc_latches_keep_time_of_edge),
	{}
};

static struct kunit_suite suite = {
	.name = "sim_esc_dc",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
