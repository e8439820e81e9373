// SPDX-License-Identifier: GPL-2.0-only
/*
 * The start of 100 drives with SYNC signals in cycles of all lengths: how long it takes
 * from activation to OP, how far the modelled clocks are apart from then on, and how many
 * acyclic frames, and clock frames among them, one send of the cycle carries.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc.h"
#include "master/boundary/ioctl.h"

#define SLAVES		100
#define OP_LIMIT_US	1500000
#define WATCH_US	20000000	/* after OP */
#define EXACT_NS	100
#define EXACT_US	1000000		/* after OP; measured: 0.15 s at most */
#define SENDS		8		/* over which clock frames of short cycles are counted */

/* what the sends carry beside process data, and the clocks */
struct load {
	u64 before;	/* frames up to the last send */
	u32 most;	/* acyclic frames of one send */
	u64 all;
	u32 clock[SENDS];	/* clock frames of the last sends */
	u32 clocks;	/* most of one send */
	u32 row;	/* most of SENDS sends in a row */
	u64 all_clocks;
	u64 op_ns;
	u64 worst_ns;	/* of a clock to the reference, since @op_ns */
	u64 exact_us;	/* all of them are exact so long after @op_ns */
};

/* Largest difference of a slave's system time to that of the reference, ns. */
static u64 worst(struct bus *b)
{
	u64 now = ktime_get_ns(), max = 0, ref;
	u32 i;

	ec_sim_advance(b->sim, now);
	ref = ec_esc_system_time(bus_esc(b, 0), now);
	for (i = 1; i < bus_n_slaves(b); i++) {
		s64 d = ec_esc_system_time(bus_esc(b, i), now) - ref;

		max = max_t(u64, max, abs(d));
	}
	return max;
}

/* Clock frames that have left with the last send, and since: nobody else has run yet. */
static u32 clock_frames(struct bus *b)
{
	u32 i, n = 0;

	for (i = 0; i < EC_SLOTS; i++) {
		const struct ec_slot *s = bus_slot(b, i);

		n += s->done == ec_flight_landed && s->sent_ns >= bus_last_send_ns(b) &&
		     bus_carry(b)->flight[i].class == EC_POST_CLOCK;
	}
	return n;
}

static void count(struct load *l, struct cyc *c)
{
	u64 frames = bus_frames(c->b), n;
	u32 i, row = 0;

	/* everything since the send before was sent by it */
	n = frames - l->before - bus_last_wire(c->b)->frames;
	if (l->before && c->cycles) {
		l->most = max_t(u64, l->most, n);
		l->all += n;
		n = clock_frames(c->b);
		l->clock[c->cycles % SENDS] = n;
		l->clocks = max_t(u32, l->clocks, n);
		l->all_clocks += n;
	}
	for (i = 0; i < SENDS; i++)
		row += l->clock[i];
	l->row = max(l->row, row);
	l->before = frames;
}

static void each(struct cyc *c)
{
	struct load *l = c->ctx;
	u64 ns;

	count(l, c);
	if (l->op_ns) {
		ns = worst(c->b);
		l->worst_ns = max(l->worst_ns, ns);
		if (ns >= EXACT_NS)
			l->exact_us = div_u64(ktime_get_ns() - l->op_ns, NSEC_PER_USEC);
	}
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

/* Not active yet; what it sees of clocks and frames goes to @l. */
static struct cyc *configure(struct kunit *test, u32 slaves, u32 us, struct load *l)
{
	struct cyc *c = cyc_drives(test, slaves, us);

	c->each = each;
	c->ctx = l;
	return c;
}

static const u32 cycles_us[] = { 1000, 2000, 4000, 10000, 20000 };

static const void *next_cycle(const void *prev, char *desc)
{
	const u32 *us = prev ? (const u32 *)prev + 1 : cycles_us;

	if (us == cycles_us + ARRAY_SIZE(cycles_us))
		return NULL;
	snprintf(desc, KUNIT_PARAM_DESC_SIZE, "cycle of %u us", *us);
	return us;
}

static void dc_start_hundred_drives_reach_op(struct kunit *test)
{
	u32 us = *(const u32 *)test->param_value, i, far = 0;
	u32 told = bus_log_lines("sync window");
	struct load l = { 0 };
	struct cyc *c = configure(test, SLAVES, us, &l);
	struct bus *b = c->b;
	u64 op;

	cyc_activate(c);
	op = cyc_wait_op(c, 30000);
	KUNIT_ASSERT_NE(test, op, ~0ull);
	l.op_ns = ktime_get_ns();
	cyc_run(c, WATCH_US / us);
	for (i = 0; i < SLAVES; i++) {
		far += ec_clock_of(bus_slave(b, i))->outside_window;
		KUNIT_EXPECT_TRUE(test, bus_esc(b, i)->dc.running);
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->note.error, EC_SLAVE_OK);
	}
	bus_figure("100 drives with SYNC0, cycle of %u us: OP %llu us after activation, clocks within %llu ns from then on for 20 s, within %u ns %llu us later; in a send at most %u acyclic frames, %u of them of clocks (%llu in all)",
		   us, op, l.worst_ns, EXACT_NS, l.exact_us, l.most, l.clocks, l.all_clocks);
	bus_row(op, OP_LIMIT_US, "us from activation to OP: 100 drives with SYNC0, cycle of %u us",
		us);
	bus_row(l.worst_ns, EC_DC_LIMIT_NS,
		"ns between clocks in the 20 s after that, cycle of %u us",
		us);
	KUNIT_EXPECT_LT(test, op, (u64)OP_LIMIT_US);
	KUNIT_EXPECT_LT(test, l.worst_ns, (u64)EC_DC_LIMIT_NS);
	KUNIT_EXPECT_LT(test, l.exact_us, (u64)EXACT_US);
	KUNIT_EXPECT_EQ(test, far, 0u);
	KUNIT_EXPECT_EQ(test, bus_log_lines("sync window"), told);
	KUNIT_EXPECT_LE(test, l.most, min(8 * us / 1000, 64u));
	KUNIT_EXPECT_LE(test, l.clocks, 2 * us / 1000);
	/* the count counts */
	KUNIT_EXPECT_GT(test, l.all_clocks, 500ull);
}

/* In a cycle of 250 us every second send may carry a clock frame. */
static void dc_start_short_cycle(struct kunit *test)
{
	struct load l = { 0 };
	struct cyc *c = configure(test, 4, 250, &l);
	u64 op;

	cyc_activate(c);
	op = cyc_wait_op(c, 5000);
	KUNIT_ASSERT_NE(test, op, ~0ull);
	l.op_ns = ktime_get_ns();
	cyc_run(c, 8000);
	bus_figure("4 drives with SYNC0, cycle of 250 us: OP %llu us after activation, clocks within %llu ns from then on; in %d sends in a row at most %u clock frames",
		   op, l.worst_ns, SENDS, l.row);
	KUNIT_EXPECT_LT(test, op, 700000ull);
	KUNIT_EXPECT_LT(test, l.worst_ns, (u64)EC_DC_LIMIT_NS);
	KUNIT_EXPECT_LE(test, l.clocks, 1u);
	KUNIT_EXPECT_LE(test, l.row, SENDS / 2 + 1u);
	KUNIT_EXPECT_GT(test, l.all_clocks, 100ull);
}

/* Nothing follows a clock that is alone: there is nothing to compensate. */
static void dc_start_single_clock_sends_little(struct kunit *test)
{
	struct load l = { 0 };
	struct cyc *c = configure(test, 1, 4000, &l);
	u64 op;

	cyc_activate(c);
	op = cyc_wait_op(c, 5000);
	cyc_run(c, 1000);
	bus_figure("one drive with SYNC0, cycle of 4000 us: OP %llu us after activation; in a send at most %u acyclic frames, %llu of clocks in all",
		   op, l.most, l.all_clocks);
	KUNIT_EXPECT_LT(test, op, 400000ull);
	KUNIT_EXPECT_LE(test, l.most, 8u);
	/* set once, then watched once a second */
	KUNIT_EXPECT_LT(test, l.all_clocks, 20ull);
}

/*
 * A cycle of 1 ms stands still for 15 ms while clocks are set: the next send carries no
 * more than the others.
 */
static void dc_start_late_cycle(struct kunit *test)
{
	struct load l = { 0 };
	struct cyc *c = configure(test, SLAVES, 1000, &l);
	u32 i;

	cyc_activate(c);
	for (i = 0; i < 40; i++) {
		c->next = ktime_add_ns(c->next, 14 * NSEC_PER_MSEC);
		cyc_run(c, 20);
	}
	bus_figure("100 drives, cycle of 1000 us that stands still for 15 ms every 20 cycles: in a send at most %u acyclic frames, %u of them of clocks",
		   l.most, l.clocks);
	KUNIT_EXPECT_LE(test, l.most, 8u);
	KUNIT_EXPECT_LE(test, l.clocks, 2u);
	KUNIT_EXPECT_GT(test, l.all_clocks, 100ull);
}

/* Frames are lost: clocks become near all the same, and stay there. */
static void dc_start_frames_lost(struct kunit *test)
{
	struct load l = { 0 };
	struct cyc *c = configure(test, SLAVES, 20000, &l);
	u32 i, far = 0;
	u64 op;

	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 10000);
	cyc_activate(c);
	op = cyc_wait_op(c, 60000);
	KUNIT_ASSERT_NE(test, op, ~0ull);
	l.op_ns = ktime_get_ns();
	cyc_run(c, WATCH_US / 20000);
	for (i = 0; i < SLAVES; i++)
		far += ec_clock_of(bus_slave(c->b, i))->outside_window;
	bus_figure("100 drives with SYNC0, cycle of 20000 us, 1 %% of all frames lost: OP %llu us after activation, clocks within %llu ns from then on for 20 s",
		   op, l.worst_ns);
	KUNIT_EXPECT_LT(test, l.worst_ns, (u64)EC_DC_LIMIT_NS);
	KUNIT_EXPECT_EQ(test, far, 0u);
}

/* The link is down for 10 ms while clocks are set. */
struct flap {
	u32 after;	/* cycles of the worker */
	u32 busy;
	u32 down;
};

static void each_flap(struct cyc *c)
{
	struct flap *f = c->ctx;

	f->busy += bus_dc_state(c->b) == EC_DC_BUSY;
	if (f->busy == f->after && !f->down++)
		bus_fault(c->b, EC_SIM_FAULT_CUT, EC_SIM_MASTER0, 0, 0, 0);
	else if (f->down && f->down++ == 10)
		bus_fault(c->b, EC_SIM_FAULT_HEAL, EC_SIM_MASTER0, 0, 0, 0);
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

static void dc_start_link_flap(struct kunit *test)
{
	struct flap f;
	struct cyc *c;
	u32 after, ms, i, most = 0;

	for (after = 1; after < 120; after += 20) {
		c = configure(test, 4, 1000, NULL);
		f = (struct flap){ .after = after };
		c->each = each_flap;
		c->ctx = &f;
		cyc_activate(c);
		for (ms = 0; ms < 5000 && (f.down < 10 || bus_dc_state(c->b) != EC_DC_READY); ms++)
			cyc_run(c, 1);
		KUNIT_EXPECT_LT_MSG(test, ms, 5000u, "link down after %u ms, state %d", after,
				    bus_dc_state(c->b));
		for (i = 0; i < 4; i++)
			KUNIT_EXPECT_TRUE(test, ec_clock_is_set(bus_slave(c->b, i)));
		most = max(most, ms);
		bus_down(c->b);
		test->priv = NULL;
	}
	bus_figure("link down for 10 ms while clocks are set: READY within %u ms", most);
}

/*
 * The reference clock forwards but no longer replies while frames of the worker compensate
 * beside slaves in OP: a time that has waited in the queue must not move their clocks.
 */
static void dc_start_reference_falls_silent(struct kunit *test)
{
	static const u32 periods_us[] = { 1000, 4000 };
	u64 most = 0;
	u32 p, k;

	for (p = 0; p < ARRAY_SIZE(periods_us); p++) {
		struct load l = { 0 };
		struct cyc *c = configure(test, 3, periods_us[p], &l);

		cyc_activate(c);
		KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
		KUNIT_ASSERT_EQ(test, bus_dc_mode(c->b), (int)EC_DC_READ);
		bus_fault(c->b, EC_SIM_FAULT_DEAD, 0, 0, 1, 0);
		for (k = 0; k < 100; k++) {
			cyc_run(c, 1);
			most = max(most, worst(c->b));
		}
		bus_figure("cycle of %u us, reference clock silent while frames compensate: clocks within %llu ns",
			   periods_us[p], most);
		bus_down(c->b);
		test->priv = NULL;
	}
	KUNIT_EXPECT_LT(test, most, 5000ull);
}

static void each_clocks(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

/*
 * The application exits while delays are measured and no frame returns. One timeout of the
 * measurement is left, and those of the slaves that are being configured.
 */
static void dc_start_measurement_ends_with_session(struct kunit *test)
{
	struct cyc *c = configure(test, 4, 1000, NULL);
	struct ec_dc *dc = bus_dc(c->b);
	u64 t0, ms;
	u32 i;

	c->each = each_clocks;
	/* as after slaves have connected */
	for (i = 0; i < 4; i++)
		ec_clock_of(bus_slave(c->b, i))->measured = 0;
	cyc_activate(c);
	for (i = 0; i < 3000 && !mutex_is_locked(&dc->lock); i++)
		cyc_run(c, 1);
	KUNIT_ASSERT_TRUE(test, mutex_is_locked(&dc->lock));
	bus_fault(c->b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	cyc_run(c, 3);
	KUNIT_EXPECT_EQ(test, READ_ONCE(dc->state), EC_DC_BUSY);
	t0 = ktime_get_ns();
	cyc_release(c);
	ms = div_u64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	bus_figure("a session ends within %llu ms while delays are measured and frames are lost",
		   ms);
	KUNIT_EXPECT_LT(test, ms, 400ull);
	/* after the session they are measured as ever */
	ec_sim_clear_faults(c->b->sim);
	bus_idle(c->b);
	KUNIT_EXPECT_EQ(test, ec_dc_measure(dc), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(dc_start_hundred_drives_reach_op, next_cycle),
	KUNIT_CASE(dc_start_short_cycle),
	KUNIT_CASE(dc_start_single_clock_sends_little),
	KUNIT_CASE(dc_start_late_cycle),
	KUNIT_CASE(dc_start_frames_lost),
	KUNIT_CASE(dc_start_link_flap),
	KUNIT_CASE(dc_start_reference_falls_silent),
	KUNIT_CASE(dc_start_measurement_ends_with_session),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_dc_start", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
