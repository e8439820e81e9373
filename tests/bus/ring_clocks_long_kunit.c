// SPDX-License-Identifier: GPL-2.0-only
/*
 * Clocks of a ring for minutes: closed, with a break at each cable, whole again. The reference
 * clock is on either side of the break, or lost. The clock of the computer is 50 ppm off and
 * wanders by up to 1 ppm.
 *
 * ring_clocks_long_kunit.minutes=N on the command line of the kernel says how long each of them
 * takes; without, some take some seconds. KUnit ends a case after 300 s, so each is four cases.
 */
#include <linux/slab.h>
#include "ring_clocks.h"

#define PARTS		4u
#define SECOND		1000u	/* cycles */
#define SHORT		20u	/* seconds */
#define SHORT_FIRST	20u	/* of @runs, then: one led by the application, and the lost ones */

static unsigned int minutes;
module_param(minutes, uint, 0444);
MODULE_PARM_DESC(minutes, "Minutes of each case, at most 11; 0: some cases, for seconds");

#define NOWHERE	CUTS	/* no cable is cut */

/* a break, and the reference clock: that gets the time of the application, or is lost */
struct run {
	u32 at;
	u32 ref;
	bool leads;
	u32 absent;	/* while it is lost */
};

static const struct run runs[] = {
	{ 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 5, 0 }, { 6, 0 }, { 7, 0 }, { 8, 0 },
	{ 0, 7 }, { 1, 7 }, { 2, 7 }, { 3, 7 }, { 4, 7 }, { 5, 7 }, { 6, 7 }, { 7, 7 }, { 8, 7 },
	{ 4, 3 }, { 3, 3 }, { 4, 0, true }, { 4, 7, true },
	{ NOWHERE, 0, false, 0x01 }, { 4, 0, false, 0x0f }, { 2, 5, false, 0x3c },
};

/* the present one, which lives longer than a case */
static struct {
	struct clocks k;
	struct cyc c;
	s64 before;	/* the break: largest difference of clocks, ns */
	s64 second;	/* behind it */
	s64 open;	/* then */
	s64 healed;	/* in the second behind that */
	s64 after;
	s64 lost;	/* of all from the line of the reference clock that is lost, in 2 s */
	s64 line;	/* of the next one from it at last */
	struct rnd_state random;
} now;

static const char numbers[ARRAY_SIZE(runs) * PARTS];	/* their addresses count */

static u32 cycles(void)
{
	return (minutes ? min(minutes, 11u) * 60 : SHORT) * SECOND;
}

static const void *next_part(const void *prev, char *desc)
{
	const char *next = prev ? (const char *)prev + 1 : numbers + !minutes * SHORT_FIRST * PARTS;
	u32 i = (next - numbers) / PARTS;

	if (i >= ARRAY_SIZE(runs))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "before %u, reference %u%s%s, part %u", runs[i].at,
		 runs[i].ref, runs[i].leads ? " led" : "", runs[i].absent ? " lost" : "",
		 (u32)(next - numbers) % PARTS + 1);
	return next;
}

static void long_exit(struct kunit_suite *suite)
{
	bus_down(now.k.b);
	memset(&now, 0, sizeof(now));
}

static void cable(const struct run *r, bool cut)
{
	if (r->at != NOWHERE)
		ring_cable_of(now.k.b, cut, r->at, SLAVES,
			      NSEC_PER_MSEC + prandom_u32_state(&now.random) % NSEC_PER_MSEC);
}

/* From now on in memory that stays. */
static void begin(struct kunit *test, const struct run *r)
{
	struct bus *b;
	struct clocks *k;

	long_exit(NULL);
	prandom_seed_state(&now.random, 37);
	b = clocks_bus(test);
	now.k.b = b;
	test->priv = NULL;
	k = clocks_new(b);
	k->leads = r->leads;
	bus_plug_scanned(b, SLAVES, 5000);
	clocks_activate(k, r->ref);
	now.c = *k->c;
	now.k = *k;
	now.k.c = &now.c;
	now.c.ctx = &now.k;
}

/* Its line goes on for two seconds, then counts that of the next one. */
static void lose(const struct run *r)
{
	struct clocks *k = &now.k;

	clocks_note_line(k);
	k->lost = true;
	k->absent = r->absent;
	clocks_power(k, r->ref, false);
	now.lost = clocks_run(k, 2 * SECOND);
	k->lost = false;
	k->ref = clocks_ref(k);
}

static void note_lost(void)
{
	struct clocks *k = &now.k;
	u64 at = ktime_get_ns();

	k->lost = true;
	now.line = abs((s64)(clock_of(k, k->ref, at) - clocks_line(k, at)));
	k->lost = false;
}

static void find_again(struct kunit *test, const struct run *r)
{
	struct clocks *k = &now.k;

	clocks_power(k, r->ref, true);
	now.healed = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	now.healed = max(now.healed, k->most);
	/* those that were gone learn their rate */
	now.healed = max(now.healed, clocks_run(k, 3 * SECOND));
	k->absent = 0;
}

static void expect(struct kunit *test, const struct run *r)
{
	char lost[128] = "";

	if (r->absent)
		snprintf(lost, sizeof(lost),
			 ", lost then: %lld ns from its line in 2 s, the next one %lld at last",
			 now.lost, now.line);
	bus_figure("ring for %u s, cut before slave %u, reference slave %u%s%s: clocks apart %lld ns before, %lld in the second after it, %lld in %u s then, %lld in the second after it has healed, then %lld",
		   cycles() / SECOND, r->at, r->ref,
		   r->leads ? " synchronized to the application" : "", lost, now.before, now.second,
		   now.open, cycles() / SECOND / 2, now.healed, now.after);
	KUNIT_EXPECT_LE(test, now.before, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.second, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.open, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.healed, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.after, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.lost, LOST_NS);
}

static void part(struct kunit *test, const struct run *r, u32 i)
{
	struct clocks *k = &now.k;

	if (i == 0) {
		now.before = clocks_run(k, cycles() / 12);
		cable(r, true);
		now.second = clocks_run(k, SECOND);
		if (r->absent)
			lose(r);
	} else if (i < PARTS - 1) {
		now.open = max(now.open, clocks_run(k, cycles() / 4));
	} else {
		if (r->at != NOWHERE && !r->absent)
			ring_open(k->b, r->at);
		if (r->absent)
			note_lost();
		cable(r, false);
		if (r->absent)
			find_again(test, r);
		else
			now.healed = clocks_run(k, SECOND);
		now.after = clocks_run(k, cycles() * 5 / 12);
		ring_closed(k->b, SLAVES);
	}
	KUNIT_EXPECT_TRUE(test, r->absent && i < PARTS - 1 ? true : cyc_all_op(k->c));
	clocks_on_grid(k);
}

static void clocks_long(struct kunit *test)
{
	u32 number = (const char *)test->param_value - numbers;
	const struct run *r = &runs[number / PARTS];

	if (number % PARTS == 0)
		begin(test, r);
	KUNIT_ASSERT_NOT_NULL(test, now.k.b);
	now.k.b->test = test;
	/* as cyc_activate() */
	sched_set_fifo_low(current);
	part(test, r, number % PARTS);
	if (number % PARTS == PARTS - 1)
		expect(test, r);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(clocks_long, next_part),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_clocks_long", .exit = bus_exit, .suite_exit = long_exit,
	.test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
