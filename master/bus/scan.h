/* SPDX-License-Identifier: GPL-2.0-only */
/* The scan: slaves are found, identified and wired. */
#ifndef EC_SCAN_H
#define EC_SCAN_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

int ec_scan(struct ec_bus *bus, unsigned int count, bool *changed);
unsigned int ec_scan_limit(void);
u16 ec_scan_station(u16 last, struct ec_slave *const *known, const u8 *claims);

/* scan_sii.c */
void ec_scan_sii(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		 unsigned int count, bool all);

/* scan_preop.c */
void ec_scan_preop(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool clean);

/* topology.c */
void ec_topology_build(struct ec_slave **slaves, unsigned int n);

#endif
