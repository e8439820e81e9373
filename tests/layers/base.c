// SPDX-License-Identifier: GPL-2.0-only
/* What all layers use: the log, and readers that take no lock. */
#include <linux/delay.h>
#include <linux/hrtimer.h>
#include <linux/kthread.h>
#include <linux/slab.h>
#include "alone.h"
#include "master/base/budget.h"
#include "master/base/grow.h"
#include "master/base/once64.h"
#include "master/kernel/compat.h"

static struct ec_base *base_new(void)
{
	struct ec_base *b = kvzalloc(sizeof(*b), GFP_KERNEL);

	if (CHECK(b))
		ec_base_init(b, 3, 0);
	return b;
}

/* what repeats is counted, other subjects are not held back */
static void repeated_lines_are_counted(void)
{
	struct ec_base *b = base_new();
	unsigned int i;

	if (!b)
		return;
	for (i = 0; i < 10; i++)
		ec_log_event(b, 1, 0, KERN_WARNING, "test of the log, slave %u\n", 1);
	CHECK_EQ(b->log.lines, 1);
	ec_log_event(b, 2, 0, KERN_WARNING, "test of the log, slave %u\n", 2);
	CHECK_EQ(b->log.lines, 2);
	ec_log_flush(b, true);
	/* one line says how many there were */
	CHECK_EQ(b->log.lines, 3);
	kvfree(b);
}

struct thread {
	struct ec_base *b;
	int ret;
	struct completion done;
};

static int reader(void *arg)
{
	struct thread *t = arg;

	t->ret = ec_show_begin(&t->b->show);
	if (!t->ret)
		ec_show_end(&t->b->show);
	complete(&t->done);
	return 0;
}

static int ends_change(void *arg)
{
	struct thread *t = arg;

	usleep_range(3000, 4000);
	ec_show_change_end(&t->b->show);
	complete(&t->done);
	return 0;
}

static bool begin_thread(struct thread *t, struct ec_base *b, int (*fn)(void *arg))
{
	t->b = b;
	init_completion(&t->done);
	return CHECK(!IS_ERR(kthread_run(fn, t, "ec_alone")));
}

static void reader_waits_for_change(void)
{
	struct ec_base *b = base_new();
	struct thread t;

	if (!b)
		return;
	ec_show_change_begin(&b->show);
	if (begin_thread(&t, b, reader)) {
		usleep_range(3000, 4000);
		CHECK(!completion_done(&t.done));
		ec_show_change_end(&b->show);
		wait_for_completion(&t.done);
		CHECK_EQ(t.ret, 0);
	}
	kvfree(b);
}

static void pause_reports_change(void)
{
	struct ec_base *b = base_new();
	struct thread t;

	if (!b)
		return;
	CHECK_EQ(ec_show_begin(&b->show), 0);
	CHECK_EQ(ec_show_pause(&b->show), 0);
	ec_show_end(&b->show);
	if (begin_thread(&t, b, ends_change)) {
		CHECK_EQ(ec_show_begin(&b->show), 0);
		ec_show_change_announce(&b->show);
		CHECK_EQ(ec_show_pause(&b->show), -EAGAIN);
		wait_for_completion(&t.done);
	}
	kvfree(b);
}

static void memory_beyond_limit_is_refused(void)
{
	static DEFINE_MUTEX(lock);
	atomic_long_t total = ATOMIC_LONG_INIT(0);
	struct ec_budget budget = { .lock = &lock, .total = &total };

	mutex_lock(&lock);
	CHECK_EQ(ec_budget_charge(&budget, EC_MAX_SESSION_BYTES), 0);
	CHECK_EQ(ec_budget_charge(&budget, 1), -EDQUOT);
	CHECK_EQ(budget.bytes, EC_MAX_SESSION_BYTES);
	ec_budget_release(&budget, EC_MAX_SESSION_BYTES);
	CHECK_EQ(atomic_long_read(&total), 0);
	mutex_unlock(&lock);
}

static void arrays_grow_and_keep_their_entries(void)
{
	u32 *array = NULL, *larger, i;

	for (i = 0; i < 100; i++) {
		larger = ec_grow(array, i, sizeof(*array));
		if (!CHECK(larger))
			break;
		array = larger;
		array[i] = i;
	}
	while (i--)
		if (!CHECK_EQ(array[i], i))
			break;
	kvfree(array);
}

/* reads the status page in an interrupt of the CPU that writes there */
struct status_reader {
	struct hrtimer timer;
	struct ec_status *st;
	u32 interrupts;
	u32 hits;	/* of the writer: the reader would wait for ever */
	u32 torn;
};

static enum hrtimer_restart read_status(struct hrtimer *timer)
{
	struct status_reader *r = container_of(timer, struct status_reader, timer);
	u32 copy[2];

	r->interrupts++;
	if (READ_ONCE(r->st->sequence) & 1) {
		r->hits++;
		return HRTIMER_NORESTART;
	}
	ec_status_copy(r->st, copy, &r->st->dc_time64, sizeof(copy));
	r->torn += copy[0] != copy[1];
	hrtimer_forward_now(timer, ns_to_ktime(20 * NSEC_PER_USEC));
	return r->interrupts < 1000 ? HRTIMER_RESTART : HRTIMER_NORESTART;
}

static void interrupt_never_hits_writer_of_status(void)
{
	struct status_reader r = { .st = kvzalloc(sizeof(*r.st), GFP_KERNEL) };
	u32 n, *half = (u32 *)&r.st->dc_time64;
	u64 end = ktime_get_ns() + 5 * (u64)NSEC_PER_SEC;
	unsigned long flags;

	if (!CHECK(r.st))
		return;
	hrtimer_setup(&r.timer, read_status, CLOCK_MONOTONIC, HRTIMER_MODE_REL_PINNED_HARD);
	hrtimer_start(&r.timer, ns_to_ktime(20 * NSEC_PER_USEC), HRTIMER_MODE_REL_PINNED_HARD);
	for (n = 0; READ_ONCE(r.interrupts) < 1000 && ktime_get_ns() < end; n++) {
		flags = ec_status_begin(r.st);
		/* in two parts, as a kernel of 32 bits does, and slowly */
		WRITE_ONCE(half[0], n);
		ndelay(500);
		WRITE_ONCE(half[1], n);
		ec_status_end(r.st, flags);
		if (READ_ONCE(r.hits))
			break;
	}
	hrtimer_cancel(&r.timer);
	CHECK_EQ(r.hits, 0);
	CHECK_EQ(r.torn, 0);
	CHECK_EQ(r.interrupts, 1000);
	kvfree(r.st);
}

const struct alone_test alone_tests[] = {
	TEST(repeated_lines_are_counted),
	TEST(reader_waits_for_change),
	TEST(pause_reports_change),
	TEST(memory_beyond_limit_is_refused),
	TEST(arrays_grow_and_keep_their_entries),
	TEST(interrupt_never_hits_writer_of_status),
	{ }
};
