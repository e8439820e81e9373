/* SPDX-License-Identifier: GPL-2.0-only */
/* The scan: slaves are found, identified and wired. */
#ifndef EC_SCAN_H
#define EC_SCAN_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

/**
 * struct ec_scan_result - what a scan has found
 * @changed: there are other slaves than before, or one fell silent or replies again
 * @again: somewhere the bus has changed meanwhile; there all is as before the scan
 */
struct ec_scan_result {
	bool changed;
	bool again;
};

int ec_scan(struct ec_bus *bus, unsigned int count, struct ec_scan_result *result);
int ec_scan_count(struct ec_bus *bus);
bool ec_scan_worth(struct ec_bus *bus, bool event);
unsigned int ec_scan_limit(void);
u16 ec_scan_station(u16 last, struct ec_slave *const *known, const u8 *claims);

/* scan_sii.c */
void ec_scan_sii(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n,
		 unsigned int count, bool all);

#endif
