/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * A ring: the backup device is at its other end. Each frame enters at both ends. In a closed ring
 * the slaves process the copy of one end, and each copy returns at the other end. In an open one
 * each copy reaches the slaves up to the break, and returns where it was sent.
 */
#ifndef EC_RING_H
#define EC_RING_H

#include <linux/types.h>
#include "ethercat.h"

struct ec_slot;

#define EC_MAIN		0	/* numbers of the links */
#define EC_BACKUP	1

/** struct ec_ring - what is known of a ring */
struct ec_ring {
	/** @state: EC_RING_*; written by the monitor */
	u8 state;
	/**
	 * @front: slaves that the copy of the main link passes: further positions are counted from
	 * the break, on the backup link; written by the monitor
	 */
	u32 front;
	/** @measured: the exit of the ring is closed to measure delays: it looks open */
	bool measured;
	/** @news: the cycle has received a copy that contradicts @state; the monitor clears it */
	bool news;
};

/** struct ec_ring_way - how a datagram with a position gets to its slave */
struct ec_ring_way {
	/** @sides: mask of the links */
	u8 sides;
	/** @shift: to be added to its address */
	u16 shift;
};

struct ec_ring_way ec_ring_find_way(const struct ec_ring *r, u8 cmd, u16 adp);
bool ec_ring_note(struct ec_ring *r, const struct ec_slot *slot);
void ec_ring_set(struct ec_ring *r, bool closed, u32 front);

#endif
