/* SPDX-License-Identifier: GPL-2.0-only */
/* Writing station addresses; see scan_address.c. */
#ifndef EC_SCAN_ADDRESS_H
#define EC_SCAN_ADDRESS_H

#include <linux/types.h>

struct scan;

int ec_scan_address_all(struct scan *sc, const u16 *at, unsigned int n);

#endif
