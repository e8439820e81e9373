/* SPDX-License-Identifier: GPL-2.0-only */
/* How far the sends of the cycle are from their schedule. */
#ifndef EC_LATE_H
#define EC_LATE_H

#include <linux/types.h>
#include "ethercat.h"

struct ec_ioc_cycle_stats;
struct ec_cycles;
struct ec_cycle;

#define EC_SCHEDULE_GAPS	15

/**
 * struct ec_schedule - when the application is expected to send; owned by the
 *	cyclic caller
 * @due_ns: when the last send was due (ktime)
 * @last_ns: when it was
 * @interval_ns: distance of two sends, set or measured
 * @sends: sends so far, up to the end of the first measurement
 * @gaps: the last times between two sends, ns
 * @n_gaps: such times so far
 */
struct ec_schedule {
	u64 due_ns;
	u64 last_ns;
	u32 interval_ns;
	u32 sends;
	u32 gaps[EC_SCHEDULE_GAPS];
	u32 n_gaps;
};

/**
 * struct ec_late_report - the last cycle that has ended; under
 *	the lock of the configuration
 * @info: what EC_IOC_CYCLE_STATS tells of it
 * @status: and its figures
 */
struct ec_late_report {
	struct ec_ioc_cycle_stats info;
	struct ec_status_cycle status;
};

void ec_late_count(struct ec_cycle *c, s64 ns);
void ec_late_send(struct ec_cycle *c, u64 now);
void ec_late_work(struct ec_cycle *c, s64 ns);

void ec_late_end(struct ec_cycle *c);
void ec_late_get(struct ec_cycles *cycles, struct ec_ioc_cycle_stats *info,
		 struct ec_status_cycle *status);
void ec_late_reset(struct ec_cycles *cycles);

#endif
