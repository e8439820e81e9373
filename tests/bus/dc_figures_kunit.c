// SPDX-License-Identifier: GPL-2.0-only
/*
 * Figures of distributed clocks: random trees of 100 slaves with clocks of all
 * rates that were switched on at any time. What counts is the true difference of
 * the modelled clocks to the reference, not what the slaves say of it.
 */
#include <linux/moduleparam.h>
#include <linux/prandom.h>
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"

#define SLAVES		100
#define LIMIT_NS	100
#define STEP_S		200
#define WINDOW_MS	300	/* of bus time, from activation until all are in the window */
#define EXACT_MS	400	/* until they are within LIMIT_NS */

/* how long each of them is watched, s of virtual time */
static unsigned int seconds = 20;
module_param(seconds, uint, 0444);

/* how many trees, and the first of them */
static unsigned int trees = 3;
module_param(trees, uint, 0444);
static unsigned int first = 1;
module_param(first, uint, 0444);

/* A tree: every line may go on behind any junction that has a port left. */
static void describe(char *text, size_t size, u32 seed)
{
	u32 i, n, junction[SLAVES], open = 0;
	struct rnd_state r;

	prandom_seed_state(&r, seed);
	n = scnprintf(text, size, "segment seed=%u\n", seed);
	for (i = 0; i < SLAVES; i++) {
		u32 v = prandom_u32_state(&r);
		bool fork = i && v % 8 == 0;

		if (open && v % 11 == 0) {
			u32 k = (v >> 8) % open;

			n += scnprintf(text + n, size - n, "branch s%u 2\n", junction[k]);
			junction[k] = junction[--open];
		}
		n += scnprintf(text + n, size - n,
			       "slave s%u %s drift=%dppb clock=%ums cable=%u\n", i,
			       fork ? "EK1100" : "drive in=8 out=8",
			       (int)(prandom_u32_state(&r) % 200001) - 100000,
			       prandom_u32_state(&r), 5 + prandom_u32_state(&r) % 500);
		if (fork)
			junction[open++] = i;
	}
}

/* Largest difference of a slave's system time to that of the reference, ns. */
static u64 worst(struct bus *b)
{
	u64 now = ktime_get_ns(), max = 0, ref;
	u32 i;

	ec_sim_advance(b->sim, now);
	ref = ec_esc_system_time(bus_esc(b, 0), now);
	for (i = 1; i < SLAVES; i++) {
		s64 d = ec_esc_system_time(bus_esc(b, i), now) - ref;

		max = max_t(u64, max, abs(d));
	}
	return max;
}

static void sync_each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

/* the tree being looked at; it lives longer than a case */
static struct {
	struct bus *b;
	struct cyc c;
	u32 seed;
	u64 t0;		/* activation (ktime, ns) */
	u64 window_us;	/* from then on: all in the window */
	u64 exact_us;	/* all within LIMIT_NS */
	u64 max;
} tree;

static void drop(struct kunit_suite *suite)
{
	bus_down(tree.b);
	memset(&tree, 0, sizeof(tree));
}

static void prepare(struct kunit *test, u32 seed)
{
	char *text = kunit_kzalloc(test, 16384, GFP_KERNEL);
	struct bus *b;
	struct cyc *c;

	KUNIT_ASSERT_NOT_NULL(test, text);
	describe(text, 16384, seed);
	drop(NULL);
	b = bus_up(test, text, SLAVES);
	tree.b = b;
	tree.seed = seed;
	test->priv = NULL;
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, SLAVES, 0);
	c->each = sync_each;
	tree.t0 = ktime_get_ns();
	cyc_activate(c);
	tree.c = *c;
}

/* How long after activation were they too far apart the last time? */
static void settle(struct kunit *test)
{
	struct bus *b = tree.b;
	u64 ns, us;
	u32 i;

	for (i = 0; i < 2000; i++) {
		cyc_run(&tree.c, 1);
		ns = worst(b);
		us = div_u64(ktime_get_ns() - tree.t0, NSEC_PER_USEC);
		if (ns >= EC_DC_LIMIT_NS)
			tree.window_us = us;
		if (ns >= LIMIT_NS)
			tree.exact_us = us;
	}
	bus_row(tree.window_us, WINDOW_MS * 1000,
		"us from activation until clocks of 100 slaves are in the sync window, tree %u",
		tree.seed);
	bus_row(tree.exact_us, EXACT_MS * 1000,
		"us from activation until they are within 100 ns, tree %u", tree.seed);
	KUNIT_EXPECT_LT(test, tree.window_us, WINDOW_MS * 1000ull);
	KUNIT_EXPECT_LT(test, tree.exact_us, EXACT_MS * 1000ull);
}

/* A part of the time in which it is watched; KUnit ends a case after 300 s. */
struct part {
	u32 seed;
	u32 from;
	u32 to;
};

static const void *next_part(const void *prev, char *desc)
{
	static struct part p;

	if (!prev)
		p = (struct part){ .seed = first };
	else if (p.to < seconds)
		p.from = p.to;
	else
		p = (struct part){ .seed = p.seed + 1 };
	if (p.seed >= first + trees)
		return NULL;
	p.to = min(p.from + STEP_S, seconds);
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "tree %u up to %u s", p.seed, p.to);
	return &p;
}

static void dc_trees(struct kunit *test)
{
	const struct part p = *(const struct part *)test->param_value;
	u32 i;

	if (!p.from)
		prepare(test, p.seed);
	KUNIT_ASSERT_NOT_NULL(test, tree.b);
	tree.b->test = test;
	if (!p.from)
		settle(test);
	for (i = p.from * 10; i < p.to * 10; i++) {
		cyc_run(&tree.c, 100);
		tree.max = max(tree.max, worst(tree.b));
	}
	KUNIT_EXPECT_LT(test, tree.max, (u64)LIMIT_NS);
	if (p.to < seconds)
		return;
	bus_figure("100 slaves, +-100 ppm, tree %u: from activation %llu us until all are in the sync window, %llu us until within %d ns, then %u s within %llu ns",
		   p.seed, tree.window_us, tree.exact_us, LIMIT_NS, seconds, tree.max);
	bus_row(tree.max, LIMIT_NS, "clocks of 100 slaves, tree %u: then for %u s within, ns",
		p.seed, seconds);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(dc_trees, next_part),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_dc_figures", .exit = bus_exit, .suite_exit = drop, .test_cases = cases,
};
kunit_test_suite(suite);
