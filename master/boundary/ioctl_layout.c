// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application that say how its process data are sent. */
#include "../config/config.h"
#include "../config/domain.h"
#include "ioctl.h"
#include "../session/session.h"

#define LATE_MAX	100000	/* delayed cycles a second */

int ec_ioc_sc_overlap(struct ec_call *call)
{
	struct ec_ioc_sc_overlap *i = call->arg;

	if (i->overlap > 1)
		return ec_refuse(call, -EINVAL, "overlapping process data: 0 or 1, not %u",
				 i->overlap);
	call->config->overlap = i->overlap;
	return 0;
}

int ec_ioc_domain_options(struct ec_call *call)
{
	static const u32 both = EC_DOMAIN_OPT_OVERLAP | EC_DOMAIN_OPT_SEPARATE;
	struct ec_ioc_domain_options *i = call->arg;

	if (i->options & ~EC_DOMAIN_OPT_ALL)
		return ec_refuse(call, -EOPNOTSUPP, "unknown domain options 0x%x; known are 0x%x",
				 i->options, EC_DOMAIN_OPT_ALL);
	if ((i->options & both) == both)
		return ec_refuse(call, -EINVAL,
				 "LRD and LWR share logical addresses anyway; choose overlap (LRW) or separate (LRD and LWR)");
	call->domain->options = i->options;
	return 0;
}

int ec_ioc_domain_age(struct ec_call *call)
{
	struct ec_ioc_domain_age *i = call->arg;

	call->domain->max_age = i->max_age;
	return 0;
}

int ec_ioc_late(struct ec_call *call)
{
	struct ec_ioc_late *i = call->arg;

	if (i->per_s > LATE_MAX)
		return ec_refuse(call, -EINVAL, "%u delayed cycles per second; use 0 to %u",
				 i->per_s,
				 LATE_MAX);
	call->session->cycle.setup.late_per_s = i->per_s;
	return 0;
}
