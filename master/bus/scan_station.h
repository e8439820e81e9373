/* SPDX-License-Identifier: GPL-2.0-only */
/* Station addresses of the slaves that a scan finds. */
#ifndef EC_SCAN_STATION_H
#define EC_SCAN_STATION_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;
struct scan;

int ec_scan_stations(struct scan *sc);
const struct ec_slave *ec_scan_unreadable(const struct ec_bus *bus, unsigned int i);

#endif
