/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/*
 * A ring of events with one writer at a time and any number of readers, which do not stop it.
 *
 * The writer stores a record, then the number of the next one (@head). Readers copy a
 * record and compare its number with @head before and after: a record whose place may be
 * written meanwhile is lost for them, so the oldest place is never read.
 */
#ifndef EC_WIRE_EVENT_RING_H
#define EC_WIRE_EVENT_RING_H

#include "env.h"
#include "../../include/uapi/ethercat_event.h"

#define EC_EVENT_PLACES		(EC_EVENTS_KEPT + 1)

/* accesses that other threads see; @head is 64 bits, also on a CPU of 32 */
#ifdef __KERNEL__
#include <linux/atomic.h>
#define EC_EVENT_HEAD			atomic64_t
#define ec_event_head_read(h)		((u64)atomic64_read(h))
#define ec_event_head_set(h, v)		atomic64_set(h, (s64)(v))
#define ec_event_load(p)		READ_ONCE(*(p))
#define ec_event_store(p, v)		WRITE_ONCE(*(p), v)
/* the data of a place and its @head */
#define ec_event_rmb()			smp_rmb()
/* likewise */
#define ec_event_wmb()			smp_wmb()
#else
#define EC_EVENT_HEAD			u64
#define ec_event_head_read(h)		__atomic_load_n(h, __ATOMIC_RELAXED)
#define ec_event_head_set(h, v)		__atomic_store_n(h, v, __ATOMIC_RELAXED)
#define ec_event_load(p)		__atomic_load_n(p, __ATOMIC_RELAXED)
#define ec_event_store(p, v)		__atomic_store_n(p, v, __ATOMIC_RELAXED)
#define ec_event_rmb()			__atomic_thread_fence(__ATOMIC_ACQUIRE)
#define ec_event_wmb()			__atomic_thread_fence(__ATOMIC_RELEASE)
#endif

/* a record as words, which are copied one by one */
union ec_event_place {
	struct ec_event event;
	u32 word[sizeof(struct ec_event) / sizeof(u32)];
};

/**
 * struct ec_event_ring - events
 * @head: number of the next one
 * @place: of event n: n modulo EC_EVENT_PLACES
 */
struct ec_event_ring {
	EC_EVENT_HEAD head;
	union ec_event_place place[EC_EVENT_PLACES];
};

void ec_event_ring_put(struct ec_event_ring *r, struct ec_event *e);
u64 ec_event_ring_head(const struct ec_event_ring *r);
u64 ec_event_ring_oldest(const struct ec_event_ring *r);
bool ec_event_ring_get(const struct ec_event_ring *r, u64 *at, struct ec_event *e);

#endif
