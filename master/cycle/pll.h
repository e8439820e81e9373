/* SPDX-License-Identifier: GPL-2.0-only */
/* A kernel cycle that is synchronized to the reference clock. */
#ifndef EC_PLL_H
#define EC_PLL_H

#include <linux/types.h>
#include "../wire/dc_lock.h"

struct ec_cycle;

#define EC_PLL_PAST	8	/* a frame may be in flight for that many cycles */

/**
 * struct ec_pll - time of a cycle; the thread's own
 * @follow: the cycle is synchronized to the reference clock, not only to its own timer
 * @phase: begin of a cycle after the grid of the SYNC signals, ns
 * @time: application time of the last cycle, ns: a point of that grid
 * @seen: send of the last frame that has brought a time (ktime)
 * @past: schedules of the last cycles and their application times
 * @n_past: cycles so far
 * @pi: controller
 */
struct ec_pll {
	bool follow;
	u32 phase;
	u64 time;
	u64 seen;
	struct {
		u64 due;
		u64 time;
	} past[EC_PLL_PAST];
	u32 n_past;
	struct ec_dc_lock pi;
};

void ec_pll_init(struct ec_pll *l, const struct ec_cycle *c);
s32 ec_pll_step(struct ec_pll *l, struct ec_cycle *c, u64 due, u64 epoch_ns);
void ec_pll_log(struct ec_cycle *c);

#endif
