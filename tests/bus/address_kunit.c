// SPDX-License-Identifier: GPL-2.0-only
/* An address is written by position while slaves before that position leave the ring. */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/boundary/ioctl.h"
#include "master/bus/ports.h"

static const char text[] =
	"segment seed=3 response=100us transition=1ms\n"
	"slave hub EK1100\n"
	"repeat 2 slave a drive in=8 out=8\n"
	"branch hub 2\nslave fork EK1122\n"
	"repeat 2 slave b drive in=8 out=8\n"
	"branch fork 3\n"
	"repeat 2 slave x drive in=8 out=8\n";

/* in the segment, and in the ring */
enum { N = 8, A1 = 1, B1 = 4, B1_AT = 6 };

/* of a shorter bus, in the segment; in the ring X1 precedes B1 */
enum { M_B1 = 3, M_B2, M = 6 };

#define FRAMES	13	/* of a scan up to the addresses */
#define MOST_HITS	8

static struct bus *hooked;
static bool hook_loses;	/* the frame that writes addresses does not return */
static bool hook_forgets;	/* B2 has lost its address as well */

/*
 * The scan asks right after it has read the addresses: has the failed hub a configuration? The
 * next frame proves them, the one after it writes.
 */
static bool cut_now(const struct ec_slave *s)
{
	if (!hooked)
		return true;
	bus_command(hooked, "cut a1.0 frame=2 register=0x10");
	if (hook_loses)
		bus_command(hooked, "lose frame=2 register=0x10 when=back");
	if (hook_forgets)
		put_unaligned_le16(0x5555, bus_esc(hooked, M_B2)->mem + EC_REG_STATION);
	hooked = NULL;
	return true;
}

static void cut_after_read(struct bus *b)
{
	static struct ec_bus_ops ops;

	ops = *bus_table(b)->ops;
	ops.attached = cut_now;
	bus_table(b)->ops = &ops;
	WRITE_ONCE(bus_slave(b, 0)->note.error, EC_SLAVE_CONFIG_FAILED);
	hooked = b;
}

static bool has_address(struct bus *b, const struct ec_slave *s, u32 index)
{
	return get_unaligned_le16(bus_esc(b, index)->mem + EC_REG_STATION) == s->station;
}

/* Slaves X1 and X2 leave, and return without their addresses. */
static void forget_addresses(struct bus *b)
{
	bus_command(b, "off x1");
	bus_command(b, "off x2");
	KUNIT_EXPECT_NE(b->test, bus_wait(b, N - 2, EC_AL_PREOP, 20000), ~0ull);
	bus_command(b, "on x1");
	bus_command(b, "on x2");
}

/* Slaves B1 and B2 keep what they are, and have another address for a millisecond at most. */
static void expect_kept(struct bus *b, struct ec_slave *const *s, const char *what)
{
	u32 ms, i, wrong = 0;

	for (ms = 0; ms < 400; ms++) {
		bool all = true;

		usleep_range(1000, 1001);
		ec_sim_advance(b->sim, ktime_get_ns());
		for (i = 0; i < 2; i++)
			all &= has_address(b, s[i], B1 + i);
		wrong += !all;
	}
	KUNIT_EXPECT_LE_MSG(b->test, wrong, 1u, "%s", what);
	bus_command(b, "heal a1.0");
	KUNIT_EXPECT_NE_MSG(b->test, bus_wait(b, N, EC_AL_PREOP, 20000), ~0ull, "%s", what);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_PTR_EQ_MSG(b->test, bus_slave(b, B1_AT + i), s[i], "%s", what);
}

/* What was meant for X1 and X2 goes to B1 and B2. */
static void address_after_slaves_left(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s[2] = { bus_slave(b, B1_AT), bus_slave(b, B1_AT + 1) };
	u32 lines = bus_log_lines("those of 2 others restored");

	bus_idle(b);
	forget_addresses(b);
	cut_after_read(b);
	expect_kept(b, s, "cut");
	KUNIT_EXPECT_NULL(test, hooked);
	KUNIT_EXPECT_EQ(test, bus_log_lines("those of 2 others restored"), lines + 1);
}

/* The contact breaks while each of the frames is under way, which is lost. */
static void address_while_slaves_leave(struct kunit *test)
{
	struct bus *b = bus_up(test, text, N);
	struct ec_slave *s[2] = { bus_slave(b, B1_AT), bus_slave(b, B1_AT + 1) };
	char words[64];
	u32 n;

	bus_idle(b);
	for (n = 1; n <= 2 * FRAMES; n++) {
		forget_addresses(b);
		snprintf(words, sizeof(words), "cut a1.0 frame=%u when=%s", (n + 1) / 2,
			 n % 2 ? "out" : "back");
		bus_command(b, words);
		expect_kept(b, s, words);
	}
}

/*
 * Bus with slaves A1 on, fork, B1 on, X1 on. Those at which the address of one of X is written when
 * all of A are gone are B1 on, as many as there are of X.
 */
struct hit {
	const char *text;
	u32 n;
	u32 b;		/* B1 in the segment */
	u32 n_b;	/* these are the last ones of the ring */
	u32 n_x;
	bool forgets;
};

/* A session with all of B; slaves are let in without a trial, as with loops=auto. */
static struct cyc *run(struct kunit *test, const struct hit *h)
{
	struct bus *b = bus_up(test, h->text, h->n);
	struct cyc *c;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, h->n - h->n_b, h->n_b, 0);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 20000), ~0ull);
	ec_ports_guard(bus_table(b), false);
	cyc_run(c, 200);
	return c;
}

static void switch_x(struct cyc *c, const struct hit *h, const char *what)
{
	char words[32];
	u32 i;

	for (i = 1; i <= h->n_x; i++) {
		snprintf(words, sizeof(words), "%s x%u", what, i);
		bus_command(c->b, words);
	}
}

/*
 * All of A leave after the addresses were read: those of B get the ones of X, which have returned,
 * and the reply of the first frame is lost. They have their own back in the same scan.
 */
static void expect_given_back(struct kunit *test, const struct hit *h)
{
	struct cyc *c = run(test, h);
	struct bus *b = c->b;
	u32 ms, i, wrong = 0, other = 0, hits = 0;
	struct ec_slave *s[MOST_HITS];
	bool was[MOST_HITS] = { 0 };

	for (i = 0; i < h->n_x; i++)
		s[i] = ec_slave_ref(bus_slave(b, h->n - h->n_b + i));
	switch_x(c, h, "off");
	for (ms = 0; ms < 2000 && bus_n_slaves(b) != h->n - h->n_x; ms++)
		cyc_run(c, 1);
	cyc_run(c, 200);
	hook_loses = true;
	hook_forgets = h->forgets;
	cut_after_read(b);
	switch_x(c, h, "on");
	for (ms = 0; ms < 1000; ms++) {
		bool all = true;

		cyc_run(c, 1);
		for (i = 0; i < h->n_x; i++) {
			bool has = has_address(b, s[i], h->b + i);

			hits += !has && !was[i];
			was[i] |= !has;
			all &= has;
			other += READ_ONCE(s[i]->stop.gone) ||
				 READ_ONCE(s[i]->al.status) != EC_AL_OP;
		}
		wrong += !all;
	}
	hook_loses = hook_forgets = false;
	KUNIT_EXPECT_NULL(b->test, hooked);
	KUNIT_EXPECT_GE_MSG(b->test, hits, h->n_x > 1 ? h->n_x - 1 : 1, "not hit");
	KUNIT_EXPECT_LE(b->test, wrong, 40u);
	KUNIT_EXPECT_EQ(b->test, other, 0u);
	for (i = 0; i < h->n_x; i++)
		ec_slave_unref(s[i]);
}

#define SMALL(b1)								\
	"segment seed=3 response=100us transition=1ms\n"			\
	"slave hub EK1100\nslave a1 drive in=8 out=8\n"			\
	"branch hub 2\nslave fork EK1122\n"					\
	"slave b1 " b1 "\nslave b2 drive in=8 out=8\n"				\
	"branch fork 3\nslave x1 drive in=8 out=8\n"

#define WIDE									\
	"segment seed=3 response=100us transition=1ms\n"			\
	"slave hub EK1100\nrepeat 8 slave a drive in=8 out=8\n"		\
	"branch hub 2\nslave fork EK1122\n"					\
	"repeat 9 slave b drive in=8 out=8\n"					\
	"branch fork 3\nrepeat 8 slave x drive in=8 out=8\n"

enum { WIDE_FORK = 9, WIDE_B = 10, WIDE_N = 27 };

/* In the segment B1 on precede X1 on, in the ring they follow. */
static u32 wide_index(u32 position)
{
	return position == WIDE_FORK ? WIDE_FORK :
	       position < WIDE_N - 9 ? position + 9 : position - MOST_HITS;
}

/* Counting says nothing, as B2 has lost its address at the same time. */
static void address_reply_lost_given_back_by_fmmu(struct kunit *test)
{
	static const struct hit h = {
		.text = SMALL("drive in=8 out=8"), .n = M, .b = M_B1, .n_b = 2, .n_x = 1,
		.forgets = true,
	};

	expect_given_back(test, &h);
}

static void address_reply_lost_given_back_without_process_data(struct kunit *test)
{
	static const struct hit h = {
		.text = SMALL("EK1100"), .n = M, .b = M_B1, .n_b = 2, .n_x = 1,
	};

	expect_given_back(test, &h);
}

/* Seven addresses are in the frame that is lost, the eighth in the next, which returns. */
static void address_reply_lost_and_another_one_not(struct kunit *test)
{
	static const struct hit h = {
		.text = WIDE, .n = WIDE_N, .b = WIDE_B, .n_b = 9, .n_x = MOST_HITS,
	};
	u32 lines = bus_log_lines("those of 1 others restored");

	expect_given_back(test, &h);
	KUNIT_EXPECT_EQ(test, bus_log_lines("those of 1 others restored"), lines + 1);
}

/*
 * B2 has got an address by mistake, and nothing that the master has received says so. It has its
 * own back in the next scan, although slaves before it and after it have left: all of A, B4 on.
 */
static void expect_given_back_by_scan(struct kunit *test, const struct hit *h)
{
	struct cyc *c = run(test, h);
	struct bus *b = c->b;
	struct ec_slave *s = ec_slave_ref(bus_slave(b, h->n - h->n_b + 1));
	u32 ms, other = 0;

	put_unaligned_le16(++bus_table(b)->next_station,
			   bus_esc(b, h->b + 1)->mem + EC_REG_STATION);
	ec_sim_rehash(bus_esc(b, h->b + 1));
	bus_command(b, "off a1");
	bus_command(b, "off b4");
	for (ms = 0; ms < 2000; ms++) {
		cyc_run(c, 1);
		other += READ_ONCE(s->stop.gone) || READ_ONCE(s->al.status) != EC_AL_OP;
	}
	KUNIT_EXPECT_TRUE(test, has_address(b, s, h->b + 1));
	KUNIT_EXPECT_EQ(test, other, 0u);
	KUNIT_EXPECT_EQ(test, bus_n_slaves(b), h->n - 8 - (h->n_b - 3));
	ec_slave_unref(s);
}

static void address_unknown_given_back_by_scan(struct kunit *test)
{
	static const struct hit h = { .text = WIDE, .n = WIDE_N, .b = WIDE_B, .n_b = 9 };

	expect_given_back_by_scan(test, &h);
}

/* Its place is beside its neighbors, not so far from one end of the ring. */
static void address_unknown_given_back_beside_neighbors(struct kunit *test)
{
	static const struct hit h = {
		.text = "segment seed=3 response=100us transition=1ms\n"
			"slave hub EK1100\nrepeat 8 slave a drive in=8 out=8\n"
			"branch hub 2\nslave fork EK1122\n"
			"slave b1 drive in=8 out=8\nslave b2 EK1100\n"
			"slave b3 drive in=8 out=8\nslave b4 drive in=8 out=8\n"
			"branch fork 3\nslave x1 drive in=8 out=8\n",
		.n = 15, .b = WIDE_B, .n_b = 4,
	};

	expect_given_back_by_scan(test, &h);
}

/*
 * Slaves come to the ring between two frames that read its addresses: those behind them are read
 * at two positions. Each of them is one slave, and keeps its address.
 */
static void address_read_while_slaves_come(struct kunit *test)
{
	static const struct hit h = { .text = WIDE, .n = WIDE_N, .n_b = 9 };
	struct cyc *c = run(test, &h);
	struct bus *b = c->b;
	struct ec_slave *s[WIDE_N];
	u32 ms, i, wrong = 0, other = 0;

	for (i = WIDE_FORK; i < WIDE_N; i++)
		s[i] = ec_slave_ref(bus_slave(b, i));
	bus_command(b, "cut a1.0");
	for (ms = 0; ms < 2000 && bus_n_slaves(b) != WIDE_N - 8; ms++)
		cyc_run(c, 1);
	cyc_run(c, 200);
	bus_command(b, "heal a1.0 frame=2 register=0x10");
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESCAN, NULL), 0);
	for (ms = 0; ms < 1000; ms++) {
		cyc_run(c, 1);
		for (i = WIDE_FORK; i < WIDE_N; i++) {
			wrong += !has_address(b, s[i], wide_index(i));
			other += READ_ONCE(s[i]->stop.gone) ||
				 (i >= WIDE_N - h.n_b && READ_ONCE(s[i]->al.status) != EC_AL_OP);
		}
	}
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_EQ(test, other, 0u);
	KUNIT_ASSERT_EQ(test, bus_n_slaves(b), (u32)WIDE_N);
	for (i = WIDE_FORK; i < WIDE_N; i++) {
		KUNIT_EXPECT_PTR_EQ(test, bus_slave(b, i), s[i]);
		ec_slave_unref(s[i]);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(address_after_slaves_left),
	KUNIT_CASE(address_while_slaves_leave),
	KUNIT_CASE(address_reply_lost_given_back_by_fmmu),
	KUNIT_CASE(address_reply_lost_given_back_without_process_data),
	KUNIT_CASE(address_reply_lost_and_another_one_not),
	KUNIT_CASE(address_unknown_given_back_by_scan),
	KUNIT_CASE(address_unknown_given_back_beside_neighbors),
	KUNIT_CASE(address_read_while_slaves_come),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_address", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
