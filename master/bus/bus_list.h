/* SPDX-License-Identifier: GPL-2.0-only */
/* The list of slaves, and waits until they have settled. */
#ifndef EC_BUS_LIST_H
#define EC_BUS_LIST_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_bus_exit(struct ec_bus *bus);
struct ec_slave *ec_bus_slave(struct ec_bus *bus, unsigned int position);
int ec_bus_wait_scan(struct ec_bus *bus);
int ec_bus_wait_due(struct ec_bus *bus, unsigned int ms);
bool ec_bus_scan_awaited(const struct ec_bus *bus);
int ec_bus_wait_slaves(struct ec_bus *bus);
void ec_bus_wait_slave(struct ec_slave *slave);

#endif
