/* SPDX-License-Identifier: GPL-2.0-only */
/* Does the bus still say what a scan has read? */
#ifndef EC_SCAN_PROOF_H
#define EC_SCAN_PROOF_H

struct scan;

int ec_scan_proof(struct scan *sc);

#endif
