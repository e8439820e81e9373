// SPDX-License-Identifier: GPL-2.0-only
/* Sources of input channels: constant, ramp, sine, output of a slave. */
#include "app.h"

/* sin(i * 90 degrees / 64) * 32767 */
static const s16 quarter[65] = {
	0, 804, 1608, 2410, 3212, 4011, 4808, 5602,
	6393, 7179, 7962, 8739, 9512, 10278, 11039, 11793,
	12539, 13279, 14010, 14732, 15446, 16151, 16846, 17530,
	18204, 18868, 19519, 20159, 20787, 21403, 22005, 22594,
	23170, 23731, 24279, 24811, 25329, 25832, 26319, 26790,
	27245, 27683, 28105, 28510, 28898, 29268, 29621, 29956,
	30273, 30571, 30852, 31113, 31356, 31580, 31785, 31971,
	32137, 32285, 32412, 32521, 32609, 32678, 32728, 32757,
	32767,
};

/* sine of phase @p, 65536 is a full turn; result -32767..32767 */
static s32 sine(u32 p)
{
	u32 q = p >> 14 & 3, x = p & 0x3FFF, i, f;
	s32 v;

	if (q & 1)
		x = 0x4000 - x;
	i = x >> 8;
	f = x & 0xFF;
	v = quarter[i];
	if (f)
		v += (quarter[i + 1] - quarter[i]) * (s32)f / 256;
	return q & 2 ? -v : v;
}

/* where in its period the source is at @now, 0..65535 */
static u32 phase(const struct ec_app_source *src, u64 now)
{
	u64 in;

	if (!src->period_ns)
		return 0;
	in = now - div64_u64(now, src->period_ns) * src->period_ns;
	/* keep the product within 64 bits: periods up to 78 hours */
	return (u32)div64_u64(in << 16, src->period_ns) & 0xFFFF;
}

/**
 * ec_app_source_value() - value of an input channel's source
 * @src: source
 * @now: time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the value.
 */
s64 ec_app_source_value(const struct ec_app_source *src, u64 now)
{
	switch (src->kind) {
	case EC_APP_SRC_CONST:
		return src->offset;
	case EC_APP_SRC_RAMP:
		return src->offset + src->amplitude * (s64)phase(src, now) / 65536;
	case EC_APP_SRC_SINE:
		return src->offset +
		       div64_s64(src->amplitude * sine(phase(src, now)), 32767);
	case EC_APP_SRC_LINK:
		return ec_app_channel(src->from, EC_APP_OUT, src->from_chan);
	default:
		return 0;
	}
}
