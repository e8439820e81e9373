/* SPDX-License-Identifier: GPL-2.0-only */
/* The scan: slaves are found, identified and wired. */
#ifndef EC_SCAN_H
#define EC_SCAN_H

#include <linux/types.h>

struct ec_bus;

/**
 * struct ec_scan_result - what a scan has found
 * @changed: there are other slaves than before, or one fell silent or replies again
 * @again: somewhere the bus has changed meanwhile; there all is as before the scan
 * @unsure: ring positions are not certain although the ring is closed
 */
struct ec_scan_result {
	bool changed;
	bool again;
	bool unsure;
};

int ec_scan(struct ec_bus *bus, unsigned int count, struct ec_scan_result *result);

#endif
