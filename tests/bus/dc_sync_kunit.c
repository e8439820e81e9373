// SPDX-License-Identifier: GPL-2.0-only
/*
 * SYNC signals run in each slave that is in OP, by a clock that was set: whatever
 * comes late, does not answer or falls back. By the model, not by what the master
 * has written.
 */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/clock/dc_state.h"
#include "master/link/device.h"
#include "master/boundary/ioctl.h"

#define PERIOD_NS	1000000

static void each(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	c->app_time = ktime_get_ns();
}

static void sync0(struct cyc *c, u32 config, u32 c0, u32 c1)
{
	struct ec_ioc_sc_dc dc = {
		.config = config, .assign_activate = c1 ? 0x0700 : 0x0300,
		.cycle0 = c0, .cycle1 = c1,
	};

	KUNIT_ASSERT_EQ(c->b->test, ec_ioc(&c->b->app, EC_IOC_SC_DC, &dc), 0);
}

/* @n slaves, each with SYNC0 of @sync_ns, in a cycle of @us */
static struct cyc *configure(struct bus *b, u32 n, u32 us, u32 sync_ns)
{
	struct cyc *c = cyc_new(b, us);
	u32 i;

	cyc_domain(c);
	cyc_map_all(c, 0, n, 0);
	c->each = each;
	for (i = 0; i < n; i++)
		sync0(c, i, sync_ns, 0);
	return c;
}

/* the same at hand */
static struct cyc *start(struct kunit *test, const char *text, u32 n, u32 us, u32 sync_ns)
{
	struct bus *b = bus_up(test, text, n);

	bus_idle(b);
	return configure(b, n, us, sync_ns);
}

static const char four[] = "segment seed=3\n"
	"slave a drive in=8 out=8 drift=60ppm cable=50\n"
	"slave b drive in=8 out=8 drift=-70ppm clock=3s\n"
	"slave c drive in=8 out=8 drift=-70ppm clock=77s\n"
	"slave d drive in=8 out=8 drift=-70ppm clock=5s\n";

/* where SYNC0 of a slave is in its period, by its own clock */
static u32 phase(struct bus *b, u32 i, u64 now)
{
	const struct ec_esc *esc = bus_esc(b, i);
	u64 t = ec_esc_local_time(esc, now) + get_unaligned_le64(esc->mem + EC_REG_DC_OFFSET) -
		esc->dc.start;

	return do_div(t, PERIOD_NS);
}

/* SYNC0 of the slaves of a mask runs in OP, at the same time */
static void expect_in_step(struct bus *b, u32 mask)
{
	u64 now = ktime_get_ns();
	u32 first = __ffs(mask), i;

	ec_sim_advance(b->sim, now);
	for (i = first; mask >> i; i++) {
		s32 off = phase(b, i, now) - phase(b, first, now);

		if (!(mask & BIT(i)))
			continue;
		off = abs(off) > PERIOD_NS / 2 ? PERIOD_NS - abs(off) : abs(off);
		KUNIT_EXPECT_EQ(b->test, bus_esc(b, i)->mem[EC_REG_AL_STATUS], EC_AL_OP);
		KUNIT_EXPECT_TRUE(b->test, bus_esc(b, i)->dc.running);
		KUNIT_EXPECT_LT_MSG(b->test, off, 1000, "slave %u", i);
	}
}

/* some slaves in OP; bus time, ms */
static u32 until_op(struct cyc *c, u32 mask, u32 limit_ms)
{
	struct bus *b = c->b;
	u32 ms, i;

	for (ms = 0; ms < limit_ms; ms++) {
		for (i = 0; mask >> i; i++)
			if (mask & BIT(i) &&
			    (bus_n_slaves(b) <= i || bus_slave_at(b, i)->work.reconfigure ||
					      bus_slave_at(b, i)->al.status != EC_AL_OP))
				break;
		if (!(mask >> i))
			break;
		cyc_run(c, 1);
	}
	KUNIT_EXPECT_LT(b->test, ms, limit_ms);
	return ms;
}

/* Frames to a slave take some cycles each, and these are long. */
static void sync_long_cycle(struct kunit *test)
{
	static const u32 cycle_ms[] = { 20, 40, 100, 300 };
	u32 i, k;

	for (k = 0; k < ARRAY_SIZE(cycle_ms); k++) {
		u32 us = 1000 * cycle_ms[k];
		struct cyc *c = start(test, four, 4, us, PERIOD_NS);
		struct bus *b = c->b;
		u64 op;

		for (i = 0; i < 4; i++) {
			/* longer than the time it has at power-on */
			struct ec_ioc_sc_sync sm = {
				.config = i, .sm = 2, .dir = EC_CFG_DIR_OUTPUT,
				.watchdog = EC_CFG_WD_DISABLE,
			};

			KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sm), 0);
		}
		cyc_activate(c);
		op = cyc_wait_op(c, 120000);
		bus_figure("cycle of %u ms, SYNC0 of 1 ms: OP %llu us after activation", us / 1000,
			   op);
		KUNIT_EXPECT_NE(test, op, ~0ull);
		cyc_run(c, 10);
		for (i = 0; i < 4; i++)
			KUNIT_EXPECT_TRUE(test, bus_esc(b, i)->dc.running);
		bus_down(b);
		test->priv = NULL;
	}
}

/* Half the range of 32 bits is not much beside such a cycle. */
static void sync_long_cycle_of_32_bits(struct kunit *test)
{
	struct cyc *c = start(test, "segment seed=3\n"
			      "slave a drive in=8 out=8 drift=60ppm dc=32\n"
			      "slave b drive in=8 out=8 drift=-70ppm clock=3s dc=32\n", 2, 1200000,
			      PERIOD_NS);
	struct bus *b = c->b;
	u32 i;

	for (i = 0; i < 2; i++) {
		struct ec_ioc_sc_sync sm = {
			.config = i, .sm = 2, .dir = EC_CFG_DIR_OUTPUT,
			.watchdog = EC_CFG_WD_DISABLE,
		};

		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SC_SYNC, &sm), 0);
	}
	cyc_activate(c);
	KUNIT_EXPECT_NE(test, cyc_wait_op(c, 200000), ~0ull);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_TRUE(test, bus_esc(b, i)->dc.running);
}

/* Acyclic frames only leave in some late cycles, and many slaves want to. */
static void sync_few_frames(struct kunit *test)
{
	struct cyc *c = start(test, "segment seed=3\n"
			      "repeat 30 slave s drive in=8 out=8 drift=30ppm\n", 30, 50,
			      PERIOD_NS);
	struct ec_ioc_late late = { .per_s = 100 };
	u64 op;

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_LATE, &late), 0);
	cyc_activate(c);
	op = cyc_wait_op(c, 60000);
	bus_figure("30 axes in 50 us, 100 late cycles a second: OP %llu us after activation", op);
	KUNIT_ASSERT_NE(test, op, ~0ull);
	cyc_run(c, 20);
	expect_in_step(c->b, BIT(30) - 1);
}

/*
 * The chosen reference clock is not there when slaves go to OP, so that their clocks
 * are not set. When it has come they are, and SYNC0 is in step.
 */
static void sync_reference_is_late(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct ec_ioc_ref_clock ref = { .config = 3 };
	struct bus *b = c->b;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_REF_CLOCK, &ref), 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 3, 0, 0, 0);
	msleep(200);
	cyc_activate(c);
	until_op(c, 7, 10000);
	cyc_run(c, 1000);
	KUNIT_EXPECT_FALSE(test, ec_clock_is_set(bus_slave(b, 0)));
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
	cyc_run(c, 1000);
	until_op(c, 15, 10000);
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

/* One with wrong working counters: the others do not wait for it, and it is set later. */
static void sync_bad_slave(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	u64 starts[3];
	u32 i;

	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 1, 0);
	cyc_activate(c);
	bus_figure("three of four slaves in OP %u ms after activation, the clock of the last one silent",
		   until_op(c, 7, 3000));
	cyc_run(c, 8000);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	KUNIT_EXPECT_FALSE(test, ec_clock_is_set(bus_slave(b, 3)));
	expect_in_step(b, 7);
	for (i = 0; i < 3; i++)
		starts[i] = bus_esc(b, i)->dc.start;
	/* well again: its clock, and the slave when somebody asks for it */
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 0, 0);
	for (i = 0; i < 10000 && !ec_clock_is_set(bus_slave(b, 3)); i++)
		cyc_run(c, 1);
	bus_figure("its clock is set %u ms after it answers", i);
	KUNIT_EXPECT_LT(test, i, 10000u);
	bus_request(b, 3, EC_AL_OP);
	until_op(c, 15, 5000);
	cyc_run(c, 500);
	expect_in_step(b, 15);
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_EQ(test, bus_esc(b, i)->dc.start, starts[i]);
}

/* The reference that nobody has chosen is the bad one: another stands in. */
static void sync_bad_reference(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;

	bus_fault(b, EC_SIM_FAULT_WKC, 0, 0, 1, 0);
	cyc_activate(c);
	until_op(c, 14, 3000);
	cyc_run(c, 500);
	KUNIT_EXPECT_PTR_EQ(test, bus_dc_ref(b), bus_slave(b, 1));
	expect_in_step(b, 14);
}

/*
 * A slave has come while somebody holds the session: until its clock is set it
 * does not start SYNC, however long that is and though the others' are set.
 */
static void sync_waits_for_its_clock(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	struct ec_slave *s;
	u32 ms;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 1000);
	s = bus_slave(b, 1);
	mutex_lock(bus_mutex(b));
	/* as the scan leaves it */
	WRITE_ONCE(ec_clock_of(s)->state, EC_CLOCK_UNSET);
	WRITE_ONCE(bus_dc(b)->changed, true);
	WRITE_ONCE(s->work.reconfigure, true);
	bus_request(b, 1, EC_AL_OP);
	cyc_run(c, 2000);
	KUNIT_EXPECT_TRUE(test, READ_ONCE(bus_dc(b)->changed));
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, bus_esc(b, 1)->mem[EC_REG_DC_ACTIVATION], 0);
	mutex_unlock(bus_mutex(b));
	ms = until_op(c, 15, 5000);
	KUNIT_EXPECT_GT(test, ms, 50u);
	KUNIT_EXPECT_FALSE(test, READ_ONCE(bus_dc(b)->changed));
	KUNIT_EXPECT_TRUE(test, ec_clock_is_set(s));
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

/* Back in PREOP by itself, with SYNC still on: it is started anew. */
static void sync_from_preop(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	u64 was;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 1000);
	was = bus_esc(b, 1)->dc.start;
	ec_app_al_fail(bus_esc(b, 1)->app, EC_AL_PREOP, 0x0060, ktime_get_ns());
	cyc_run(c, 200);
	until_op(c, 15, 5000);
	KUNIT_EXPECT_GT(test, bus_esc(b, 1)->dc.start, was);
	expect_in_step(b, 15);
}

static void expect_reason(struct bus *b, u32 i, const char *what)
{
	KUNIT_EXPECT_NE(b->test, bus_slave_at(b, i)->al.status, EC_AL_OP);
	KUNIT_EXPECT_EQ(b->test, bus_slave_at(b, i)->note.error, EC_SLAVE_CONFIG_FAILED);
	KUNIT_EXPECT_NOT_NULL_MSG(b->test, strstr(bus_slave_at(b, i)->note.why, what), "%s",
				  bus_slave_at(b, i)->note.why);
}

/* Without any cycle time there is nothing to start. */
static void sync_without_time(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);

	sync0(c, 1, 0, 0);
	sync0(c, 2, 4000000000u, 4000000000u);
	cyc_activate(c);
	until_op(c, 9, 5000);
	cyc_run(c, 200);
	expect_reason(c->b, 1, "the sum must be 1 to 4294967295 ns");
	expect_reason(c->b, 2, "the sum must be 1 to 4294967295 ns");
	expect_in_step(c->b, 9);
}

static void no_sync_of_1(struct cyc *c)
{
	bus_esc(c->b, 1)->dc.running = false;
	each(c);
}

/* Started in time, and yet nothing comes: no OP, and a reason. */
static void sync_has_no_effect(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);

	c->each = no_sync_of_1;
	cyc_activate(c);
	until_op(c, 13, 5000);
	cyc_run(c, 1000);
	expect_reason(c->b, 1, "SYNC signals started but not running");
	expect_in_step(c->b, 13);
}

/* A slave comes before the first cycle: the clocks get the time of the cycle all the same. */
static void sync_late_cycle(struct kunit *test)
{
	u32 after, i;

	for (after = 0; after < 2; after++) {
		struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
		struct bus *b = c->b;

		bus_fault(b, EC_SIM_FAULT_POWER_OFF, 3, 0, 0, 0);
		msleep(300);
		if (!after)
			bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
		cyc_activate(c);
		msleep(200);
		if (after)
			bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
		msleep(700);
		for (i = 0; i < 3; i++)
			KUNIT_EXPECT_FALSE(test, ec_clock_is_set(bus_slave(b, i)));
		until_op(c, 15, 8000);
		cyc_run(c, 500);
		expect_in_step(b, 15);
		for (i = 0; i < 4; i++) {
			u64 now = ktime_get_ns();
			u64 off = abs((s64)(ec_esc_system_time(bus_esc(b, i), now) - now));

			KUNIT_EXPECT_LT_MSG(test, off, (u64)PERIOD_NS, "slave %u", i);
		}
		bus_down(b);
		test->priv = NULL;
	}
}

/* SYNC1 slower than SYNC0: the first one comes after all of its time. */
static void sync1_is_slower(struct kunit *test)
{
	static const u32 each_nth[] = { 8, 3, 2 };
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	u32 i;

	for (i = 0; i < 3; i++)
		sync0(c, i, PERIOD_NS, (each_nth[i] - 1) * PERIOD_NS);
	/* as long before the first one as somebody may wait */
	sync0(c, 3, PERIOD_NS, 1000 * PERIOD_NS);
	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 8000), ~0ull);
	expect_in_step(b, 15);
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_EQ(test, bus_slave_at(b, i)->note.error, EC_SLAVE_OK);
}

/* What a controller without register 0x0984 answers there means nothing: OP is tried. */
static void sync_without_status(struct kunit *test)
{
	static const u8 value[] = { 0x00, 0x07, 0x03, 0xff };
	struct bus *b = bus_new(test, four);
	struct cyc *c;
	u32 i;

	for (i = 1; i < 4; i++)
		bus_esc(b, i)->cfg.features &= ~EC_FEAT_DC_ENHANCED;
	bus_esc(b, 3)->cfg.features &= ~EC_FEAT_DC64;
	for (i = 1; i < 4; i++) {
		put_unaligned_le16(bus_esc(b, i)->cfg.features,
				   bus_esc(b, i)->mem + EC_REG_FEATURES);
		bus_esc(b, i)->mem[EC_REG_DC_ACT_STATUS] = value[i];
	}
	bus_plug(b);
	KUNIT_ASSERT_NE(test, bus_wait(b, 4, EC_AL_PREOP, 10000), ~0ull);
	bus_idle(b);
	c = configure(b, 4, 1000, PERIOD_NS);
	cyc_activate(c);
	until_op(c, 15, 5000);
	expect_in_step(b, 15);
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_EQ(test, bus_slave_at(b, i)->note.error, EC_SLAVE_OK);
}

static void not_started_again(struct cyc *c)
{
	const u8 *mem = bus_esc(c->b, 1)->mem;

	no_sync_of_1(c);
	if (mem[EC_REG_AL_STATUS] == EC_AL_SAFEOP && !mem[EC_REG_DC_ACTIVATION])
		bus_fault(c->b, EC_SIM_FAULT_WKC, 1, 0, 1, 0);
}

/* In SAFEOP SYNC is started again, and that fails half way: no OP is tried without it. */
static void sync_frames_lost_during_start(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;

	c->each = not_started_again;
	cyc_activate(c);
	until_op(c, 13, 5000);
	cyc_run(c, 1000);
	expect_reason(b, 1, "communication failed before OP");
	KUNIT_EXPECT_EQ(test, bus_esc(b, 1)->mem[EC_REG_AL_STATUS], EC_AL_SAFEOP);
	/* well again */
	c->each = each;
	bus_fault(b, EC_SIM_FAULT_WKC, 1, 0, 0, 0);
	bus_request(b, 1, EC_AL_OP);
	until_op(c, 15, 5000);
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

/* On its way up and waiting, for its clock or for the first SYNC1: PREOP is asked for. */
static void sync_wait_aborted_by_preop_request(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	struct ec_slave *s;
	u32 i;

	sync0(c, 1, PERIOD_NS, 2000 * PERIOD_NS);
	cyc_activate(c);
	s = bus_slave(b, 1);
	for (i = 0; i < 3000 && s->al.status != EC_AL_SAFEOP; i++)
		cyc_run(c, 1);
	cyc_run(c, 100);
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_SAFEOP);
	bus_request(b, 1, EC_AL_PREOP);
	cyc_run(c, 50);
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_PREOP);
	bus_request(b, 1, EC_AL_OP);
	until_op(c, 15, 5000);

	mutex_lock(bus_mutex(b));
	/* as the scan leaves it */
	WRITE_ONCE(ec_clock_of(s)->state, EC_CLOCK_UNSET);
	WRITE_ONCE(bus_dc(b)->changed, true);
	WRITE_ONCE(s->work.reconfigure, true);
	bus_request(b, 1, EC_AL_OP);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_PREOP);
	bus_request(b, 1, EC_AL_PREOP);
	cyc_run(c, 150);
	KUNIT_EXPECT_NULL(test, READ_ONCE(s->stop.worker));
	mutex_unlock(bus_mutex(b));
	cyc_run(c, 2000);
	KUNIT_EXPECT_EQ(test, s->al.status, EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, s->note.error, EC_SLAVE_OK);
	bus_request(b, 1, EC_AL_OP);
	until_op(c, 15, 5000);
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

static void until_state(struct cyc *c, const struct ec_clock *clock, enum ec_clock_state state)
{
	u32 i;

	for (i = 0; i < 10000 && READ_ONCE(clock->state) != state; i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_EQ(c->b->test, clock->state, (u32)state);
}

/*
 * A clock that is set stops replying: it stays set, keeps its offset, and is polled until it
 * replies. The next activation does not take it for set.
 */
static void sync_set_clock_lost_then_set(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	struct ec_clock *clock;
	u64 offset;

	cyc_activate(c);
	until_op(c, 15, 5000);
	cyc_run(c, 1000);
	clock = ec_clock_of(bus_slave(b, 3));
	KUNIT_EXPECT_EQ(test, clock->state, (u32)EC_CLOCK_SET);
	offset = clock->offset;
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 1, 0);
	WRITE_ONCE(bus_dc(b)->changed, true);
	until_state(c, clock, EC_CLOCK_LOST);
	KUNIT_EXPECT_TRUE(test, ec_clock_is_set(bus_slave(b, 3)));
	cyc_run(c, 3000);
	KUNIT_EXPECT_EQ(test, clock->state, (u32)EC_CLOCK_LOST);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_READY);
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 0, 0);
	until_state(c, clock, EC_CLOCK_SET);
	KUNIT_EXPECT_EQ(test, clock->offset, offset);
	/* the rest of the table */
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_ACTIVATION), EC_CLOCK_SET);
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_SILENT), EC_CLOCK_UNSET);
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_ACTIVATION),
			EC_CLOCK_EXCLUDED);
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_SET), EC_CLOCK_EXCLUDED);
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_SILENT), EC_CLOCK_SET);
	KUNIT_EXPECT_EQ(test, (int)ec_clock_event(clock, EC_CLOCK_ON_ACTIVATION), EC_CLOCK_LOST);
	KUNIT_EXPECT_EQ(test, clock->state, (u32)EC_CLOCK_EXCLUDED);
}

static u32 begun;

/* the last slave answers, but not while the clocks are set */
static void never_set(struct cyc *c)
{
	static bool was;
	bool busy = ec_dc_busy(bus_dc(c->b));

	each(c);
	if (busy != was)
		bus_fault(c->b, EC_SIM_FAULT_WKC, 3, 0, busy, 0);
	begun += busy && !was;
	was = busy;
}

/* The others' clocks are not measured for ever because of one that cannot be set. */
static void sync_unset_clock_excluded_after_retries(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	u32 i;

	begun = 0;
	c->each = never_set;
	cyc_activate(c);
	until_op(c, 7, 20000);
	cyc_run(c, 45000);
	KUNIT_EXPECT_EQ(test, begun, 4u);
	cyc_run(c, 60000);
	KUNIT_EXPECT_EQ(test, begun, 4u);
	KUNIT_EXPECT_EQ(test, ec_clock_of(bus_slave(b, 3))->state, (u32)EC_CLOCK_EXCLUDED);
	expect_in_step(b, 7);
	/* well again when it comes anew */
	c->each = each;
	bus_fault(b, EC_SIM_FAULT_WKC, 3, 0, 0, 0);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 3, 0, 0, 0);
	cyc_run(c, 500);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 3, 0, 0, 0);
	for (i = 0; i < 10000 && (bus_n_slaves(b) < 4 || !ec_clock_is_set(bus_slave(b, 3))); i++)
		cyc_run(c, 1);
	KUNIT_EXPECT_LT(test, i, 10000u);
	until_op(c, 15, 5000);
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

/* the clock of slave 1 is set back by a year before it gets its start time, once */
static struct {
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	struct bus *b;
	u32 starts;
} year;

static int set_back(void *priv, u8 *buf, size_t len)
{
	struct ec_frame_iter it;
	struct ec_dgram d;

	if (!ec_frame_iter_init(&it, buf + EC_ETH_HDR, len - EC_ETH_HDR))
		while (ec_frame_iter_next(&it, &d) == 1)
			if (d.cmd == EC_CMD_FPWR && d.ado == EC_REG_DC_START &&
			    d.adp == bus_slave_at(year.b, 1)->station && !year.starts++)
				bus_esc(year.b, 1)->dc.base_local -= 365 * 86400 * NSEC_PER_SEC;
	return year.real->tx_send(priv, buf, len);
}

/* Its start time is a year ahead then: it is given another one. */
static void sync_clock_set_back_during_start(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct ecdev *dev = bus_dev(c->b);

	year.b = c->b;
	year.starts = 0;
	year.real = dev->ops;
	year.ops = *dev->ops;
	year.ops.tx_send = set_back;
	dev->ops = &year.ops;
	cyc_activate(c);
	bus_figure("clock set back by a year while SYNC is started: all in OP after %u ms",
		   until_op(c, 15, 5000));
	KUNIT_EXPECT_EQ(test, year.starts, 2u);
	KUNIT_EXPECT_TRUE(test, bus_esc(c->b, 1)->dc.running);
	dev->ops = year.real;
}

/* Another attempt for another slave is due: a slave on its way to OP waits for its end. */
static void sync_waits_for_attempt_that_is_due(struct kunit *test)
{
	struct cyc *c = start(test, four, 4, 1000, PERIOD_NS);
	struct bus *b = c->b;
	u32 lines;

	cyc_activate(c);
	KUNIT_ASSERT_NE(test, cyc_wait_op(c, 5000), ~0ull);
	cyc_run(c, 1000);
	lines = bus_log_lines("SYNC signals started, but");
	mutex_lock(bus_mutex(b));
	ec_dc_set_state(bus_dc(b), EC_DC_RETRY_DUE);
	WRITE_ONCE(bus_slave(b, 1)->work.reconfigure, true);
	bus_request(b, 1, EC_AL_OP);
	cyc_run(c, 1000);
	KUNIT_EXPECT_EQ(test, bus_dc_state(b), (int)EC_DC_RETRY_DUE);
	KUNIT_EXPECT_EQ(test, bus_slave(b, 1)->al.status, EC_AL_PREOP);
	mutex_unlock(bus_mutex(b));
	until_op(c, 15, 5000);
	KUNIT_EXPECT_EQ(test, bus_log_lines("SYNC signals started, but"), lines);
	cyc_run(c, 500);
	expect_in_step(b, 15);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sync_unset_clock_excluded_after_retries),
	KUNIT_CASE(sync_wait_aborted_by_preop_request),
	KUNIT_CASE(sync_frames_lost_during_start),
	KUNIT_CASE(sync_without_status),
	KUNIT_CASE(sync1_is_slower),
	KUNIT_CASE(sync_late_cycle),
	KUNIT_CASE(sync_long_cycle),
	KUNIT_CASE(sync_long_cycle_of_32_bits),
	KUNIT_CASE(sync_few_frames),
	KUNIT_CASE(sync_reference_is_late),
	KUNIT_CASE(sync_bad_slave),
	KUNIT_CASE(sync_bad_reference),
	KUNIT_CASE(sync_waits_for_its_clock),
	KUNIT_CASE(sync_set_clock_lost_then_set),
	KUNIT_CASE(sync_from_preop),
	KUNIT_CASE(sync_without_time),
	KUNIT_CASE(sync_has_no_effect),
	KUNIT_CASE(sync_clock_set_back_during_start),
	KUNIT_CASE(sync_waits_for_attempt_that_is_due),
	{ }
};

static struct kunit_suite suite = { .name = "bus_dc_sync", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
