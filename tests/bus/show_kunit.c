// SPDX-License-Identifier: GPL-2.0-only
/*
 * Readers that pause. Here is one CPU only, so the part of a changer on another CPU
 * that waits for a section is played by the case itself.
 */
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/sched/signal.h>
#include <linux/workqueue.h>
#include "bus.h"
#include "master/boundary/call.h"
#include "master/boundary/ioctl.h"
#include "master/config/why.h"

struct change {
	struct delayed_work work;
	struct bus *b;
};

static struct bus *ready(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);

	bus_idle(b);
	return b;
}

static void end_change(struct work_struct *work)
{
	struct change *c = container_of(to_delayed_work(work), struct change, work);

	ec_show_change_end(bus_show(c->b));
}

/* What was found is gone, whether the change began in the section or in the pause. */
static void show_pause_reports_change_that_waited(struct kunit *test)
{
	struct bus *b = ready(test);
	struct change c = { .b = b };
	u64 t0 = ktime_get_ns();
	int ret;

	INIT_DELAYED_WORK_ONSTACK(&c.work, end_change);
	KUNIT_ASSERT_EQ(test, ec_show_begin(bus_show(b)), 0);
	ec_show_change_announce(bus_show(b));
	schedule_delayed_work(&c.work, msecs_to_jiffies(20));
	ret = ec_show_pause(bus_show(b));
	/* else the next change waits for ever */
	if (!ret)
		ec_show_end(bus_show(b));
	KUNIT_EXPECT_EQ(test, ret, -EAGAIN);
	KUNIT_EXPECT_GE_MSG(test, ktime_get_ns() - t0, 10 * NSEC_PER_MSEC,
			    "it waits for the end of the change");
	KUNIT_EXPECT_EQ_MSG(test, atomic_read(&bus_show(b)->showing), 0, "the section has ended");
	destroy_delayed_work_on_stack(&c.work);
}

/* Without a change, and after one that was over before, what was found is still there. */
static void show_pause_goes_on_without_change(struct kunit *test)
{
	struct bus *b = ready(test);

	bus_lock(b);
	bus_unlock(b);
	KUNIT_ASSERT_EQ(test, ec_show_begin(bus_show(b)), 0);
	KUNIT_EXPECT_EQ(test, ec_show_pause(bus_show(b)), 0);
	KUNIT_EXPECT_EQ(test, atomic_read(&bus_show(b)->showing), 1);
	ec_show_end(bus_show(b));
}

#define CONFIGS	200

static void configure(struct bus *b, u16 position)
{
	struct ec_ioc_slave_config i = {
		.position = position, .vendor_id = 1, .product_code = 2,
	};

	KUNIT_ASSERT_EQ(b->test, ec_ioc(&b->app, EC_IOC_SLAVE_CONFIG, &i), 0);
}

/* A section is short, however many configurations there are; the last one is found. */
static void show_many_configs_in_pieces(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_slave slave = { 0 };
	unsigned int from = 0, i;

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_RESERVE, NULL), 0);
	for (i = 1; i < CONFIGS; i++)
		configure(b, i);
	configure(b, 0);
	KUNIT_ASSERT_EQ(test, ec_show_begin(bus_show(b)), 0);
	KUNIT_EXPECT_NULL(test, ec_config_at(bus_wanted(b), bus_slave_at(b, 0), &from));
	KUNIT_EXPECT_LE(test, from, 64u);
	ec_show_end(bus_show(b));
	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &slave), 0);
	KUNIT_EXPECT_EQ(test, slave.config, (u32)CONFIGS);
	KUNIT_EXPECT_TRUE(test, slave.differs);
	bus_end(b);
}

/* What a program leaves in the structure is no alias of a slave. */
static void show_slave_takes_no_alias_from_caller(struct kunit *test)
{
	struct bus *b = ready(test);
	struct ec_ioc_slave i = { .alias_group = 7 };

	KUNIT_ASSERT_EQ(test, ec_ioc(&b->app, EC_IOC_SLAVE, &i), 0);
	KUNIT_EXPECT_EQ(test, i.alias_group, 0);
}

struct reader {
	struct bus *b;
	u32 looks;
};

static struct reader *reader;

/* as if each look met a change that is over at once; a signal comes with the third */
static int meet_change(struct ec_call *call)
{
	if (++reader->looks == 3)
		send_sig(SIGUSR1, current, 1);
	return reader->looks < 100 ? -EAGAIN : 0;
}

static int read_on(void *arg)
{
	static const struct ec_ioctl op = { .fn = meet_change, .class = EC_CLASS_SHOW_SLAVE };
	struct ec_ioc_address first = { 0 };

	allow_signal(SIGUSR1);
	return ec_call_run(&reader->b->app, &op, &first, false);
}

/* Changes one after the other do not keep a reader that has got a signal. */
static void show_ends_on_signal_between_changes(struct kunit *test)
{
	struct reader r = { .b = ready(test) };
	struct task_struct *t;

	reader = &r;
	t = kthread_create(read_on, NULL, "reader");
	KUNIT_ASSERT_FALSE(test, IS_ERR(t));
	get_task_struct(t);
	wake_up_process(t);
	msleep(20);
	KUNIT_EXPECT_EQ(test, kthread_stop(t), -ERESTARTSYS);
	put_task_struct(t);
	KUNIT_EXPECT_EQ(test, r.looks, 3u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(show_pause_reports_change_that_waited),
	KUNIT_CASE(show_pause_goes_on_without_change),
	KUNIT_CASE(show_many_configs_in_pieces),
	KUNIT_CASE(show_slave_takes_no_alias_from_caller),
	KUNIT_CASE(show_ends_on_signal_between_changes),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_show",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
