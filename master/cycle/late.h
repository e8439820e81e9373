/* SPDX-License-Identifier: GPL-2.0-only */
/* Send deviations of a cycle: how far each send is from its schedule. */
#ifndef EC_LATE_H
#define EC_LATE_H

#include <linux/types.h>
#include "ethercat.h"

struct ec_access;

#define EC_SCHEDULE_GAPS	15

/** struct ec_schedule - when the application is expected to send; of the cycle owner */
struct ec_schedule {
	/** @due_ns: when the last send was due (ktime) */
	u64 due_ns;
	/** @last_ns: when it was */
	u64 last_ns;
	/** @interval_ns: time between two sends, configured or measured */
	u32 interval_ns;
	/** @sends: sends so far, up to the end of the measurement */
	u32 sends;
	/** @gaps: the last times between two sends while it is measured, ns */
	u32 gaps[EC_SCHEDULE_GAPS];
	/** @block_ns: begin of the sends whose mean is checked next (ktime) */
	u64 block_ns;
	/** @before_ns: begin of the sends before, 0: none */
	u64 before_ns;
	/** @n_block: sends since @block_ns */
	u32 n_block;
	/** @far: gaps in a row that are far from @interval_ns, to the same side */
	u8 far;
	/** @far_side: 1: longer, -1: shorter */
	s8 far_side;
	/** @mean_side: as @far_side, of the last mean, 0: near */
	s8 mean_side;
	/** @n_gaps: times in @gaps so far */
	u32 n_gaps;
};

/** struct ec_late - the figures of a cycle while it is active; of the cycle owner */
struct ec_late {
	/** @status: page with the figures; immutable, as is the next one */
	struct ec_status *status;
	/** @access: interval and last send of the cycle */
	struct ec_access *access;
	/** @reset: the cycle owner sets the figures to zero and clears it; set by any caller */
	bool reset;
	/** @schedule: when an application that runs the cycle is expected to send */
	struct ec_schedule schedule;
};

void ec_late_forget(struct ec_status_cycle *st);
void ec_late_count(struct ec_late *l, s64 ns);
void ec_late_send(struct ec_late *l, u64 now);
void ec_late_work(struct ec_late *l, s64 ns);

#endif
