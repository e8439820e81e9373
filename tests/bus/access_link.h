/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The way of the tests to what lies below the slaves: links, frames, bus access. As access.h,
 * which is included before.
 */
#ifndef EC_BUS_ACCESS_LINK_H
#define EC_BUS_ACCESS_LINK_H

#include "master/link/capture.h"
#include "master/carry/flight.h"
#include "master/carry/xfer.h"

static inline struct ec_links *bus_links(const struct bus *b)
{
	return &b->m->links;
}

/* links and their devices */

static inline struct ec_link *bus_link(const struct bus *b, u32 i)
{
	return &bus_links(b)->link[i];
}

/* of the main link, NULL: none */
static inline struct ecdev *bus_dev(const struct bus *b)
{
	return READ_ONCE(bus_link(b, 0)->dev);
}

static inline void bus_set_dev(const struct bus *b, struct ecdev *dev)
{
	WRITE_ONCE(bus_link(b, 0)->dev, dev);
}

/* the master gives up its device and gets no other */
static inline void bus_no_device(const struct bus *b)
{
	ec_device_release(bus_links(b), EC_MAIN, "none", NULL);
}

static inline bool bus_link_up(const struct bus *b)
{
	return READ_ONCE(bus_link(b, 0)->up);
}

static inline const struct ec_link_stats *bus_stats(const struct bus *b)
{
	return &bus_link(b, 0)->stats;
}

static inline u64 bus_frames(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->tx_frames);
}

static inline u64 bus_tx_bytes(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->tx_bytes);
}

static inline u64 bus_tx_errors(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->tx_errors);
}

static inline u64 bus_rx_frames(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->rx_frames);
}

static inline u64 bus_lost(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->lost);
}

static inline u64 bus_late(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->late);
}

static inline u64 bus_unmatched(const struct bus *b)
{
	return atomic64_read(&bus_stats(b)->unmatched);
}

static inline struct net_device *bus_capture_dev(const struct bus *b)
{
	return bus_links(b)->capture->nd;
}

static inline struct ec_tap *bus_tap(const struct bus *b)
{
	return &bus_links(b)->capture->tap;
}

/* frames */

static inline struct ec_slots *bus_slots(const struct bus *b)
{
	return &bus_links(b)->slots;
}

static inline struct ec_slot *bus_slot(const struct bus *b, u32 i)
{
	return &bus_slots(b)->slot[i];
}

/* memory for the copies of two links, until bus_one_copy() */
static inline void bus_two_copies(const struct bus *b, struct ec_slot *slot)
{
	u32 side;

	for (side = 0; side < EC_MAX_LINKS; side++) {
		slot->copy[side] = kunit_kzalloc(b->test, EC_ETH_MAX, GFP_KERNEL);
		KUNIT_ASSERT_NOT_NULL(b->test, slot->copy[side]);
	}
	bus_slots(b)->copies = slot->copy[0];
	if (!bus_slots(b)->merged)
		bus_slots(b)->merged = kunit_kzalloc(b->test, EC_ETH_MAX, GFP_KERNEL);
	KUNIT_ASSERT_NOT_NULL(b->test, bus_slots(b)->merged);
}

static inline void bus_one_copy(const struct bus *b, struct ec_slot *slot)
{
	u32 side;

	bus_slots(b)->copies = NULL;
	bus_slots(b)->merged = NULL;
	for (side = 0; side < EC_MAX_LINKS; side++)
		slot->copy[side] = ec_slot_body(slot);
}

/* does a slave of the ring seem to be the wrong way round? */
static inline bool bus_ring_turned(const struct bus *b)
{
	return READ_ONCE(b->m->bus.turned);
}

static inline struct ec_riders *bus_riders(const struct bus *b)
{
	return &b->m->riders;
}

static inline struct ec_carry *bus_carry(const struct bus *b)
{
	return &b->m->carry;
}

/* posts that have not left */
static inline unsigned int bus_queued(const struct bus *b)
{
	return READ_ONCE(bus_carry(b)->n_ready);
}

/* acyclic frames on their way */
static inline unsigned int bus_acyclic(const struct bus *b)
{
	return READ_ONCE(bus_carry(b)->n_flying);
}

/* how often the thread of the posts has slept */
static inline unsigned long bus_post_slept(const struct bus *b)
{
	return READ_ONCE(bus_carry(b)->thread->nvcsw);
}

/* its work begins now */
static inline void bus_post_kick(const struct bus *b)
{
	ec_carry_kick(bus_carry(b));
}

/* as at the end of the master, whose device may still be there: no post is taken */
static inline void bus_post_close(const struct bus *b, bool closed)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&bus_carry(b)->lock, flags);
	bus_carry(b)->closed = closed;
	raw_spin_unlock_irqrestore(&bus_carry(b)->lock, flags);
}

/* posts that have not left, and frames on their way */
static inline u32 bus_posts(const struct bus *b)
{
	return bus_queued(b) + bus_acyclic(b);
}

/* wire time of these frames */
static inline int bus_acyclic_ns(const struct bus *b)
{
	return atomic_read(&bus_link(b, 0)->acyclic_ns);
}

static inline int bus_xfer(const struct bus *b, struct ec_dg *dg, unsigned int n)
{
	return ec_xfer(bus_links(b), dg, n);
}

static inline int bus_xfer_clock(const struct bus *b, struct ec_dg *dg, unsigned int n)
{
	return ec_xfer_clock(bus_links(b), dg, n);
}

static inline int bus_fprd(const struct bus *b, u16 station, u16 ado, void *data, u16 len)
{
	return ec_xfer_fprd(bus_links(b), station, ado, data, len);
}

static inline int bus_fpwr(const struct bus *b, u16 station, u16 ado, const void *data, u16 len)
{
	return ec_xfer_fpwr(bus_links(b), station, ado, data, len);
}

/* bus access */

static inline int bus_access_mode(const struct bus *b)
{
	return READ_ONCE(bus_links(b)->access.mode);
}

/* cycle timeouts */
static inline u32 bus_timeouts(const struct bus *b)
{
	return atomic_read(&bus_links(b)->access.timeouts);
}

static inline u64 bus_last_send_ns(const struct bus *b)
{
	return READ_ONCE(bus_links(b)->access.last_send_ns);
}

static inline u32 bus_interval_us(const struct bus *b)
{
	return READ_ONCE(bus_links(b)->access.interval_us);
}

static inline void bus_set_interval(const struct bus *b, u32 us)
{
	bus_links(b)->access.interval_us = us;
}

/* did the application tell it? */
static inline bool bus_interval_told(const struct bus *b)
{
	return READ_ONCE(bus_links(b)->access.interval_set);
}

static inline void bus_set_interval_told(const struct bus *b, bool told)
{
	bus_links(b)->access.interval_set = told;
}

/* wire time beside a cycle, and the data bytes of the largest frame that fits */
static inline u32 bus_slack_ns(const struct bus *b)
{
	return ec_access_slack_ns(bus_links(b));
}

static inline u16 bus_room(const struct bus *b)
{
	return ec_access_room(bus_links(b));
}

/* cycles that acyclic frames have delayed */
static inline u32 bus_late_cycles(const struct bus *b)
{
	return READ_ONCE(bus_carry(b)->share.late_cycles);
}

static inline u32 bus_late_per_s(const struct bus *b)
{
	return READ_ONCE(bus_carry(b)->share.late_per_s);
}

static inline void bus_set_late_per_s(const struct bus *b, u32 cycles)
{
	bus_carry(b)->share.late_per_s = cycles;
}

#endif
