// SPDX-License-Identifier: GPL-2.0-only
/* Commands for the network devices of slaves with EoE. */
#include <linux/capability.h>
#include "../bus/slave.h"
#include "../eoe/netdevs.h"
#include "ioctl.h"
#include "master.h"

int ec_ioc_eoe(struct ec_call *call)
{
	struct ec_ioc_eoe *i = call->arg;
	u32 index = i->index;

	return ec_eoe_show(&call->master->eoe, i) ?
	       ec_refuse(call, -ENOENT, "master %u has no network device %u for EoE",
			 call->master->base->index, index) : 0;
}

int ec_ioc_eoe_wish(struct ec_call *call)
{
	struct ec_ioc_eoe_wish *i = call->arg;
	const struct ec_slave *s = call->slave;

	/* as for other network devices of the host */
	if (!capable(CAP_NET_ADMIN))
		return ec_refuse(call, -EPERM,
				 "network devices are made and removed by root only (CAP_NET_ADMIN)");
	if (i->wish > EC_EOE_WISH_OFF)
		return ec_refuse(call, -EINVAL, "wish %u: 0 to %u", i->wish, EC_EOE_WISH_OFF);
	if (i->wish == EC_EOE_WISH_ON &&
	    (!ec_mbox_present(&s->mbox) || !(s->info.protocols & EC_SII_PROTO_EOE)))
		return ec_refuse(call, -EPROTONOSUPPORT, "slave %u has no EoE", s->position);
	return ec_ioc_limit(call, ec_eoe_wish(&call->master->eoe, s->device, i->wish));
}
