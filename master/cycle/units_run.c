// SPDX-License-Identifier: GPL-2.0-only
/*
 * Sync units in the cycle: each is judged by the working counters of its own domains, and what is
 * done about it stays within these. Their outputs are replaced in a second image, so neither the
 * application nor the rest of the cycle is involved. Nothing here allocates, prints or waits.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/workqueue.h>
#include "../base/once64.h"
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
static void replace_outputs(struct ec_cycle *c, u64 domains, bool zero)
{
	struct ec_cyc_units *us = c->units;
	u64 left;

	for (left = zero ? domains : domains & ~us->replaced; left; left &= left - 1) {
		unsigned int d = __ffs64(left), i;
		const struct ec_unit_place *p = &us->places[d];
		const u8 *from = last_sent(c, d);

		for (i = 0; i < p->outputs; i++) {
			const struct ec_domain_area *a = &p->areas[i];

			if (zero)
				memset(us->image + a->offset, 0, a->len);
			else
				memcpy(us->image + a->offset, from + a->offset, a->len);
		}
	}
	ec_write64(&us->replaced, us->replaced | domains);
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
static noinline void report_unit(struct ec_cycle *c, struct ec_cyc_unit *u, enum reason why)
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
		 u->rate.more - 1, u->reported);
	u->reported = state;
	u->rate.more = 0;
}

/* Let the outputs follow the state of the unit, and report what has changed. */
static void settle_unit(struct ec_cycle *c, struct ec_cyc_unit *u, u32 before, enum reason why)
{
	struct ec_cyc_units *us = c->units;
	u8 sends = outputs_of(us, u);

	/* those of a holder are replaced as well */
	if (sends == EC_UNIT_SENDS_VALUES && !u->held)
		ec_write64(&us->replaced, us->replaced & ~u->domains);
	else if (sends == EC_UNIT_SENDS_VALUES)
		ec_write64(&us->replaced, us->replaced | u->domains);
	else if (sends != u->sends)
		replace_outputs(c, u->domains, sends == EC_UNIT_SENDS_ZERO);
	WRITE_ONCE(u->sends, sends);
	if ((ec_units_state(u) ^ before) & 0xffff)
		u->rate.more++;
	if (u->rate.more)
		report_unit(c, u, why);
	if (u->rate.more)
		us->calm = false;
	WRITE_ONCE(c->shared->status->units[u->what.index], ec_units_state(u));
}

static void lose_authority(struct ec_cyc_unit *u, u8 without)
{
	u->without = without;
	WRITE_ONCE(u->authority, false);
}

/* All units, because one has stopped all, or does not any more. */
static void settle_others(struct ec_cycle *c, const struct ec_cyc_unit *by, enum reason why)
{
	unsigned int i;

	for (i = 0; i < c->units->n; i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];

		if (u != by)
			settle_unit(c, u, ec_units_state(u), why);
	}
}

/* Everything stops: domains of no unit as well. What other units have is not changed. */
static void stop_all(struct ec_cycle *c, const struct ec_cyc_unit *by)
{
	WRITE_ONCE(c->units->stopped, by->what.index + 1);
	replace_outputs(c, c->units->used, true);
	settle_others(c, by, BY_STOP);
}

/* The policy of a unit that has failed. */
static void punish(struct ec_cycle *c, struct ec_cyc_unit *u)
{
	WRITE_ONCE(u->faults, u->faults + 1);
	switch (u->what.policy) {
	case EC_UNIT_POLICY_CONTINUE:
		return;
	case EC_UNIT_POLICY_STOP:
	case EC_UNIT_POLICY_SAFEOP:
		WRITE_ONCE(u->down, true);
		lose_authority(u, EC_UNIT_SENDS_ZERO);
		if (u->what.policy == EC_UNIT_POLICY_STOP)
			stop_all(c, u);
		queue_work(c->units->queue, c->units->alarm);
		return;
	default:
		if (u->what.flags & EC_UNIT_FLAG_AUTHORITY)
			lose_authority(u, u->what.policy == EC_UNIT_POLICY_HOLD ?
				       EC_UNIT_SENDS_HELD : EC_UNIT_SENDS_ZERO);
	}
}

/* While all is stopped its slaves are in SAFEOP for that reason; see resume_all(). */
static void unit_fails(struct ec_cycle *c, struct ec_cyc_unit *u)
{
	WRITE_ONCE(u->run, EC_UNIT_RUN_FAILED);
	if (!c->units->stopped)
		punish(c, u);
}

/* Units that are not complete when the stop ends have failed by themselves. */
static void resume_all(struct ec_cycle *c, const struct ec_cyc_unit *by)
{
	struct ec_cyc_units *us = c->units;
	u64 units = 0;
	unsigned int i;

	WRITE_ONCE(us->stopped, 0);
	for (i = 0; i < us->n; i++) {
		struct ec_cyc_unit *u = &us->unit[i];

		units |= u->domains;
		if (u != by && u->run == EC_UNIT_RUN_FAILED)
			punish(c, u);
	}
	ec_write64(&us->replaced, us->replaced & units);
	settle_others(c, by, BY_COMMAND);
}

static bool domain_is_complete(const struct ec_cycle *c, unsigned int d)
{
	/* expected none: all its slaves are of groups that may be absent */
	return !READ_ONCE(c->domains[d].expected) ||
	       READ_ONCE(c->shared->status->domains[d].wc_state) == EC_STATUS_WC_COMPLETE;
}

/* A unit whose slaves are all absent: the next ones that come begin without authority. */
static bool has_nobody(const struct ec_cycle *c, const struct ec_cyc_unit *u)
{
	u64 left;

	for (left = u->domains; left; left &= left - 1)
		if (READ_ONCE(c->domains[__ffs64(left)].expected))
			return false;
	return true;
}

static void judge_unit(struct ec_cycle *c, struct ec_cyc_unit *u, u64 judged)
{
	bool whole = READ_ONCE(u->op), bad;
	u64 left;

	u->off = whole ? 0 : u->off + 1;
	bad = u->off >= u->what.limit;
	for (left = u->domains; left; left &= left - 1) {
		unsigned int d = __ffs64(left);
		bool complete = domain_is_complete(c, d);

		whole &= complete;
		/* a domain that is not exchanged in each cycle counts with its own exchanges */
		if (judged >> d & 1)
			c->units->bad[d] = complete ? 0 : c->units->bad[d] + 1;
		bad |= c->units->bad[d] >= u->what.limit;
	}
	if (u->run == EC_UNIT_RUN_COMPLETE && bad)
		unit_fails(c, u);
	u->same = whole ? u->same + 1 : 0;
	WRITE_ONCE(u->waits, u->run == EC_UNIT_RUN_COMPLETE ? min(u->waits, ~0u - 1) + 1 : 0);
	if (whole && (u->run == EC_UNIT_RUN_STARTING || u->same >= u->what.limit))
		WRITE_ONCE(u->run, EC_UNIT_RUN_COMPLETE);
	if (u->authority && u->what.flags & EC_UNIT_FLAG_AUTHORITY && has_nobody(c, u))
		lose_authority(u, EC_UNIT_SENDS_ZERO);
}

/* The commands for a unit; one that takes authority comes first. */
static void obey(struct ec_cycle *c, struct ec_cyc_unit *u)
{
	u32 wish = atomic_xchg(&u->wish, 0), before = ec_units_state(u);

	if (!wish)
		return;
	if (wish & EC_UNIT_HOLDER) {
		c->units->holders -= u->held;
		WRITE_ONCE(u->held, !!READ_ONCE(u->holder));
		c->units->holders += u->held;
	}
	if (wish & (EC_UNIT_HOLDER | EC_UNIT_TAKE)) {
		lose_authority(u, EC_UNIT_SENDS_ZERO);
	} else if (ec_units_may_have(c->units, u) && !has_nobody(c, u)) {
		/* it may have failed since the command */
		WRITE_ONCE(u->authority, true);
		if (c->units->stopped)
			resume_all(c, u);
	}
	settle_unit(c, u, before, BY_COMMAND);
}

/* Does a receive in which all domains are complete change nothing? */
static bool is_calm(const struct ec_cycle *c)
{
	const struct ec_cyc_units *us = c->units;
	unsigned int i;
	u64 left;

	for (i = 0; i < us->n; i++)
		if (us->unit[i].run != EC_UNIT_RUN_COMPLETE || us->unit[i].off ||
		    us->unit[i].rate.more)
			return false;
	for (left = us->used; left; left &= left - 1)
		if (us->bad[__ffs64(left)])
			return false;
	return !us->stopped;
}

static void obey_all(struct ec_cycle *c)
{
	unsigned int i;

	if (likely(!atomic_read(&c->units->wished)))
		return;
	atomic_xchg(&c->units->wished, 0);
	for (i = 0; i < c->units->n; i++)
		obey(c, &c->units->unit[i]);
}

/**
 * ec_units_judge() - judge the units after the domains
 * @c: active cycle with units
 * @judged: domains that were sent or received since the last receive
 *
 * Not while the application takes its slaves to PREOP.
 *
 * Context: The cycle owner, in receive. RT-safe: bounded by units and domains; when the outputs of
 * a unit change by their bytes as well.
 */
void ec_units_judge(struct ec_cycle *c, u64 judged)
{
	unsigned int i;

	if (READ_ONCE(c->units->looked))
		xchg(&c->units->looked, false);
	for (i = 0; i < c->units->n && !READ_ONCE(c->slaves_down); i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];
		u32 before;

		if (!(judged & u->domains))
			continue;
		before = ec_units_state(u);
		judge_unit(c, u, judged);
		settle_unit(c, u, before, BY_COUNTER);
	}
	obey_all(c);
	c->units->calm = is_calm(c);
}

/**
 * ec_units_outage() - there is no device: units fail
 * @c: active cycle with units
 *
 * Context: The cycle owner, in receive and send. RT-safe, as ec_units_judge().
 */
void ec_units_outage(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->units->n; i++) {
		struct ec_cyc_unit *u = &c->units->unit[i];
		u32 before = ec_units_state(u);

		if (u->run != EC_UNIT_RUN_COMPLETE)
			continue;
		u->same = 0;
		unit_fails(c, u);
		settle_unit(c, u, before, BY_COUNTER);
	}
	obey_all(c);
}

/**
 * ec_units_fill() - take the last inputs for domains whose outputs are replaced
 * @c: active cycle with units
 * @queued: domains that are sent
 *
 * The part of a missing slave returns as sent: its last inputs are sent. Commands since the receive
 * are carried out before.
 *
 * Context: The cycle owner, in send. RT-safe: bounded by the inputs.
 */
void ec_units_fill(struct ec_cycle *c, u64 queued)
{
	struct ec_cyc_units *us = c->units;
	u64 left;

	obey_all(c);
	if (us->holders)
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
		if (u->held)
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
 * @c: active cycle with units, before it takes the outputs for this cycle
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
		settle_unit(c, u, before, BY_LEASE);
	}
}
