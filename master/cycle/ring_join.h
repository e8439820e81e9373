/* SPDX-License-Identifier: GPL-2.0-only */
/* One reply of the two copies that a frame of the cycle has in a ring. */
#ifndef EC_RING_JOIN_H
#define EC_RING_JOIN_H

#include <linux/log2.h>
#include "cycle.h"

const u8 *ec_ring_data(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_cyc_dgram *d,
		       const u8 *at, u16 *irq);
void ec_ring_riders(struct ec_cycle *c, const struct ec_cyc_flight *f, const u8 *at, const u8 *end);
bool ec_ring_join(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot);

/**
 * ec_ring_is_steady() - is a frame in a ring as the last one, with both copies?
 * @c: active cycle
 * @slot: its slot, in state DONE
 * @two: result: as of ec_ring_join(), which is not needed then; the reply is set
 *
 * Context: The cycle owner. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
static inline bool ec_ring_is_steady(const struct ec_cycle *c, struct ec_slot *slot, bool *two)
{
	u8 processed = slot->back & ~slot->blank;

	if (slot->back != slot->sides || c->mute)
		return false;
	*two = !c->crossed;
	if (!*two)
		return slot->crossed & processed && is_power_of_2(processed) &&
		       READ_ONCE(c->links->ring.state) == EC_RING_CLOSED;
	if (slot->crossed || processed != (BIT(EC_MAIN) | BIT(EC_BACKUP)) ||
	    READ_ONCE(c->links->ring.state) == EC_RING_CLOSED)
		return false;
	slot->reply = slot->got[EC_MAIN];
	return true;
}

#endif
