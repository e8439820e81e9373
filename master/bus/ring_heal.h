/* SPDX-License-Identifier: GPL-2.0-only */
/* Both ends of a break: when they open again. */
#ifndef EC_RING_HEAL_H
#define EC_RING_HEAL_H

#include <linux/types.h>

struct ec_bus;
struct ec_riders;
struct ec_slave;

int ec_ring_heal_init(struct ec_bus *bus, struct ec_riders *riders);
bool ec_ring_heal_look(struct ec_bus *bus, bool event);
void ec_ring_heal_open(struct ec_bus *bus);
void ec_ring_heal_forget(struct ec_bus *bus);
u8 ec_ring_heal_loops(const struct ec_slave *s, u8 loops);

#endif
