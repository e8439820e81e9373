/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Bus access: which thread may use the links.
 *
 * Direct: each thread sends at once, under the access lock. Cyclic: only the cycle owner sends
 * and polls; it also sends the posts of other threads. After a cycle timeout the access is direct
 * again. The owner of the bus access is the thread that holds the lock with direct access, or the
 * cycle owner that has entered the links.
 */
#ifndef EC_ACCESS_H
#define EC_ACCESS_H

#include <linux/atomic.h>
#include <linux/rtmutex.h>
#include <linux/types.h>

struct ec_links;
struct ec_slot;

enum ec_access_mode {
	EC_ACCESS_DIRECT,
	EC_ACCESS_CYCLIC,
};

/** struct ec_access - bus access of a master, and the times of its cycle */
struct ec_access {
	/** @lock: taken by senders with direct access, and to change @mode */
	struct rt_mutex lock;
	/** @mode: enum ec_access_mode; see ec_access_change() */
	int mode;
	/** @open: the cycle owner may enter: the access is cyclic, see also ec_access_shut() */
	bool open;
	/** @busy: the cycle owner is using the links */
	atomic_t busy;
	/** @last_send_ns: time of the last cyclic send (ktime) */
	aligned_u64 last_send_ns;
	/** @polls: receives of the cycle so far; wraps */
	u32 polls;
	/** @interval_us: cycle time, configured or measured */
	u32 interval_us;
	/** @interval_set: the application has configured @interval_us */
	bool interval_set;
	/** @wire_ns: wire time of a cycle: of its layout, or of the last send if that was longer */
	u32 wire_ns;
	/** @stopped: no cyclic send since the last cycle timeout, though a receive may have come */
	bool stopped;
	/** @timeouts: cycle timeouts so far */
	atomic_t timeouts;
	/** @timeout_ns: last cyclic send before the last cycle timeout (ktime) */
	aligned_u64 timeout_ns;
};

void ec_access_init(struct ec_access *a);
bool ec_access_change(struct ec_links *l, enum ec_access_mode mode);
bool ec_access_timed_out(struct ec_links *l);
void ec_access_timeout(struct ec_links *l);
void ec_access_poll(struct ec_links *l);
void ec_access_shut(struct ec_links *l);
void ec_access_reopen(struct ec_links *l);

/* for the cycle owner */
int ec_access_reenter(struct ec_links *l);
int ec_access_try_enter(struct ec_links *l);

/* free wire time beside a cycle */
#define EC_ROOM_MIN	32	/* data bytes of a minimum Ethernet frame */
u32 ec_access_slack_ns(const struct ec_links *l);
u16 ec_access_room(const struct ec_links *l);

/* Mark the links as in use. False: the cycle owner must not enter, ec_access_leave() follows. */
static inline bool ec_access_enters(struct ec_access *a)
{
	atomic_set(&a->busy, 1);
	smp_mb();	/* busy before open; pairs with ec_access_change() */
	/* pairs with ec_access_reopen() */
	return smp_load_acquire(&a->open);
}

/**
 * ec_access_leave() - the cycle owner leaves the links
 * @a: access to links that it has entered
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
static inline void ec_access_leave(struct ec_access *a)
{
	atomic_set_release(&a->busy, 0);
}

static inline bool ec_access_is_cyclic(const struct ec_access *a)
{
	return READ_ONCE(a->mode) == EC_ACCESS_CYCLIC;
}

/* Does the cycle owner send? After a cycle timeout a receive alone makes the access cyclic. */
static inline bool ec_access_runs(const struct ec_access *a)
{
	return ec_access_is_cyclic(a) && !READ_ONCE(a->stopped);
}

/* The cycle owner may change it at any time, by its measurement. */
static inline u32 ec_access_interval_us(const struct ec_access *a)
{
	return READ_ONCE(a->interval_us);
}

#endif
