/* SPDX-License-Identifier: GPL-2.0-only */
/* How many of the acyclic frames that wait one cyclic send carries. */
#ifndef EC_SHARE_H
#define EC_SHARE_H

#include <linux/atomic.h>
#include <linux/types.h>

struct ec_carry;
struct ec_links;

/** struct ec_share - acyclic frames since the last cyclic send; owned by the cycle owner */
struct ec_share {
	/** @frames: sent */
	u32 frames;
	/** @wire_ns: wire time of them */
	u32 wire_ns;
	/** @clock_credit: clock frames that may be sent, 1/1000 */
	u32 clock_credit;
	/** @clocks: clock frames among @frames */
	u32 clocks;
	/** @was_urgent: the last one was urgent */
	bool was_urgent;
	/** @clock_last: the last one was a clock frame */
	bool clock_last;
	/** @late_per_s: cycles a second that acyclic frames may delay */
	u32 late_per_s;
	/** @late_next_ns: from this time on the next cycle may be delayed (ktime) */
	u64 late_next_ns;
	/** @late_cycles: cycles that acyclic frames have delayed since activation */
	u32 late_cycles;
};

#define EC_SHARE_PER_MS		8	/* acyclic frames per millisecond of cycle */
#define EC_SHARE_CLOCKS_PER_MS	2	/* clock frames among them */

extern unsigned int ec_share_max;	/* acyclic frames of one send: max_acyclic of the module */

/**
 * ec_share_begin() - a cyclic send begins: it may carry acyclic frames again
 * @share: of the links
 * @interval_us: of the cycle
 *
 * Short cycles carry a clock frame only now and then.
 *
 * Context: The cycle owner. RT-safe.
 */
static inline void ec_share_begin(struct ec_share *share, u32 interval_us)
{
	u32 more = interval_us * EC_SHARE_CLOCKS_PER_MS;

	share->frames = 0;
	share->clocks = 0;
	share->wire_ns = 0;
	share->clock_credit = min(share->clock_credit + more, max(more, 1000u));
}

u16 ec_share_clock_bytes(const struct ec_links *l);
void ec_share_send_left(struct ec_carry *c, u32 wire_ns);
void ec_share_send_between(struct ec_carry *c);

#endif
