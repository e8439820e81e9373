// SPDX-License-Identifier: GPL-2.0-only
/* Commands for hot connect groups. */
#include <linux/nospec.h>
#include "../config/config.h"
#include "../config/group.h"
#include "../session/session.h"
#include "../session/session_attach.h"
#include "../session/session_groups.h"
#include "ioctl.h"
#include "master.h"

static int group_failed(struct ec_call *call, const struct ec_ioc_group *i, int ret)
{
	switch (ret) {
	case -EEXIST:
		return ec_refuse(call, ret,
				 "group %s: another group has this name, alias, identification or port",
				 i->name);
	case -ENOSPC:
		return ec_refuse(call, ret, "limit of %u groups reached", EC_MAX_GROUPS);
	case -EINVAL:
		return ec_refuse(call, ret,
				 "group '%s': it needs a name (a letter, then letters, digits, _ - .) and an alias, an identification, or a configuration with a port (1 to 3)",
				 i->name);
	default:
		return ec_ioc_limit(call, ret);
	}
}

int ec_ioc_group(struct ec_call *call)
{
	struct ec_ioc_group *i = call->arg;
	struct ec_group *g;

	if (!memchr(i->name, 0, sizeof(i->name)))
		return ec_refuse(call, -EINVAL, "the name of a group has at most %zu bytes",
				 sizeof(i->name) - 1);
	g = ec_group_create(&call->session->wanted, i);
	if (IS_ERR(g))
		return group_failed(call, i, PTR_ERR(g));
	i->index = g->index;
	ec_session_attach_all(call->session);
	return 0;
}

static int member_failed(struct ec_call *call, const struct ec_ioc_group_config *i,
			 const struct ec_group *g, int ret)
{
	switch (ret) {
	case -EINVAL:
		return ec_refuse(call, ret, "group %s has %u members: configure member %u next",
				 g->name, g->n_members, g->n_members);
	case -ENOENT:
		return ec_refuse(call, ret,
				 "member %s is configured as 0x%08x/0x%08x already, not as 0x%08x/0x%08x",
				 g->members[i->member]->name, g->members[i->member]->vendor,
				 g->members[i->member]->product, i->vendor_id, i->product_code);
	case -ENOSPC:
		return ec_refuse(call, ret, "limit of %u slave configurations reached",
				 EC_MAX_CONFIGS);
	default:
		return ec_ioc_limit(call, ret);
	}
}

/* @i: below the number of groups */
static struct ec_group *group_at(const struct ec_session *s, u32 i)
{
	return s->wanted.groups[array_index_nospec(i, s->wanted.n_groups)];
}

static int add_member(struct ec_call *call, struct ec_ioc_group_config *i)
{
	struct ec_session *s = call->session;
	struct ec_config *c;
	struct ec_group *g;

	if (i->group >= s->wanted.n_groups)
		return ec_refuse(call, -ENOENT, "there is no group %u", i->group);
	g = group_at(s, i->group);
	if (s->wanted.active && i->member >= g->n_members)
		return ec_refuse(call, -EBUSY,
				 "member %u of group %s has no configuration and the master is active; configure before ecrt_master_activate()",
				 i->member, g->name);
	c = ec_session_configure_member(s, g, i->member, i->vendor_id, i->product_code);
	if (IS_ERR(c))
		return member_failed(call, i, g, PTR_ERR(c));
	i->index = c->index;
	return 0;
}

int ec_ioc_group_config(struct ec_call *call)
{
	struct ec_ioc_group_config *i = call->arg;
	struct ec_master *m = call->master;
	struct ec_slave *slave = NULL;
	int ret = ec_ioc_lock_session(call);

	if (ret)
		return ret;
	if (!call->session->wanted.active && call->session != m->sessions.candidate &&
	    i->group < call->session->wanted.n_groups)
		slave = ec_session_find_member(call->session, group_at(call->session, i->group),
					       i->member);
	ret = ec_ioc_wait_pdos(call, slave);
	if (ret)
		return ret;
	ret = add_member(call, i);
	ec_sessions_unlock(&m->sessions);
	return ret;
}

int ec_ioc_config_group(struct ec_call *call)
{
	struct ec_ioc_config_group *i = call->arg;
	const struct ec_group *g = call->config->group;

	if (!g)
		return ec_refuse(call, -ENOENT, "configuration %s is not in a hot connect group",
				 call->config->name);
	i->group = g->index;
	i->by = g->by;
	i->value = g->value;
	i->port = g->port;
	i->mandatory = g->mandatory;
	i->at = g->at ? g->at->index : EC_UAPI_NONE32;
	i->members = g->n_members;
	i->position = g->position;
	i->cause = g->cause;
	strscpy(i->name, g->name, sizeof(i->name));
	strscpy(i->why, g->why, sizeof(i->why));
	return 0;
}
