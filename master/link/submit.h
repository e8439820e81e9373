/* SPDX-License-Identifier: GPL-2.0-only */
/* An acyclic frame is sent, or queued for the cycle, and its caller waits. */
#ifndef EC_SUBMIT_H
#define EC_SUBMIT_H

#include "access.h"

/** struct ec_submit_wait - wait of a caller for acyclic frames */
struct ec_submit_wait {
	/** @clock: they are of ec_xfer_clock() */
	bool clock;
	/** @mode: bus access when the wait began */
	enum ec_access_mode mode;
	/** @turns: cycles of the timeout */
	u32 turns;
	/** @began_ns: when that was (ktime) */
	u64 began_ns;
	/** @turn_ns: until when they may be in the queue (ktime) */
	u64 turn_ns;
	/** @timeout_us: how long it lasts once they have left */
	u32 timeout_us;
	/** @polls: receives of the cycle when the frames were handed over */
	u32 polls;
};

int ec_submit(struct ec_links *l, struct ec_slot *slot, bool urgent);
void ec_submit_wait_begin(const struct ec_links *l, struct ec_submit_wait *w);
bool ec_submit_wait_turn(struct ec_links *l, const struct ec_submit_wait *w);
bool ec_submit_wait_more(struct ec_links *l, const struct ec_submit_wait *w);

#endif
