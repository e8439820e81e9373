/* SPDX-License-Identifier: GPL-2.0-only */
/* What the monitor asks before a scan. */
#ifndef EC_SCAN_COUNT_H
#define EC_SCAN_COUNT_H

#include <linux/types.h>

struct ec_bus;
struct scan;
struct ec_dg;

int ec_scan_count(struct ec_bus *bus);
int ec_scan_count_again(const struct scan *sc);
void ec_scan_look_at_mute(struct ec_bus *bus);
bool ec_scan_see_ring(struct ec_bus *bus, const struct ec_dg *dg, bool last);
bool ec_scan_worth(struct ec_bus *bus, bool event);
unsigned int ec_scan_limit(void);

#endif
