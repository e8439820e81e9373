/* SPDX-License-Identifier: GPL-2.0-only */
/* A limit of uevents for each place where slaves come and go. */
#ifndef EC_UEVENT_RATE_H
#define EC_UEVENT_RATE_H

#include <linux/types.h>

#define EC_UEVENT_RATE	32	/* uevents of a place in any second */

/** struct ec_uevent_rate - uevents of a place */
struct ec_uevent_rate {
	/** @second: of the last one (ktime) */
	u32 second;
	/** @now: uevents in it */
	u8 now;
	/** @before: in the second before */
	u8 before;
};

/**
 * ec_uevent_rate_admit() - may a change have a uevent?
 * @r: of its place, initially zeroed
 * @second: time (ktime), s
 *
 * Two seconds of the clock have no more than the limit, so no second between them has more.
 *
 * Context: Any, one caller at a time.
 * Return: whether it may.
 */
static inline bool ec_uevent_rate_admit(struct ec_uevent_rate *r, u32 second)
{
	if (r->second != second) {
		r->before = r->second + 1 == second ? r->now : 0;
		r->now = 0;
		r->second = second;
	}
	if (r->now + r->before >= EC_UEVENT_RATE)
		return false;
	r->now++;
	return true;
}

#endif
