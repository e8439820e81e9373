// SPDX-License-Identifier: GPL-2.0-only
/*
 * A cable behind which there are 100 drives is one fact, not 400 records that push the others out
 * of the ring: AL states on request, and that slaves are in OP again, are noted with the slave.
 * The monitor makes one event of neighbours that have changed alike.
 */
#include <linux/ktime.h>
#include "../base/report.h"
#include "slave.h"
#include "pending.h"

#define TOGETHER_MS	1000	/* a slave that needs longer than others has its own event */

/* neighbours that have changed alike */
struct group {
	struct ec_bus *bus;
	struct ec_pending pending;
	u8 state;
	u16 first;
	u32 n;
};

static void put_al(const struct group *g)
{
	ec_event_slave(g->bus->base, EC_EVENT_AL_STATE, g->first, g->state, g->pending.from, g->n,
		       g->pending.lowest < min(g->state, g->pending.from) ? g->pending.lowest : 0);
}

static void pending_put_back(const struct group *g)
{
	ec_report_more(g->bus->base, EC_EVENT_SLAVE_BACK, g->first, NULL, g->pending.back_ms, g->n);
}

/**
 * ec_pending_al() - an AL state was reached on request
 * @s: slave
 * @before: AL state before
 * @state: AL state
 *
 * Context: Process.
 */
void ec_pending_al(struct ec_slave *s, u8 before, u8 state)
{
	raw_spin_lock(&s->note.lock);
	if (!s->pending.from) {
		s->pending.from = before;
		s->pending.lowest = before;
	}
	s->pending.lowest = min(s->pending.lowest, state);
	raw_spin_unlock(&s->note.lock);
	/* after it: the monitor clears it first */
	WRITE_ONCE(s->bus->pending, true);
}

/**
 * ec_pending_back() - a slave that was lost or silent is in OP again
 * @s: slave
 * @ms: since it was last seen
 *
 * Context: Process.
 */
void ec_pending_back(struct ec_slave *s, u64 ms)
{
	raw_spin_lock(&s->note.lock);
	s->pending.back_ms = clamp_t(u64, ms, 1, U32_MAX);
	raw_spin_unlock(&s->note.lock);
	WRITE_ONCE(s->bus->pending, true);
}

/* What has changed, for its event. */
static struct group take_changes(struct ec_slave *s, bool al)
{
	struct group g = { .bus = s->bus, .first = s->position, .n = 1 };

	raw_spin_lock(&s->note.lock);
	g.pending = s->pending;
	g.state = READ_ONCE(s->al.status) & EC_AL_STATE_MASK;
	if (al)
		s->pending.from = 0;
	else
		s->pending.back_ms = 0;
	raw_spin_unlock(&s->note.lock);
	return g;
}

/**
 * ec_pending_before() - record what a slave has reached, before an event of it alone
 * @s: slave
 *
 * Context: Process.
 */
void ec_pending_before(struct ec_slave *s)
{
	const struct group g = take_changes(s, true);

	if (g.pending.from)
		put_al(&g);
}

static bool alike_al(const struct group *a, const struct group *b)
{
	return a->state == b->state && a->pending.from == b->pending.from &&
	       a->pending.lowest == b->pending.lowest;
}

/* Has one more slave joined its neighbours? Otherwise these are recorded. */
static bool joins(struct group *all, const struct group *g, bool any, bool al)
{
	if (all->n && any && (!al || alike_al(all, g))) {
		all->n++;
		all->pending.back_ms = max(all->pending.back_ms, g->pending.back_ms);
		return true;
	}
	if (all->n && al)
		put_al(all);
	else if (all->n)
		pending_put_back(all);
	return false;
}

static void record(struct ec_bus *bus, bool al)
{
	struct group all = { .bus = bus };

	ec_for_each_slave(s, bus) {
		const struct group g = take_changes(s, al);
		bool any = al ? g.pending.from : g.pending.back_ms;

		if (joins(&all, &g, any, al))
			continue;
		all = g;
		all.n = any;
	}
	joins(&all, &all, false, al);
}

/**
 * ec_pending_flush() - record what slaves have reached
 * @bus: bus
 * @all: now; otherwise once no slave is busy any more, or after %TOGETHER_MS
 *
 * Context: The monitor thread.
 */
void ec_pending_flush(struct ec_bus *bus, bool all)
{
	u64 now;

	if (!READ_ONCE(bus->pending))
		return;
	now = ktime_get_ns();
	bus->pending_ns = bus->pending_ns ?: now;
	if (now - bus->pending_ns < TOGETHER_MS * NSEC_PER_MSEC)
		ec_for_each_slave(s, bus)
			if (!all && ec_slave_busy(s))
				return;
	bus->pending_ns = 0;
	WRITE_ONCE(bus->pending, false);
	record(bus, true);
	record(bus, false);
}
