// SPDX-License-Identifier: GPL-2.0-only
/* Sync units: made by an activation, and what commands do with them. */
#include <linux/bitops.h>
#include <linux/slab.h>
#include <linux/workqueue.h>
#include "../base/report.h"
#include "../config/domain.h"
#include "../config/group.h"
#include "../config/unit.h"
#include "../config/why.h"
#include "cycle.h"
#include "units.h"
#include "units_hold.h"

DEFINE_STATIC_KEY_FALSE(ec_units_used);

static int make_places(struct ec_cyc_units *us, const struct ec_wanted *w)
{
	struct ec_domain_area *at;
	size_t n = 0;

	ec_for_each_domain(d, w)
		n += d->n_fmmus;
	us->areas = kvcalloc(n ?: 1, sizeof(*us->areas), GFP_KERNEL_ACCOUNT);
	if (!us->areas)
		return -ENOMEM;
	at = us->areas;
	ec_for_each_domain(d, w) {
		struct ec_unit_place *p = &us->places[d->index];

		p->areas = at;
		p->outputs = ec_domain_areas(d, EC_CFG_DIR_OUTPUT, at, 0);
		p->inputs = ec_domain_areas(d, EC_CFG_DIR_INPUT, at + p->outputs, 0);
		at += p->outputs + p->inputs;
		us->used |= BIT_ULL(d->index);
	}
	return 0;
}

/* The unit of each slave; one that takes its slaves to SAFEOP has them alone. */
static int make_configs(struct ec_cyc_units *us, const struct ec_wanted *w)
{
	unsigned int i, k;

	us->of_config = kvmalloc(w->n_configs ?: 1, GFP_KERNEL_ACCOUNT);
	us->seen = kvzalloc(w->n_configs ?: 1, GFP_KERNEL_ACCOUNT);
	if (!us->of_config || !us->seen)
		return -ENOMEM;
	memset(us->of_config, EC_NO_UNIT, w->n_configs);
	for (i = 0; i < us->n; i++)
		ec_for_each_domain(d, w)
			for (k = 0; us->unit[i].domains >> d->index & 1 && k < d->n_fmmus; k++)
				us->of_config[d->fmmus[k].config->index] = i;
	return 0;
}

static void make_unit(struct ec_cyc_units *us, const struct ec_unit *from)
{
	struct ec_cyc_unit *u = &us->unit[us->n++];
	unsigned int i;

	u->what = from->what;
	u->domains = from->domains;
	for (i = 1; i < u->what.repeats; i++)
		us->repeated[i - 1] |= u->domains;
	for (i = 0; i < EC_MAX_DOMAINS; i++)
		if (u->domains >> i & 1 && us->places[i].outputs)
			u->feeds |= BIT_ULL(i);
	u->authority = !(u->what.flags & EC_UNIT_FLAG_AUTHORITY);
	u->sends = u->authority ? EC_UNIT_SENDS_VALUES : EC_UNIT_SENDS_ZERO;
	u->without = EC_UNIT_SENDS_ZERO;
	if (!u->authority)
		us->replaced |= u->domains;
}

/**
 * ec_units_make() - prepare the sync units of an activation
 * @c: cycle with a layout; ec_units_end() frees what @c has then
 * @queue: runs @alarm
 * @alarm: takes slaves to the states that ec_units_keep_down() says
 *
 * Without units nothing is made, and a cycle has no work for them.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_units_make(struct ec_cycle *c, struct workqueue_struct *queue, struct work_struct *alarm)
{
	const struct ec_wanted *w = c->wanted;
	struct ec_cyc_units *us;
	int ret;

	lockdep_assert_held(w->lock);
	if (!w->n_units)
		return 0;
	us = kvzalloc(struct_size(us, unit, w->n_units), GFP_KERNEL_ACCOUNT);
	if (!us)
		return -ENOMEM;
	us->queue = queue;
	us->alarm = alarm;
	us->image = kvzalloc(c->shared->image_size ?: 1, GFP_KERNEL_ACCOUNT);
	ret = us->image ? make_places(us, w) : -ENOMEM;
	if (!ret) {
		ec_for_each_unit(u, w) {
			make_unit(us, u);
			ret = ret ?: ec_units_buffers(&us->unit[us->n - 1], w);
		}
		ret = ret ?: make_configs(us, w);
	}
	/* ec_units_end() takes it back in any case */
	static_branch_inc(&ec_units_used);
	if (ret)
		ec_units_end(us);
	else
		c->units = us;
	return ret;
}

/**
 * ec_units_end() - free the units of a cycle
 * @us: of a cycle that does not run any more, or NULL
 *
 * Context: Process. May sleep.
 */
void ec_units_end(struct ec_cyc_units *us)
{
	unsigned int i;

	if (!us)
		return;
	for (i = 0; i < us->n; i++)
		kvfree(us->unit[i].buffers);
	static_branch_dec(&ec_units_used);
	kvfree(us->image);
	kvfree(us->areas);
	kvfree(us->of_config);
	kvfree(us->seen);
	kvfree(us);
}

/* Let the cycle owner do something. */
static void post_wish(struct ec_cyc_units *us, struct ec_cyc_unit *u, int wish)
{
	atomic_or(wish, &u->wish);
	/* a reader of this finds the wish */
	atomic_set_release(&us->wished, 1);
}

/**
 * ec_units_give() - give authority to a unit
 * @c: active cycle with units
 * @unit: index
 *
 * If its policy has taken slaves to SAFEOP, OP is requested for them.
 *
 * Context: Process, lock of the configuration held.
 * Return: 0: the cycle gives it with its next receive or send; -EINPROGRESS as long as
 * ec_units_may_have() says no, or another command waits for the cycle.
 */
int ec_units_give(struct ec_cycle *c, u32 unit)
{
	struct ec_cyc_units *us = c->units;
	struct ec_cyc_unit *u = &us->unit[unit];

	lockdep_assert_held(c->wanted->lock);
	if (READ_ONCE(u->down)) {
		WRITE_ONCE(u->down, false);
		queue_work(us->queue, us->alarm);
		return -EINPROGRESS;
	}
	if (!ec_units_may_have(us, u) || atomic_read(&u->wish) & ~EC_UNIT_GIVE)
		return -EINPROGRESS;
	post_wish(us, u, EC_UNIT_GIVE);
	return 0;
}

/**
 * ec_units_take() - take authority from a unit
 * @c: active cycle with units
 * @unit: index
 *
 * The outputs of the next send that begins after this are zero.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_units_take(struct ec_cycle *c, u32 unit)
{
	lockdep_assert_held(c->wanted->lock);
	post_wish(c->units, &c->units->unit[unit], EC_UNIT_TAKE);
}

/**
 * ec_units_take_over() - another application gets the session
 * @c: active cycle
 *
 * As at the begin, units that need authority have none.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_units_take_over(struct ec_cycle *c)
{
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; c->units && i < c->units->n; i++)
		if (c->units->unit[i].what.flags & EC_UNIT_FLAG_AUTHORITY)
			ec_units_take(c, i);
}

/**
 * ec_units_hold() - another application gives the outputs of a unit from now on
 * @c: active cycle with units
 * @unit: index
 * @holder: its open file
 *
 * It begins with zeros, and without authority.
 *
 * Context: Process, lock of the configuration held.
 * Return: 0, also for the one that holds it; -EACCES it is not offered; -EBUSY another one holds
 * it, or it has authority.
 */
int ec_units_hold(struct ec_cycle *c, u32 unit, const void *holder)
{
	struct ec_cyc_unit *u = &c->units->unit[unit];

	lockdep_assert_held(c->wanted->lock);
	if (!(u->what.flags & EC_UNIT_FLAG_OFFERED))
		return -EACCES;
	if (u->holder == holder)
		return 0;
	if (u->holder || READ_ONCE(u->authority) || atomic_read(&u->wish) & EC_UNIT_GIVE)
		return -EBUSY;
	ec_units_clear(u);
	WRITE_ONCE(u->holder, holder);
	post_wish(c->units, u, EC_UNIT_HOLDER);
	return 0;
}

/**
 * ec_units_leave() - a file does not hold a unit any more
 * @c: active cycle
 * @unit: index, or EC_UNIT_NONE: all that it holds
 * @holder: open file
 *
 * They lose authority before anything else than the outputs of the holder is sent.
 *
 * Context: Process, lock of the configuration held.
 * Return: 0, or -ENOENT: it holds none.
 */
int ec_units_leave(struct ec_cycle *c, u32 unit, const void *holder)
{
	struct ec_cyc_units *us = c->units;
	int ret = -ENOENT;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; us && i < us->n; i++) {
		struct ec_cyc_unit *u = &us->unit[i];

		if (u->holder != holder || (unit != EC_UNIT_NONE && unit != i))
			continue;
		WRITE_ONCE(u->holder, NULL);
		post_wish(us, u, EC_UNIT_HOLDER);
		ret = 0;
	}
	return ret;
}

/* A slave of a group that may be absent counts once it was in OP, until it is disconnected. */
static bool is_in_op(struct ec_cyc_units *us, const struct ec_config *c)
{
	u8 *seen = &us->seen[c->index];

	if (!c->slave)
		*seen &= ~EC_UNIT_SEEN_OP;
	if (ec_config_status(c) & EC_STATUS_SC_OP) {
		*seen |= EC_UNIT_SEEN_OP;
		return true;
	}
	return ec_group_is_optional(c->group) && !(*seen & EC_UNIT_SEEN_OP);
}

static bool has_all_in_op(struct ec_cyc_units *us, const struct ec_cyc_unit *u,
			  const struct ec_wanted *w)
{
	bool all = true;
	unsigned int i;

	ec_for_each_domain(d, w)
		for (i = 0; u->domains >> d->index & 1 && i < d->n_fmmus; i++)
			all &= is_in_op(us, d->fmmus[i].config);
	return all;
}

/**
 * ec_units_look() - are the slaves of the units in OP?
 * @c: active cycle
 *
 * A slave in SAFEOP counts in working counters as one in OP does.
 *
 * Context: Process, lock of the configuration held.
 */
void ec_units_look(struct ec_cycle *c)
{
	struct ec_cyc_units *us = c->units;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; us && i < us->n; i++) {
		bool op = has_all_in_op(us, &us->unit[i], c->wanted);

		if (op == us->unit[i].op)
			continue;
		WRITE_ONCE(us->unit[i].op, op);
		/* a cycle that sees this finds it */
		smp_store_release(&us->looked, true);
	}
}

/* May the unit take its slaves out of OP now? */
static bool is_down(const struct ec_cyc_units *us, u32 unit)
{
	return unit < us->n && READ_ONCE(us->unit[unit].down);
}

/**
 * ec_units_keep_down() - is a slave to be in SAFEOP?
 * @c: active cycle
 * @config: index of its configuration
 *
 * Context: Process, lock of the configuration held.
 * Return: true: a policy has taken it out of OP.
 */
bool ec_units_keep_down(const struct ec_cycle *c, u32 config)
{
	const struct ec_cyc_units *us = c->units;

	lockdep_assert_held(c->wanted->lock);
	/* EC_NO_UNIT is beyond the last one, as is 0 - 1 */
	return us && (is_down(us, READ_ONCE(us->stopped) - 1) ||
		      is_down(us, us->of_config[config]));
}

/**
 * ec_units_turns() - does a policy want another state of a slave than before?
 * @c: active cycle with units
 * @config: index of its configuration
 *
 * Context: Process, lock of the configuration held.
 * Return: true: once for each change.
 */
bool ec_units_turns(struct ec_cycle *c, u32 config)
{
	bool down = ec_units_keep_down(c, config);
	u8 *seen = &c->units->seen[config];

	lockdep_assert_held(c->wanted->lock);
	if (down == !!(*seen & EC_UNIT_SEEN_DOWN))
		return false;
	*seen ^= EC_UNIT_SEEN_DOWN;
	return true;
}
