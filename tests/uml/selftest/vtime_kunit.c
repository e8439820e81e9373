// SPDX-License-Identifier: GPL-2.0-only
/*
 * Proof that the UML kernel runs on virtual time: a thread sleeps on absolute
 * hrtimers each 1 ms for one hour, which takes seconds of real time.
 *
 * KUnit's limit of 300 s for a case counts virtual time too; hence the thread
 * runs on while many cases wait 290 s each and look at it.
 */
#include <linux/completion.h>
#include <linux/delay.h>
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/sched.h>
#include "ec_kunit.h"

#define CYCLE_NS	NSEC_PER_MSEC
#define CYCLES		(3600L * 1000)
#define WAIT_S		290

static struct {
	struct task_struct *task;
	struct completion done;
	long cycles;
	s64 start;
	s64 end;
	s64 worst_late;
} soak;

static int soak_thread(void *unused)
{
	ktime_t next = ktime_get();

	soak.start = ktime_to_ns(next);
	while (soak.cycles < CYCLES && !kthread_should_stop()) {
		s64 late;

		next = ktime_add_ns(next, CYCLE_NS);
		set_current_state(TASK_UNINTERRUPTIBLE);
		schedule_hrtimeout(&next, HRTIMER_MODE_ABS);
		late = ktime_to_ns(ktime_sub(ktime_get(), next));
		if (late > soak.worst_late)
			soak.worst_late = late;
		WRITE_ONCE(soak.cycles, soak.cycles + 1);
	}
	soak.end = ktime_get_ns();
	complete(&soak.done);
	while (!kthread_should_stop()) {
		set_current_state(TASK_INTERRUPTIBLE);
		if (!kthread_should_stop())
			schedule();
		__set_current_state(TASK_RUNNING);
	}
	return 0;
}

static int vtime_suite_init(struct kunit_suite *suite)
{
	memset(&soak, 0, sizeof(soak));
	init_completion(&soak.done);
	soak.task = kthread_run(soak_thread, NULL, "vtime_soak");
	return PTR_ERR_OR_ZERO(soak.task);
}

static void vtime_suite_exit(struct kunit_suite *suite)
{
	if (!IS_ERR_OR_NULL(soak.task))
		kthread_stop(soak.task);
}

static void vtime_advances(struct kunit *test)
{
	long before = READ_ONCE(soak.cycles);
	s64 t0 = ktime_get_ns();
	long cycles;
	s64 ms;

	wait_for_completion_timeout(&soak.done, WAIT_S * HZ);
	/* Leaves the completion set for the cases after this one. */
	if (READ_ONCE(soak.cycles) == CYCLES)
		complete_all(&soak.done);

	ms = div_s64(ktime_get_ns() - t0, NSEC_PER_MSEC);
	cycles = READ_ONCE(soak.cycles) - before;
	KUNIT_EXPECT_GE(test, cycles, (long)ms - 1);
	KUNIT_EXPECT_LE(test, cycles, (long)ms + 1);
}

static void vtime_hour_done(struct kunit *test)
{
	s64 ns = soak.end - soak.start;

	KUNIT_ASSERT_TRUE(test, completion_done(&soak.done));
	KUNIT_EXPECT_EQ(test, soak.cycles, CYCLES);
	KUNIT_EXPECT_GE(test, ns, CYCLES * CYCLE_NS);
	KUNIT_EXPECT_LE(test, ns, CYCLES * CYCLE_NS + 1000 * NSEC_PER_USEC);
	/* Nothing but the timer's own time passes: no jitter worth a word. */
	KUNIT_EXPECT_LE(test, soak.worst_late, 1000 * NSEC_PER_USEC);
	kunit_info(test, "%ld cycles in %lld ns, latest wake-up %lld ns late",
		   soak.cycles, ns, soak.worst_late);
}

/* 13 x 290 s covers the hour. */
static struct kunit_case vtime_cases[] = {
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances), KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_advances),
	KUNIT_CASE(vtime_hour_done),
	{}
};

static struct kunit_suite vtime_suite = {
	.name = "uml_vtime",
	.suite_init = vtime_suite_init,
	.suite_exit = vtime_suite_exit,
	.test_cases = vtime_cases,
};

kunit_test_suite(vtime_suite);

MODULE_LICENSE("GPL");
