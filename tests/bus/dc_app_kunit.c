// SPDX-License-Identifier: GPL-2.0-only
/*
 * The application's time jumps after the clocks are set to it: they go on, SYNC0
 * keeps its place to the frames, and nothing of it is silent.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"
#include "master/wire/dc_lock.h"

#define PERIOD_NS	1000000
#define STARTS		5u

/**
 * struct told - what an application tells of its time
 * @leads: and the reference clock has to follow
 * @every: but only in one of so many cycles, 0: in all
 * @narrow: as it has only 32 bits of it for that
 * @add: its time is so much later than the machine's
 * @once: another time for the next cycle, 0: none
 * @still: the same time again and again
 * @drift_ns: and later by so much with each cycle
 * @mute: no application time
 * @alone: nothing but the time for the reference clock
 * @late_us: two of five sends are so late
 * @late: which of them
 */
struct told {
	bool leads;
	u32 every;
	bool narrow;
	u64 add;
	u64 once;
	bool still;
	s64 drift_ns;
	bool mute;
	bool alone;
	u32 late_us;
	u32 late;
};

static void each(struct cyc *c)
{
	struct told *t = c->ctx;

	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	if (t->leads && (!t->every || c->cycles % t->every == 0))
		c->flags |= EC_SEND_FLAG_SYNC_REF;
	if (t->mute)
		c->flags &= ~EC_SEND_FLAG_APP_TIME;
	if (t->alone)
		c->flags &= ~EC_SEND_FLAG_SYNC_SLAVES;
	t->add += t->drift_ns;
	if (!t->still)
		c->app_time = ktime_to_ns(c->next) + t->add;
	if (t->once)
		c->app_time = t->once;
	t->once = 0;
	c->sync_time = t->narrow ? (u32)c->app_time : c->app_time;
	if (t->late_us && (c->cycles + t->late) % 5 < 2)
		usleep_range(t->late_us, t->late_us + 1);
}

static const struct variant {
	const char *name;
	struct told told;
	const char *text;
} variants[] = {
	{ "follows", { .add = 123456789 }, "" },
	{ "leads", { .leads = true, .add = 848584520973327310 }, "" },
	{ "leads with 32 bits", { .leads = true, .narrow = true, .add = 848584520973327310 }, "" },
	{ "leads without another time",
	  { .leads = true, .mute = true, .add = 848584520973327310 }, "" },
	{ "leads clocks of 32 bits", { .leads = true, .add = 848584520973327310 }, "dc=32" },
};

static void variant_name(const struct variant *v, char *desc)
{
	strscpy(desc, v->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(variant, variants, variant_name);

/* In OP with SYNC0, and @t as it is told. */
static struct cyc *start(struct kunit *test, struct told *t, const char *clocks)
{
	struct bus *b;
	struct cyc *c;
	char text[256];

	snprintf(text, sizeof(text), "segment seed=7\n"
		 "slave a drive in=8 out=8 drift=87ppm cable=50 clock=5s %s\n"
		 "slave b drive in=8 out=8 drift=-93ppm cable=20 clock=900s %s\n", clocks, clocks);
	b = bus_up(test, text, 2);
	bus_idle(b);
	c = cyc_new(b, PERIOD_NS / 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	cyc_sync0(c, 2);
	c->each = each;
	c->ctx = t;
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	return c;
}

static s64 since_start(struct bus *b, u32 slave, u64 now)
{
	struct ec_esc *esc = bus_esc(b, slave);

	ec_sim_advance(b->sim, now);
	return ec_esc_local_time(esc, now) + get_unaligned_le64(esc->mem + EC_REG_DC_OFFSET) -
	       esc->dc.start;
}

/*
 * Cycles in which SYNC0, less the machine's time, moves by no more than @drift_ns and
 * the slaves differ by no more than @apart_ns.
 */
static void expect_steady(struct cyc *c, u32 cycles, u64 drift_ns, s64 apart_ns,
			  const char *what)
{
	u64 now = ktime_get_ns();
	s64 was = since_start(c->b, 0, now) - now, most = 0, apart = 0;

	while (cycles--) {
		s64 t;

		cyc_run(c, 1);
		now = ktime_get_ns();
		t = since_start(c->b, 0, now);
		most = max_t(s64, most, abs(t - (s64)now - was));
		apart = max_t(s64, apart, abs((s32)((u32)ec_esc_system_time(bus_esc(c->b, 1), now) -
						    (u32)ec_esc_system_time(bus_esc(c->b, 0),
									    now))));
	}
	bus_figure("%s: SYNC0 moves by %lld ns against the frames, slaves %lld ns apart", what,
		   most,
		   apart);
	KUNIT_EXPECT_LT(c->b->test, most, (s64)drift_ns);
	KUNIT_EXPECT_LT(c->b->test, apart, apart_ns);
	KUNIT_EXPECT_TRUE(c->b->test, bus_esc(c->b, 0)->dc.running);
	KUNIT_EXPECT_TRUE(c->b->test, cyc_all_op(c));
}

/* the log tells nothing more until expect_told() */
static void hush(struct cyc *c)
{
	bus_dc_app(c->b)->log_ns = ~0ull;
}

/* What it was given to tell since then; now it does, and not again for 10 s. */
static void expect_told(struct cyc *c, u32 jumps, bool ignored)
{
	struct ec_dc_app *a = bus_dc_app(c->b);
	struct kunit *test = c->b->test;

	KUNIT_EXPECT_EQ(test, a->jumps, jumps);
	KUNIT_EXPECT_EQ(test, a->ignored != 0, ignored);
	a->log_ns = 0;
	cyc_run(c, 250);
	KUNIT_EXPECT_EQ(test, a->jumps, 0u);
	KUNIT_EXPECT_EQ(test, a->ignored, 0u);
	KUNIT_EXPECT_GT(test, a->log_ns, ktime_get_ns());
	hush(c);
}

/* where the clocks may drift within so many cycles when nobody leads them */
static u64 drift(const struct told *t, u32 cycles)
{
	return 10000 + (t->leads ? 0 : cycles * 100);
}

/* One second forth, as a time service does, and back to 0 as after a new start. */
static void app_jumps(struct kunit *test)
{
	const struct variant *v = test->param_value;
	struct told t = v->told;
	struct cyc *c = start(test, &t, v->text);

	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, bus_dc_app(c->b)->log_ns, 0ull);
	hush(c);
	t.add += NSEC_PER_SEC;
	expect_steady(c, 2000, drift(&t, 2000), 2000, "1 s forth");
	KUNIT_EXPECT_LT(test, abs(bus_dc_app(c->b)->jump_ns - NSEC_PER_SEC), 10000l);
	expect_told(c, 1, false);
	t.add -= c->app_time + PERIOD_NS;
	expect_steady(c, 2000, drift(&t, 2000), 2000, "begins with 0 again");
	expect_told(c, 1, false);
	/* and it is followed */
	KUNIT_EXPECT_FALSE(test, bus_dc_hold(c->b));
}

/* A single wrong time, and one that stands still. */
static void app_is_off(struct kunit *test)
{
	const struct variant *v = test->param_value;
	struct told t = v->told;
	struct cyc *c = start(test, &t, v->text);

	cyc_run(c, 3000);
	hush(c);
	/* also of its lower 32 bits, which are all that one variant tells */
	t.once = (u32)(c->app_time + NSEC_PER_SEC);
	expect_steady(c, 1000, drift(&t, 1000), 2000, "wrong once");
	expect_told(c, 0, true);
	/* nobody leads meanwhile */
	t.still = true;
	expect_steady(c, 1000, drift(&t, 1000) + 20000, 2000, "stands still");
	KUNIT_EXPECT_EQ(test, bus_dc_hold(c->b), t.leads);
	t.still = false;
	expect_steady(c, 3000, drift(&t, 3000) + 20000, 5000, "goes on");
	expect_told(c, 0, true);
	expect_steady(c, 1000, drift(&t, 1000), 1000, "a while later");
}

/* A slave that connects again has its SYNC0 where the others have it. */
static void expect_one_grid(struct cyc *c)
{
	struct bus *b = c->b;
	u64 now;
	u32 i;

	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	for (i = 0; i < 100 && bus_n_slaves(b) != 1; i++)
		cyc_run(c, 10);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	for (i = 0; i < 100 && bus_n_slaves(b) != 2; i++)
		cyc_run(c, 10);
	KUNIT_ASSERT_NE(b->test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 1000);
	now = ktime_get_ns();
	KUNIT_EXPECT_TRUE(b->test, bus_esc(b, 1)->dc.running);
	/* both at the same place of the period */
	KUNIT_EXPECT_LT(b->test,
			abs(ec_dc_lock_wrap(since_start(b, 1, now) - since_start(b, 0, now),
					    PERIOD_NS)), 2000);
}

/* So it is after a jump. */
static void app_jumps_then_slave(struct kunit *test)
{
	const struct variant *v = test->param_value;
	struct told t = v->told;
	struct cyc *c = start(test, &t, v->text);

	cyc_run(c, 2000);
	t.add -= 17 * NSEC_PER_SEC + 12345;
	cyc_run(c, 1000);
	expect_one_grid(c);
}

/* And when the first application time comes after SYNC has started: it sets no other phase. */
static void app_begins_then_slave(struct kunit *test)
{
	const struct variant *v = test->param_value;
	struct told t = { .mute = true };
	struct cyc *c = start(test, &t, v->text);
	u64 next = ktime_to_ns(c->next);

	cyc_run(c, 1000);
	t = v->told;
	/* 300 us behind the grid that SYNC has without an application */
	t.add += 300000 - do_div(next, PERIOD_NS) - v->told.add % PERIOD_NS;
	cyc_run(c, 1000);
	KUNIT_EXPECT_NE(test, bus_app_time(c->b), 0ull);
	expect_one_grid(c);
}

/* While the time deviates it is not sent; a send with nothing else makes no frame. */
static void app_jumps_in_send_without_data(struct kunit *test)
{
	struct told t = { .leads = true, .add = 123456789 };
	struct cyc *c = start(test, &t, "");
	u64 lost, frames;

	cyc_run(c, 2000);
	KUNIT_ASSERT_TRUE(test, bus_dc(c->b)->ref_wide);
	lost = bus_lost(c->b);
	t.alone = true;
	c->queued = 0;
	cyc_run(c, 2);
	t.add += NSEC_PER_SEC;
	frames = bus_last_wire(c->b)->frames;
	KUNIT_EXPECT_EQ(test, frames, 1ull);
	cyc_run(c, 10);
	KUNIT_EXPECT_TRUE(test, bus_dc_hold(c->b));
	frames = bus_last_wire(c->b)->frames;
	KUNIT_EXPECT_EQ(test, frames, 0ull);
	cyc_run(c, 30);
	KUNIT_EXPECT_FALSE(test, bus_dc_hold(c->b));
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), lost);
}

/* Time of the reference clock less the application's when the clocks were just set. */
static s64 begin(struct cyc *c, const struct told *t)
{
	u64 now;
	u32 i;

	for (i = 0; i < 1000 && bus_dc_mode(c->b) == EC_DC_IDLE; i++)
		cyc_run(c, 1);
	now = ktime_get_ns();
	ec_sim_advance(c->b->sim, now);
	return ec_esc_system_time(bus_esc(c->b, 0), now) - now - t->add;
}

static void power(struct cyc *c, bool on)
{
	u32 i;

	for (i = 0; i < 2; i++)
		bus_fault(c->b, on ? EC_SIM_FAULT_POWER_ON : EC_SIM_FAULT_POWER_OFF, i, 0, 0, 0);
	for (i = 0; i < 100 && (bus_n_slaves(c->b) != (on ? 2 : 0) ||
			       (!on && bus_dc_mode(c->b) != EC_DC_IDLE)); i++)
		cyc_run(c, 10);
	KUNIT_ASSERT_EQ(c->b->test, bus_n_slaves(c->b), on ? 2u : 0u);
}

/* All clocks are set anew within a session: to the time of now, not of its start. */
static void app_drift_then_new_synchronization(struct kunit *test)
{
	const struct variant *v = test->param_value;
	struct told t = v->told;
	struct cyc *c = start(test, &t, v->text);
	s64 off;

	cyc_run(c, 1000);
	hush(c);
	t.drift_ns = 5000;
	cyc_run(c, 4000);
	t.drift_ns = 0;
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, bus_dc_app(c->b)->jumps, 0u);
	power(c, false);
	power(c, true);
	off = (s32)begin(c, &t);
	bus_figure("after 20 ms of drift all clocks are set anew: the reference begins %lld ns off",
		   off);
	KUNIT_EXPECT_LT(test, abs(off), 100000ll);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 5000), ~0ull);
}

/* Times for the reference clock that are held back, of so many that are told. */
static u32 held(struct cyc *c, const struct told *t, u32 tellings)
{
	u32 n = 0;

	while (tellings--) {
		while (c->cycles % t->every)
			cyc_run(c, 1);
		cyc_run(c, 1);
		n += bus_dc_hold(c->b);
	}
	return n;
}

/* Once a second the reference clock is told a time that is 100 ppm off the machine's. */
static void app_leads_rarely(struct kunit *test)
{
	struct told t = { .leads = true, .every = 1000, .add = 123456789, .drift_ns = 100 };
	struct cyc *c = start(test, &t, "");
	struct ec_dc_app *a = bus_dc_app(c->b);
	u32 n = held(c, &t, 20);

	bus_figure("leads once a second, 100 ppm off: %u of 20 times are held back", n);
	KUNIT_EXPECT_EQ(test, n, 0u);
	KUNIT_EXPECT_EQ(test, a->log_ns, 0ull);
	/* a jump is held, which is told, and then followed */
	t.add += NSEC_PER_SEC;
	KUNIT_EXPECT_EQ(test, held(c, &t, 3), 3u);
	KUNIT_EXPECT_GT(test, a->log_ns, ktime_get_ns());
	n = held(c, &t, 30);
	bus_figure("jumps: %u times more are held back", n);
	KUNIT_EXPECT_LT(test, n, 14u);
	KUNIT_EXPECT_EQ(test, held(c, &t, 5), 0u);
	KUNIT_EXPECT_LT(test, abs((s64)(a->skip - NSEC_PER_SEC)), 5000000ll);
}

/* Who no longer leads is followed by his other time. */
static void app_led_once(struct kunit *test)
{
	struct told t = { .leads = true, .add = 123456789 };
	struct cyc *c = start(test, &t, "");
	struct ec_dc_app *a = bus_dc_app(c->b);

	cyc_run(c, 1000);
	t.leads = false;
	t.drift_ns = 100;
	cyc_run(c, 10000);
	bus_figure("led once, then 1 ms of drift: %lld ns of it not seen", (s64)(t.add - a->base));
	KUNIT_EXPECT_LT(test, abs((s64)(t.add - a->base)), 50000ll);
	t.drift_ns = 0;
	hush(c);
	t.add += NSEC_PER_SEC;
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, a->jumps, 1u);
}

/* The clocks begin with the time of most cycles, whatever one of them is. */
static void app_is_late(struct kunit *test)
{
	struct told t = { .leads = true, .add = 123456789, .late_us = 320 };
	struct bus *b = bus_up(test, "repeat 2 slave s drive in=8 out=8", 2);
	s64 worst = 0;
	u32 i;

	bus_idle(b);
	for (i = 0; i < STARTS; i++) {
		struct cyc *c = cyc_new(b, PERIOD_NS / 1000);

		cyc_domain(c);
		cyc_map_all(c, 0, 2, 0);
		c->each = each;
		c->ctx = &t;
		t.late = i;
		cyc_activate(c);
		worst = max_t(s64, worst, abs(begin(c, &t)));
		/* lateness is no jump */
		cyc_run(c, 500);
		KUNIT_EXPECT_EQ(test, bus_dc_app(b)->log_ns, 0ull);
		cyc_release(c);
		bus_idle(b);
	}
	bus_figure("of 5 sends 2 are 320 us late: in %u starts the reference begins %lld ns off at most",
		   STARTS, worst);
	KUNIT_EXPECT_LT(test, worst, 20000ll);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(app_jumps, variant_gen_params),
	KUNIT_CASE_PARAM(app_is_off, variant_gen_params),
	KUNIT_CASE_PARAM(app_jumps_then_slave, variant_gen_params),
	KUNIT_CASE_PARAM(app_begins_then_slave, variant_gen_params),
	KUNIT_CASE(app_jumps_in_send_without_data),
	KUNIT_CASE_PARAM(app_drift_then_new_synchronization, variant_gen_params),
	KUNIT_CASE(app_leads_rarely),
	KUNIT_CASE(app_led_once),
	KUNIT_CASE(app_is_late),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_app", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
