// SPDX-License-Identifier: GPL-2.0-only
/* Priority and CPU of the thread that runs the cycle. */
#include <linux/cpumask.h>
#include <linux/err.h>
#include <linux/sched.h>
#include <uapi/linux/sched/types.h>
#include "cycle_run.h"
#include "cycle_sched.h"

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
		.size = sizeof(attr), .sched_policy = c->setup.priority ? SCHED_FIFO : SCHED_NORMAL,
		.sched_priority = c->setup.priority,
	};
	int ret = sched_setattr_nocheck(task, &attr);

	if (ret)
		ec_warn(c, "kernel cycle: cannot set SCHED_FIFO priority %u (%pe)\n",
			c->setup.priority, ERR_PTR(ret));
}

/**
 * ec_cycle_sched_log() - log which part of the priority is not permitted
 * @c: cycle with a thread
 *
 * The activation succeeds, so it does not report which right is missing.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_sched_log(const struct ec_cycle *c)
{
	u32 wanted = c->setup.kernel.priority ?: EC_CYCLE_PRIORITY;

	lockdep_assert_held(c->wanted->lock);
	if (!c->setup.priority)
		ec_warn(c,
			"cycle thread runs SCHED_OTHER: SCHED_FIFO %u needs CAP_SYS_NICE or RLIMIT_RTPRIO %u of the application (/etc/security/limits.d)\n",
			wanted, wanted);
	else if (c->setup.priority < wanted)
		ec_warn(c,
			"cycle thread runs SCHED_FIFO %u: %u exceeds RLIMIT_RTPRIO of the application (/etc/security/limits.d)\n",
			c->setup.priority, wanted);
}

#define NO_RIGHT \
	"EC_CYCLE_INTERRUPT needs CAP_SYS_NICE or RLIMIT_RTPRIO 99 of the application (/etc/security/limits.d)"

/**
 * ec_cycle_sched_log_place() - log where cycles have run that may run in an interrupt
 * @c: active cycle
 *
 * Each place once: a cycle that is too long now and then does not fill the log.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_cycle_sched_log_place(struct ec_cycle *c)
{
	static const char *const why[] = {
		[EC_CYCLE_PLACE_RIGHT] = NO_RIGHT,
		[EC_CYCLE_PLACE_DEVICE] = "the device needs it; use a native device, see 'ethercat devices'",
		[EC_CYCLE_PLACE_LONG] = "the interrupt left too little time to other threads of its CPU; set a longer period",
		[EC_CYCLE_PLACE_DEBUG] = "debug level 2 prints frames",
	};
	u32 fresh = READ_ONCE(c->places) & ~c->watch.places_logged;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	c->watch.places_logged |= fresh;
	if (fresh & BIT(EC_CYCLE_PLACE_INTERRUPT))
		ec_info(c, "kernel cycle runs in the interrupt of its timer\n");
	for (i = 0; i < ARRAY_SIZE(why); i++)
		if (fresh & BIT(i) && why[i])
			ec_warn(c, "kernel cycle runs in its thread: %s\n", why[i]);
}

/* Log the change by a takeover. */
static void log_right(const struct ec_cycle *c)
{
	if (!(c->setup.kernel.flags & EC_CYCLE_FLAG_INTERRUPT))
		return;
	if (c->setup.may_interrupt)
		ec_info(c, "kernel cycle runs in the interrupt of its timer, as the new application permits\n");
	else
		ec_warn(c, "kernel cycle runs in its thread: %s\n", NO_RIGHT);
}

/**
 * ec_cycle_thread_inherit() - the cycle gets the rights of its new owner
 * @c: active cycle, taken over; without a thread nothing happens
 * @priority: SCHED_FIFO priority that the new application may use; 0: SCHED_OTHER
 * @may_interrupt: it may have the cycle run in an interrupt
 *
 * Otherwise a cycle would keep a right that its new owner does not have, or lack one that it has.
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_inherit(struct ec_cycle *c, u32 priority, bool may_interrupt)
{
	struct task_struct *task = ec_cycle_thread_task(c);

	lockdep_assert_held(c->wanted->lock);
	if (task && c->setup.may_interrupt != may_interrupt) {
		WRITE_ONCE(c->setup.may_interrupt, may_interrupt);
		/* else the monitor repeats it */
		c->watch.places_logged |= BIT(EC_CYCLE_PLACE_RIGHT) | BIT(EC_CYCLE_PLACE_INTERRUPT);
		log_right(c);
	}
	if (!task || c->setup.priority == priority)
		return;
	c->setup.priority = priority;
	ec_cycle_sched_set(c, task);
	if (priority == (c->setup.kernel.priority ?: EC_CYCLE_PRIORITY))
		ec_info(c, "cycle thread runs SCHED_FIFO %u, as the new application permits\n",
			priority);
	else
		ec_cycle_sched_log(c);
}

/**
 * ec_cycle_thread_check_cpu() - keep the cycle thread on its CPU
 * @c: active cycle
 *
 * When that CPU goes offline the kernel lets the thread run on all others, and does
 * not move it again. This function moves it to its CPU once that is online again.
 *
 * Context: The monitor thread, lock of the configuration held. May sleep.
 */
void ec_cycle_thread_check_cpu(struct ec_cycle *c)
{
	int cpu = c->setup.kernel.cpu;
	struct task_struct *task = ec_cycle_thread_task(c);

	lockdep_assert_held(c->wanted->lock);
	if (!task || cpu < 0)
		return;
	if (cpumask_equal(task->cpus_ptr, cpumask_of(cpu)))
		return;
	if (!c->watch.cpu_lost) {
		c->watch.cpu_lost = true;
		c->watch.cpu_losses++;
		ec_warn(c,
			"CPU %d of the cycle thread went offline: the thread runs on any CPU until CPU %d is online again\n",
			cpu, cpu);
	}
	/* a CPU that goes offline is still online for a while, but not active */
	if (cpu_active(cpu) && !set_cpus_allowed_ptr(task, cpumask_of(cpu))) {
		c->watch.cpu_lost = false;
		ec_info(c, "cycle thread runs on CPU %d again\n", cpu);
	}
}
