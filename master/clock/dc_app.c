// SPDX-License-Identifier: GPL-2.0-only
/*
 * The application time: the clocks are set to it, and the reference clock is synchronized to it
 * if the application wants so.
 *
 * Once the clocks are set, SYNC signals run by them, so they never jump. The application time
 * has to advance with CLOCK_MONOTONIC. An error in some cycles is ignored. An error that stays
 * is a jump (the time was set, or the application counts cycles and was stopped): the clocks
 * follow the time without the jump, so frames keep their place between the SYNC signals. Both
 * are logged.
 */
#include <linux/ktime.h>
#include <linux/log2.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include <linux/sort.h>
#include "ethercat_map.h"
#include "../link/links.h"
#include "dc_app.h"
#include "../base/once64.h"

#define EPOCH_2000_NS	(946684800ULL * NSEC_PER_SEC)
#define STAYS		16	/* cycles that must agree until it is a jump */
#define LIMIT_MIN_NS	(100 * NSEC_PER_USEC)
#define ERROR_NS	(100 * (s64)NSEC_PER_MSEC)	/* no cycle is that late */
#define LOG_NS		(10 * (u64)NSEC_PER_SEC)
#define HELD_NS		((u64)NSEC_PER_SEC)	/* a longer error is logged */
#define MEAN_SENDS	512	/* times whose mean the reference clock is given */
#define SPREAD_SENDS	64	/* for their usual deviation */
#define PART_BITS	16	/* of a ns */
#define LEAD_NS		(2 * (u64)NSEC_PER_SEC)	/* without its time: it leads no longer */

/* A larger deviation is not that of a delayed cycle, and would move SYNC to another cycle. */
static s64 dc_app_limit(const struct ec_dc *dc)
{
	u32 interval_us = ec_access_interval_us(&dc->links->access);

	return max_t(s64, interval_us * (NSEC_PER_USEC / 2), LIMIT_MIN_NS);
}

/* Since the last time, perhaps long ago; two clocks differ by less than 244 ppm. */
static s64 drift(u64 since_ns, u64 at_ns)
{
	return max_t(s64, at_ns - since_ns, 0) >> 12;
}

/* A deviation of @dev: true when it has stayed for STAYS cycles; @dev is the mean then. */
static bool stays(struct ec_dc_app *a, s64 *dev, u64 at_ns, s64 lim)
{
	if (!a->deviating || abs(*dev - a->first) > lim + drift(a->first_ns, at_ns)) {
		a->deviating = 0;
		a->first = *dev;
		a->first_ns = at_ns;
		a->sum = 0;
	}
	a->sum += *dev - a->first;
	if (++a->deviating < STAYS)
		return false;
	*dev = a->first + div_s64(a->sum, STAYS);
	return true;
}

/* The mean of about 8 cycles; the last one if the time comes less often. */
static void approach(struct ec_dc_app *a, s64 dev, u64 at_ns, s64 lim)
{
	s64 since = at_ns - a->base_ns, span = 16 * lim;

	if (since > 0)
		a->base += since < span ? div64_s64(dev * since, span) : dev;
	a->base_ns = at_ns;
}

/*
 * The mean of many cycles, and the rate: the reference clock is given this time, so that
 * neither the jitter of the application nor single delayed cycles move it, and all slaves
 * with it. Initially the mean is of few cycles, so it adapts fast. A deviation counts as
 * four times the usual one at most.
 */
static void smooth(struct ec_dc_app *a, s64 dev)
{
	s64 limit = 4 * (s64)a->spread + NSEC_PER_USEC, total;
	unsigned int shift;

	if (a->n_mean < MEAN_SENDS)
		a->n_mean++;
	shift = ilog2(a->n_mean);
	dev = clamp_t(s64, dev + a->base - a->mean, -limit, limit);
	a->spread += (s32)(min_t(s64, abs(dev), S32_MAX) - a->spread) / SPREAD_SENDS;
	total = a->mean_part + (dev << PART_BITS >> shift) + a->mean_rate;
	a->mean += total >> PART_BITS;
	a->mean_part = total & (BIT(PART_BITS) - 1);
	a->mean_rate += dev << PART_BITS >> (2 * shift + 2);
}

/* An application time after the clocks are set; false: it must not be used. */
static bool dc_app_follow(struct ec_dc_app *a, u64 time, u64 at_ns, s64 lim)
{
	s64 dev = time - a->skip - at_ns - a->base;

	a->off = dev;
	if (abs(dev) <= lim + drift(a->base_ns, at_ns)) {
		smooth(a, dev);
		approach(a, dev, at_ns, lim);
		a->deviating = 0;
		return true;
	}
	if (abs(dev) > ERROR_NS) {
		a->ignored++;
		a->ignored_ns = dev;
	}
	if (!stays(a, &dev, at_ns, lim))
		return false;
	a->base_ns = a->first_ns;
	a->ignored -= min(a->ignored, a->deviating);
	a->deviating = 0;
	a->skip += dev;
	a->jumps++;
	a->jump_ns = dev;
	return true;
}

/* Before they are set any time is valid; keep the last ones. */
static void note(struct ec_dc_app *a, u64 time, u64 at_ns)
{
	a->base = time - at_ns;
	a->base_ns = at_ns;
	a->past[a->n_past++ % EC_DC_APP_PAST] = a->base;
}

/*
 * Is the application the time reference? @now: with this send. It may write its time in few
 * cycles, or no longer: then its other time is valid again.
 */
static bool leading(struct ec_dc *dc, bool now, u64 at_ns)
{
	u64 gap = at_ns - dc->led_ns;

	lockdep_assert_held(&dc->time_lock);
	if (now) {
		dc->led_gap = dc->led_ns ? gap : 0;
		dc->led_ns = at_ns;
		dc->app_leads = true;
	} else if (gap > clamp(4 * dc->led_gap, LEAD_NS, 30 * LEAD_NS)) {
		dc->app_leads = false;
	}
	return dc->app_leads;
}

static void set_phase(struct ec_dc *dc, u64 app_time)
{
	lockdep_assert_held(&dc->time_lock);
	if (dc->has_phase || !app_time)
		return;
	dc->phase = app_time;
	dc->has_phase = true;
}

/**
 * ec_dc_app_time() - set a time that cannot jump: before activation, or of a kernel cycle
 * @dc: clocks
 * @app_time: ns
 * @at_ns: when it was, or will be, that time (ktime)
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_app_time(struct ec_dc *dc, u64 app_time, u64 at_ns)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	set_phase(dc, app_time);
	dc->app_time_seen = true;
	ec_write64(&dc->app_time, app_time);
	ec_write64(&dc->app_ktime, at_ns);
	dc->app.n_past = 0;
	dc->app.base = app_time - at_ns;
	dc->app.base_ns = at_ns;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
}

/**
 * ec_dc_app_forget() - forget the application time and the phase of SYNC
 * @dc: clocks whose SYNC signals are not started
 *
 * At the end of a session, and before a cycle of the kernel, which has its own time.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_dc_app_forget(struct ec_dc *dc)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	dc->has_phase = false;
	ec_write64(&dc->app_time, 0);
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
}

/**
 * ec_dc_update_app_time() - take the application time of a send
 * @dc: clocks
 * @what: flags (at least one of the times), @app_time and @sync_time; any value
 * @lead: result: the time for the reference clock less ktime: the mean of that time, without jumps
 *
 * If the application is the time reference, the time to be written is valid; its other time
 * only has the upper half.
 *
 * Context: Cycle owner. RT-safe.
 * Return: true when the time deviates, or the clocks are not set: it must not be written to the
 * reference clock.
 */
bool ec_dc_update_app_time(struct ec_dc *dc, const struct ec_ioc_send *what, u64 *lead)
{
	bool leads = what->flags & EC_SEND_FLAG_SYNC_REF, good;
	unsigned long flags;
	u64 time, at_ns;

	at_ns = ktime_get_ns();
	raw_spin_lock_irqsave(&dc->time_lock, flags);
	if (what->flags & EC_SEND_FLAG_APP_TIME)
		time = what->app_time;
	else
		time = dc->app_time ? dc->app_time + (at_ns - dc->app_ktime) : what->sync_time;
	set_phase(dc, time);
	dc->app_time_seen = true;
	ec_write64(&dc->app_time, time);
	ec_write64(&dc->app_ktime, at_ns);
	if (leads)
		time += (s32)((u32)what->sync_time - (u32)time);
	/* the written time is valid, even if it comes less often */
	good = dc->app.set;
	if (leading(dc, leads, at_ns) == leads) {
		if (dc->app.set)
			good = dc_app_follow(&dc->app, time, at_ns, dc_app_limit(dc));
		else
			note(&dc->app, time, at_ns);
	}
	*lead = dc->app.mean;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	return leads && !good;
}

/**
 * ec_dc_phase() - a point of the grid on which SYNC starts
 * @dc: clocks
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: first application time of the session, ns; 0 without one when the clocks were set.
 */
u64 ec_dc_phase(struct ec_dc *dc)
{
	unsigned long flags;
	u64 phase;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	phase = dc->has_phase ? dc->phase : 0;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	return phase;
}

/**
 * ec_dc_now() - the application's time at this moment
 * @dc: clocks
 *
 * Without its jumps since the clocks were set.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns; without an application time the time since 2000-01-01.
 */
u64 ec_dc_now(struct ec_dc *dc)
{
	unsigned long flags;
	u64 t;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	t = dc->has_phase ? dc->app.base + ktime_get_ns() :
	    ktime_get_real_ns() - EPOCH_2000_NS;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	return t;
}

static int later(const void *a, const void *b)
{
	s64 d = *(const u64 *)a - *(const u64 *)b;

	return d < 0 ? -1 : d > 0;
}

/**
 * ec_dc_app_at() - the application time that clocks are set to
 * @dc: clocks
 * @at_ns: when (ktime)
 *
 * The median of its last cycles, since each may be late.
 *
 * Context: Process.
 * Return: ns; without an application the time since 2000-01-01.
 */
u64 ec_dc_app_at(struct ec_dc *dc, u64 at_ns)
{
	struct ec_dc_app *a = &dc->app;
	u64 past[EC_DC_APP_PAST];
	unsigned long flags;
	u32 n;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	n = dc->has_phase ? min_t(u32, a->n_past, EC_DC_APP_PAST) : 0;
	memcpy(past, a->past, sizeof(past));
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	if (!n)
		return ec_dc_now(dc) - (ktime_get_ns() - at_ns);
	sort(past, n, sizeof(*past), later, NULL);
	WRITE_ONCE(a->spread, min_t(u64, past[n * 3 / 4] - past[n / 4], S32_MAX));
	return past[n / 2] + at_ns;
}

/**
 * ec_dc_app_set() - note that the clocks are set, or no longer
 * @dc: clocks
 * @base: the time they were set to, less ktime
 * @set: they must not jump from now on
 *
 * Context: Process.
 */
void ec_dc_app_set(struct ec_dc *dc, u64 base, bool set)
{
	struct ec_dc_app *a = &dc->app;
	unsigned long flags;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	if (set && !a->set) {
		a->base = base;
		a->base_ns = ktime_get_ns();
		a->mean = base;
		a->mean_part = 0;
		a->mean_rate = 0;
		a->n_mean = min_t(u32, a->n_past, EC_DC_APP_PAST);
		a->n_past = 0;	/* from now on dc_app_follow() updates @base */
		/* later application times do not move the SYNC grid of slaves that connect later */
		if (!dc->has_phase)
			dc->phase = 0;
		dc->has_phase = true;
	} else if (!set) {
		a->n_past = 0;
		a->spread = 0;
		a->skip = 0;
		a->deviating = 0;
		a->jumps = 0;
		a->ignored = 0;
		a->log_ns = 0;
		dc->app_leads = false;
		dc->led_ns = 0;
	}
	a->set = set;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
}

/**
 * ec_dc_app_due() - may ec_dc_app_log() have something to log?
 * @dc: clocks
 *
 * Context: Any. RT-safe.
 * Return: whether it may, or has to wait until its last message is old enough.
 */
bool ec_dc_app_due(const struct ec_dc *dc)
{
	const struct ec_dc_app *a = &dc->app;

	return READ_ONCE(a->jumps) || READ_ONCE(a->ignored) || READ_ONCE(a->deviating);
}

/**
 * ec_dc_app_log() - log jumps of the application time, which the cycle cannot
 * @dc: clocks
 *
 * At most once in 10 s.
 *
 * Context: The monitor thread.
 */
void ec_dc_app_log(struct ec_dc *dc)
{
	struct ec_dc_app *a = &dc->app;
	u64 now = ktime_get_ns(), held = 0;
	u32 jumps, ignored;
	unsigned long flags;
	s64 jump, single, off;

	raw_spin_lock_irqsave(&dc->time_lock, flags);
	jumps = a->jumps;
	ignored = a->deviating ? 0 : a->ignored;	/* it may become a jump */
	if (a->deviating && (s64)(now - a->base_ns) > (s64)HELD_NS)
		held = now - a->base_ns;
	jump = a->jump_ns;
	single = a->ignored_ns;
	off = a->off;
	if ((!jumps && !ignored && !held) || now < a->log_ns) {
		raw_spin_unlock_irqrestore(&dc->time_lock, flags);
		return;
	}
	a->jumps = 0;
	if (ignored || held)
		a->ignored = 0;
	a->log_ns = now + LOG_NS;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	if (jumps)
		ec_warn(dc,
			"application time jumped by %lld ns (%u since the last message); clocks and SYNC signals continue without it\n",
			jump, jumps);
	if (ignored)
		ec_warn(dc, "application time: %u isolated error(s), last %lld ns, ignored\n",
			ignored, single);
	if (held)
		ec_warn(dc, "application time off by %lld ns for %llu ms, ignored\n",
			off, div_u64(held, NSEC_PER_MSEC));
}
