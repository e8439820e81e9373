// SPDX-License-Identifier: GPL-2.0-only
/* A session that its application leaves to the master, and commands that set its outputs. */
#include "../session/detached.h"
#include "ioctl.h"
#include "master.h"

int ec_ioc_detach(struct ec_call *call)
{
	int ret = ec_detached_begin(call->session);

	switch (ret) {
	case 0:
		return 0;
	case -EINVAL:
		return ec_refuse(call, ret,
				 "the kernel runs no cycle of this application; call ecrt_master_set_cycle() and activate before it is detached");
	case -EDOM:
		return ec_refuse(call, -EINVAL,
				 "an output stall, or a sync unit with a lease, authority or a policy, would replace outputs that are set; use stall_cycles 0 and only units without these");
	case -EBUSY:
		return ec_refuse(call, ret,
				 "a process still has memory of the session mapped; unmap it first");
	default:
		return ec_refuse(call, ret, "the session cannot be detached (%pe)", ERR_PTR(ret));
	}
}

static int output_failed(struct ec_call *call, const struct ec_ioc_output *i, int ret)
{
	switch (ret) {
	case -EPERM:
		return ec_refuse(call, ret,
				 "the outputs of master %u are those of an application, which alone sets them; only a bus that 'ethercat run' runs has outputs to set",
				 call->master->base->index);
	case -EINVAL:
		return ec_refuse(call, ret,
				 "value 0x%llx in %u bits for %u ms: use 1 to 64 bits, a value that fits, and either a lease of 1 to %u ms or none",
				 i->value, i->bits, i->lease_ms, EC_OUTPUT_LEASE_MAX_MS);
	case -ENOENT:
		return ec_refuse(call, ret,
				 "%u bits from bit %u of domain %u on are not outputs of this slave, or the slave is disconnected",
				 i->bits, i->bit, i->domain);
	case -EEXIST:
		return ec_refuse(call, ret,
				 "a copy of the application writes some of these bits in each cycle");
	case -EBUSY:
		return ec_refuse(call, ret,
				 "some of these bits are set with a lease, together with others; wait for its end, or set exactly the same bits");
	case -ENOSPC:
		return ec_refuse(call, ret, "too many outputs are set with a lease; use no lease");
	default:
		return ret;
	}
}

int ec_ioc_output(struct ec_call *call)
{
	struct ec_sessions *ss = &call->master->sessions;
	int ret = -ENODATA;

	/* nothing that readers show changes, so the mutex alone is enough */
	mutex_lock(&ss->lock);
	if (ss->session && ss->session->wanted.active)
		ret = ec_detached_set(ss->session, call->arg);
	mutex_unlock(&ss->lock);
	if (ret == -ENODATA)
		return ec_refuse(call, -EINVAL,
				 "master %u is not active: it has no outputs; begin with 'ethercat run'",
				 call->master->base->index);
	return ret ? output_failed(call, call->arg, ret) : 0;
}
