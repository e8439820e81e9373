/* SPDX-License-Identifier: GPL-2.0-only */
/* The list that a scan has found takes the place of the one before. */
#ifndef EC_SCAN_PUBLISH_H
#define EC_SCAN_PUBLISH_H

struct scan;

int ec_scan_publish(struct scan *sc);

#endif
