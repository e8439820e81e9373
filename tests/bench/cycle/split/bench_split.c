// SPDX-License-Identifier: GPL-2.0-only
/*
 * What the CPU executes, split by task, for tests/bench/cycle. Under -icount an instruction
 * takes a nanosecond while idle time passes at once, so work is the time that
 * has passed less that in which the CPU halts. It is looked at whenever the scheduler switches. An
 * interrupt counts for the task it comes in; what is executed in the idle task before the CPU
 * halts for the task before, what is executed then, where most interrupts come, for the task that
 * runs next: the one that was woken. The kernel's idle time also has the way to the halt and back
 * in it, which are instructions as others; "idling" says how many of all these are. Between the
 * tracepoint and the halt, and between the interrupt and the end of the idle time, they are missed.
 *
 * A task that never sleeps and has no priority is interrupted all the time. What wakes another
 * one then counts for that one, with the switch to it, and the clock tick for "timer". That
 * needs more looks, which themselves cost a little: only on request.
 *
 * Work that the driver e1000e has put off is "e1000e", and not that of the thread which does it.
 *
 * Parameters: clear (written: all are 0; "spin": the second way), tasks (lines "NAME ns", the
 * last one "idling ns", until now; the first way from now on).
 */
#include <linux/cpumask.h>
#include <linux/interrupt.h>
#include <linux/math64.h>
#include <linux/module.h>
#include <linux/sched.h>
#include <linux/string.h>
#include <linux/tick.h>
#include <linux/timekeeping.h>
#include <linux/tracepoint.h>
#include <linux/workqueue.h>
#include <trace/events/power.h>

#define TASKS	64	/* those of a cycle are some ten */

static struct task_work {
	const void *who;
	char name[TASK_COMM_LEN];
	u64 ns;
} tasks[TASKS];
static unsigned int n_tasks;
static u64 last_ns;	/* end of the last look */
static u64 idle_us;	/* the kernel's idle time until then */
static u64 idling_us;	/* of it the CPU did not halt */
static u64 woken_ns;	/* executed in the idle task after its first halt */
static bool halts;	/* between the tracepoints around a halt */
static const struct task_struct *before;	/* the idle task, until its first halt */

static bool spins;
static const struct task_struct *woken;	/* by the interrupt of the timer */

static struct task_work *find(const void *who, const char *name)
{
	struct task_work *t;

	for (t = tasks; t < tasks + n_tasks; t++)
		if (t->who == who)
			return t;
	if (n_tasks == TASKS)
		return &tasks[TASKS - 1];
	n_tasks++;
	t->who = who;
	t->ns = 0;
	strscpy(t->name, name, sizeof(t->name));
	return t;
}

/* @task NULL: the interrupt of the timer */
static struct task_work *find_task(const struct task_struct *task)
{
	/* get_task_comm() may sleep on PREEMPT_RT */
	return find(task, task ? task->comm : "timer");
}

/* with interrupts off; executed since the last look. The work of this call counts for no thread */
static u64 executed(void)
{
	u64 work = ktime_get_mono_fast_ns() - last_ns, idle;

	if (is_idle_task(current)) {
		idle = get_cpu_idle_time_us(0, NULL);
		if (halts)
			work -= (idle - idle_us) * NSEC_PER_USEC;
		else
			idling_us += idle - idle_us;
		idle_us = idle;
	}
	return work;
}

static void charge_to(struct task_work *t)
{
	t->ns += executed() + woken_ns;
	woken_ns = 0;
	last_ns = ktime_get_mono_fast_ns();
}

static void charge(const struct task_struct *to)
{
	charge_to(find_task(to));
}

/* The idle task lets the CPU halt, or has. */
static void on_idle(void *data, unsigned int state, unsigned int cpu)
{
	u64 work = executed();

	if (before)
		find_task(before)->ns += work;
	else
		woken_ns += work;
	before = NULL;
	halts = state != PWR_EVENT_EXIT;
	last_ns = ktime_get_mono_fast_ns();
}

static void on_switch(void *data, bool preempt, struct task_struct *prev,
		      struct task_struct *next, unsigned int prev_state)
{
	bool displaced = spins && preempt && prev->policy == SCHED_NORMAL;

	charge(displaced || is_idle_task(prev) ? next : prev);
	before = is_idle_task(next) ? prev : NULL;
}

/* the rest that is put off counts for its thread */
static void on_work(void *data, struct work_struct *work)
{
	local_irq_disable();
	charge(current);
	local_irq_enable();
}

static void on_work_done(void *data, struct work_struct *work, work_func_t function)
{
	char name[64];

	snprintf(name, sizeof(name), "%ps", function);
	local_irq_disable();
	if (strstr(name, "[e1000e]"))
		charge_to(find(tasks, "e1000e"));
	else
		charge(current);
	local_irq_enable();
}

static void look_at_current(void)
{
	if (!is_idle_task(current))
		charge(current);
}

static void on_timer(void *data, int vector)
{
	look_at_current();
	woken = NULL;
}

static void on_wake(void *data, struct task_struct *task)
{
	woken = task;
}

static void on_timer_done(void *data, int vector)
{
	if (!is_idle_task(current))
		charge(woken);
}

static void on_interrupt(void *data, int irq, struct irqaction *action)
{
	look_at_current();
}

static struct probe {
	const char *name;
	void *call;
	struct tracepoint *at;
} probes[] = {
	{ "sched_switch", on_switch },
	{ "cpu_idle", on_idle },
	{ "workqueue_execute_start", on_work },
	{ "workqueue_execute_end", on_work_done },
	{ "sched_waking", on_wake },
	{ "irq_handler_entry", on_interrupt },
	{ "local_timer_entry", on_timer },
	{ "local_timer_exit", on_timer_done },
};

static void look(struct tracepoint *tp, void *data)
{
	struct probe *p;

	for (p = probes; p < probes + ARRAY_SIZE(probes); p++)
		if (!strcmp(tp->name, p->name))
			p->at = tp;
}

#define ALWAYS	4	/* the first ones */

static unsigned int watched;	/* probes that are registered */

static int watch_until(unsigned int n)
{
	int ret = 0;

	while (watched < n && !ret) {
		struct probe *p = &probes[watched];

		ret = p->at ? tracepoint_probe_register(p->at, p->call, NULL) : -ENOENT;
		watched += !ret;
	}
	while (watched > n) {
		watched--;
		tracepoint_probe_unregister(probes[watched].at, probes[watched].call, NULL);
	}
	spins = watched == ARRAY_SIZE(probes);
	return ret;
}

static int clear(const char *value, const struct kernel_param *kp)
{
	int ret = watch_until(sysfs_streq(value, "spin") ? ARRAY_SIZE(probes) : ALWAYS);

	local_irq_disable();
	n_tasks = 0;
	idling_us = 0;
	woken_ns = 0;
	idle_us = get_cpu_idle_time_us(0, NULL);
	last_ns = ktime_get_mono_fast_ns();
	local_irq_enable();
	return ret;
}

static int get_tasks(char *buffer, const struct kernel_param *kp)
{
	const struct task_work *t;
	int n = 0;

	local_irq_disable();
	charge(current);
	local_irq_enable();
	watch_until(ALWAYS);
	for (t = tasks; t < tasks + n_tasks; t++)
		n += scnprintf(buffer + n, PAGE_SIZE - n, "%s %llu\n", t->name, t->ns);
	return n + scnprintf(buffer + n, PAGE_SIZE - n, "idling %llu\n",
			     idling_us * NSEC_PER_USEC);
}

static const struct kernel_param_ops clear_ops = { .set = clear };
static const struct kernel_param_ops tasks_ops = { .get = get_tasks };

module_param_cb(clear, &clear_ops, NULL, 0200);
module_param_cb(tasks, &tasks_ops, NULL, 0400);

static void split_exit(void)
{
	watch_until(0);
	tracepoint_synchronize_unregister();
}

static int __init split_init(void)
{
	for_each_kernel_tracepoint(look, NULL);
	if (num_possible_cpus() == 1 && !watch_until(ALWAYS))
		return 0;
	pr_err("bench_split: needs its tracepoints and one CPU\n");
	return -EINVAL;
}

module_init(split_init);
module_exit(split_exit);
MODULE_DESCRIPTION("What the CPU executes, split by task");
MODULE_LICENSE("GPL");
