/* SPDX-License-Identifier: GPL-2.0-only */
/* How a ring is connected: the device at each end, and slaves that are the wrong way round. */
#ifndef EC_RING_ENDS_H
#define EC_RING_ENDS_H

#include <linux/types.h>

struct ec_bus;
struct ec_dg;
struct ec_slave;
struct scan;

bool ec_ring_ends_fit(struct ec_bus *bus, const struct ec_dg *dg);
int ec_ring_ends_judge(struct scan *sc);
void ec_ring_ends_note(const struct scan *sc, struct ec_slave **slaves, unsigned int n);
struct ec_slave *ec_ring_ends_turned(const struct ec_bus *bus);
struct ec_slave *ec_ring_ends_branch(const struct ec_bus *bus, unsigned int *port);
void ec_ring_ends_report(struct ec_bus *bus);

#endif
