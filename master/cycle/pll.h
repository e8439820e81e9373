/* SPDX-License-Identifier: GPL-2.0-only */
/* A kernel cycle that is synchronized to the reference clock. */
#ifndef EC_PLL_H
#define EC_PLL_H

#include <linux/types.h>
#include "../wire/dc_lock.h"

struct ec_cycle;

#define EC_PLL_PAST	8	/* a frame may be in flight for that many cycles */

/** struct ec_pll - time of a cycle; the thread's own */
struct ec_pll {
	/** @follow: the cycle is synchronized to the reference clock, not only to its own timer */
	bool follow;
	/** @phase: begin of a cycle after the grid of the SYNC signals, ns */
	u32 phase;
	/** @time: application time of the last cycle, ns: a point of that grid */
	u64 time;
	/** @seen: send of the last frame that has brought a time (ktime) */
	u64 seen;
	/** @past: the last cycles */
	struct {
		/** @past.due: schedule */
		u64 due;
		/** @past.time: application time */
		u64 time;
	} past[EC_PLL_PAST];
	/** @n_past: cycles so far */
	u32 n_past;
	/** @pi: controller */
	struct ec_dc_lock pi;
};

void ec_pll_init(struct ec_pll *l, const struct ec_cycle *c);
s32 ec_pll_step(struct ec_pll *l, struct ec_cycle *c, u64 due, u64 epoch_ns);
void ec_pll_log(struct ec_cycle *c);

#endif
