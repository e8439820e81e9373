// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include "../base/once64.h"
#include "device.h"
#include "links.h"

#define SHUT_TRIES	1000	/* attempts to find the cycle owner outside of the links */

/**
 * ec_access_init() - direct access
 * @a: zeroed structure
 *
 * Context: Any.
 */
void ec_access_init(struct ec_access *a)
{
	rt_mutex_init(&a->lock);
	a->interval_us = EC_INTERVAL_US;
}

static void own_devices(struct ec_links *l, bool cycle)
{
	unsigned int i;

	lockdep_assert_held(&l->access.lock);
	for (i = 0; i < EC_MAX_LINKS; i++) {
		struct ecdev *dev = l->link[i].dev;

		if (dev && dev->ops->cycle)
			dev->ops->cycle(dev->priv, cycle);
	}
}

static void changed(struct ec_links *l)
{
	lockdep_assert_held(&l->access.lock);
	if (l->ops && l->ops->changed)
		l->ops->changed(l);
}

/**
 * ec_access_change() - change the bus access
 * @l: links
 * @mode: new one
 *
 * Before direct access waits until the cycle owner has left the links.
 *
 * Context: Process. May sleep.
 * Return: whether it was another one before.
 */
bool ec_access_change(struct ec_links *l, enum ec_access_mode mode)
{
	bool change;

	rt_mutex_lock(&l->access.lock);
	change = l->access.mode != mode;
	if (change) {
		ec_write64(&l->access.last_send_ns, ktime_get_ns());
		/* the devices end their own polls before the cycle owner may enter */
		if (mode == EC_ACCESS_CYCLIC)
			own_devices(l, true);
		WRITE_ONCE(l->access.mode, mode);
		WRITE_ONCE(l->access.open, mode == EC_ACCESS_CYCLIC);
		smp_mb();	/* open before busy; pairs with ec_access_enters() */
		/* polled: a cycle owner that leaves wakes no thread */
		while (mode == EC_ACCESS_DIRECT && atomic_read_acquire(&l->access.busy))
			usleep_range(20, 50);
		if (mode == EC_ACCESS_DIRECT)
			own_devices(l, false);
		changed(l);
	}
	rt_mutex_unlock(&l->access.lock);
	return change;
}

/**
 * ec_access_shut() - keep the cycle owner out of the links for a moment
 * @l: links
 *
 * Shuts while the cycle owner is outside, so that the cycle does not wait while this function
 * sleeps. A cycle owner that wants to enter now waits for the lock, or its call returns -EAGAIN.
 *
 * Context: Process, with the access lock held; ec_access_reopen() must follow, soon. May sleep.
 */
void ec_access_shut(struct ec_links *l)
{
	unsigned int tries = 0;

	lockdep_assert_held(&l->access.lock);
	while (1) {
		WRITE_ONCE(l->access.open, false);
		smp_mb();	/* open before busy; pairs with ec_access_enters() */
		if (!atomic_read_acquire(&l->access.busy))
			return;
		/* the cycle owner is hardly ever outside: after these attempts it has to wait */
		if (tries++ < SHUT_TRIES)
			WRITE_ONCE(l->access.open, l->access.mode == EC_ACCESS_CYCLIC);
		usleep_range(20, 50);
	}
}

/**
 * ec_access_reopen() - the cycle owner may enter the links again
 * @l: links
 *
 * Context: Process, after ec_access_shut() with the access lock still held.
 */
void ec_access_reopen(struct ec_links *l)
{
	lockdep_assert_held(&l->access.lock);
	/* the cycle owner sees what was changed meanwhile; pairs with ec_access_enters() */
	smp_store_release(&l->access.open, l->access.mode == EC_ACCESS_CYCLIC);
}

/**
 * ec_access_reenter() - make the access cyclic again, and enter the links
 * @l: links
 *
 * Context: Cycle owner. May sleep.
 * Return: 0; -ENODEV without device: nothing is entered.
 */
int ec_access_reenter(struct ec_links *l)
{
	do {
		if (!ec_links_attached(l)) {
			ec_access_leave(&l->access);
			return -ENODEV;
		}
		ec_access_leave(&l->access);
		ec_access_change(l, EC_ACCESS_CYCLIC);
	} while (!ec_access_enters(&l->access));
	return 0;
}

/**
 * ec_access_try_enter() - enter the links for one call, if no sleep is needed
 * @l: links
 *
 * For a caller that must not sleep. While the links are entered the active session
 * stays: deactivation waits for the caller in ec_access_change().
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -EBUSY another caller has entered; -EAGAIN access is direct after a cycle
 * timeout, or a device is being attached: a thread that may sleep has to call
 * ec_access_change().
 */
int ec_access_try_enter(struct ec_links *l)
{
	if (atomic_cmpxchg(&l->access.busy, 0, 1))
		return -EBUSY;
	smp_mb();	/* busy before open; pairs with ec_access_change() */
	/* pairs with ec_access_reopen() */
	if (smp_load_acquire(&l->access.open))
		return 0;
	ec_access_leave(&l->access);
	return -EAGAIN;
}

/**
 * ec_access_timed_out() - has the cycle owner stopped sending?
 * @l: links with cyclic access
 *
 * Context: Process.
 * Return: true after max(10 periods, 20 ms) without a send.
 */
bool ec_access_timed_out(struct ec_links *l)
{
	s64 limit = max_t(s64, 10LL * ec_access_interval_us(&l->access) * NSEC_PER_USEC,
			  20 * NSEC_PER_MSEC);

	/* signed: the cycle owner may send after the clock was read */
	return (s64)(ktime_get_ns() - ec_read64(&l->access.last_send_ns)) > limit;
}

/**
 * ec_access_timeout() - the cycle owner has not sent for too long: direct access
 * @l: links
 *
 * Mailboxes and tools work again. Process data stop, and the watchdogs of the slaves act on the
 * outputs. The next call of the cycle owner makes the access cyclic again. If it sends nothing,
 * the same cycle timeout continues and is not counted again.
 *
 * Context: Process. May sleep.
 */
void ec_access_timeout(struct ec_links *l)
{
	u64 sent = ec_read64(&l->access.last_send_ns);

	if (!ec_access_change(l, EC_ACCESS_DIRECT) || READ_ONCE(l->access.stopped))
		return;
	WRITE_ONCE(l->access.stopped, true);
	ec_write64(&l->access.timeout_ns, sent);
	atomic_inc(&l->access.timeouts);
}

/**
 * ec_access_poll() - let the devices deliver overdue frames that no interrupt has reported
 * @l: links
 *
 * Context: Process. May sleep.
 */
void ec_access_poll(struct ec_links *l)
{
	rt_mutex_lock(&l->access.lock);
	/* with cyclic access the cycle owner polls */
	if (READ_ONCE(l->access.mode) == EC_ACCESS_DIRECT)
		ec_links_poll(l);
	rt_mutex_unlock(&l->access.lock);
	/* for devices without a poll function: their interrupt thread delivers */
	usleep_range(200, 500);
}

/**
 * ec_access_slack_ns() - wire time that a cycle leaves for acyclic frames
 * @l: links
 *
 * A tenth of the interval is kept free: the next send may be early.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns; ~0 while there is no cycle.
 */
u32 ec_access_slack_ns(const struct ec_links *l)
{
	u64 budget = ec_access_interval_us(&l->access) * 900ULL;
	u32 used = READ_ONCE(l->access.wire_ns);

	if (READ_ONCE(l->access.mode) != EC_ACCESS_CYCLIC)
		return ~0u;
	return budget > used ? min_t(u64, budget - used, ~0u) : 0;
}

/**
 * ec_access_room() - data of one acyclic datagram that fits before the next
 *	cyclic send
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes, at least what a minimum Ethernet frame holds.
 */
u16 ec_access_room(const struct ec_links *l)
{
	u32 bytes = ec_access_slack_ns(l) / 80;

	/* what ec_frame_wire_ns() adds, and the headers */
	bytes -= min(bytes, 8u + 4 + 12 + EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD);
	return clamp_t(u32, bytes, EC_ROOM_MIN, EC_DGRAM_DATA_MAX);
}

