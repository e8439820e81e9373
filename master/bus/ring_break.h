/* SPDX-License-Identifier: GPL-2.0-only */
/* Where a ring is open, between which slaves. */
#ifndef EC_RING_BREAK_H
#define EC_RING_BREAK_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_ring_break_note(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n);
bool ec_ring_break_is_news(const struct ec_bus *bus);
struct ec_slave *ec_ring_break_neighbor(const struct ec_slave *s, u8 *port);
void ec_ring_break_report(struct ec_bus *bus);
void ec_ring_forget(struct ec_bus *bus, bool line);
void ec_ring_break_show(const struct ec_bus *bus, u32 *state, u32 *slave, u32 *port, u32 *next);

#endif
