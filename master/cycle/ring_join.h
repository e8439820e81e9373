/* SPDX-License-Identifier: GPL-2.0-only */
/* One reply of the two copies that a frame of the cycle has in a ring. */
#ifndef EC_RING_JOIN_H
#define EC_RING_JOIN_H

#include "cycle.h"

const u8 *ec_ring_data(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_cyc_dgram *d,
		       const u8 *at, u16 *irq);
bool ec_ring_join(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot);

#endif
