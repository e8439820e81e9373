// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application whose cycle the kernel runs. */
#include <linux/cpumask.h>
#include "cycle_thread.h"
#include "ioctl.h"
#include "master.h"
#include "session.h"

#define PERIOD_MIN_NS	10000
#define PERIOD_MAX_NS	((u32)NSEC_PER_SEC)
#define PRIORITY_MAX	98	/* above are the kernel's own */
#define DC_FLAGS	(EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | \
			 EC_SEND_FLAG_MONITOR | EC_SEND_FLAG_REF_TIME | EC_CYCLE_DC_FOLLOW)

static int check_cycle(struct ec_file *f, const struct ec_ioc_cycle *i)
{
	if (!i->period_ns)
		return 0;
	if (i->period_ns < PERIOD_MIN_NS || i->period_ns > PERIOD_MAX_NS)
		return ec_refuse(f, -EINVAL, "a period of %u ns; use %u to %u", i->period_ns,
				 PERIOD_MIN_NS, PERIOD_MAX_NS);
	if (i->phase_ns >= i->period_ns)
		return ec_refuse(f, -EINVAL, "a phase of %u ns must be less than the period, %u",
				 i->phase_ns, i->period_ns);
	if (i->priority > PRIORITY_MAX)
		return ec_refuse(f, -EINVAL, "a priority of %u; use 1 to %u, or 0 for 50",
				 i->priority, PRIORITY_MAX);
	if (i->cpu < -1 || i->cpu >= (int)nr_cpu_ids)
		return ec_refuse(f, -EINVAL, "there is no CPU %d; use 0 to %u, or -1 for any",
				 i->cpu, nr_cpu_ids - 1);
	if (i->stall > EC_STALL_STOP)
		return ec_refuse(f, -EINVAL, "unknown stall policy %u; use 0 to %u", i->stall,
				 EC_STALL_STOP);
	if (i->dc & ~DC_FLAGS)
		return ec_refuse(f, -EOPNOTSUPP, "unknown clock flags 0x%x; use 0x%x or less of it",
				 i->dc, DC_FLAGS);
	if (i->dc & EC_CYCLE_DC_FOLLOW && !(i->dc & EC_SEND_FLAG_SYNC_SLAVES))
		return ec_refuse(f, -EINVAL, "the cycle cannot follow a reference clock it never reads; add the flag that tells the slaves its time");
	if (i->dc & EC_CYCLE_DC_FOLLOW && i->dc & EC_SEND_FLAG_SYNC_REF)
		return ec_refuse(f, -EINVAL, "the cycle cannot follow the reference clock while that follows the cycle; use one of both");
	return 0;
}

int ec_ioc_cycle(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	struct ec_ioc_cycle *i = arg;
	int ret = check_cycle(f, i);

	if (ret)
		return ret;
	mutex_lock(&m->session_lock);
	if (!m->session || m->session->owner != f)
		ret = -EPERM;
	else if (m->session->active)
		ret = -EBUSY;
	else
		m->session->kernel = *i;
	mutex_unlock(&m->session_lock);
	if (ret == -EPERM)
		ec_refuse(f, ret, "reserve the master first (ecrt_request_master)");
	else if (ret)
		ec_refuse(f, ret, "the master is active; choose who runs the cycle before ecrt_master_activate()");
	return ret;
}

int ec_ioc_wait(struct ec_file *f, void *arg)
{
	struct ec_master *m = f->master;
	struct ec_ioc_wait *i = arg;
	bool ours;
	u32 run;

	mutex_lock(&m->cyclic_lock);
	ours = m->active && m->active->owner == f && m->active->thread;
	run = READ_ONCE(m->kernel_run);
	mutex_unlock(&m->cyclic_lock);
	if (!ours)
		return ec_refuse(f, -EPERM, "the kernel runs no cycle of this application; call ecrt_master_set_cycle() before activation");
	return ec_cycle_thread_wait(m, run, &i->cycle, i->timeout_us);
}
