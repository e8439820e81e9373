/* SPDX-License-Identifier: GPL-2.0-only */
/* EEPROMs of the slaves that a scan finds. */
#ifndef EC_SCAN_SII_H
#define EC_SCAN_SII_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

void ec_scan_sii(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		 unsigned int count, bool all);

#endif
