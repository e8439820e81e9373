// SPDX-License-Identifier: GPL-2.0-only
/* The kernel's cycle in the interrupt of its timer, and when its thread has to take it. */
#include <linux/delay.h>
#include "kcyc.h"
#include "master/cycle/cycle_run.h"
#include "master/link/device.h"
#include "master/cycle/cycle_sched.h"

static const struct ec_ioc_cycle interrupt = { .flags = EC_CYCLE_FLAG_INTERRUPT };

/* a device that looks at its callers */
static struct {
	const struct ecdev_ops *real;
	struct ecdev_ops ops;
	u32 hard;
	u32 thread;
	u32 delay_us;	/* of the next call */
	bool stays;	/* and of all others */
} spy;

static u8 *spy_tx_get(void *priv)
{
	if (in_hardirq() && irqs_disabled())
		spy.hard++;
	else
		spy.thread++;
	udelay(spy.delay_us);
	if (!spy.stays)
		spy.delay_us = 0;
	return spy.real->tx_get(priv);
}

static struct kcyc *watched(struct kunit *test, struct ec_ioc_cycle cfg)
{
	struct kcyc *a = kcyc_start(test, cfg);
	struct ecdev *dev = bus_dev(a->c->b);

	memset(&spy, 0, sizeof(spy));
	spy.real = dev->ops;
	spy.ops = *dev->ops;
	spy.ops.tx_get = spy_tx_get;
	dev->ops = &spy.ops;
	return a;
}

static void unwatch(struct kcyc *a)
{
	bus_dev(a->c->b)->ops = spy.real;
}

static u32 place(struct kcyc *a)
{
	struct ec_ioc_cycle_stats info = { 0 };

	KUNIT_EXPECT_EQ(a->c->b->test, ec_ioc(&a->c->b->app, EC_IOC_CYCLE_STATS, &info), 0);
	return info.place;
}

static void timer_runs_all_cycles(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	struct bus *b = a->c->b;
	u32 i;

	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	for (i = 1; i <= 1000; i++) {
		kcyc_write(a, i);
		kcyc_give(a);
		kcyc_wait_cycles(a, 2);
		KUNIT_ASSERT_EQ(test, kcyc_output(a, "s1", 1), (s64)i);
		KUNIT_ASSERT_NOT_NULL(test, kcyc_take(a));
	}
	KUNIT_EXPECT_GE(test, spy.hard, 2000u);
	KUNIT_EXPECT_EQ(test, spy.thread, 0u);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(b), 0ull);
	unwatch(a);
}

/* Without the flag nothing of this happens. */
static void timer_is_asked_for(struct kunit *test)
{
	struct kcyc *a = watched(test, (struct ec_ioc_cycle){ 0 });

	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_THREAD);
	KUNIT_EXPECT_EQ(test, spy.hard, 0u);
	KUNIT_EXPECT_GE(test, spy.thread, 100u);
	unwatch(a);
}

static bool no_link(void *priv)
{
	return false;
}

/* The device needs a thread now and then: no cycle is left out. */
static void timer_not_for_each_device(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	struct ec_link *backup = bus_link(a->c->b, 1);
	/* the monitor asks it, too */
	struct ecdev_ops ops = { .atomic = false, .link_up = no_link };
	struct ecdev dev = { .ops = &ops };
	u32 hard;

	kcyc_wait_cycles(a, 10);
	spy.ops.atomic = false;
	kcyc_wait_cycles(a, 2);
	hard = spy.hard;
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_DEVICE);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	spy.ops.atomic = true;
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	KUNIT_EXPECT_GE(test, spy.hard, hard + 97);
	/* no frame of the cycle goes to the backup device */
	WRITE_ONCE(backup->dev, &dev);
	kcyc_wait_cycles(a, 10);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	WRITE_ONCE(backup->dev, NULL);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), 0ull);
	unwatch(a);
}

/* One cycle of more than half of the period: threads get their time for the next 1000. */
static void timer_leaves_time(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	u32 hard;

	kcyc_wait_cycles(a, 10);
	spy.delay_us = KCYC_PERIOD_NS / NSEC_PER_USEC * 6 / 10;
	kcyc_wait_cycles(a, 2);
	hard = spy.hard;
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_LONG);
	kcyc_wait_cycles(a, 990);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	KUNIT_EXPECT_GE(test, spy.thread, 990u);
	kcyc_wait_cycles(a, 20);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	KUNIT_EXPECT_GE(test, spy.hard, hard + 5);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), 0ull);
	unwatch(a);
}

/* Each cycle takes less than half of the period, but begins late: what is left becomes less. */
static void timer_is_late(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	u32 i, hard;

	/* it has four frames */
	spy.delay_us = KCYC_PERIOD_NS / NSEC_PER_USEC / 10;
	spy.stays = true;
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	for (i = 0; i < 6; i++) {
		local_irq_disable();
		udelay(KCYC_PERIOD_NS / NSEC_PER_USEC * 95 / 100);
		local_irq_enable();
	}
	kcyc_wait_cycles(a, 2);
	hard = spy.hard;
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_LONG);
	kcyc_wait_cycles(a, 900);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	unwatch(a);
}

static u32 woken;

static int wake(struct wait_queue_entry *entry, unsigned int mode, int flags, void *key)
{
	woken++;
	return 0;
}

static struct wait_queue_entry entry;
static wait_queue_head_t *queue;

static void add_entry(struct file *filp, wait_queue_head_t *wq, poll_table *table)
{
	init_waitqueue_func_entry(&entry, wake);
	add_wait_queue(wq, &entry);
	queue = wq;
}

/* poll() is woken for each cycle, also for the last one of the interrupt. */
static void timer_wakes_poll(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	poll_table table;
	u32 i, before;

	init_poll_funcptr(&table, add_entry);
	KUNIT_EXPECT_FALSE(test, ec_file_poll(&a->c->b->app, (struct file *)&table, &table) &
				 EPOLLERR);
	kcyc_wait_cycles(a, 1);
	for (i = 0; i < 100; i++) {
		before = woken;
		/* one of them is too long: the thread has the next ones */
		spy.delay_us = i == 50 ? KCYC_PERIOD_NS / NSEC_PER_USEC * 6 / 10 : 0;
		kcyc_wait_cycles(a, 1);
		/* the thread has a priority: it was before this one */
		KUNIT_EXPECT_GT_MSG(test, woken, before, "cycle %u", i);
	}
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_LONG);
	remove_wait_queue(queue, &entry);
	unwatch(a);
}

/* A kernel that panics may not disable its timers: no frame goes on for ever. */
static void timer_ends_with_panic(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	struct notifier_block *nb = &bus_cycle(a->c->b)->thread->panic;
	u32 hard;

	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	nb->notifier_call(nb, 0, NULL);
	hard = spy.hard;
	/* not the 20 ms of a cycle timeout, after which the monitor sends: here its thread lives */
	usleep_range(15000, 15001);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	KUNIT_EXPECT_EQ(test, spy.thread, 0u);
	unwatch(a);
}

/* Printed frames may take any time. */
static void timer_not_while_printing(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	u32 *debug = &bus_base(a->c->b)->debug, before = *debug, hard;

	WRITE_ONCE(*debug, 2);
	kcyc_wait_cycles(a, 2);
	hard = spy.hard;
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_DEBUG);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	WRITE_ONCE(*debug, before);
	kcyc_wait_cycles(a, 3);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	unwatch(a);
}

/* The application that takes the cycle over may not have the right. */
static void timer_needs_right(struct kunit *test)
{
	struct kcyc *a = watched(test, interrupt);
	struct bus *b = a->c->b;
	struct ec_cycle *c = bus_cycle(b);
	u32 hard;

	bus_lock(b);
	ec_cycle_thread_inherit(c, c->setup.priority, false);
	bus_unlock(b);
	kcyc_wait_cycles(a, 2);
	hard = spy.hard;
	kcyc_wait_cycles(a, 100);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_RIGHT);
	KUNIT_EXPECT_EQ(test, spy.hard, hard);
	bus_lock(b);
	ec_cycle_thread_inherit(c, c->setup.priority, true);
	bus_unlock(b);
	kcyc_wait_cycles(a, 2);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	KUNIT_EXPECT_EQ(test, bus_lost(a->c->b), 0ull);
	unwatch(a);
}

/* The last cycle of the policy "stop" is one of the interrupt; its caller returns. */
static void timer_stops(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, (struct ec_ioc_cycle){ .flags = EC_CYCLE_FLAG_INTERRUPT,
		.stall = EC_STALL_STOP, .stall_cycles = 20 });
	int ret = 0;
	u32 i;

	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	kcyc_give(a);
	for (i = 0; i < 100 && !ret; i++)
		ret = kcyc_wait(a, 100000);
	KUNIT_EXPECT_EQ(test, ret, -ECANCELED);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->state, (u32)EC_CYCLE_STATE_STOPPED);
	KUNIT_EXPECT_EQ(test, ec_ioc(&a->c->b->app, EC_IOC_DEACTIVATE, NULL), 0);
}

/* A time limit of the caller, and the device goes away under the interrupt. */
static void timer_without_device(struct kunit *test)
{
	struct kcyc *a = kcyc_start(test, interrupt);
	struct ec_ioc_wait w = { .cycle = U64_MAX - 1, .timeout_us = 5000 };
	struct bus *b = a->c->b;
	u64 before = ktime_get_ns();

	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_INTERRUPT);
	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_WAIT, &w), -ETIMEDOUT);
	KUNIT_EXPECT_GE(test, ktime_get_ns() - before, 5000000ull);
	bus_no_device(b);
	a->seen = kcyc_status(a)->cycle;
	kcyc_wait_cycles(a, 500);
	KUNIT_EXPECT_EQ(test, place(a), (u32)EC_CYCLE_PLACE_QUIET);
	KUNIT_EXPECT_EQ(test, kcyc_status(a)->overruns, 0ull);
	KUNIT_EXPECT_EQ(test, kcyc_shared(a)->status->no_device, 1u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(timer_runs_all_cycles),
	KUNIT_CASE(timer_is_asked_for),
	KUNIT_CASE(timer_not_for_each_device),
	KUNIT_CASE(timer_leaves_time),
	KUNIT_CASE(timer_is_late),
	KUNIT_CASE(timer_wakes_poll),
	KUNIT_CASE(timer_ends_with_panic),
	KUNIT_CASE(timer_not_while_printing),
	KUNIT_CASE(timer_needs_right),
	KUNIT_CASE(timer_stops),
	KUNIT_CASE(timer_without_device),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_kcyc_timer", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
