// SPDX-License-Identifier: GPL-2.0-only
#include <linux/err.h>
#include <linux/nospec.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "config.h"
#include "domain.h"
#include "group.h"
#include "unit.h"

static bool is_valid(const struct ec_ioc_unit *what)
{
	return !(what->flags & EC_UNIT_FLAG_OFFERED && !(what->flags & EC_UNIT_FLAG_AUTHORITY)) &&
	       ec_group_is_name(what->name) && what->policy <= EC_UNIT_POLICY_STOP &&
	       what->repeats <= EC_UNIT_REPEATS && what->limit <= EC_MAX_UNIT_LIMIT;
}

/**
 * ec_unit_create() - find or make a sync unit
 * @w: what an application configures, not active
 * @what: from the application; its name has a zero at the end
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: unit, or ERR_PTR: -EINVAL no name, unknown policy, beyond a limit; -EEXIST another unit
 * has the name; -ENOSPC beyond EC_MAX_DOMAINS units; -ENOMEM; -EDQUOT as ec_budget_charge().
 */
struct ec_unit *ec_unit_create(struct ec_wanted *w, const struct ec_ioc_unit *what)
{
	struct ec_unit made = { .what = *what }, *u;
	int ret;

	lockdep_assert_held(w->lock);
	if (!is_valid(what))
		return ERR_PTR(-EINVAL);
	made.what.limit = what->limit ?: EC_UNIT_LIMIT;
	made.what.repeats = what->repeats ?: 1;
	ec_for_each_unit(x, w)
		if (!strcmp(x->what.name, what->name)) {
			made.what.index = x->what.index;
			return ec_unit_differs(x, &made) ? ERR_PTR(-EEXIST) : x;
		}
	if (w->n_units >= EC_MAX_DOMAINS)
		return ERR_PTR(-ENOSPC);
	ret = ec_budget_charge(&w->budget, sizeof(*u));
	if (ret)
		return ERR_PTR(ret);
	u = kmalloc(sizeof(*u), GFP_KERNEL_ACCOUNT);
	if (!u) {
		ec_budget_release(&w->budget, sizeof(*u));
		return ERR_PTR(-ENOMEM);
	}
	made.what.index = w->n_units;
	*u = made;
	w->units[w->n_units++] = u;
	return u;
}

/**
 * ec_unit_add() - put a domain into a unit, or out of all
 * @w: what an application configures, not active
 * @d: its domain
 * @unit: index, or EC_UNIT_NONE
 *
 * Context: Process, lock of the session held.
 * Return: 0 or -ENOENT.
 */
int ec_unit_add(struct ec_wanted *w, struct ec_domain *d, u32 unit)
{
	lockdep_assert_held(w->lock);
	if (unit != EC_UNIT_NONE && unit >= w->n_units)
		return -ENOENT;
	ec_for_each_unit(u, w)
		u->domains &= ~BIT_ULL(d->index);
	if (unit != EC_UNIT_NONE)
		w->units[array_index_nospec(unit, w->n_units)]->domains |= BIT_ULL(d->index);
	return 0;
}

static const struct ec_unit *unit_of(const struct ec_wanted *w, const struct ec_domain *d)
{
	ec_for_each_unit(u, w)
		if (u->domains >> d->index & 1)
			return u;
	return NULL;
}

/**
 * ec_unit_repeats() - how often the frames of a domain are sent in a cycle
 * @w: what an application has configured
 * @d: its domain
 *
 * Context: Process, lock of the session held.
 * Return: 1 to EC_UNIT_REPEATS.
 */
u8 ec_unit_repeats(const struct ec_wanted *w, const struct ec_domain *d)
{
	const struct ec_unit *u = unit_of(w, d);

	lockdep_assert_held(w->lock);
	return u ? u->what.repeats : 1;
}

/* A slave in another domain may be in no other unit than in this one. */
static const struct ec_unit *other_unit(const struct ec_config *c, const struct ec_unit *u)
{
	unsigned int i;

	for (i = 0; i < c->n_fmmus; i++) {
		const struct ec_unit *x = unit_of(c->wanted, c->fmmus[i].domain);

		if (x && x != u)
			return x;
	}
	return NULL;
}

static int check_slave(const struct ec_unit *u, const struct ec_config *c, char *why, size_t size)
{
	const struct ec_unit *other = u->what.policy == EC_UNIT_POLICY_SAFEOP ?
				      other_unit(c, u) : NULL;

	if (other) {
		snprintf(why, size,
			 "slave %s has process data in unit %s, which takes its slaves to SAFEOP, and in unit %s; put them into one unit, or let it zero or hold its outputs",
			 c->name, u->what.name, other->what.name);
		return -EXDEV;
	}
	if (u->what.repeats > 1 && !ec_config_flag(c, EC_FLAG_REPEAT)) {
		snprintf(why, size,
			 "unit %s sends its frames %u times, and slave %s does not allow that; if its vendor does, set the flag " EC_FLAG_REPEAT " of its configuration to 1",
			 u->what.name, u->what.repeats, c->name);
		return -EXDEV;
	}
	return 0;
}

static int check_unit(const struct ec_unit *u, const struct ec_wanted *w, bool by_kernel, char *why,
		      size_t size)
{
	unsigned int i;
	int ret;

	if (u->what.lease_cycles && !by_kernel) {
		snprintf(why, size,
			 "unit %s has a lease, and the application runs the cycle; let the kernel run it (ecrt_master_set_cycle), or set no lease",
			 u->what.name);
		return -EOPNOTSUPP;
	}
	ec_for_each_domain(d, w)
		for (i = 0; u->domains >> d->index & 1 && i < d->n_fmmus; i++) {
			ret = check_slave(u, d->fmmus[i].config, why, size);
			if (ret)
				return ret;
		}
	return 0;
}

/**
 * ec_units_check() - may these units be activated?
 * @w: what an application has configured
 * @by_kernel: the kernel runs the cycle
 * @why: result after an error: the reason, with what to do
 * @size: of @why
 *
 * Context: Process, lock of the session held.
 * Return: 0; -EOPNOTSUPP a lease without a cycle of the kernel; -EXDEV a slave does not fit its
 * unit.
 */
int ec_units_check(const struct ec_wanted *w, bool by_kernel, char *why, size_t size)
{
	int ret;

	lockdep_assert_held(w->lock);
	ec_for_each_unit(u, w) {
		ret = check_unit(u, w, by_kernel, why, size);
		if (ret)
			return ret;
	}
	return 0;
}

/**
 * ec_unit_differs() - is one unit another one than it was?
 * @a: unit
 * @b: unit of another session, or a description
 *
 * Context: Process. Both stay unchanged meanwhile.
 * Return: true: they differ in more than their domains.
 */
bool ec_unit_differs(const struct ec_unit *a, const struct ec_unit *b)
{
	const struct ec_ioc_unit *x = &a->what, *y = &b->what;

	return x->flags != y->flags || x->index != y->index || x->policy != y->policy ||
	       x->limit != y->limit || x->lease_cycles != y->lease_cycles ||
	       x->repeats != y->repeats || strcmp(x->name, y->name);
}

/**
 * ec_units_free() - free all units
 * @w: what an application has configured, not active
 *
 * Context: Process, lock of the session held.
 */
void ec_units_free(struct ec_wanted *w)
{
	lockdep_assert_held(w->lock);
	while (w->n_units)
		kfree(w->units[--w->n_units]);
}
