// SPDX-License-Identifier: GPL-2.0-only
/* Priority and CPU of the thread that runs the cycle. */
#include <linux/cpumask.h>
#include <linux/err.h>
#include <linux/sched.h>
#include <uapi/linux/sched/types.h>
#include "cycle.h"
#include "cycle_thread.h"

/**
 * ec_cycle_sched_set() - give a thread the priority of the cycle
 * @c: cycle
 * @task: its cycle thread
 *
 * Context: Process. May sleep.
 */
void ec_cycle_sched_set(const struct ec_cycle *c, struct task_struct *task)
{
	const struct sched_attr attr = {
		.size = sizeof(attr), .sched_policy = c->priority ? SCHED_FIFO : SCHED_NORMAL,
		.sched_priority = c->priority,
	};
	int ret = sched_setattr_nocheck(task, &attr);

	if (ret)
		ec_warn(c, "kernel cycle: cannot set SCHED_FIFO priority %u (%pe)\n",
			c->priority, ERR_PTR(ret));
}

/**
 * ec_cycle_sched_log() - log which part of the priority is not permitted
 * @c: cycle with a thread
 *
 * The application does not learn from a successful activation what it lacks.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_sched_log(const struct ec_cycle *c)
{
	u32 wanted = c->kernel.priority ?: EC_CYCLE_PRIORITY;

	lockdep_assert_held(c->wanted->lock);
	if (!c->priority)
		ec_warn(c,
			"cycle thread runs SCHED_OTHER: SCHED_FIFO %u needs CAP_SYS_NICE or RLIMIT_RTPRIO %u of the application (/etc/security/limits.d)\n",
			wanted, wanted);
	else if (c->priority < wanted)
		ec_warn(c,
			"cycle thread runs SCHED_FIFO %u: %u exceeds RLIMIT_RTPRIO of the application (/etc/security/limits.d)\n",
			c->priority, wanted);
}

/**
 * ec_cycle_sched_log_place() - log where the cycle runs, when it shall run in an interrupt
 * @c: active cycle
 *
 * Each place once: a cycle that is too long now and then does not fill the log.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_sched_log_place(struct ec_cycle *c)
{
	static const char *const why[] = {
		[EC_CYCLE_PLACE_RIGHT] = "EC_CYCLE_INTERRUPT needs CAP_SYS_NICE or RLIMIT_RTPRIO 99 of the application (/etc/security/limits.d)",
		[EC_CYCLE_PLACE_DEVICE] = "a device needs it; use native devices only, see 'ethercat device'",
		[EC_CYCLE_PLACE_LONG] = "a cycle took more than half of its period in the interrupt; set a longer period",
	};
	u32 place = READ_ONCE(c->place);

	lockdep_assert_held(c->wanted->lock);
	if (c->places_logged & BIT(place))
		return;
	c->places_logged |= BIT(place);
	if (place == EC_CYCLE_PLACE_INTERRUPT)
		ec_info(c, "kernel cycle runs in the interrupt of its timer\n");
	else if (place < ARRAY_SIZE(why) && why[place])
		ec_warn(c, "kernel cycle runs in its thread: %s\n", why[place]);
}

/**
 * ec_cycle_thread_inherit() - the cycle gets the rights of its new owner
 * @c: active cycle, taken over; without a thread nothing happens
 * @priority: SCHED_FIFO priority that the new application may use; 0: SCHED_OTHER
 * @may_interrupt: it may have the cycle run in an interrupt
 *
 * Otherwise a cycle would keep a right that its owner does not have, or lack one.
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_inherit(struct ec_cycle *c, u32 priority, bool may_interrupt)
{
	struct task_struct *task = ec_cycle_thread_task(c);

	lockdep_assert_held(c->wanted->lock);
	if (task && c->may_interrupt != may_interrupt) {
		WRITE_ONCE(c->may_interrupt, may_interrupt);
		c->places_logged = 0;
	}
	if (!task || c->priority == priority)
		return;
	c->priority = priority;
	ec_cycle_sched_set(c, task);
	if (priority == (c->kernel.priority ?: EC_CYCLE_PRIORITY))
		ec_info(c, "cycle thread runs SCHED_FIFO %u, as the new application permits\n",
			priority);
	else
		ec_cycle_sched_log(c);
}

/**
 * ec_cycle_thread_check_cpu() - keep the cycle thread on its CPU
 * @c: active cycle
 *
 * When that CPU goes offline the kernel lets the thread run on all others, for
 * ever. Once it is online again the thread returns to it.
 *
 * Context: The monitor thread, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_check_cpu(struct ec_cycle *c)
{
	int cpu = c->kernel.cpu;
	struct task_struct *task = ec_cycle_thread_task(c);

	lockdep_assert_held(c->wanted->lock);
	if (!task || cpu < 0)
		return;
	if (cpumask_equal(task->cpus_ptr, cpumask_of(cpu)))
		return;
	if (!c->cpu_lost) {
		c->cpu_lost = true;
		c->cpu_losses++;
		ec_warn(c,
			"CPU %d of the cycle thread went offline: the thread runs on any CPU until CPU %d is online again\n",
			cpu, cpu);
	}
	/* on its way down a CPU is still online */
	if (cpu_active(cpu) && !set_cpus_allowed_ptr(task, cpumask_of(cpu))) {
		c->cpu_lost = false;
		ec_info(c, "cycle thread runs on CPU %d again\n", cpu);
	}
}
