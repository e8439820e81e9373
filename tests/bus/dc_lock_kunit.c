// SPDX-License-Identifier: GPL-2.0-only
/* The kernel's cycle follows the reference clock: when do its frames leave? */
#include "cyc.h"
#include "devices/sim/esc_int.h"
#include "master/cycle/cycle_thread.h"
#include "master/cycle/pll.h"
#include "master/clock/dc_state.h"
#include "master/boundary/ioctl.h"
#include "master/wire/dc_lock.h"

#define PERIOD_NS	1000000
#define STARTS		100u

static const char two[] = "segment seed=9\n"
	"slave a drive in=8 out=8 drift=87ppm cable=50 clock=5s\n"
	"slave b drive in=8 out=8 drift=-93ppm cable=20 clock=900s\n";

/**
 * struct app - an application whose cycle the kernel runs
 * @c: its configuration
 * @cfg: cycle
 */
struct app {
	struct cyc *c;
	struct ec_ioc_cycle cfg;
};

static struct ec_status_cycle *status(const struct app *a)
{
	return bus_kernel_status(a->c->b);
}

/* All slaves with SYNC0, shifts of a quarter of a period from one to the next. */
static void configure(struct app *a, struct bus *b, u32 slaves)
{
	u32 i;

	a->c = cyc_new(b, PERIOD_NS / 1000);
	cyc_domain(a->c);
	cyc_map_all(a->c, 0, slaves, 0);
	for (i = 0; i < slaves; i++) {
		struct ec_ioc_sc_dc dc = {
			.config = i, .assign_activate = 0x0300, .cycle0 = a->cfg.period_ns,
			.shift0 = (i % 4) * (a->cfg.period_ns / 4),
		};

		KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SC_DC, &dc), 0);
	}
}

static void activate(struct app *a, struct bus *b, u32 slaves)
{
	configure(a, b, slaves);
	KUNIT_ASSERT_EQ_MSG(b->test, ec_ioc(&b->app, EC_IOC_CYCLE, &a->cfg), 0, "%s",
			    b->app.reason);
	cyc_activate(a->c);
}

static struct app *start(struct kunit *test, const char *text, u32 slaves, u32 phase_ns)
{
	struct bus *b = bus_up(test, text, slaves);
	struct app *a = kunit_kzalloc(test, sizeof(*a), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, a);
	bus_idle(b);
	a->cfg = (struct ec_ioc_cycle){
		.period_ns = PERIOD_NS, .phase_ns = phase_ns, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_CYCLE_DC_FOLLOW,
	};
	activate(a, b, slaves);
	return a;
}

/* until it is locked and all are in OP; bus time, ms */
static u32 until_locked(struct app *a)
{
	u32 ms;

	for (ms = 0; ms < 5000; ms++) {
		if (READ_ONCE(status(a)->lock) == EC_CYCLE_LOCK_LOCKED && cyc_all_op(a->c))
			break;
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_LT(a->c->b->test, ms, 5000u);
	return ms;
}

/*
 * When the last frame passed the reference, counted from the SYNC0 of a slave
 * before it, by that slave's true clock; ns.
 */
static u32 phase(struct app *a, u32 slave)
{
	struct bus *b = a->c->b;
	u64 sent = bus_last_send_ns(b) + b->sim->route[0].step[0].pu_ns, since;
	const struct ec_esc *esc = bus_esc(b, slave);

	ec_sim_advance(b->sim, ktime_get_ns());
	since = ec_esc_local_time(esc, sent) + get_unaligned_le64(esc->mem + EC_REG_DC_OFFSET) -
		esc->dc.start;
	return do_div(since, a->cfg.period_ns);
}

static s32 phase_error(struct app *a, u32 slave, u32 wanted)
{
	return ec_dc_lock_wrap((s64)phase(a, slave) - wanted, a->cfg.period_ns);
}

/*
 * Mean distance to the phase that was asked for, looked at so many times. A
 * single cycle may be a microsecond late: virtual time passes when it is read.
 */
static s32 mean(struct app *a, u32 slave, u32 wanted, u32 times)
{
	s64 sum = 0;
	u32 i;

	for (i = 0; i < times; i++) {
		s32 e;

		usleep_range(1370, 1371);
		e = phase_error(a, slave, wanted);
		KUNIT_EXPECT_LT(a->c->b->test, abs(e), 3000);
		sum += e;
	}
	return (s32)div_s64(sum, times);
}

/* Cycles keep phase and rate of the slaves' SYNC0. */
static void lock_keeps_phase(struct kunit *test)
{
	struct app *a = start(test, two, 2, 300000);
	u32 ms = until_locked(a);
	s32 off;

	msleep(1000);
	off = mean(a, 0, 300000, 1000);
	bus_figure("cycle locked and slaves in OP %u ms after activation, its mean phase to SYNC0 then %d ns off",
		   ms, off);
	KUNIT_EXPECT_LT(test, abs(off), 200);
	/* SYNC0 of the other one is shifted by a quarter */
	KUNIT_EXPECT_LT(test, abs(mean(a, 1, 50000, 500)), 200);
	KUNIT_EXPECT_EQ(test, status(a)->lock_losses, 0u);
	KUNIT_EXPECT_EQ(test, status(a)->overruns, 0ull);
	KUNIT_EXPECT_LT(test, abs(status(a)->phase_error), 1000);
	KUNIT_EXPECT_LT(test, abs(status(a)->rate_ppb - 87000), 500);
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), 0ull);
}

/* The application time of a program for another master, set before activation, has no effect. */
static void lock_ignores_app_time_before_activation(struct kunit *test)
{
	struct bus *b = bus_up(test, two, 2);
	struct ec_ioc_app_time early = { .app_time = 123456789 };
	struct app a = { .cfg = {
		.period_ns = PERIOD_NS, .phase_ns = 300000, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_CYCLE_DC_FOLLOW,
	} };

	bus_idle(b);
	configure(&a, b, 2);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &a.cfg), 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_APP_TIME, &early), 0);
	cyc_activate(a.c);
	until_locked(&a);
	msleep(1000);
	KUNIT_EXPECT_LT(test, abs(mean(&a, 0, 300000, 100)), 200);
	KUNIT_EXPECT_LT(test, abs(mean(&a, 1, 50000, 100)), 200);
}

/* A reference with 32 bits: it wraps each 4.3 s. */
static void lock_to_short_clock(struct kunit *test)
{
	struct app *a = start(test, "slave a drive in=8 out=8 dc=32 drift=-60ppm clock=3s\n"
			      "slave b drive in=8 out=8 dc=32 drift=40ppm cable=90\n", 2, 0);
	u32 i;

	until_locked(a);
	msleep(1000);
	for (i = 0; i < 10; i++)
		KUNIT_EXPECT_LT(test, abs(mean(a, 0, 0, 1000)), 200);
	KUNIT_EXPECT_EQ(test, status(a)->lock_losses, 0u);
	KUNIT_EXPECT_EQ(test, status(a)->overruns, 0ull);
}

/* One frame in twenty is lost, then all for a while: the rate is kept. */
static void lock_survives_lost_frames(struct kunit *test)
{
	struct app *a = start(test, two, 2, 500000);
	struct bus *b = a->c->b;

	until_locked(a);
	msleep(2000);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 50000);
	KUNIT_EXPECT_LT(test, abs(mean(a, 0, 500000, 500)), 200);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	msleep(100);
	KUNIT_EXPECT_EQ(test, status(a)->lock, EC_CYCLE_LOCK_LOCKED);
	/* for longer than any watchdog: the slaves fall back, the cycle goes on */
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 1000000);
	msleep(150);
	KUNIT_EXPECT_EQ(test, status(a)->lock, EC_CYCLE_LOCK_HOLD);
	KUNIT_EXPECT_LT(test, abs(phase_error(a, 0, 500000)), 1000);
	bus_fault(b, EC_SIM_FAULT_LOSE, 0, -1, 0, 0);
	until_locked(a);
	KUNIT_EXPECT_LT(test, abs(mean(a, 0, 500000, 100)), 200);
}

/*
 * The reference clock is silent for longer than a second, and no scan replaces it: the other
 * clocks continue at its rate, as the cycle does.
 */
static void lock_holdover_keeps_slaves_in_phase(struct kunit *test)
{
	struct app *a = start(test, two, 2, 300000);
	struct bus *b = a->c->b;
	s32 error;

	until_locked(a);
	msleep(2000);
	WRITE_ONCE(bus_table(b)->held, true);
	bus_fault(b, EC_SIM_FAULT_DEAD, 0, 0, 1, 0);
	msleep(5000);
	error = phase_error(a, 1, 50000);
	KUNIT_EXPECT_EQ(test, status(a)->lock, EC_CYCLE_LOCK_HOLD);
	bus_figure("reference clock silent for 5 s: SYNC0 of the other slave %d ns off", error);
	KUNIT_EXPECT_LT(test, abs(error), 5000);
	bus_fault(b, EC_SIM_FAULT_DEAD, 0, 0, 0, 0);
	WRITE_ONCE(bus_table(b)->held, false);
	until_locked(a);
}

/*
 * A hundred starts, each at another moment and after clocks have drifted: the
 * phase of the frame to SYNC0 is always the same.
 */
static void lock_same_phase_each_start(struct kunit *test)
{
	struct app *a = start(test, two, 2, 400000);
	struct bus *b = a->c->b;
	s32 e, low = 0, high = 0;
	u32 i, ms = 0;

	for (i = 0; i < STARTS; i++) {
		if (i)
			activate(a, b, 2);
		ms = max(ms, until_locked(a));
		usleep_range(200000, 200001);
		e = mean(a, 0, 400000, 30);
		low = i ? min(low, e) : e;
		high = i ? max(high, e) : e;
		cyc_release(a->c);
		KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
		usleep_range(1000 + i * 1234567 % 100000, 200000);
	}
	bus_figure("%u starts, cycle follows: phase to SYNC0 from %d to %d ns off, locked and in OP after %u ms at most",
		   STARTS, low, high, ms);
	bus_row(high - low, 1000, "phase of the frame to SYNC0 over %u starts, cycle follows, ns",
		STARTS);
	KUNIT_EXPECT_LT(test, high - low, 1000);
}

static void lead(struct cyc *c)
{
	c->flags = EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_APP_TIME;
	/* its own schedule, by a clock of its own */
	c->app_time = ktime_to_ns(c->next) + 123456789;
	c->sync_time = c->app_time;
}

/* The same when the reference follows an application that runs its cycle. */
static void lead_same_phase_each_start(struct kunit *test)
{
	struct bus *b = bus_up(test, two, 2);
	struct app a = { .cfg = { .period_ns = PERIOD_NS } };
	s32 low = 0, high = 0, early = 0;
	u32 i, k;

	bus_idle(b);
	for (i = 0; i < STARTS; i++) {
		s64 sum = 0;

		configure(&a, b, 2);
		a.c->each = lead;
		cyc_activate(a.c);
		KUNIT_ASSERT_NE(test, cyc_wait_op(a.c, 5000), ~0ull);
		cyc_run(a.c, 1000);
		early = max_t(s32, early, abs(phase_error(&a, 0, 0)));
		cyc_run(a.c, 1000);
		for (k = 0; k < 30; k++) {
			cyc_run(a.c, 1);
			sum += phase_error(&a, 0, 0);
		}
		sum = div_s64(sum, 30);
		low = i ? min_t(s32, low, sum) : sum;
		high = i ? max_t(s32, high, sum) : sum;
		cyc_release(a.c);
		KUNIT_ASSERT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
		usleep_range(1000 + i * 1234567 % 100000, 200000);
	}
	bus_figure("%u starts, reference follows: phase to SYNC0 %d ns off after 1 s, then from %d to %d ns",
		   STARTS, early, low, high);
	/* 860 to 1040, by how the starts fall to the looks of the monitor */
	bus_row(high - low, 1100, "phase of the frame to SYNC0 over %u starts, clock follows, ns",
		STARTS);
	KUNIT_EXPECT_LT(test, high - low, 1100);
}

/* What makes no sense is refused with a reason. */
static void lock_refused(struct kunit *test)
{
	struct bus *b = bus_up(test, two, 2);
	struct ec_ioc_cycle cfg = {
		.period_ns = PERIOD_NS, .cpu = -1, .dc = EC_CYCLE_DC_FOLLOW,
	};

	cyc_new(b, 1000);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "needs EC_CYCLE_SYNC_SLAVES"));
	cfg.dc |= EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_SYNC_REF;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	KUNIT_EXPECT_NOT_NULL(test, strstr(b->app.reason, "excludes EC_CYCLE_SYNC_REFERENCE"));
	cfg.dc &= ~EC_SEND_FLAG_SYNC_REF;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
}

/* The counter of cycles has 32 bits; at 10 kHz it wraps after five days. */
static void lock_cycle_count_wraps_time_continues(struct kunit *test)
{
	struct app *a = start(test, two, 2, 0);
	struct ec_cycle *c = bus_cycle(a->c->b);
	u64 due = ktime_get_ns(), first;
	struct ec_pll l;

	ec_pll_init(&l, c);
	l.follow = false;
	ec_pll_step(&l, c, due, 12345);
	first = l.time;
	l.past[(U32_MAX - 1) % EC_PLL_PAST] = l.past[0];
	l.n_past = U32_MAX;
	ec_pll_step(&l, c, due + PERIOD_NS, 0);
	ec_pll_step(&l, c, due + 2ULL * PERIOD_NS, 0);
	KUNIT_EXPECT_EQ(test, l.time, first + 2ULL * PERIOD_NS);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(lock_keeps_phase),
	KUNIT_CASE(lock_ignores_app_time_before_activation),
	KUNIT_CASE(lock_to_short_clock),
	KUNIT_CASE(lock_survives_lost_frames),
	KUNIT_CASE(lock_holdover_keeps_slaves_in_phase),
	KUNIT_CASE(lock_same_phase_each_start),
	KUNIT_CASE(lead_same_phase_each_start),
	KUNIT_CASE(lock_refused),
	KUNIT_CASE(lock_cycle_count_wraps_time_continues),
	{ }
};

static struct kunit_suite suite = { .name = "bus_lock", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
