/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Events of a master: binary records in a ring, for readers of /dev/EtherCAT<n>. The
 * kernel log has the text of most of them, and not of all when they repeat.
 */
#ifndef EC_EVENTS_H
#define EC_EVENTS_H

#include <linux/spinlock.h>
#include <linux/types.h>
#include "../wire/event_ring.h"

#define EC_EVENT_RATE_NS	NSEC_PER_SEC
#define EC_EVENT_RATE		4	/* records of a subject in that time */

/**
 * struct ec_events - events of a master
 * @lock: one writer at a time; readers do not take it
 * @ring: events
 */
struct ec_events {
	raw_spinlock_t lock;
	struct ec_event_ring ring;
};

/**
 * struct ec_event_rate - what may change in each cycle has few records
 * @since_ns: when the current period has begun (ktime)
 * @records: in it
 * @more: changes without a record since the last one
 */
struct ec_event_rate {
	u64 since_ns;
	u32 records;
	u32 more;
};

void ec_events_init(struct ec_events *ev);
void ec_events_put(struct ec_events *ev, u32 kind, u16 slave, const u32 *args);
bool ec_events_admit(struct ec_event_rate *r, u64 now);

/* @base: struct ec_base; the arguments of @kind follow. RT-safe, in any context */
#define ec_event_slave(base, kind, slave, ...) \
	ec_events_put(&(base)->events, kind, slave, (const u32 [EC_EVENT_ARGS]) { __VA_ARGS__ })
#define ec_event(base, kind, ...) \
	ec_event_slave(base, kind, EC_EVENT_NO_SLAVE, ##__VA_ARGS__)

#endif
