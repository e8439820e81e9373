/* SPDX-License-Identifier: GPL-2.0-only */
/* Where the slaves of a closed ring are while it is open. */
#ifndef EC_RING_PLACE_H
#define EC_RING_PLACE_H

#include <linux/types.h>
#include "ring_places.h"

struct ec_bus;
struct ec_slave;

void ec_ring_places_exit(struct ec_ring_places *p);
void ec_ring_places_note(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool whole);
bool ec_ring_places_are_unsure(const struct ec_bus *bus);
void ec_ring_places_forget(struct ec_bus *bus);
int ec_ring_places_count(u32 place, u32 front, u32 n, u32 total);
int ec_ring_places_find(const struct ec_bus *bus, u32 place, u32 total);
bool ec_ring_places_misses(const struct ec_bus *bus);
bool ec_ring_places_cut(const struct ec_bus *bus);
bool ec_ring_places_open_between(const struct ec_bus *bus, u32 a, u32 b);
u32 ec_ring_places_of(const struct ec_bus *bus, u32 index);

#endif
