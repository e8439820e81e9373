// SPDX-License-Identifier: GPL-2.0-only
/*
 * The cycle sleeps nowhere, prints nothing, and under lockdep (run.sh --debug)
 * takes no lock that may sleep and allocates nothing that may: each call is
 * made inside a fence that has all of that reported. The plain kernel counts no
 * preempt_disable(): there only the count of switches shows a sleep.
 */
#include <linux/console.h>
#include <linux/debug_locks.h>
#include <linux/hrtimer.h>
#include <linux/lockdep.h>
#include <linux/sched/mm.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "cyc.h"
#include "master/boundary/ioctl.h"
#include "master/cycle/receive.h"
#include "master/cycle/send.h"
#include "master/clock/dc_app.h"

#define CYCLES	1000
#define ALL	(EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | EC_SEND_FLAG_MONITOR)

static DEFINE_SPINLOCK(fence);
static unsigned int lines;

/**
 * struct seen - what happened inside the fence
 * @switches: times the caller slept
 * @lines: lines printed
 * @lockdep: lockdep had something to say
 */
struct seen {
	unsigned long switches;
	unsigned int lines;
	bool lockdep;
};

static void count_line(struct console *con, const char *text, unsigned int len)
{
	lines++;
}

static struct console counter = {
	.name = "rtcount", .write = count_line,
};

/*
 * Inside a spinlock no lock that sleeps may be taken, and inside reclaim none
 * of what waits for memory may be asked for: both is what lockdep checks. @lock
 * false: the caller itself takes a mutex, which nobody holds.
 */
static void enter(struct seen *v, bool lock)
{
	v->switches -= current->nvcsw;
	v->lines -= lines;
	if (lock)
		spin_lock(&fence);
	fs_reclaim_acquire(GFP_KERNEL);
}

static void leave(struct seen *v, bool lock)
{
	fs_reclaim_release(GFP_KERNEL);
	if (lock)
		spin_unlock(&fence);
	v->switches += current->nvcsw;
	v->lines += lines;
#ifdef CONFIG_LOCKDEP
	v->lockdep |= !debug_locks;
#endif
}

static void expect_nothing(struct kunit *test, const struct seen *v)
{
	KUNIT_EXPECT_EQ(test, v->switches, 0ul);
	KUNIT_EXPECT_EQ(test, v->lines, 0u);
	KUNIT_EXPECT_FALSE(test, v->lockdep);
}

/* Unregistering has disabled it. */
static void count_lines(void)
{
	counter.flags = CON_ENABLED | CON_ANYTIME;
	register_console(&counter);
}

/* Drives with clocks and mailboxes, two domains. */
static struct cyc *configure(struct kunit *test)
{
	struct bus *b = bus_up(test, "repeat 4 slave d drive in=22 out=22 drift=50ppm\n", 4);
	struct cyc *c;

	count_lines();
	bus_idle(b);
	c = cyc_new(b, 1000);
	cyc_domain(c);
	cyc_domain(c);
	cyc_map_all(c, 0, 2, 0);
	cyc_map_all(c, 2, 2, 1);
	c->flags = ALL;
	return c;
}

static void rt_exit(struct kunit *test)
{
	unregister_console(&counter);
	bus_exit(test);
}

static void next(struct cyc *c)
{
	c->next = ktime_add_ns(c->next, c->period_ns);
	set_current_state(TASK_UNINTERRUPTIBLE);
	schedule_hrtimeout(&c->next, HRTIMER_MODE_ABS);
}

static struct cyc *start(struct kunit *test)
{
	struct cyc *c = configure(test);

	cyc_activate(c);
	cyc_wait_op(c, 5000);
	cyc_run(c, 100);
	return c;
}

/* Receive and send of both kinds of cycle, and what a tool leaves to them. */
static void rt_receive_send(struct kunit *test)
{
	struct cyc *c = start(test);
	struct ec_cycle *cycle = bus_cycle(c->b);
	struct ec_ioc_send send = { .queued = 3, .flags = ALL };
	struct seen v = { 0 };
	u32 i;

	for (i = 0; i < CYCLES; i++) {
		next(c);
		if (i == CYCLES / 2)
			bus_request(c->b, 1, EC_AL_SAFEOP);
		send.sync_time = ktime_to_ns(c->next);
		enter(&v, true);
		KUNIT_ASSERT_EQ(test, ec_cycle_receive(cycle), 0);
		ec_dc_app_time(bus_dc(c->b), send.sync_time, send.sync_time);
		KUNIT_ASSERT_EQ(test, ec_cycle_send(cycle, &send), 0);
		leave(&v, true);
	}
	expect_nothing(test, &v);
	KUNIT_EXPECT_EQ(test, bus_lost(c->b), 0ull);
}

/* The commands of an application: the mutex they take is free. */
static void rt_commands(struct kunit *test)
{
	struct cyc *c = start(test);
	struct ec_ioc_send send = { .queued = 3, .flags = ALL | EC_SEND_FLAG_REQUESTS };
	struct seen v = { 0 };
	u32 i;

	for (i = 0; i < CYCLES; i++) {
		next(c);
		enter(&v, false);
		KUNIT_ASSERT_EQ(test, ec_ioc_receive(&c->b->app), 0);
		KUNIT_ASSERT_EQ(test, ec_ioc_send(&c->b->app, &send), 0);
		leave(&v, false);
	}
	expect_nothing(test, &v);
}

static struct task_struct *find_thread(void)
{
	struct task_struct *p, *found = NULL;

	rcu_read_lock();
	for_each_process(p)
		if (!strcmp(p->comm, "EtherCAT0-cyc"))
			found = p;
	rcu_read_unlock();
	return found;
}

/* The thread of the kernel's cycle sleeps once a cycle, for its timer. */
static void rt_thread(struct kunit *test)
{
	struct cyc *c = configure(test);
	struct ec_ioc_cycle cfg = { .period_ns = 1000000, .cpu = -1, .dc = ALL };
	const struct ec_status_cycle *st;
	struct task_struct *thread;
	unsigned long slept;
	unsigned int printed;
	u64 cycles;

	KUNIT_ASSERT_EQ(test, ec_ioc(&c->b->app, EC_IOC_CYCLE, &cfg), 0);
	cyc_activate(c);
	msleep(3000);
	KUNIT_ASSERT_TRUE(test, cyc_all_op(c));
	thread = find_thread();
	KUNIT_ASSERT_NOT_NULL(test, thread);
	st = bus_kernel_status(c->b);
	slept = thread->nvcsw;
	printed = lines;
	cycles = st->cycle;
	msleep(CYCLES);
	cycles = st->cycle - cycles;
	KUNIT_EXPECT_GE(test, cycles, (u64)CYCLES - 1);
	KUNIT_EXPECT_EQ(test, (u64)(thread->nvcsw - slept), cycles);
	KUNIT_EXPECT_EQ(test, lines - printed, 0u);
}

/* Control: sleeping and printing inside the fence are noticed. */
static void rt_control(struct kunit *test)
{
	struct cyc *c = start(test);
	struct seen v = { 0 };

	v.switches -= current->nvcsw;
	msleep(1);
	v.switches += current->nvcsw;
	KUNIT_EXPECT_GE(test, v.switches, 1ul);
	enter(&v, true);
	pr_info("a line inside the fence\n");
	leave(&v, true);
	KUNIT_EXPECT_EQ(test, v.lines, 1u);
	cyc_run(c, 10);
}

#ifdef CONFIG_PROVE_LOCKING
static DEFINE_MUTEX(a_mutex);
static DEFINE_RT_MUTEX(an_rt_mutex);
static DECLARE_RWSEM(a_semaphore);

static void take_mutex(void)
{
	mutex_lock(&a_mutex);
	mutex_unlock(&a_mutex);
}

static void take_rt_mutex(void)
{
	rt_mutex_lock(&an_rt_mutex);
	rt_mutex_unlock(&an_rt_mutex);
}

static void take_semaphore(void)
{
	down_read(&a_semaphore);
	up_read(&a_semaphore);
}

static void allocate(void)
{
	kfree(kmalloc(64, GFP_KERNEL));
}

static void nothing(void)
{
}

/* Does lockdep notice @fn inside the fence? As in its own self-test. */
static bool noticed(void (*fn)(void))
{
	struct seen v = { 0 };

	debug_locks_silent = 1;
	oops_in_progress++;	/* might_sleep() reports it to the console otherwise */
	enter(&v, true);
	fn();
	leave(&v, true);
	lockdep_reset();
	oops_in_progress--;
	debug_locks_silent = 0;
	return v.lockdep;
}

/* Control: what lockdep must notice inside the fence, it notices. */
static void rt_control_lockdep(struct kunit *test)
{
	KUNIT_ASSERT_TRUE(test, debug_locks);
	KUNIT_EXPECT_FALSE(test, noticed(nothing));
	KUNIT_EXPECT_TRUE(test, noticed(take_mutex));
	KUNIT_EXPECT_TRUE(test, noticed(take_rt_mutex));
	KUNIT_EXPECT_TRUE(test, noticed(take_semaphore));
	KUNIT_EXPECT_TRUE(test, noticed(allocate));
	KUNIT_EXPECT_TRUE(test, debug_locks);
	count_lines();
}
#endif

static struct kunit_case cases[] = {
	KUNIT_CASE(rt_receive_send),
	KUNIT_CASE(rt_commands),
	KUNIT_CASE(rt_thread),
	KUNIT_CASE(rt_control),
#ifdef CONFIG_PROVE_LOCKING
	KUNIT_CASE(rt_control_lockdep),
#endif
	{ }
};

static struct kunit_suite suite = { .name = "bus_rt", .exit = rt_exit, .test_cases = cases };
kunit_test_suite(suite);
