/* SPDX-License-Identifier: GPL-2.0-only */
/* The figures of the cycle that runs, and of the last one. */
#ifndef EC_CYCLE_STATS_H
#define EC_CYCLE_STATS_H

struct ec_cycle;
struct ec_cycles;
struct ec_ioc_cycle_stats;
struct ec_status_cycle;

void ec_cycle_stats_end(struct ec_cycle *c);
void ec_cycle_stats_get(struct ec_cycles *cycles, struct ec_ioc_cycle_stats *info,
			struct ec_status_cycle *status);
void ec_cycle_stats_reset(struct ec_cycles *cycles);

#endif
