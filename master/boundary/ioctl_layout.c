// SPDX-License-Identifier: GPL-2.0-only
/* Commands of the application that say how its process data are sent. */
#include "../config/config.h"
#include "../cycle/domain.h"
#include "ioctl.h"
#include "../master.h"
#include "../session/session.h"

#define LATE_MAX	100000	/* a second */

int ec_ioc_sc_overlap(struct ec_file *f, void *arg)
{
	struct ec_ioc_sc_overlap *i = arg;
	struct ec_config *c;
	int ret = 0;

	if (i->overlap > 1)
		return ec_refuse(f, -EINVAL, "overlapping process data: 0 or 1, not %u",
				 i->overlap);
	c = ec_ioc_lock_config(f, i->config, &ret);
	if (!c)
		return ret;
	c->overlap = i->overlap;
	ec_session_unlock(f->master);
	return 0;
}

int ec_ioc_domain_options(struct ec_file *f, void *arg)
{
	static const u32 both = EC_DOMAIN_OPT_OVERLAP | EC_DOMAIN_OPT_SEPARATE;
	struct ec_ioc_domain_options *i = arg;
	struct ec_session *s;
	int ret = 0;

	if (i->options & ~EC_DOMAIN_OPT_ALL)
		return ec_refuse(f, -EOPNOTSUPP, "unknown domain options 0x%x; known are 0x%x",
				 i->options, EC_DOMAIN_OPT_ALL);
	if ((i->options & both) == both)
		return ec_refuse(f, -EINVAL, "LRD and LWR share logical addresses anyway; choose overlap (LRW) or separate (LRD and LWR)");
	s = ec_ioc_lock_idle(f, &ret);
	if (!s)
		return ret;
	if (i->domain < s->n_domains)
		s->domains[i->domain]->options = i->options;
	else
		ret = ec_refuse(f, -ENOENT, "there is no domain %u", i->domain);
	ec_session_unlock(f->master);
	return ret;
}

int ec_ioc_domain_age(struct ec_file *f, void *arg)
{
	struct ec_ioc_domain_age *i = arg;
	struct ec_session *s;
	int ret = 0;

	s = ec_ioc_lock_idle(f, &ret);
	if (!s)
		return ret;
	if (i->domain < s->n_domains)
		s->domains[i->domain]->max_age = i->max_age;
	else
		ret = ec_refuse(f, -ENOENT, "there is no domain %u", i->domain);
	ec_session_unlock(f->master);
	return ret;
}

int ec_ioc_late(struct ec_file *f, void *arg)
{
	struct ec_ioc_late *i = arg;
	struct ec_session *s;
	int ret = 0;

	if (i->per_s > LATE_MAX)
		return ec_refuse(f, -EINVAL, "%u delayed cycles per second; use 0 to %u", i->per_s,
				 LATE_MAX);
	s = ec_ioc_lock_idle(f, &ret);
	if (!s)
		return ret;
	s->late_per_s = i->per_s;
	ec_session_unlock(f->master);
	return 0;
}
