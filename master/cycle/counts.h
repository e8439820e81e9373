/* SPDX-License-Identifier: GPL-2.0-only */
/* Expected working counters while slaves of hot connect groups come and go. */
#ifndef EC_COUNTS_H
#define EC_COUNTS_H

struct ec_cycle;

void ec_counts_update(struct ec_cycle *c);

#endif
