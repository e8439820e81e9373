// SPDX-License-Identifier: GPL-2.0-only
/* Priority and CPU of the thread that runs the cycle. */
#include <linux/cpumask.h>
#include <linux/err.h>
#include <linux/sched.h>
#include <uapi/linux/sched/types.h>
#include "cycle_thread.h"
#include "../master.h"
#include "../session/session.h"

/**
 * ec_cycle_sched_set() - give a thread the priority of the cycle
 * @s: session
 * @task: its cycle thread
 *
 * Context: Process. May sleep.
 */
void ec_cycle_sched_set(const struct ec_session *s, struct task_struct *task)
{
	const struct sched_attr attr = {
		.size = sizeof(attr), .sched_policy = s->priority ? SCHED_FIFO : SCHED_NORMAL,
		.sched_priority = s->priority,
	};
	int ret = sched_setattr_nocheck(task, &attr);

	if (ret)
		ec_warn(s->master, "kernel cycle: cannot set SCHED_FIFO priority %u (%pe)\n",
			s->priority, ERR_PTR(ret));
}

/**
 * ec_cycle_sched_log() - log which part of the priority is not permitted
 * @s: session with a thread
 *
 * The application does not learn from a successful activation what it lacks.
 *
 * Context: Process, session_lock held.
 */
void ec_cycle_sched_log(const struct ec_session *s)
{
	u32 wanted = s->kernel.priority ?: EC_CYCLE_PRIORITY;

	if (!s->priority)
		ec_warn(s->master, "cycle thread runs SCHED_OTHER: SCHED_FIFO %u needs CAP_SYS_NICE or RLIMIT_RTPRIO %u of the application (/etc/security/limits.d)\n",
			wanted, wanted);
	else if (s->priority < wanted)
		ec_warn(s->master, "cycle thread runs SCHED_FIFO %u: %u exceeds RLIMIT_RTPRIO of the application (/etc/security/limits.d)\n",
			s->priority, wanted);
}

/**
 * ec_cycle_thread_inherit() - the cycle gets the priority that its new owner may use
 * @s: active session, taken over; without a thread nothing happens
 * @priority: SCHED_FIFO priority that the new application may use; 0: SCHED_OTHER
 *
 * Otherwise a cycle would keep a right that its owner does not have, or lack one.
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_cycle_thread_inherit(struct ec_session *s, u32 priority)
{
	struct task_struct *task = ec_cycle_thread_task(s);

	lockdep_assert_held(&s->master->session_lock);
	if (!task || s->priority == priority)
		return;
	s->priority = priority;
	ec_cycle_sched_set(s, task);
	if (priority == (s->kernel.priority ?: EC_CYCLE_PRIORITY))
		ec_info(s->master, "cycle thread runs SCHED_FIFO %u, as the new application permits\n",
			priority);
	else
		ec_cycle_sched_log(s);
}

/**
 * ec_cycle_thread_check_cpu() - keep the cycle thread on its CPU
 * @s: active session
 *
 * When that CPU goes offline the kernel lets the thread run on all others, for
 * ever. Once it is online again the thread returns to it.
 *
 * Context: The monitor thread, session_lock held. May sleep.
 */
void ec_cycle_thread_check_cpu(struct ec_session *s)
{
	int cpu = s->kernel.cpu;
	struct task_struct *task = ec_cycle_thread_task(s);

	if (!task || cpu < 0)
		return;
	if (cpumask_equal(task->cpus_ptr, cpumask_of(cpu)))
		return;
	if (!s->cpu_lost) {
		s->cpu_lost = true;
		s->cpu_losses++;
		ec_warn(s->master, "CPU %d of the cycle thread went offline: the thread runs on any CPU until CPU %d is online again\n",
			cpu, cpu);
	}
	/* on its way down a CPU is still online */
	if (cpu_active(cpu) && !set_cpus_allowed_ptr(task, cpumask_of(cpu))) {
		s->cpu_lost = false;
		ec_info(s->master, "cycle thread runs on CPU %d again\n", cpu);
	}
}
