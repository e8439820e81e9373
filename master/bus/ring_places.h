/* SPDX-License-Identifier: GPL-2.0-only */
/* What is remembered of a closed ring; ring_place.c has the functions. */
#ifndef EC_RING_PLACES_H
#define EC_RING_PLACES_H

#include <linux/types.h>
#include "../carry/rider.h"

/**
 * struct ec_ring_places - positions of a ring, changed with topo and ec_show_change_begin()
 * @open: the ring is open
 * @sure: it is closed, and a place in the list is a position
 * @partial: the list is not that of the whole bus: slaves may be missing at any place of it
 * @front: slaves before the break
 * @n_list: slaves of the list
 * @n: slaves when it was closed, 0: it was not
 * @device: their numbers
 * @index: if not @sure: where the slave at each position is in the list, if that is certain
 * @last: number given last when it was closed
 */
struct ec_ring_places {
	bool open;
	bool sure;
	bool partial;
	u32 front;
	u32 n_list;
	u32 n;
	u64 *device;
	u16 *index;
	u64 last;
};

/**
 * struct ec_ring_exit - the port towards the backup device, if the master has closed it
 * @device: number of its slave, 0: it has not
 * @port: port
 * @tried_ns: the last attempt (ktime)
 * @station: of a line that was a ring: station address of the slave at its end, 0: no such line
 * @open: likewise: loop control of that slave, with the port open
 * @closed: likewise: the port was closed, and the slave is the one that shows it
 */
struct ec_ring_exit {
	u64 device;
	u8 port;
	u64 tried_ns;
	u16 station;
	u8 open;
	bool closed;
};

/**
 * struct ec_ring_end - an end of a break, at a slave
 * @device: number of that, 0: none
 * @link_ns: since when it has had a link without loss (ktime), 0: it has none
 * @port: port
 * @lost: its counter of lost links as read last
 * @cleared: that was full, and was cleared
 */
struct ec_ring_end {
	u64 device;
	u64 link_ns;
	u8 port;
	u8 lost;
	bool cleared;
};

/**
 * struct ec_ring_heal - ends that do not open by themselves
 * @end: the one before and the one behind the break; both or none
 * @open: mask of those that may open
 * @read_ns: last read of both (ktime)
 * @riders: of the master, immutable
 * @rider: what opens them
 */
struct ec_ring_heal {
	struct ec_ring_end end[2];
	u8 open;
	u64 read_ns;
	struct ec_riders *riders;
	struct ec_rider rider[2];
};

#endif
