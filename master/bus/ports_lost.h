/* SPDX-License-Identifier: GPL-2.0-only */
/* Ports that lose their link while the monitor is busy elsewhere. */
#ifndef EC_PORTS_LOST_H
#define EC_PORTS_LOST_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_ports_close_lost(struct ec_bus *bus, u16 irq);
void ec_ports_look_for_lost(struct ec_bus *bus);
void ec_ports_watch_found(struct ec_bus *bus, struct ec_slave **found, unsigned int n);

#endif
