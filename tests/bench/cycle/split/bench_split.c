// SPDX-License-Identifier: GPL-2.0-only
/*
 * What the CPU executes, split by task, for tests/bench/cycle. Under -icount an instruction
 * takes a nanosecond while idle time passes at once, so work is the time that
 * has passed less the idle time. It is looked at whenever the scheduler switches. An
 * interrupt counts for the task it comes in; what is executed in the idle task, where most
 * interrupts come, for the task that runs next: the one that was woken.
 *
 * Parameters: clear (written: all are 0), tasks (lines "NAME ns", until now).
 */
#include <linux/cpumask.h>
#include <linux/math64.h>
#include <linux/module.h>
#include <linux/sched.h>
#include <linux/string.h>
#include <linux/tick.h>
#include <linux/timekeeping.h>
#include <linux/tracepoint.h>

#define TASKS	64	/* those of a cycle are some ten */

static struct task_work {
	const struct task_struct *task;
	char name[TASK_COMM_LEN];
	u64 ns;
} tasks[TASKS];
static unsigned int n_tasks;
static u64 last_ns;	/* end of the last look */
static u64 idle_us;	/* idle time until then */
static struct tracepoint *switches;

static struct task_work *find(struct task_struct *task)
{
	struct task_work *t;

	for (t = tasks; t < tasks + n_tasks; t++)
		if (t->task == task)
			return t;
	if (n_tasks == TASKS)
		return &tasks[TASKS - 1];
	n_tasks++;
	t->task = task;
	t->ns = 0;
	/* get_task_comm() may sleep on PREEMPT_RT */
	strscpy(t->name, task->comm, sizeof(t->name));
	return t;
}

/* with interrupts off; the work of this call counts for no thread */
static void charge(struct task_struct *prev, struct task_struct *next)
{
	u64 work = ktime_get_mono_fast_ns() - last_ns;

	if (is_idle_task(prev)) {
		u64 idle = get_cpu_idle_time_us(0, NULL);

		work -= (idle - idle_us) * NSEC_PER_USEC;
		idle_us = idle;
	}
	find(is_idle_task(prev) ? next : prev)->ns += work;
	last_ns = ktime_get_mono_fast_ns();
}

static void on_switch(void *data, bool preempt, struct task_struct *prev,
		      struct task_struct *next, unsigned int prev_state)
{
	charge(prev, next);
}

static int clear(const char *value, const struct kernel_param *kp)
{
	local_irq_disable();
	n_tasks = 0;
	idle_us = get_cpu_idle_time_us(0, NULL);
	last_ns = ktime_get_mono_fast_ns();
	local_irq_enable();
	return 0;
}

static int get_tasks(char *buffer, const struct kernel_param *kp)
{
	const struct task_work *t;
	int n = 0;

	local_irq_disable();
	charge(current, current);
	local_irq_enable();
	for (t = tasks; t < tasks + n_tasks; t++)
		n += scnprintf(buffer + n, PAGE_SIZE - n, "%s %llu\n", t->name, t->ns);
	return n;
}

static const struct kernel_param_ops clear_ops = { .set = clear };
static const struct kernel_param_ops tasks_ops = { .get = get_tasks };

module_param_cb(clear, &clear_ops, NULL, 0200);
module_param_cb(tasks, &tasks_ops, NULL, 0400);

static void look(struct tracepoint *tp, void *data)
{
	if (!strcmp(tp->name, "sched_switch"))
		switches = tp;
}

static int __init split_init(void)
{
	for_each_kernel_tracepoint(look, NULL);
	if (!switches || num_possible_cpus() != 1) {
		pr_err("bench_split: needs the tracepoint sched_switch and one CPU\n");
		return -EINVAL;
	}
	return tracepoint_probe_register(switches, on_switch, NULL);
}

static void __exit split_exit(void)
{
	tracepoint_probe_unregister(switches, on_switch, NULL);
	tracepoint_synchronize_unregister();
}

module_init(split_init);
module_exit(split_exit);
MODULE_DESCRIPTION("What the CPU executes, split by task");
MODULE_LICENSE("GPL");
