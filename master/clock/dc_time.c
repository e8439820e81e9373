// SPDX-License-Identifier: GPL-2.0-only
/* The time of the reference clock, by its replies. */
#include <linux/ktime.h>
#include "dc_time.h"

/**
 * ec_dc_clock() - take the time of a reply of the reference clock
 * @dc: clocks
 * @time: all 64 bits, ns
 * @at_ns: when it was that time (ktime)
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_clock(struct ec_dc *dc, u64 time, u64 at_ns)
{
	atomic64_set(&dc->ref_minus_ktime, time - at_ns);
}

/**
 * ec_dc_clock_predict() - take a predicted time while the reference clock does not reply
 * @dc: clocks
 * @time: from its last replies and its rate, ns
 * @at_ns: when it will be that time (ktime)
 *
 * Ignores a time that differs from the last one by 1 ms or more: the clocks were set again.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_clock_predict(struct ec_dc *dc, u64 time, u64 at_ns)
{
	if (abs((s64)(time - ec_dc_clock_at(dc, at_ns))) < NSEC_PER_MSEC)
		ec_dc_clock(dc, time, at_ns);
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
	return atomic64_read(&dc->ref_minus_ktime) + at_ns;
}

/**
 * ec_dc_clock_now() - time of the reference clock at this moment
 * @dc: clocks that are set
 *
 * From its last reply; the clock drifts since then.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns.
 */
u64 ec_dc_clock_now(struct ec_dc *dc)
{
	return ec_dc_clock_at(dc, ktime_get_ns());
}

/**
 * ec_dc_extend32() - add the upper half to the time of a clock with 32 bits
 * @dc: clocks that are set
 * @low: time of the clock
 * @at_ns: when (ktime)
 *
 * The upper half continues the time of the clocks since they were set. The application time may
 * differ by any number of seconds by now.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: all 64 bits, ns.
 */
u64 ec_dc_extend32(struct ec_dc *dc, u32 low, u64 at_ns)
{
	u64 about = ec_dc_clock_at(dc, at_ns);

	return about + (s32)(low - (u32)about);
}
