/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* Controller that lets a cycle follow the reference clock; times in ns. */
#ifndef EC_WIRE_DC_LOCK_H
#define EC_WIRE_DC_LOCK_H

#include "env.h"

enum ec_dc_lock_state {
	EC_DC_LOCK_OFF,		/* no error is known yet */
	EC_DC_LOCK_SEEK,	/* adjusts period and phase */
	EC_DC_LOCK_LOCKED,	/* period and phase are those of the reference */
	EC_DC_LOCK_HOLD,	/* was locked, no error is known; keeps the rate */
};

#define EC_DC_LOCK_SLEW		100	/* a correction is at most 1/100 of the period */
#define EC_DC_LOCK_RATE		1000	/* the rate differs by at most 1/1000 */
#define EC_DC_LOCK_GOOD		100	/* that many cycles in a row make it locked */
#define EC_DC_LOCK_MISSING	100	/* that many without error make it hold */

/**
 * struct ec_dc_lock - the controller
 * @period: of the cycle
 * @rate: correction of every cycle that keeps the rate, 2^-16 ns
 * @rest: what rounding has left of corrections, 2^-16 ns
 * @last: last errors, the newest first; not wrapped
 * @n_last: how many there are
 * @error: median of them; positive: the cycle is late
 * @good: cycles in a row with a small error
 * @bad: cycles in a row with a large one, while locked
 * @missing: cycles in a row without
 * @state: enum ec_dc_lock_state
 */
struct ec_dc_lock {
	u32 period;
	s64 rate;
	s64 rest;
	s64 last[3];
	u8 n_last;
	s32 error;
	u32 good;
	u32 bad;
	u32 missing;
	u8 state;
};

void ec_dc_lock_init(struct ec_dc_lock *l, u32 period);
s32 ec_dc_lock_step(struct ec_dc_lock *l, s32 error);
s32 ec_dc_lock_miss(struct ec_dc_lock *l);
s32 ec_dc_lock_wrap(s64 difference, u32 period);
s32 ec_dc_lock_ppb(const struct ec_dc_lock *l);

#endif
