// SPDX-License-Identifier: GPL-2.0-only
/* The time of the reference clock, as its answers show it. */
#include <linux/ktime.h>
#include "dc.h"

/**
 * ec_dc_clock() - the reference clock has told its time
 * @dc: clocks
 * @time: all of it, ns
 * @at_ns: when it was that time (ktime)
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_clock(struct ec_dc *dc, u64 time, u64 at_ns)
{
	atomic64_set(&dc->ahead, time - at_ns);
}

/**
 * ec_dc_clock_at() - time of the reference clock at a moment
 * @dc: clocks that are set
 * @at_ns: the moment (ktime)
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns.
 */
u64 ec_dc_clock_at(struct ec_dc *dc, u64 at_ns)
{
	return atomic64_read(&dc->ahead) + at_ns;
}

/**
 * ec_dc_clock_now() - time of the reference clock at this moment
 * @dc: clocks that are set
 *
 * By what it was last; it drifts.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns.
 */
u64 ec_dc_clock_now(struct ec_dc *dc)
{
	return ec_dc_clock_at(dc, ktime_get_ns());
}

/**
 * ec_dc_whole() - time of a clock with 32 bits
 * @dc: clocks that are set
 * @low: what the clock says
 * @at_ns: when (ktime)
 *
 * The rest is that of the time the clocks have gone through since they were set. The
 * application's time may be any number of seconds away by now.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: all 64 bits, ns.
 */
u64 ec_dc_whole(struct ec_dc *dc, u32 low, u64 at_ns)
{
	u64 about = ec_dc_clock_at(dc, at_ns);

	return about + (s32)(low - (u32)about);
}
