/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units in the cycle. */
#ifndef EC_UNITS_RUN_H
#define EC_UNITS_RUN_H

#include "unit_state.h"

struct ec_cycle;

void ec_units_judge(struct ec_cycle *c, u64 judged);
void ec_units_outage(struct ec_cycle *c);
void ec_units_fill(struct ec_cycle *c, u64 queued);
void ec_units_fed(struct ec_cyc_units *us, u64 domains);
void ec_units_lease(struct ec_cycle *c);

#endif
