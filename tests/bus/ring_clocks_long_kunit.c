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
#define SHORT_FIRST	21u	/* of @runs, then: one led by the application, and the lost ones */
#define SHORT_END	30u

static unsigned int minutes;
module_param(minutes, uint, 0444);
MODULE_PARM_DESC(minutes, "Minutes of each case, at most 11; 0: some cases, for seconds");

static unsigned int first;
module_param(first, uint, 0444);
MODULE_PARM_DESC(first, "Number of the first case");

#define NOWHERE	CUTS	/* no cable is cut */

/* a break, and the reference clock: that gets the time of the application, or is lost */
struct run {
	u32 at;
	u32 ref;
	bool leads;
	u32 absent;	/* while it is lost */
	bool line;	/* no ring */
	bool late;	/* not after a minute, but after four */
};

static const struct run runs[] = {
	{ 0, 0 }, { 1, 0 }, { 2, 0 }, { 3, 0 }, { 4, 0 }, { 5, 0 }, { 6, 0 }, { 7, 0 }, { 8, 0 },
	{ 0, 7 }, { 1, 7 }, { 2, 7 }, { 3, 7 }, { 4, 7 }, { 5, 7 }, { 6, 7 }, { 7, 7 }, { 8, 7 },
	{ 4, 3 }, { 3, 3 }, { 4, 0, true }, { 4, 7, true },
	{ NOWHERE, 0, .absent = 0x01 },
	{ NOWHERE, 3, .absent = 0x08 },
	{ NOWHERE, 7, .absent = 0x80 },
	{ 4, 0, .absent = 0x0f },
	{ 2, 5, .absent = 0x3c },
	{ 6, 3, .absent = 0x38 },
	{ NOWHERE, 7, .absent = 0x80, .line = true },
	{ NOWHERE, 3, .absent = 0xf8, .line = true },
	{ NOWHERE, 0, .absent = 0x01, .late = true },
	{ NOWHERE, 3, .absent = 0x08, .late = true },
	{ NOWHERE, 7, .absent = 0x80, .late = true },
	{ 4, 0, .absent = 0x0f, .late = true },
	{ 2, 5, .absent = 0x3c, .late = true },
	{ 6, 3, .absent = 0x38, .late = true },
	{ NOWHERE, 7, .absent = 0x80, .line = true, .late = true },
	{ NOWHERE, 3, .absent = 0xf8, .line = true, .late = true },
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
	s64 line;	/* in all the time then */
	struct rnd_state random;
} now;

static const char numbers[ARRAY_SIZE(runs) * PARTS];	/* their addresses count */

static u32 cycles(void)
{
	return (minutes ? min(minutes, 11u) * 60 : SHORT) * SECOND;
}

static const void *next_part(const void *prev, char *desc)
{
	const char *begin = numbers + (minutes ? first : SHORT_FIRST) * PARTS;
	const char *next = prev ? (const char *)prev + 1 : begin;
	u32 i = (next - numbers) / PARTS;

	if (i >= (minutes ? ARRAY_SIZE(runs) : SHORT_END))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "%sbefore %u, reference %u%s%s%s, part %u",
		 runs[i].line ? "line, " : "", runs[i].at, runs[i].ref,
		 runs[i].leads ? " led" : "", runs[i].absent ? " lost" : "",
		 runs[i].late ? " late" : "", (u32)(next - numbers) % PARTS + 1);
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
	b = r->line ? clocks_bus_line(test) : clocks_bus(test);
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

/* Its line goes on until it is found again. */
static void lose(const struct run *r)
{
	struct clocks *k = &now.k;

	clocks_note_line(k);
	k->absent = r->absent;
	clocks_power(k, r->ref, false);
	now.lost = clocks_run(k, 2 * SECOND);
}

/* Then counts that of the next one. */
static void forget(void)
{
	struct clocks *k = &now.k;

	now.line = now.open;
	k->lost = false;
	k->ref = clocks_ref(k);
	now.open = clocks_run(k, SECOND);
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
			 ", lost then%s: %lld ns from its line in 2 s, %lld in %u s",
			 r->late ? ", late" : "", now.lost, now.line, cycles() / SECOND / 2);
	bus_figure("%s for %u s, cut before slave %u, reference slave %u%s%s: clocks apart %lld ns before, %lld in the second after it, %lld in %u s then, %lld in the second after it has healed, then %lld",
		   r->line ? "line" : "ring", cycles() / SECOND, r->at, r->ref,
		   r->leads ? " synchronized to the application" : "", lost, now.before, now.second,
		   now.open, r->absent ? 1 : cycles() / SECOND / 2, now.healed, now.after);
	KUNIT_EXPECT_LE(test, now.before, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.second, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.open, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.healed, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.after, GOAL_NS);
	KUNIT_EXPECT_LE(test, now.lost, LOST_NS);
	KUNIT_EXPECT_LE(test, now.line, LOST_NS);
}

static void part(struct kunit *test, const struct run *r, u32 i)
{
	struct clocks *k = &now.k;
	u32 before = r->late ? cycles() * 2 / 5 : cycles() / 10;

	if (i == 0) {
		now.before = clocks_run(k, before);
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
			forget();
		cable(r, false);
		if (r->absent)
			find_again(test, r);
		else
			now.healed = clocks_run(k, SECOND);
		now.after = clocks_run(k, cycles() / 2 - before);
		if (!r->line)
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
