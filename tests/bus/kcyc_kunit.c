// SPDX-License-Identifier: GPL-2.0-only
/* The kernel runs the cycle; a case is the application. */
#include <linux/poll.h>
#include "kcyc.h"
#include "master/cycle/cycle_wait.h"

/* Period and phase are exact, nothing is lost, each cycle has its inputs. */
static void kcyc_period(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .phase_ns = 250000 });
	u64 frames = bus_frames(a->c->b), lost = bus_lost(a->c->b), cycle = 0, counted = 0;
	u32 i, wrong = 0;

	kcyc_take(a);
	for (i = 0; i < 1000; i++) {
		const struct ec_exchange_buffer *in;

		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		in = kcyc_take(a);
		KUNIT_ASSERT_NOT_NULL(test, in);
		if (cycle)
			KUNIT_EXPECT_EQ(test, in->cycle, cycle + 1);
		cycle = in->cycle;
		KUNIT_EXPECT_EQ(test, in->cycle, a->seen);
		KUNIT_EXPECT_EQ(test, in->time_ns % KCYC_PERIOD_NS, 250000ull);
		wrong += in->domains[0].wc_state != 2;
		kcyc_write(a, i);
		kcyc_give(a);
	}
	KUNIT_EXPECT_EQ(test, wrong, 0u);
	KUNIT_EXPECT_GE(test, bus_frames(a->c->b) - frames, 1000ull);
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), lost);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->late_count, kcyc_status(a)->cycle);
	for (i = 0; i < EC_CYCLE_BUCKETS; i++)
		counted += kcyc_status(a)->late[i];
	KUNIT_EXPECT_EQ(test, counted, kcyc_status(a)->cycle);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->work_count, kcyc_status(a)->cycle);
	KUNIT_EXPECT_GT(test, kcyc_status(a)->work_max, 0u);
	/* time passes only when it is read */
	bus_figure("kernel cycle: send %u to %u ns after its schedule", kcyc_status(a)->late_min,
		   kcyc_status(a)->late_max);
	KUNIT_EXPECT_LT(test, kcyc_status(a)->late_max, 10000u);
}

/* Outputs reach the slaves whole and come back as inputs of one cycle. */
static void kcyc_whole_images(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	u32 i, last = 0, torn = 0, fresh = 0;

	for (i = 1; i <= 500; i++) {
		const struct ec_exchange_buffer *in;
		u32 k, v[4];

		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
		in = kcyc_take(a);
		KUNIT_ASSERT_NOT_NULL(test, in);
		for (k = 0; k < 4; k++)
			v[k] = get_unaligned_le32((u8 *)(in + 1) +
						  kcyc_place(a, k / 2, 1, k % 2 ?
							     KCYC_CHANNELS : 1));
		torn += v[0] != v[1] || v[0] != v[2] || v[0] != v[3];
		fresh += v[0] == last + 1;
		last = v[0];
		kcyc_write(a, i);
		kcyc_give(a);
	}
	KUNIT_EXPECT_EQ(test, torn, 0u);
	/* a value is back three cycles after it was given */
	KUNIT_EXPECT_GE(test, fresh, 495u);
	KUNIT_EXPECT_GE(test, last, 495u);
}

/* Only the newest of several outputs counts; the kernel never takes half. */
static void kcyc_newest_wins(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	u32 i;

	for (i = 0; i < 10; i++) {
		kcyc_write(a, 100 + i);
		kcyc_give(a);
	}
	kcyc_write(a, 7);	/* not given */
	KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 109ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 109ll);
}

/* events of this kind with these first arguments */
static u32 events(struct kcyc *a, u32 kind, u32 first, u32 second)
{
	struct ec_event e = { };
	u64 at = 0;
	u32 n = 0;

	while (ec_event_ring_get(bus_events(a->c->b), &at, &e))
		n += e.kind == kind && e.arg[0] == first && e.arg[1] == second;
	return n;
}

static void kcyc_stall_hold(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.stall = EC_STALL_HOLD, .stall_cycles = 5 });

	/* before the first outputs nobody has stalled */
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_RUNNING);
	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_RUNNING);
	kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_STALLED);
	kcyc_wait_cycles(a, 20);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 25ull);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
	KUNIT_EXPECT_EQ(test, events(a, EC_EVENT_STALL, EC_STALL_HOLD, 5), 1u);
	kcyc_give(a);
	kcyc_wait_cycles(a, 1);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_RUNNING);
	KUNIT_EXPECT_EQ(test, events(a, EC_EVENT_OUTPUTS, 25, 0), 1u);
}

static void kcyc_stall_zero(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.stall = EC_STALL_ZERO, .stall_cycles = 5 });

	kcyc_write(a, 42);
	kcyc_give(a);
	kcyc_wait_cycles(a, 5);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 42ll);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 0ll);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s2", KCYC_CHANNELS), 0ll);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
	KUNIT_EXPECT_EQ(test, events(a, EC_EVENT_STALL, EC_STALL_ZERO, 5), 1u);
	kcyc_write(a, 43);
	kcyc_give(a);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, kcyc_output(a, "s1", 1), 43ll);
}

/* One in each sixth cycle, as of a slow application: few events, and none is forgotten. */
static void kcyc_stall_again_and_again(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.stall = EC_STALL_HOLD, .stall_cycles = 5 });
	struct ec_event e = { };
	u64 at = 0, stalls = 0;
	u32 i, n = 0;

	for (i = 0; i < 500; i++) {
		kcyc_give(a);
		kcyc_wait_cycles(a, 6);
	}
	/* the last one stands, and has its record when a second is over */
	kcyc_wait_cycles(a, 1000);
	while (ec_event_ring_get(bus_events(a->c->b), &at, &e)) {
		n += e.kind == EC_EVENT_STALL || e.kind == EC_EVENT_OUTPUTS;
		stalls += e.kind == EC_EVENT_STALL ? 1 + e.arg[2] : 0;
	}
	KUNIT_EXPECT_EQ(test, stalls, 500ull);
	KUNIT_EXPECT_LE(test, n, 5u * 2 * EC_EVENT_RATE);
}

static void kcyc_stall_stop(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){
		.stall = EC_STALL_STOP, .stall_cycles = 5 });
	u64 cycle;

	kcyc_write(a, 42);
	kcyc_give(a);
	while (!kcyc_wait(a, 0))
		;
	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 0), -ECANCELED);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, EC_CYCLE_STATE_STOPPED);
	KUNIT_EXPECT_EQ(test, events(a, EC_EVENT_STALL, EC_STALL_STOP, 5), 1u);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->missed, 5ull);
	KUNIT_EXPECT_TRUE(test, ec_cycle_thread_poll(bus_cycles(a->c->b), &a->c->b->app) &
			  EPOLLHUP);
	cycle = kcyc_status(a)->cycle;
	msleep(200);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->cycle, cycle);
	KUNIT_EXPECT_EQ(test, bus_access_mode(a->c->b), (int)EC_ACCESS_DIRECT);
}

/* Nobody gets the processor for 3.5 ms: three cycles are left out. */
static void kcyc_overrun(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	const struct ec_exchange_buffer *in;
	u64 counted = 0;
	u32 i;

	KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	udelay(4500);
	KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 3ull);
	KUNIT_EXPECT_GE(test, kcyc_status(a)->late_max, 3000000u);
	KUNIT_EXPECT_LT(test, kcyc_status(a)->late_max, 4000000u);
	for (i = 0; i < 8; i++)		/* 2.1 to 4.2 ms */
		counted += kcyc_status(a)->late[152 + i];
	KUNIT_EXPECT_EQ(test, counted, 1ull);
	kcyc_wait_cycles(a, 10);
	in = kcyc_take(a);
	KUNIT_ASSERT_NOT_NULL(test, in);
	KUNIT_EXPECT_EQ(test, in->time_ns % KCYC_PERIOD_NS, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 3ull);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
}

/* The clocks of the slaves follow without the application. */
static void kcyc_clocks(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a drive in=8 out=8 drift=100ppm\n"
			       "slave b drive in=8 out=8 drift=-100ppm clock=9s\n", 2);
	struct cyc *c;
	struct ec_ioc_cycle cfg = {
		.period_ns = KCYC_PERIOD_NS, .cpu = -1,
		.dc = EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR,
	};
	struct ec_status *st;
	u64 now;
	s64 d;

	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
	cyc_activate(c);
	msleep(2000);
	st = bus_status(b);
	KUNIT_EXPECT_TRUE(test, cyc_all_op(c));
	KUNIT_EXPECT_EQ(test, st->dc_ref, 1u);
	KUNIT_EXPECT_EQ(test, st->dc_time_valid, 1u);
	KUNIT_EXPECT_LT(test, st->dc_monitor, 100u);
	now = ktime_get_ns();
	ec_sim_advance(b->sim, now);
	d = ec_esc_system_time(bus_esc(b, 0), now) - ec_esc_system_time(bus_esc(b, 1), now);
	KUNIT_EXPECT_LT(test, abs(d), 100ll);
}

/* What only the kernel may do, and what cannot be. */
static void kcyc_refused(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;
	struct ec_ioc_app_time time = { .app_time = 5 };
	struct ec_ioc_cycle cfg = { .period_ns = KCYC_PERIOD_NS, .cpu = -1 };
	struct ec_ioc_send send = { 0 };

	KUNIT_EXPECT_EQ(test, ec_ioc_receive(&b->app), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc_send(&b->app, &send), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_APP_TIME, &time), -EBUSY);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EBUSY);
	cyc_release(a->c);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EPERM);
	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 1000), -EPERM);
	cyc_new(b, 1000);
	cfg.period_ns = 9999;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	cfg.period_ns = KCYC_PERIOD_NS;
	cfg.phase_ns = KCYC_PERIOD_NS;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	cfg.phase_ns = 0;
	cfg.cpu = nr_cpu_ids;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	cfg.cpu = -1;
	cfg.priority = 99;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	cfg.priority = 0;
	cfg.stall = 3;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EINVAL);
	cfg.stall = 0;
	cfg.dc = EC_SEND_FLAG_APP_TIME;
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), -EOPNOTSUPP);
}

/* Whatever the application writes into the exchange, its session goes on. */
static void kcyc_hostile_exchange(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct ec_exchange *x = kcyc_shared(a)->exchange;
	u32 i;

	for (i = 0; i < 200; i++) {
		WRITE_ONCE(x->outputs, i * 0x9e3779b9u);
		WRITE_ONCE(x->inputs, i * 0x85ebca6bu);
		WRITE_ONCE(x->stride, i * 0xc2b2ae35u);
		KUNIT_ASSERT_EQ(test, kcyc_wait(a, 0), 0);
	}
	KUNIT_EXPECT_TRUE(test, cyc_all_op(a->c));
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), 0ull);
}

struct ending {
	struct delayed_work work;
	struct kcyc *a;
};

static void release(struct work_struct *w)
{
	struct ending *e = container_of(to_delayed_work(w), struct ending, work);

	cyc_release(e->a->c);
}

/* The session ends while the application waits for a cycle. */
static void kcyc_end_while_running(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ 0 });
	struct bus *b = a->c->b;
	struct ending e = { .a = a };
	u32 round;

	INIT_DELAYED_WORK_ONSTACK(&e.work, release);
	schedule_delayed_work(&e.work, msecs_to_jiffies(20));
	a->seen = ~0ull;
	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 2000), -ETIMEDOUT);
	KUNIT_EXPECT_EQ(test, kcyc_wait(a, 0), -ECANCELED);
	flush_delayed_work(&e.work);
	destroy_delayed_work_on_stack(&e.work);
	KUNIT_EXPECT_NULL(test, bus_session(b));
	KUNIT_EXPECT_NE(test, bus_wait(b, 2, EC_AL_PREOP, 5000), ~0ull);
	/* and again, as often as one likes */
	for (round = 0; round < 20; round++) {
		struct ec_ioc_cycle cfg = { .period_ns = KCYC_PERIOD_NS, .cpu = -1 };
		struct ec_ioc_activate act = { 0 };

		cyc_new(b, 1000);
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_CYCLE, &cfg), 0);
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_ACTIVATE, &act), 0);
		KUNIT_EXPECT_GT(test, act.exchange_size, 0u);
		a->seen = 0;
		if (round % 2)
			kcyc_wait_cycles(a, round);
		KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RELEASE, NULL), 0);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(kcyc_period),
	KUNIT_CASE(kcyc_whole_images),
	KUNIT_CASE(kcyc_newest_wins),
	KUNIT_CASE(kcyc_stall_hold),
	KUNIT_CASE(kcyc_stall_zero),
	KUNIT_CASE(kcyc_stall_again_and_again),
	KUNIT_CASE(kcyc_stall_stop),
	KUNIT_CASE(kcyc_overrun),
	KUNIT_CASE(kcyc_clocks),
	KUNIT_CASE(kcyc_refused),
	KUNIT_CASE(kcyc_hostile_exchange),
	KUNIT_CASE(kcyc_end_while_running),
	{ }
};

static struct kunit_suite suite = { .name = "bus_kcyc", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
