// SPDX-License-Identifier: GPL-2.0-only
/* Commands for sync units. */
#include <linux/nospec.h>
#include "../cycle/units.h"
#include "../cycle/units_hold.h"
#include "../config/domain.h"
#include "../config/unit.h"
#include "../session/session.h"
#include "../session/session_units.h"
#include "ioctl.h"
#include "master.h"

int ec_ioc_unit(struct ec_call *call)
{
	struct ec_ioc_unit *i = call->arg;
	struct ec_unit *u;
	int ret;

	if (!memchr(i->name, 0, sizeof(i->name)))
		return ec_refuse(call, -EINVAL, "the name of a unit has at most %zu bytes",
				 sizeof(i->name) - 1);
	u = ec_unit_create(&call->session->wanted, i);
	ret = PTR_ERR_OR_ZERO(u);
	switch (ret) {
	case 0:
		i->index = u->what.index;
		return 0;
	case -EEXIST:
		return ec_refuse(call, ret, "unit %s exists, and is another one", i->name);
	case -ENOSPC:
		return ec_refuse(call, ret, "limit of %u units reached", EC_MAX_DOMAINS);
	case -EINVAL:
		return ec_refuse(call, ret,
				 "unit '%s': it needs a name (a letter, then letters, digits, _ - .), a policy 0 to %u, a limit of at most %u, and 1 to %u frames",
				 i->name, EC_UNIT_POLICY_STOP, EC_MAX_UNIT_LIMIT, EC_UNIT_REPEATS);
	default:
		return ec_ioc_limit(call, ret);
	}
}

int ec_ioc_domain_unit(struct ec_call *call)
{
	struct ec_ioc_domain_unit *i = call->arg;
	int ret = ec_unit_add(&call->session->wanted, call->domain, i->unit);

	return ret ? ec_refuse(call, ret, "there are %u units, no %u",
			       call->session->wanted.n_units, i->unit) : 0;
}

int ec_ioc_unit_info(struct ec_call *call)
{
	const struct ec_wanted *w = &call->session->wanted;
	const struct ec_cyc_units *us = call->session->cycle.units;
	struct ec_ioc_unit_info *i = call->arg;
	const struct ec_unit *u;

	if (i->index >= w->n_units)
		return ec_refuse(call, -ENOENT, "there are %u units, no %u", w->n_units, i->index);
	i->index = array_index_nospec(i->index, w->n_units);
	u = w->units[i->index];
	*i = (struct ec_ioc_unit_info){
		.flags = u->what.flags, .index = i->index, .policy = u->what.policy,
		.limit = u->what.limit, .lease_cycles = u->what.lease_cycles,
		.repeats = u->what.repeats, .domains = u->domains,
	};
	memcpy(i->name, u->what.name, sizeof(i->name));
	if (w->active && us) {
		i->active = 1;
		i->state = ec_units_state(&us->unit[i->index]);
	}
	return 0;
}

/*
 * The running session, locked, or NULL without. Nothing that is shown changes, so the mutex alone
 * is enough: a holder of a unit that comes in each cycle does not disturb readers.
 */
static struct ec_session *lock_active(struct ec_call *call)
{
	struct ec_sessions *ss = &call->master->sessions;

	mutex_lock(&ss->lock);
	if (ss->session && ss->session->wanted.active)
		return ss->session;
	mutex_unlock(&ss->lock);
	return NULL;
}

static int inactive(struct ec_call *call)
{
	return ec_refuse(call, -EINVAL, "no application has activated master %u",
			 call->master->base->index);
}

/* May the caller give authority? To take it is open to all that may write. */
static int may_give(struct ec_call *call, const struct ec_session *s, u32 unit)
{
	const struct ec_cyc_unit *u = &s->cycle.units->unit[unit];

	lockdep_assert_held(s->wanted.lock);
	if (u->holder == call->file)
		return 0;
	if (u->holder)
		return ec_refuse(call, -EBUSY, "another application holds unit %s", u->what.name);
	if (s->cycle.owner == call->file)
		return 0;
	return ec_refuse(call, -EPERM,
			 "only the application that has activated the master, or that holds unit %s, gives authority to it; others take it",
			 u->what.name);
}

static int authority(struct ec_call *call, struct ec_session *s, u32 unit, bool give)
{
	int ret;

	if (unit >= s->wanted.n_units)
		return ec_refuse(call, -ENOENT, "there are %u units, no %u", s->wanted.n_units,
				 unit);
	unit = array_index_nospec(unit, s->wanted.n_units);
	if (!give) {
		ec_units_take(&s->cycle, unit);
		return 0;
	}
	ret = may_give(call, s, unit);
	if (ret)
		return ret;
	ret = ec_units_give(&s->cycle, unit);
	return ret ? ec_refuse(call, ret,
			       "unit %s is not complete: a slave is not in OP or a working counter is incomplete; try again, and see 'ethercat why'",
			       s->wanted.units[unit]->what.name) : 0;
}

int ec_ioc_unit_authority(struct ec_call *call)
{
	struct ec_ioc_unit_authority *i = call->arg;
	struct ec_session *s;
	int ret;

	if (i->authority > 1)
		return ec_refuse(call, -EINVAL, "authority: 0 or 1, not %u", i->authority);
	s = lock_active(call);
	if (!s)
		return inactive(call);
	ret = authority(call, s, i->unit, i->authority);
	mutex_unlock(&call->master->sessions.lock);
	return ret;
}

static int hold_unit(struct ec_call *call, struct ec_session *s, struct ec_ioc_unit_hold *i)
{
	int unit = ec_session_find_unit(s, i->name), ret;

	if (unit < 0)
		return ec_refuse(call, unit, "there is no unit %s", i->name);
	if (i->flags & EC_UNIT_HOLD_END) {
		ret = ec_units_leave(&s->cycle, unit, call->file);
		return ret ? ec_refuse(call, -EPERM, "this application does not hold unit %s",
				       i->name) : 0;
	}
	if (s->cycle.owner == call->file)
		return ec_refuse(call, -EPERM,
				 "the application that has activated the master has its units anyway");
	ret = ec_units_hold(&s->cycle, unit, call->file);
	if (ret == -EACCES)
		return ec_refuse(call, ret,
				 "unit %s is not offered; its application has to set EC_UNIT_OFFERED",
				 i->name);
	if (ret)
		return ec_refuse(call, ret,
				 "another application holds unit %s, or has given it authority",
				 i->name);
	call->file->holds = true;
	i->index = unit;
	i->size = s->cycle.units->unit[unit].bytes;
	return 0;
}

int ec_ioc_unit_hold(struct ec_call *call)
{
	struct ec_ioc_unit_hold *i = call->arg;
	struct ec_session *s;
	int ret;

	if (!memchr(i->name, 0, sizeof(i->name)))
		return ec_refuse(call, -EINVAL, "the name of a unit has at most %zu bytes",
				 sizeof(i->name) - 1);
	s = lock_active(call);
	if (!s)
		return inactive(call);
	ret = hold_unit(call, s, i);
	mutex_unlock(&call->master->sessions.lock);
	return ret;
}

/* The unit that the caller holds; the session is locked then. Or ERR_PTR, and it is not. */
static struct ec_cyc_unit *lock_held(struct ec_call *call, u32 unit, u32 size)
{
	struct ec_session *s = lock_active(call);
	struct ec_cyc_unit *u;
	int ret;

	if (!s)
		return ERR_PTR(inactive(call));
	u = unit < s->wanted.n_units ?
	    &s->cycle.units->unit[array_index_nospec(unit, s->wanted.n_units)] : NULL;
	if (u && u->holder == call->file && size == u->bytes)
		return u;
	if (!u || u->holder != call->file)
		ret = ec_refuse(call, -EPERM,
				"this application does not hold unit %u; call ecrt_master_unit_hold()",
				unit);
	else
		ret = ec_refuse(call, -EINVAL, "unit %s has %u bytes, not %u", u->what.name,
				u->bytes, size);
	mutex_unlock(&call->master->sessions.lock);
	return ERR_PTR(ret);
}

int ec_ioc_unit_write(struct ec_call *call)
{
	struct ec_ioc_unit_data *i = call->arg;
	struct ec_cyc_unit *u = lock_held(call, i->unit, i->size);

	if (IS_ERR(u))
		return PTR_ERR(u);
	ec_units_write(&call->master->sessions.session->cycle, u->what.index, call->data);
	i->state = ec_units_state(u);
	mutex_unlock(&call->master->sessions.lock);
	return 0;
}

int ec_ioc_unit_read(struct ec_call *call)
{
	struct ec_ioc_unit_data *i = call->arg;
	struct ec_cyc_unit *u = lock_held(call, i->unit, i->size);
	struct ec_session *s;
	u8 *to = call->data;

	if (IS_ERR(u))
		return PTR_ERR(u);
	s = call->master->sessions.session;
	ec_for_each_domain(d, &s->wanted) {
		if (!(u->domains >> d->index & 1))
			continue;
		memcpy(to, ec_session_domain_data(d), d->size);
		ec_units_show(&s->cycle, d, to, 0, d->size);
		to += d->size;
	}
	i->state = ec_units_state(u);
	mutex_unlock(&call->master->sessions.lock);
	return 0;
}
