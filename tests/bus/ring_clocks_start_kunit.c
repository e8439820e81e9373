// SPDX-License-Identifier: GPL-2.0-only
/* Clocks that are set while a ring is open, and delays that are measured there. */
#include "ring_clocks.h"

#define JUMP_NS	100	/* of a clock in a cycle */

/* a start with an open ring */
struct start {
	u32 at;
	u32 ref;
	u32 back_ns;	/* cable to the backup device */
	struct kinds kinds;
};

static const struct start starts[] = {
	{ 0, 0, 250 }, { 1, 0, 250 }, { 3, 0, 250 }, { 7, 0, 250 }, { 8, 0, 250 }, { 2, 3, 250 },
	{ 5, 3, 250 }, { 3, 0, 2250 }, { 3, 0, 250, { 0x55 } }, { 3, 5, 250, { 0xff } },
	{ 4, 1, 250, { 0, 0x99 } }, { 3, 5, 250, { 0x20, 0x98 } },
};

static void start_desc(const struct start *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE,
		 "open before %u, reference %u, %u ns, 0x%x narrow, 0x%x none", p->at, p->ref,
		 p->back_ns, p->kinds.narrow, p->kinds.none);
}

KUNIT_ARRAY_PARAM(start, starts, start_desc);

/* The ring is open from the start, closes, and opens again. */
static void clocks_start_open(struct kunit *test)
{
	const struct start *p = test->param_value;
	struct bus *b = clocks_bus_of(test, p->back_ns, p->kinds);
	s64 limit = GOAL_NS + abs((int)p->back_ns - 250), most, healed, end, again;
	struct clocks *k;

	ring_cable(b, true, p->at);
	k = clocks_new(b);
	k->none = p->kinds.none;
	bus_plug_scanned(b, SLAVES, 5000);
	clocks_activate(k, p->ref);
	ring_open(b, p->at);
	most = clocks_run(k, 2000);
	ring_cable(b, false, p->at);
	healed = clocks_run(k, 3000);
	ring_closed(b, SLAVES);
	KUNIT_EXPECT_LE(test, k->jump, JUMP_NS);
	end = clocks_run(k, 1000);
	ring_cable(b, true, p->at);
	again = clocks_run(k, 2000);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	KUNIT_EXPECT_EQ(test, k->left, 0u);
	clocks_on_grid(k);
	bus_figure("ring open before slave %u at the start, reference slave %u, cable to the backup device of %u ns: clocks apart at most %lld ns, %lld in 3 s after it has closed, then %lld; %lld when it opens again",
		   p->at, p->ref, p->back_ns, most, healed, end, again);
	KUNIT_EXPECT_LE(test, most, limit);
	KUNIT_EXPECT_LE(test, healed, limit);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, again, GOAL_NS);
}

/* a start without the chosen reference clock */
struct lack {
	u32 cut[2];	/* cables, NONE: none */
	int off;	/* slave without power, -1: none */
	u32 n;		/* slaves that are configured */
	u32 ref;
	u32 absent;	/* mask of configured slaves that do not run then */
};

#define NONE	CUTS

static const struct lack lacks[] = {
	{ { 2, 5 }, -1, SLAVES, 3, 0x1c }, { { 0, 4 }, -1, SLAVES, 1, 0x0f },
	{ { 6, 8 }, -1, SLAVES, 7, 0xc0 }, { { NONE, NONE }, 5, SLAVES, 5, 0x20 },
	{ { 4, NONE }, 3, SLAVES, 3, 0x08 },
	/* never seen closed, more are there than configured: which they are behind the break? */
	{ { 3, NONE }, -1, 6, 3, 0x38 },
};

static void lack_desc(const struct lack *p, char *desc)
{
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "reference %u of %u, open before %u and %u, %d off",
		 p->ref, p->n, p->cut[0], p->cut[1], p->off);
}

KUNIT_ARRAY_PARAM(lack, lacks, lack_desc);

static void lack_cables(struct clocks *k, const struct lack *p, bool cut)
{
	u32 i;

	for (i = 0; i < ARRAY_SIZE(p->cut); i++)
		if (p->cut[i] != NONE)
			ring_cable(k->b, cut, p->cut[i]);
	if (p->off >= 0)
		clocks_power(k, p->off, !cut);
}

/* Another clock takes its place until it is there: SYNC goes on, and no slave leaves OP. */
static void clocks_start_without_ref(struct kunit *test)
{
	const struct lack *p = test->param_value;
	struct clocks *k = clocks_new(clocks_bus(test));
	u32 after = bus_log_lines("only after SYNC"), i;
	s64 most, healed, end;
	u64 start[SLAVES];

	if (p->n < SLAVES)
		lack_cables(k, p, true);
	bus_plug_scanned(k->b, SLAVES, 5000);
	clocks_configure(k, p->ref, p->n);
	if (p->n == SLAVES)
		lack_cables(k, p, true);
	msleep(1000);
	bus_rescan(k->b);
	msleep(1000);
	k->absent = p->absent;
	clocks_begin(k);
	k->ref = clocks_ref(k);
	KUNIT_EXPECT_NE(test, k->ref, p->ref);
	most = clocks_run(k, 1000);
	for (i = 0; i < SLAVES; i++)
		start[i] = bus_esc(k->b, i)->dc.start;
	lack_cables(k, p, false);
	healed = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	healed = max(healed, k->most);
	for (i = 0; i < SLAVES; i++)
		if (!(p->absent & BIT(i)))
			KUNIT_EXPECT_EQ_MSG(test, bus_esc(k->b, i)->dc.start, start[i],
					    "SYNC0 of slave %u", i);
	KUNIT_EXPECT_EQ(test, bus_log_lines("only after SYNC"), after);
	KUNIT_EXPECT_EQ(test, k->left, 0u);
	k->absent = p->n < SLAVES ? 0xffu << p->n & 0xff : 0;
	k->ref = clocks_ref(k);
	KUNIT_EXPECT_EQ(test, k->ref, p->ref);
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	clocks_on_grid(k);
	ring_closed(k->b, SLAVES);
	bus_figure("start without reference clock %u, %u slaves there: clocks apart at most %lld ns, %lld until it is there, then %lld",
		   p->ref, SLAVES - hweight32(p->absent), most, healed, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* The application ends and begins again while the ring is open; then it closes. */
static void clocks_restart(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
	s64 most, healed, end;

	ring_cable(k->b, true, 3);
	clocks_run(k, 1000);
	cyc_release(k->c);
	msleep(3000);
	clocks_activate(k, 0);
	ring_open(k->b, 3);
	most = clocks_run(k, 2000);
	ring_cable(k->b, false, 3);
	healed = clocks_run(k, 3000);
	end = clocks_run(k, 1000);
	bus_figure("application restarted while the ring is open: clocks apart at most %lld ns, %lld in 3 s after it has closed, then %lld",
		   most, healed, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

/* A slave that lost its power comes back behind the break. */
static void clocks_join(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
	s64 most, end, healed;

	k->absent = BIT(3);
	clocks_power(k, 3, false);
	ring_cable(k->b, true, 3);
	clocks_run(k, 2000);
	clocks_power(k, 3, true);
	most = clocks_run(k, 100);
	KUNIT_EXPECT_NE(test, cyc_wait_op(k->c, 20000), ~0ull);
	most = max(most, k->most);
	ring_open(k->b, 3);
	k->absent = 0;
	clocks_run(k, 3000);
	end = clocks_run(k, 500);
	ring_cable(k->b, false, 3);
	healed = clocks_run(k, 3000);
	bus_figure("a slave joins those behind the break: the others apart at most %lld ns, all %lld then, %lld when it closes",
		   most, end, healed);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
	KUNIT_EXPECT_LE(test, healed, GOAL_NS);
}

/* The ring breaks while its exit is closed: what is behind the break is back soon. */
static void clocks_cut_while_measured(struct kunit *test)
{
	struct clocks *k = clocks_start(clocks_bus(test), 0);
	struct bus *b = k->b;
	s64 most, open, end;
	u32 i, ms;

	k->absent = BIT(3);
	clocks_power(k, 3, false);
	clocks_run(k, 1000);
	clocks_power(k, 3, true);
	for (i = 0; i < 5000 && !bus_links(b)->ring.measured; i++)
		clocks_run(k, 1);
	KUNIT_ASSERT_TRUE(test, bus_links(b)->ring.measured);
	k->absent = BIT(3) | BIT(5) | BIT(6) | BIT(7);
	ring_cable(b, true, 5);
	most = clocks_run(k, 20);
	for (ms = 20; ms < 20000 && (bus_n_slaves(b) < SLAVES || !cyc_all_op(k->c)); ms++)
		most = max(most, clocks_run(k, 1));
	KUNIT_EXPECT_TRUE(test, cyc_all_op(k->c));
	ring_open(b, 5);
	k->absent = 0;
	clocks_run(k, 3000);
	open = clocks_run(k, 500);
	ring_cable(b, false, 5);
	clocks_run(k, 2000);
	end = clocks_run(k, 500);
	ring_closed(b, SLAVES);
	bus_figure("ring cut while delays are measured: all in OP after %u ms, the others apart at most %lld ns, all %lld then, %lld when it has healed",
		   ms, most, open, end);
	KUNIT_EXPECT_LE(test, most, GOAL_NS);
	KUNIT_EXPECT_LE(test, open, GOAL_NS);
	KUNIT_EXPECT_LE(test, end, GOAL_NS);
}

static void expect_near(struct kunit *test, s32 is, s32 goal, s32 noise)
{
	s32 off = abs(is - goal);

	KUNIT_EXPECT_LE_MSG(test, off, noise, "%d, expected %d", is, goal);
}

/* At rest: the delays stay behind a break, and are measured again when it has healed. */
static void clocks_at_rest(struct kunit *test)
{
	struct bus *b = clocks_bus(test);
	u32 delay[SLAVES], i, k;

	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	for (k = 0; k < SLAVES; k++)
		delay[k] = ec_clock_of(bus_slave(b, k))->delay;
	expect_near(test, delay[SLAVES - 1], 3850, 50);
	for (i = 0; i <= SLAVES; i++) {
		ring_cable(b, true, i);
		bus_idle(b);
		ring_open(b, i);
		for (k = 0; k < SLAVES; k++)
			expect_near(test, ec_clock_of(bus_slave(b, k))->delay, delay[k], 20);
		ring_cable(b, false, i);
		bus_idle(b);
		for (k = 0; k < SLAVES; k++)
			expect_near(test, ec_clock_of(bus_slave(b, k))->delay, delay[k], 20);
	}
}

/* Nothing is measured while the exit of a closed ring is not known. */
static void clocks_no_exit(struct kunit *test)
{
	struct bus *b = clocks_bus(test);
	u32 k;

	bus_fault(b, EC_SIM_FAULT_DEAD, SLAVES - 1, 0, 1, 0);
	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	ring_closed(b, SLAVES);
	KUNIT_ASSERT_EQ(test, bus_slave(b, SLAVES - 1)->note.error, EC_SLAVE_SCAN_FAILED);
	for (k = 0; k < SLAVES; k++)
		KUNIT_EXPECT_EQ(test, ec_clock_of(bus_slave(b, k))->measured, 0u);
	bus_fault(b, EC_SIM_FAULT_DEAD, SLAVES - 1, 0, 0, 0);
	for (k = 0; k < 100 && bus_slave(b, SLAVES - 1)->note.error; k++)
		msleep(100);
	bus_idle(b);
	expect_near(test, ec_clock_of(bus_slave(b, SLAVES - 1))->delay, 3850, 50);
}

/* The exit opens itself after a second: receive times of a later latch do not count. */
static void clocks_slow_cycle(struct kunit *test)
{
	struct bus *b = clocks_bus(test);
	struct cyc *c;
	u32 i;

	bus_plug_scanned(b, SLAVES, 5000);
	bus_idle(b);
	c = cyc_new(b, 800000);
	cyc_domain(c);
	cyc_map_all(c, 0, SLAVES, 0);
	cyc_sync0(c, SLAVES);
	c->flags = EC_SEND_FLAG_SYNC_SLAVES;
	for (i = 0; i < SLAVES; i++)
		ec_clock_of(bus_slave(b, i))->measured = 0;
	cyc_activate(c);
	for (i = 0; i < 200 && !ec_clock_of(bus_slave(b, SLAVES - 1))->measured; i++)
		cyc_run(c, 1);
	for (i = 0; i < SLAVES; i++)
		expect_near(test, ec_clock_of(bus_slave(b, i))->delay, 550 * i, 50);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(clocks_start_open, start_gen_params),
	KUNIT_CASE_PARAM(clocks_start_without_ref, lack_gen_params),
	KUNIT_CASE(clocks_restart),
	KUNIT_CASE(clocks_join),
	KUNIT_CASE(clocks_cut_while_measured),
	KUNIT_CASE(clocks_at_rest),
	KUNIT_CASE(clocks_no_exit),
	KUNIT_CASE(clocks_slow_cycle),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_ring_clocks_start", .exit = bus_exit, .test_cases = cases,
};

kunit_test_suite(suite);
MODULE_LICENSE("GPL");
