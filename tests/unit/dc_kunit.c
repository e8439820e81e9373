// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/dc.h"

#define P(n) BIT(n)

/* the worked example: S2 at port 3 of S1, S3 at its port 1, S4 behind S3 */
static void dc_delays_of_tree(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(3) | P(1), .dc = true,
		  .recv = { 1000, 4000, 0, 2000 } },
		{ .parent = 0, .parent_port = 3, .open = P(0), .dc = true, .recv = { 80000 } },
		{ .parent = 0, .parent_port = 1, .open = P(0) | P(1), .dc = true,
		  .recv = { 5000000, 5000600 } },
		{ .parent = 2, .parent_port = 1, .open = P(0), .dc = true, .recv = { 123456 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[0].delay, 0u);
	KUNIT_EXPECT_EQ(test, n[1].delay, 500u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 1700u);
	KUNIT_EXPECT_EQ(test, n[3].delay, 2000u);
	KUNIT_EXPECT_EQ(test, ec_dc_offset(1000000000, n[0].delay, 1000), 999999000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_offset(1000000000, n[1].delay, 80000), 999920500ull);
	KUNIT_EXPECT_EQ(test, ec_dc_offset(1000000000, n[2].delay, 5000000), 995001700ull);
	KUNIT_EXPECT_EQ(test, ec_dc_offset(1000000000, n[3].delay, 123456), 999878544ull);
}

/* behind the break of a ring: a frame comes by port 1 of the last slave, at the same time */
static void dc_delays_of_open_ring(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 1000 } },
		{ .parent = 0, .parent_port = 1, .open = P(0), .dc = true, .recv = { 7 } },
		{ .parent = 3, .entry = 1, .open = P(1), .dc = true, .other = true,
		  .recv = { 99999, 50 } },
		{ .parent = EC_DC_NONE, .entry = 1, .open = P(0) | P(1), .dc = true, .other = true,
		  .recv = { 4600, 4000 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 500u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 300u);
	KUNIT_EXPECT_EQ(test, n[3].delay, 600u);
	ec_dc_delays(n, ARRAY_SIZE(n), 3);
	KUNIT_EXPECT_EQ(test, n[0].delay, -600u);
	KUNIT_EXPECT_EQ(test, n[2].delay, -300u);
}

/* receive times that wrap between two ports */
static void dc_delays_across_wrap(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true,
		  .recv = { 0xffffff00, 0x00000100 } },
		{ .parent = 0, .parent_port = 1, .open = P(0), .dc = true, .recv = { 5 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 256u);
}

/* a slave without clock between two with one is a part of the cable */
static void dc_delays_through_slave_without_clock(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 2600 } },
		{ .parent = 0, .parent_port = 1, .open = P(0) | P(1) },
		{ .parent = 1, .parent_port = 1, .open = P(0) | P(1), .dc = true,
		  .recv = { 10, 610 } },
		{ .parent = 2, .parent_port = 1, .open = P(0), .dc = true, .recv = { 7 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 0u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 1000u);
	KUNIT_EXPECT_EQ(test, n[3].delay, 1300u);
}

/* two behind a coupler without clock: the way is shared in equal parts */
static void dc_delays_behind_branch_without_clock(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 1500 } },
		{ .parent = 0, .parent_port = 1, .open = P(0) | P(3) | P(1) },
		{ .parent = 1, .parent_port = 3, .open = P(0), .dc = true, .recv = { 99 } },
		{ .parent = 1, .parent_port = 1, .open = P(0), .dc = true, .recv = { 98 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[2].delay, 500u);
	KUNIT_EXPECT_EQ(test, n[3].delay, 1000u);
}

/*
 * Connected the wrong way round: the frame comes in by port 1, and is at the processing
 * unit when it comes back to port 0, after the slave that hangs there.
 */
static void dc_delays_of_reversed_slave(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 3000 } },
		{ .parent = 2, .parent_port = 0, .open = P(0), .dc = true, .recv = { 0 } },
		{ .parent = 0, .parent_port = 1, .entry = 1, .open = P(0) | P(1), .dc = true,
		  .recv = { 1600, 1000 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 1500u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 1800u);
	KUNIT_EXPECT_EQ(test, n[2].hop, 1200u);
	KUNIT_EXPECT_FALSE(test, n[0].unreliable || n[1].unreliable || n[2].unreliable);
}

/* the same at the end of a branch: port 0 is closed, and what it latched once is old */
static void dc_delays_of_reversed_end(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1) | P(2), .dc = true,
		  .recv = { 0, 1000, 3000 } },
		{ .parent = 0, .parent_port = 1, .entry = 1, .open = P(1), .dc = true,
		  .recv = { 77, 999999999 } },
		{ .parent = 0, .parent_port = 2, .open = P(0), .dc = true },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 500u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 2000u);
	KUNIT_EXPECT_FALSE(test, n[1].unreliable || n[2].unreliable);
}

/* in by port 1, out by 2, then the processing unit, then out by 3; and a clock at each */
static void dc_delays_on_both_sides_of_unit(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = 1, .parent_port = 2, .open = P(0), .dc = true },
		{ .parent = EC_DC_NONE, .entry = 1, .open = P(1) | P(2) | P(3), .dc = true,
		  .recv = { 5, 1000, 1600, 2600 } },
		{ .parent = 1, .parent_port = 3, .open = P(0), .dc = true },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[0].delay, 0u);
	KUNIT_EXPECT_EQ(test, n[1].delay, 300u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 800u);
}

/* times of a closed port, or of another latch: said, not taken for a way */
static void dc_impossible_times_are_inconsistent(struct kunit *test)
{
	static const u32 back[] = { 500000000, 0x80000000, 0xfffffc00, 3000000 };
	u32 i;

	for (i = 0; i < ARRAY_SIZE(back); i++) {
		struct ec_dc_node n[] = {
			{ .parent = EC_DC_NONE, .open = P(0) | P(1) | P(2), .dc = true,
			  .recv = { 0, 1000, 1000 + back[i] } },
			{ .parent = 0, .parent_port = 1, .open = P(0), .dc = true },
			{ .parent = 0, .parent_port = 2, .open = P(0) | P(1), .dc = true,
			  .recv = { 0, 600 } },
			{ .parent = 2, .parent_port = 1, .open = P(0), .dc = true },
		};

		ec_dc_delays(n, ARRAY_SIZE(n), 0);
		KUNIT_EXPECT_FALSE(test, n[0].unreliable);
		KUNIT_EXPECT_FALSE(test, n[1].unreliable);
		KUNIT_EXPECT_TRUE_MSG(test, n[2].unreliable, "%x", back[i]);
		KUNIT_EXPECT_TRUE(test, n[3].unreliable);
	}
}

/* A broken slave in a line: those behind it get a delay of some us less, not of a second. */
static void dc_impossible_times_do_not_spread(struct kunit *test)
{
	static const u32 broken[] = { 1 << 30, 3u << 30, 1u << 31 };
	u32 i, k;

	for (i = 0; i < ARRAY_SIZE(broken); i++) {
		struct ec_dc_node n[] = {
			{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true,
			  .recv = { 0, 3000 } },
			{ .parent = 0, .parent_port = 1, .open = P(0) | P(1), .dc = true,
			  .recv = { 7, 7 + broken[i] } },
			{ .parent = 1, .parent_port = 1, .open = P(0) | P(1), .dc = true,
			  .recv = { 0, 1000 } },
			{ .parent = 2, .parent_port = 1, .open = P(0), .dc = true },
		};

		ec_dc_delays(n, ARRAY_SIZE(n), 0);
		KUNIT_EXPECT_FALSE(test, n[0].unreliable);
		for (k = 1; k < ARRAY_SIZE(n); k++) {
			KUNIT_EXPECT_TRUE(test, n[k].unreliable);
			KUNIT_EXPECT_LT_MSG(test, n[k].delay, 1000000u, "%x, slave %u", broken[i],
					    k);
		}
		/* what a healthy slave measures is kept */
		KUNIT_EXPECT_EQ(test, n[3].hop, 500u);
		KUNIT_EXPECT_EQ(test, n[3].delay - n[2].delay, 500u);
	}
}

/* The same in front of slaves that are no part of its line, and for its own processing unit. */
static void dc_impossible_times_do_not_spread_to_branches(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1) | P(2) },
		{ .parent = 0, .parent_port = 1, .entry = 1, .open = P(1) | P(2) | P(3), .dc = true,
		  .recv = { 0, 0, 1 << 30, (1 << 30) + 600 } },
		{ .parent = 1, .parent_port = 2, .open = P(0), .dc = true },
		{ .parent = 1, .parent_port = 3, .open = P(0), .dc = true },
		{ .parent = 0, .parent_port = 2, .open = P(0), .dc = true },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 1);
	KUNIT_EXPECT_TRUE(test, n[2].unreliable);
	KUNIT_EXPECT_EQ(test, n[2].delay, 0u);
	KUNIT_EXPECT_EQ(test, n[3].delay, 300u);
	KUNIT_EXPECT_EQ(test, n[4].delay, 600u);
}

/* Two broken slaves behind a coupler without clock, whose times add up to none. */
static void dc_impossible_times_do_not_cancel(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 3000 } },
		{ .parent = 0, .parent_port = 1, .open = P(0) | P(1) | P(2) | P(3) },
		{ .parent = 1, .parent_port = 3, .open = P(0) | P(1), .dc = true,
		  .recv = { 0, 1 << 30 } },
		{ .parent = 1, .parent_port = 1, .open = P(0) | P(1), .dc = true,
		  .recv = { 0, 3u << 30 } },
		{ .parent = 1, .parent_port = 2, .open = P(0), .dc = true },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_TRUE(test, n[4].unreliable);
	KUNIT_EXPECT_LT(test, n[3].delay, 1000000u);
	KUNIT_EXPECT_LT(test, n[4].delay, 1000000u);
}

static void dc_slaves_before_reference_have_negative_delay(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 1400 } },
		{ .parent = 0, .parent_port = 1, .open = P(0), .dc = true, .recv = { 50 } },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 1);
	KUNIT_EXPECT_EQ(test, n[0].delay, (u32)-700);
	KUNIT_EXPECT_EQ(test, n[1].delay, 0u);
	KUNIT_EXPECT_EQ(test, ec_dc_offset(10000, n[0].delay, 300), 9000ull);
}

/* noise must not turn a short cable into four seconds */
static void dc_negative_distance_counts_as_zero(struct kunit *test)
{
	struct ec_dc_node n[] = {
		{ .parent = EC_DC_NONE, .open = P(0) | P(1), .dc = true, .recv = { 0, 590 } },
		{ .parent = 0, .parent_port = 1, .open = P(0) | P(1), .dc = true,
		  .recv = { 0, 600 } },
		{ .parent = 1, .parent_port = 1, .open = P(0), .dc = true },
	};

	ec_dc_delays(n, ARRAY_SIZE(n), 0);
	KUNIT_EXPECT_EQ(test, n[1].delay, 0u);
	KUNIT_EXPECT_EQ(test, n[2].delay, 300u);
}

static void dc_difference_has_sign_and_magnitude(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_dc_diff(0x80000005), 5);
	KUNIT_EXPECT_EQ(test, ec_dc_diff(0x00000005), -5);
	KUNIT_EXPECT_EQ(test, ec_dc_diff(0x80000000), 0);
	KUNIT_EXPECT_EQ(test, ec_dc_diff(0x7fffffff), -0x7fffffff);
}

static void dc_start_is_on_grid(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_dc_start(1100123456, 0, 1000000, 0), 1101000000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, 0), 1101000000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000001, 0, 1000000, 250000), 1101250000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101250001, 0, 1000000, 250000), 1102250000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, -250000), 1101750000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, 5250000), 1101250000ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(10, 0, 1000000, 250), 250ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, 999999), 1101999999ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, -999999), 1101000001ull);
	KUNIT_EXPECT_EQ(test, ec_dc_start(1101000000, 0, 1000000, -1000000), 1101000000ull);
}

/* an application time that wraps below zero, or is of another decade */
static void dc_start_is_on_grid_far_away(struct kunit *test)
{
	u64 phase = 0 - 946684799999000123ULL;
	u64 start = ec_dc_start(815000000000000000ULL, phase, 1000000, 0);

	KUNIT_EXPECT_GE(test, start, 815000000000000000ULL);
	KUNIT_EXPECT_LT(test, start, 815000000001000000ULL);
	KUNIT_EXPECT_EQ(test, (start - phase) % 1000000, 0ull);
	phase = 815000000000123456ULL;
	start = ec_dc_start(5000000, phase, 1000000, -1);
	KUNIT_EXPECT_EQ(test, start, 5123455ull);
	KUNIT_EXPECT_EQ(test, (phase - start) % 1000000, 1ull);
}

static void dc_sync_fits_multiples(struct kunit *test)
{
	static const struct {
		u32 sync0, cycle;
		bool fits;
	} t[] = {
		{ 1000000, 1000000, true }, { 500000, 1000000, true }, { 2000000, 1000000, true },
		{ 62500, 1000000, true }, { 333333, 1000000, true }, { 0, 1000000, true },
		{ 1000000, 0, true }, { 1000000, 998000, true }, { 250000, 1003000, true },
		{ 300000, 1000000, false }, { 750000, 1000000, false }, { 1500000, 1000000, false },
		{ 1000000, 1100000, false }, { 4000000000u, 1500000000, false },
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(t); i++)
		KUNIT_EXPECT_EQ_MSG(test, ec_dc_sync_fits(t[i].sync0, t[i].cycle), t[i].fits,
				    "%u in %u", t[i].sync0, t[i].cycle);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(dc_delays_of_tree),
	KUNIT_CASE(dc_delays_of_open_ring),
	KUNIT_CASE(dc_delays_across_wrap),
	KUNIT_CASE(dc_delays_through_slave_without_clock),
	KUNIT_CASE(dc_delays_behind_branch_without_clock),
	KUNIT_CASE(dc_delays_of_reversed_slave),
	KUNIT_CASE(dc_delays_of_reversed_end),
	KUNIT_CASE(dc_delays_on_both_sides_of_unit),
	KUNIT_CASE(dc_impossible_times_are_inconsistent),
	KUNIT_CASE(dc_impossible_times_do_not_spread),
	KUNIT_CASE(dc_impossible_times_do_not_spread_to_branches),
	KUNIT_CASE(dc_impossible_times_do_not_cancel),
	KUNIT_CASE(dc_slaves_before_reference_have_negative_delay),
	KUNIT_CASE(dc_negative_distance_counts_as_zero),
	KUNIT_CASE(dc_difference_has_sign_and_magnitude),
	KUNIT_CASE(dc_start_is_on_grid),
	KUNIT_CASE(dc_start_is_on_grid_far_away),
	KUNIT_CASE(dc_sync_fits_multiples),
	{ }
};

static struct kunit_suite suite = { .name = "dc", .test_cases = cases };
kunit_test_suite(suite);
