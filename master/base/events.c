// SPDX-License-Identifier: GPL-2.0-only
/*
 * Writers are in the cycle, in softirqs, in workers: they take a raw spinlock for one copy of
 * 64 bytes, allocate nothing and wake no reader: the monitor does.
 */
#include <linux/ktime.h>
#include <linux/string.h>
#include "events.h"

/**
 * ec_events_init() - initialize the events of a master
 * @ev: events, zeroed
 *
 * Context: Any.
 */
void ec_events_init(struct ec_events *ev)
{
	raw_spin_lock_init(&ev->lock);
}

/**
 * ec_events_put() - record an event
 * @ev: events
 * @kind: EC_EVENT_*
 * @slave: ring position or EC_EVENT_NO_SLAVE
 * @args: EC_EVENT_ARGS arguments
 *
 * Context: Any but NMI. RT-safe.
 */
void ec_events_put(struct ec_events *ev, u32 kind, u16 slave, const u32 *args)
{
	struct ec_event e = { .kind = kind, .slave = slave };
	unsigned long irq;

	memcpy(e.arg, args, sizeof(e.arg));
	raw_spin_lock_irqsave(&ev->lock, irq);
	/* with the lock, so that times are in the order of numbers */
	e.time_ns = ktime_get_ns();
	e.wall_ns = ktime_get_real_ns();
	ec_event_ring_put(&ev->ring, &e);
	raw_spin_unlock_irqrestore(&ev->lock, irq);
}

/**
 * ec_events_admit() - may a change of this subject have a record?
 * @r: of the subject, initially zeroed
 * @now: time of the change (ktime)
 *
 * The caller counts changes without one in @r->more; its next record says how many there were.
 * It asks again until the last change has one.
 *
 * Context: Any, one caller at a time. RT-safe.
 * Return: true for %EC_EVENT_RATE changes in %EC_EVENT_RATE_NS.
 */
bool ec_events_admit(struct ec_event_rate *r, u64 now)
{
	if (now - r->since_ns >= EC_EVENT_RATE_NS) {
		r->since_ns = now;
		r->records = 0;
	}
	if (r->records >= EC_EVENT_RATE)
		return false;
	r->records++;
	return true;
}
