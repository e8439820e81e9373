/* SPDX-License-Identifier: GPL-2.0-only */
/* Pieces of the ring in which a scan has found other slaves. */
#ifndef EC_SCAN_STRETCH_H
#define EC_SCAN_STRETCH_H

struct scan;

int ec_scan_stretches(struct scan *sc);

#endif
