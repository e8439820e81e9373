// SPDX-License-Identifier: GPL-2.0-only
/* The thread of the posts: when it runs, and what is said when it cannot. */
#include <linux/delay.h>
#include "bus.h"
#include "cyc.h"

/* Beside a cycle that nothing happens to, and on a bus without one, its thread sleeps. */
static void post_thread_rests(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\nslave d drive in=8 out=8\n", 2);
	unsigned long before, idle, beside;
	struct cyc *c;

	bus_idle(b);
	before = bus_post_slept(b);
	msleep(10000);
	idle = bus_post_slept(b) - before;
	c = cyc_in_op(b, 0, 2);
	cyc_run(c, 2000);
	before = bus_post_slept(b);
	cyc_run(c, 10000);
	beside = bus_post_slept(b) - before;
	bus_figure("thread of the posts in 10 s: %lu times without cycle, %lu beside one", idle,
		   beside);
	KUNIT_EXPECT_LT(test, idle, 100ul);
	KUNIT_EXPECT_LT(test, beside, 100ul);
}

static void never(struct ec_post *post)
{
}

/* It does not wake for a post that was to be sent later, and is not sent at all. */
static void post_thread_rests_without_later(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	struct ec_post *post = kunit_kzalloc(test, sizeof(*post), GFP_KERNEL);
	u8 type[1];
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, type);
	unsigned long before;

	KUNIT_ASSERT_NOT_NULL(test, post);
	bus_idle(b);
	ec_post_init(post, bus_links(b), never);
	post->dg = &dg;
	post->n = 1;
	before = bus_post_slept(b);
	ec_post_send(post, ktime_get_ns() + 100 * NSEC_PER_MSEC);
	KUNIT_EXPECT_TRUE(test, ec_post_recall(post));
	msleep(10000);
	KUNIT_EXPECT_LT(test, bus_post_slept(b) - before, 100ul);
}

/* the thread of the posts has work, more of it all the time, and gets no CPU */
static void keep_cpu(struct bus *b, unsigned int ms)
{
	unsigned int i;

	preempt_disable();
	for (i = 0; i < ms; i += 20) {
		bus_post_kick(b);
		mdelay(20);
	}
	preempt_enable();
}

/* the machine stands still: not even its timers run */
static void stand_still(struct bus *b, unsigned int ms)
{
	local_irq_disable();
	bus_post_kick(b);
	mdelay(ms);
	local_irq_enable();
}

static u64 lines(const struct bus *b)
{
	return READ_ONCE(bus_base(b)->log.lines);
}

/* once nothing is left to report: all lines so far */
static u64 lines_at_rest(struct bus *b)
{
	bus_idle(b);
	msleep(11000);
	return lines(b);
}

/* A thread of higher priority on its CPU is reported after a second, and no sooner. */
static void post_thread_starved_reported(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	u64 l0;

	l0 = lines_at_rest(b);
	keep_cpu(b, 900);
	msleep(2000);
	KUNIT_EXPECT_EQ(test, lines(b), l0);
	keep_cpu(b, 1100);
	KUNIT_EXPECT_EQ(test, lines(b), l0 + 1);
	msleep(5000);
	KUNIT_EXPECT_EQ(test, lines(b), l0 + 1);
}

/* Whatever started the timer while the thread went to rest, at rest it is not starved. */
static void post_thread_at_rest_not_reported(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	u32 i;
	u64 l0;

	l0 = lines_at_rest(b);
	ec_carry_expect(bus_carry(b), 0);
	msleep(5000);
	KUNIT_EXPECT_EQ(test, lines(b), l0);
	for (i = 0; i < 3000; i++) {
		bus_post_kick(b);
		usleep_range(1000, 1001);
	}
	KUNIT_EXPECT_EQ(test, lines(b), l0);
}

/* A guest that is paused stands still with all that is in it: none of its threads is starved. */
static void post_thread_of_paused_machine_not_reported(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	u64 l0;

	l0 = lines_at_rest(b);
	stand_still(b, 5000);
	msleep(5000);
	KUNIT_EXPECT_EQ(test, lines(b), l0);
	/* but afterwards as ever */
	preempt_disable();
	stand_still(b, 5000);
	mdelay(1100);
	preempt_enable();
	KUNIT_EXPECT_EQ(test, lines(b), l0 + 1);
}

/* Above all programs without a priority, below each cycle that has one of 2 or more. */
static void post_thread_has_fifo_1(struct kunit *test)
{
	struct bus *b = bus_up(test, "slave a EK1100\n", 1);
	const struct task_struct *task = READ_ONCE(bus_carry(b)->thread);

	KUNIT_ASSERT_NOT_NULL(test, task);
	KUNIT_EXPECT_EQ(test, task->policy, (unsigned int)SCHED_FIFO);
	KUNIT_EXPECT_EQ(test, task->rt_priority, 1u);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(post_thread_rests),
	KUNIT_CASE(post_thread_rests_without_later),
	KUNIT_CASE(post_thread_has_fifo_1),
	KUNIT_CASE(post_thread_starved_reported),
	KUNIT_CASE(post_thread_at_rest_not_reported),
	KUNIT_CASE(post_thread_of_paused_machine_not_reported),
	{}
};

static struct kunit_suite suite = {
	.name = "bus_post_thread",
	.exit = bus_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);

MODULE_LICENSE("GPL");
