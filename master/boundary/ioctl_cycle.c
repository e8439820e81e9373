// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application whose cycle the kernel runs. */
#include <linux/capability.h>
#include <linux/cpumask.h>
#include <linux/sched/signal.h>
#include "../cycle/cycle_wait.h"
#include "../config/domain.h"
#include "ioctl.h"
#include "master.h"
#include "../session/session.h"

#define PERIOD_MIN_NS	10000
#define PERIOD_MAX_NS	((u32)NSEC_PER_SEC)
#define PRIORITY_MAX	98	/* above are the kernel's own */
#define PRIORITY_ALL	99	/* an interrupt is before all threads */
#define DC_FLAGS	(EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | \
			 EC_SEND_FLAG_MONITOR | EC_SEND_FLAG_REF_TIME | EC_CYCLE_DC_FOLLOW)

static int check_cycle(struct ec_call *call, const struct ec_ioc_cycle *i)
{
	if (!i->period_ns)
		return 0;
	if (i->period_ns < PERIOD_MIN_NS || i->period_ns > PERIOD_MAX_NS)
		return ec_refuse(call, -EINVAL, "a period of %u ns; use %u to %u", i->period_ns,
				 PERIOD_MIN_NS, PERIOD_MAX_NS);
	if (i->phase_ns >= i->period_ns)
		return ec_refuse(call, -EINVAL, "a phase of %u ns must be less than the period, %u",
				 i->phase_ns, i->period_ns);
	if (i->priority > PRIORITY_MAX)
		return ec_refuse(call, -EINVAL, "a priority of %u; use 1 to %u, or 0 for 50",
				 i->priority, PRIORITY_MAX);
	if (i->cpu < -1 || i->cpu >= (int)nr_cpu_ids)
		return ec_refuse(call, -EINVAL, "there is no CPU %d; use 0 to %u, or -1 for any",
				 i->cpu, nr_cpu_ids - 1);
	if (i->stall > EC_STALL_STOP)
		return ec_refuse(call, -EINVAL, "unknown stall policy %u; use 0 to %u", i->stall,
				 EC_STALL_STOP);
	if (i->dc & ~DC_FLAGS)
		return ec_refuse(call, -EOPNOTSUPP,
				 "unknown clock flags 0x%x; use 0x%x or less of it",
				 i->dc, DC_FLAGS);
	if (i->dc & EC_CYCLE_DC_FOLLOW && !(i->dc & EC_SEND_FLAG_SYNC_SLAVES))
		return ec_refuse(call, -EINVAL,
				 "EC_CYCLE_FOLLOW_REFERENCE needs EC_CYCLE_SYNC_SLAVES, which reads the reference clock");
	if (i->dc & EC_CYCLE_DC_FOLLOW && i->dc & EC_SEND_FLAG_SYNC_REF)
		return ec_refuse(call, -EINVAL,
				 "EC_CYCLE_FOLLOW_REFERENCE excludes EC_CYCLE_SYNC_REFERENCE: each would be synchronized to the other");
	if (i->flags & EC_CYCLE_FLAG_DETACH && i->stall == EC_STALL_STOP)
		return ec_refuse(call, -EINVAL,
				 "EC_CYCLE_DETACH excludes EC_CYCLE_STOP; use EC_CYCLE_HOLD or EC_CYCLE_ZERO");
	return 0;
}

/* The priority, up to the limit that sched_setscheduler() has for the caller. */
static u32 permitted(u32 priority)
{
	if (capable(CAP_SYS_NICE))
		return priority;
	return min_t(unsigned long, priority, rlimit(RLIMIT_RTPRIO));
}

int ec_ioc_cycle(struct ec_call *call)
{
	struct ec_ioc_cycle *i = call->arg;
	int ret = check_cycle(call, i);

	if (ret)
		return ret;
	call->session->cycle.setup.kernel = *i;
	call->session->cycle.setup.priority = permitted(i->priority ?: EC_CYCLE_PRIORITY);
	call->session->cycle.setup.may_interrupt = permitted(PRIORITY_ALL) == PRIORITY_ALL;
	return 0;
}

int ec_ioc_division(struct ec_call *call)
{
	struct ec_ioc_division *i = call->arg;

	if (!i->division || i->division > EC_MAX_DIVISION || i->phase >= i->division)
		return ec_refuse(call, -EINVAL,
				 "every %u cycles, phase %u: use 1 to %u, and a phase below that",
				 i->division, i->phase, EC_MAX_DIVISION);
	call->domain->division = i->division;
	call->domain->phase = i->phase;
	return 0;
}

static int copy_failed(struct ec_call *call, const struct ec_ioc_copy *i, int ret)
{
	switch (ret) {
	case -ENOENT:
		return ec_refuse(call, ret, "there is no domain %u or %u", i->from_domain,
				 i->to_domain);
	case -EDOM:
		return ec_refuse(call, -EINVAL,
				 "%u bits from bit %u of domain %u on are not inputs of one slave; register them first",
				 i->bits, i->from_bit, i->from_domain);
	case -ERANGE:
		return ec_refuse(call, -EINVAL,
				 "%u bits from bit %u of domain %u on are not outputs of one slave; register them first",
				 i->bits, i->to_bit, i->to_domain);
	case -EEXIST:
		return ec_refuse(call, ret,
				 "another copy writes to some of these %u bits from bit %u of domain %u on",
				 i->bits, i->to_bit, i->to_domain);
	case -ENOSPC:
		return ec_refuse(call, ret, "at most %u copies", EC_MAX_COPIES);
	default:
		return ret;
	}
}

int ec_ioc_copy(struct ec_call *call)
{
	struct ec_ioc_copy *i = call->arg;
	int ret = ec_copy_add(&call->session->cycle.setup.copies, &call->session->wanted, i);

	return ret ? copy_failed(call, i, ret) : 0;
}

int ec_ioc_wait(struct ec_call *call)
{
	struct ec_cycles *cycles = &call->master->cycles;
	struct ec_ioc_wait *i = call->arg;
	int ret = ec_cycle_thread_wait(cycles, call->file, &call->file->waiters, &i->cycle,
				       i->timeout_us);

	if (ret == -EPERM)
		return ec_refuse(call, ret,
				 "the kernel runs no cycle of this application; call ecrt_master_set_cycle() before activation");
	if (ret == -EBUSY)
		return ec_refuse(call, ret,
				 "%u threads wait for the cycle already; let one of them wake the others",
				 EC_MAX_WAITERS);
	return ret;
}
