/* SPDX-License-Identifier: GPL-2.0-only */
/* The port of a ring towards the backup device, closed while that is absent. */
#ifndef EC_RING_EXIT_H
#define EC_RING_EXIT_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_ring_exit_note(struct ec_bus *bus);
void ec_ring_exit_forget(struct ec_bus *bus, bool line);
bool ec_ring_exit_close(struct ec_bus *bus);
bool ec_ring_exit_is_closed(const struct ec_bus *bus);
void ec_ring_exit_look(struct ec_bus *bus);
u8 ec_ring_exit_loops(const struct ec_slave *s, u8 loops);

#endif
