// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
/*
 * A PI controller. Its input is how much later than wanted a cycle was, by the
 * reference clock; its output makes the next one come earlier or later. While
 * it seeks it is fast; once locked it is four times slower and averages the
 * jitter of sends. The median of three keeps a single late frame out.
 */
#include "dc_lock.h"

#define FRACTION	16	/* bits */
/* gains as shifts: P and I while seeking, P and I while locked; I = P^2 / 8 */
#define SEEK_P		3
#define SEEK_I		9
#define LOCKED_P	5
#define LOCKED_I	13
#define LIMIT_SHIFT	6	/* locked: error below 1/64 of the period */
#define LOST_SHIFT	3	/* lost: above 1/8 of it */
#define LOST_CYCLES	8

/**
 * ec_dc_lock_init() - reset the controller
 * @l: controller
 * @period: of the cycle, ns, 1000..1000000000
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_lock_init(struct ec_dc_lock *l, u32 period)
{
	memset(l, 0, sizeof(*l));
	l->period = period;
}

static s64 limited(s64 v, s64 limit)
{
	return v > limit ? limit : v < -limit ? -limit : v;
}

/**
 * ec_dc_lock_wrap() - distance to the nearest multiple of a period
 * @difference: ns
 * @period: ns, not 0
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: -@period/2 .. @period/2, ns.
 */
s32 ec_dc_lock_wrap(s64 difference, u32 period)
{
	u64 magnitude = difference < 0 ? 0 - (u64)difference : (u64)difference;
	u32 rest = (u32)(magnitude - div_u64(magnitude, period) * period);
	s32 near = rest > period / 2 ? (s32)(rest - period) : (s32)rest;

	return difference < 0 ? -near : near;
}

static s64 dc_lock_median(const s64 v[3])
{
	s64 low = min(v[0], v[1]), high = max(v[0], v[1]);

	return v[2] < low ? low : v[2] > high ? high : v[2];
}

/*
 * Half a period early is half a period late. Near that point the direction
 * once taken is kept, so that noise does not turn it over and over.
 */
static s64 unwrap(const struct ec_dc_lock *l, s64 error)
{
	if (l->n_last && error - l->last[0] > l->period / 2)
		error -= l->period;
	else if (l->n_last && l->last[0] - error > l->period / 2)
		error += l->period;
	if (error > l->period / 4 * 3LL || error < -(l->period / 4 * 3LL))
		error = ec_dc_lock_wrap(error, l->period);
	return error;
}

/* the new error among the last three */
static void remember(struct ec_dc_lock *l, s64 error)
{
	error = unwrap(l, error);
	l->last[2] = l->last[1];
	l->last[1] = l->last[0];
	l->last[0] = error;
	if (l->n_last < 3)
		l->n_last++;
	l->error = (s32)(l->n_last == 3 ? dc_lock_median(l->last) : error);
}

static void dc_lock_judge(struct ec_dc_lock *l)
{
	u32 magnitude = l->error < 0 ? -(u32)l->error : (u32)l->error;

	l->good = magnitude < l->period >> LIMIT_SHIFT ? l->good + 1 : 0;
	l->bad = magnitude > l->period >> LOST_SHIFT ? l->bad + 1 : 0;
	if (l->state == EC_DC_LOCK_HOLD)
		l->state = l->good ? EC_DC_LOCK_LOCKED : EC_DC_LOCK_SEEK;
	else if (l->state != EC_DC_LOCK_LOCKED)
		l->state = l->good >= EC_DC_LOCK_GOOD ? EC_DC_LOCK_LOCKED : EC_DC_LOCK_SEEK;
	else if (l->bad >= LOST_CYCLES)
		l->state = EC_DC_LOCK_SEEK;
}

/* Whole ns of a correction; the rest is kept for the next. */
static s32 whole(struct ec_dc_lock *l, s64 correction)
{
	s64 sum = correction + l->rest, ns = sum >> FRACTION;

	l->rest = sum - ns * (1 << FRACTION);
	return (s32)ns;
}

/**
 * ec_dc_lock_step() - a cycle with a known error
 * @l: controller
 * @error: how late the last cycle was by the reference clock, as from
 *	ec_dc_lock_wrap(), ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what to add to the period until the next cycle, ns; at most 1/100 of
 * the period.
 */
s32 ec_dc_lock_step(struct ec_dc_lock *l, s32 error)
{
	s64 slew = div_s64((s64)l->period << FRACTION, EC_DC_LOCK_SLEW);
	s64 fast = div_s64((s64)l->period << FRACTION, EC_DC_LOCK_RATE);
	s64 e, p, sum;
	bool locked;

	l->missing = 0;
	remember(l, error);
	dc_lock_judge(l);
	locked = l->state == EC_DC_LOCK_LOCKED;
	e = (s64)l->error * (1 << FRACTION);
	p = e >> (locked ? LOCKED_P : SEEK_P);
	sum = -p + l->rate;
	/* far away the error says nothing of the rate */
	if (sum < slew && sum > -slew)
		l->rate = limited(l->rate - (e >> (locked ? LOCKED_I : SEEK_I)), fast);
	return whole(l, limited(sum, slew));
}

/**
 * ec_dc_lock_miss() - a cycle without known error: its frame is not back
 * @l: controller
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: as ec_dc_lock_step(); the rate is kept.
 */
s32 ec_dc_lock_miss(struct ec_dc_lock *l)
{
	if (l->state == EC_DC_LOCK_OFF)
		return 0;
	if (++l->missing >= EC_DC_LOCK_MISSING) {
		l->missing = EC_DC_LOCK_MISSING;
		if (l->state == EC_DC_LOCK_LOCKED)
			l->state = EC_DC_LOCK_HOLD;
		l->n_last = 0;
		l->good = 0;
		l->bad = 0;
	}
	return whole(l, l->rate);
}

/**
 * ec_dc_lock_ppb() - how much faster than the local clock the cycle runs
 * @l: controller
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 1e-9.
 */
s32 ec_dc_lock_ppb(const struct ec_dc_lock *l)
{
	return (s32)(div_s64(-l->rate * 1000000, (s32)l->period) * 1000 / (1 << FRACTION));
}
