// SPDX-License-Identifier: GPL-2.0-only
/*
 * Sync units in the cycle: each is judged by the working counters of its own domains, and what is
 * done about it stays within these. Their outputs are replaced in a second image, so neither the
 * application nor the rest of the cycle is involved. Nothing here allocates, prints or waits.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/workqueue.h>
#include "../config/domain.h"
#include "cycle.h"
#include "units_hold.h"
#include "units_run.h"

/* why the outputs of a unit are other ones now; argument of EC_EVENT_UNIT */
enum reason {
	BY_COUNTER, BY_LEASE, BY_COMMAND, BY_STOP,
};

/* Image with the outputs that were sent last. */
static const u8 *last_sent(const struct ec_cycle *c, unsigned int domain)
{
	return c->direct ?: c->domains[domain].image;
}

/* Replace the outputs of @domains: by zero, or by what was sent last. */
static void replace(struct ec_cycle *c, u64 domains, bool zero)
{
	struct ec_cyc_units *us = c->units;
	u64 left;

	for (left = zero ? domains : domains & ~us->replaced; left; left &= left - 1) {
		unsigned int d = __ffs64(left), i;
		const struct ec_unit_place *p = &us->places[d];
		const u8 *from = last_sent(c, d);

		for (i = 0; i < p->outputs; i++) {
			const struct ec_unit_area *a = &p->areas[i];

			if (zero)
				memset(us->image + a->offset, 0, a->len);
			else
				memcpy(us->image + a->offset, from + a->offset, a->len);
		}
	}
	WRITE_ONCE(us->replaced, us->replaced | domains);
}

static u8 stronger(u8 a, u8 b)
{
	return a == EC_UNIT_SENDS_ZERO || b == EC_UNIT_SENDS_ZERO ? EC_UNIT_SENDS_ZERO :
	       a | b;
}

/* What is sent for a unit now? */
static u8 outputs_of(const struct ec_cyc_units *us, const struct ec_cyc_unit *u)
{
	u8 sends = EC_UNIT_SENDS_VALUES;

	if (us->stopped)
		return EC_UNIT_SENDS_ZERO;
	if (!u->authority)
		sends = u->without;
	if (u->run == EC_UNIT_RUN_FAILED && u->what.policy != EC_UNIT_POLICY_CONTINUE)
		sends = stronger(sends, u->what.policy == EC_UNIT_POLICY_HOLD ?
				 EC_UNIT_SENDS_HELD : EC_UNIT_SENDS_ZERO);
	if (u->ended)
		sends = stronger(sends, u->what.flags & EC_UNIT_FLAG_LEASE_HOLD ?
				 EC_UNIT_SENDS_HELD : EC_UNIT_SENDS_ZERO);
	return sends;
}

/* A change is an event; of many in a second the first and the last. */
static noinline void tell(struct ec_cycle *c, struct ec_cyc_unit *u, enum reason why)
{
	u32 state = ec_units_state(u) & 0xffff, wkc = 0, expected = 0, bad = EC_EVENT_NONE;
	u64 left;

	if (!ec_events_admit(&u->rate, ktime_get_ns()))
		return;
	/* the first domain that is not complete */
	for (left = u->domains; left; left &= left - 1) {
		unsigned int d = __ffs64(left);
		const struct ec_status_domain *st = &c->shared->status->domains[d];

		if (READ_ONCE(st->wc_state) == EC_STATUS_WC_COMPLETE)
			continue;
		bad = d;
		wkc = READ_ONCE(st->working_counter);
		expected = READ_ONCE(c->domains[d].expected);
		break;
	}
	ec_event(c->base, EC_EVENT_UNIT, u->what.index, state, why, bad, wkc, expected,
		 u->rate.more - 1, u->told);
	u->told = state;
	u->rate.more = 0;
}

/* Let the outputs follow the state of the unit, and tell what has changed. */
static void settle(struct ec_cycle *c, struct ec_cyc_unit *u, u32 before, enum reason why)
{
	struct ec_cyc_units *us = c->units;
	u8 sends = outputs_of(us, u);

	/* also when a holder has left meanwhile */
	if (sends == EC_UNIT_SENDS_VALUES && !READ_ONCE(u->held))
		WRITE_ONCE(us->replaced, us->replaced & ~u->domains);
	else if (sends != u->sends && sends != EC_UNIT_SENDS_VALUES)
		replace(c, u->domains, sends == EC_UNIT_SENDS_ZERO);
	WRITE_ONCE(u->sends, sends);
	if ((ec_units_state(u) ^ before) & 0xffff)
		u->rate.more++;
	if (u->rate.more)
		tell(c, u, why);
	WRITE_ONCE(c->shared->status->units[u->what.index], ec_units_state(u));
}

/* A policy without return by itself, or a unit that needs authority again. */
static void lose_authority(struct ec_cyc_unit *u, u8 without)
{
	u->without = without;
	WRITE_ONCE(u->authority, false);
}

/* Everything stops: domains of no unit as well. */
static void stop_all(struct ec_cycle *c, const struct ec_cyc_unit *by)
{
	struct ec_cyc_units *us = c->units;
	unsigned int i;

	if (us->stopped)
		return;
	WRITE_ONCE(us->stopped, by->what.index + 1);
	WRITE_ONCE(us->down, true);
	replace(c, us->used, true);
	for (i = 0; i < us->n; i++) {
		struct ec_cyc_unit *u = &us->unit[i];
		u32 before = ec_units_state(u);

		lose_authority(u, EC_UNIT_SENDS_ZERO);
		if (u != by)
			settle(c, u, before, BY_STOP);
	}
}

/* The stop ends when its unit gets authority: those that began with it get it as well. */
static void resume_all(struct ec_cycle *c, const struct ec_cyc_unit *by)
{
	struct ec_cyc_units *us = c->units;
	unsigned int i;

	WRITE_ONCE(us->stopped, 0);
	us->replaced = 0;
	for (i = 0; i < us->n; i++) {
		struct ec_cyc_unit *u = &us->unit[i];
		u32 before = ec_units_state(u);

		if (!(u->what.flags & EC_UNIT_FLAG_AUTHORITY))
			WRITE_ONCE(u->authority, true);
		if (u->sends != EC_UNIT_SENDS_VALUES)
			us->replaced |= u->domains;
		if (u != by)
			settle(c, u, before, BY_COMMAND);
	}
}

static void fail(struct ec_cycle *c, struct ec_cyc_unit *u)
{
	struct ec_cyc_units *us = c->units;

	WRITE_ONCE(u->run, EC_UNIT_RUN_FAILED);
	/* its slaves were taken down: no failure of its own */
	if (us->stopped)
		return;
	WRITE_ONCE(u->faults, u->faults + 1);
	switch (u->what.policy) {
	case EC_UNIT_POLICY_CONTINUE:
		return;
	case EC_UNIT_POLICY_STOP:
		stop_all(c, u);
		break;
	case EC_UNIT_POLICY_SAFEOP:
		WRITE_ONCE(u->down, true);
		lose_authority(u, EC_UNIT_SENDS_ZERO);
		break;
	default:
		if (u->what.flags & EC_UNIT_FLAG_AUTHORITY)
			lose_authority(u, u->what.policy == EC_UNIT_POLICY_HOLD ?
				       EC_UNIT_SENDS_HELD : EC_UNIT_SENDS_ZERO);
		return;
	}
	queue_work(us->queue, us->alarm);
}

static bool unit_is_complete(const struct ec_cycle *c, const struct ec_cyc_unit *u)
{
	u64 left;

	if (!READ_ONCE(u->op))
		return false;
	for (left = u->domains; left; left &= left - 1) {
		unsigned int d = __ffs64(left);

		/* expected none: all its slaves are of groups that may be absent */
		if (READ_ONCE(c->domains[d].expected) &&
		    READ_ONCE(c->shared->status->domains[d].wc_state) != EC_STATUS_WC_COMPLETE)
			return false;
	}
	return true;
}

static void judge(struct ec_cycle *c, struct ec_cyc_unit *u)
{
	bool complete = unit_is_complete(c, u);

	if (complete == (u->run == EC_UNIT_RUN_COMPLETE)) {
		u->same = 0;
		return;
	}
	if (u->run == EC_UNIT_RUN_STARTING) {
		if (complete)
			WRITE_ONCE(u->run, EC_UNIT_RUN_COMPLETE);
		return;
	}
	if (++u->same < u->what.limit)
		return;
	u->same = 0;
	if (complete)
		WRITE_ONCE(u->run, EC_UNIT_RUN_COMPLETE);
	else
		fail(c, u);
}

/* A command since the last receive. */
static void obey(struct ec_cycle *c, struct ec_cyc_unit *u, u32 wish)
{
	if (wish == EC_UNIT_TAKE) {
		lose_authority(u, EC_UNIT_SENDS_ZERO);
		return;
	}
	/* it may have failed since the command */
	if (u->run != EC_UNIT_RUN_COMPLETE)
		return;
	WRITE_ONCE(u->authority, true);
	if (c->units->stopped == u->what.index + 1)
		resume_all(c, u);
}

/**
 * ec_units_judge() - judge the units after the domains
 * @c: active cycle with units
 * @judged: domains that were sent or received since the last receive
 *
 * Context: The cycle owner, in receive. RT-safe: bounded by units and domains; when the outputs of
 * a unit change by their bytes as well.
 */
void ec_units_judge(struct ec_cycle *c, u64 judged)
{
	unsigned int i;

	for (i = 0; i < c->units->n; i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];
		u32 before, wish = READ_ONCE(u->wish) ? xchg(&u->wish, 0) : 0;

		if (!wish && !(judged & u->domains))
			continue;
		before = ec_units_state(u);
		if (judged & u->domains)
			judge(c, u);
		if (wish)
			obey(c, u, wish);
		settle(c, u, before, wish ? BY_COMMAND : BY_COUNTER);
	}
}

/**
 * ec_units_fill() - take the last inputs for domains whose outputs are replaced
 * @c: active cycle with units
 * @queued: domains that are sent
 *
 * As the part of a missing slave returns as it was sent, its last inputs are sent.
 *
 * Context: The cycle owner, in send. RT-safe: bounded by the inputs.
 */
void ec_units_fill(struct ec_cycle *c, u64 queued)
{
	struct ec_cyc_units *us = c->units;
	u64 left;

	if (READ_ONCE(us->holders))
		ec_units_take_held(c);
	for (left = us->replaced & queued; left; left &= left - 1) {
		unsigned int d = __ffs64(left), i;
		const struct ec_unit_place *p = &us->places[d];
		const u8 *from = c->domains[d].image;

		for (i = p->outputs; i < p->outputs + p->inputs; i++)
			memcpy(us->image + p->areas[i].offset, from + p->areas[i].offset,
			       p->areas[i].len);
	}
}

/**
 * ec_units_fed() - the application has given outputs
 * @us: units
 * @domains: of these, bit n: domain n
 *
 * Context: The thread of the cycle. RT-safe.
 */
void ec_units_fed(struct ec_cyc_units *us, u64 domains)
{
	unsigned int i;

	for (i = 0; i < us->n; i++) {
		struct ec_cyc_unit *u = &us->unit[i];

		/* what the session gives for a unit that another application holds is not sent */
		if (READ_ONCE(u->held))
			continue;
		u->fed |= domains & u->feeds;
		if (!u->feeds || u->fed != u->feeds)
			continue;
		u->fed = 0;
		u->unfed = 0;
		u->leased = true;
	}
}

/**
 * ec_units_lease() - one more cycle: leases end
 * @c: active cycle with units, whose outputs for this cycle are chosen
 *
 * Context: The thread of the cycle. RT-safe.
 */
void ec_units_lease(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->units->n; i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];
		u32 before = ec_units_state(u);
		bool ended;

		if (!u->what.lease_cycles || !u->leased)
			continue;
		ended = u->unfed >= u->what.lease_cycles;
		u->unfed += !ended;
		if (ended == u->ended)
			continue;
		WRITE_ONCE(u->ended, ended);
		if (ended) {
			WRITE_ONCE(u->faults, u->faults + 1);
			if (u->what.flags & EC_UNIT_FLAG_AUTHORITY)
				lose_authority(u, u->what.flags & EC_UNIT_FLAG_LEASE_HOLD ?
					       EC_UNIT_SENDS_HELD : EC_UNIT_SENDS_ZERO);
		}
		settle(c, u, before, BY_LEASE);
	}
}
