// SPDX-License-Identifier: GPL-2.0-only
/*
 * The application's time: what the clocks are set to, and what the reference clock
 * follows if it shall.
 *
 * Once the clocks are set, SYNC signals run by them, so they never jump. What is
 * told has to go on as the machine's clock does. A time that is off for some
 * cycles is ignored; one that stays off has jumped (it was set, or the application
 * was held up and counts cycles), and is followed without the jump. So frames keep
 * their place between the SYNC signals. The log tells both.
 */
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include <linux/sort.h>
#include "ethercat_map.h"
#include "../link/links.h"
#include "dc.h"
#include "../base/once64.h"

#define EPOCH_2000_NS	(946684800ULL * NSEC_PER_SEC)
#define STAYS		16	/* cycles that must agree until it is a jump */
#define LIMIT_MIN_NS	(100 * NSEC_PER_USEC)
#define TELL_NS		(100 * (s64)NSEC_PER_MSEC)	/* no cycle is that late */
#define LOG_NS		(10 * (u64)NSEC_PER_SEC)
#define HELD_NS		((u64)NSEC_PER_SEC)	/* a hold that lasts so long is told */
#define LEAD_NS		(2 * (u64)NSEC_PER_SEC)	/* without leading: it is over */

/* More than that is no lateness of a cycle, and would take SYNC to another one. */
static s64 limit(const struct ec_dc *dc)
{
	u32 interval_us = ec_access_interval_us(&dc->links->access);

	return max_t(s64, interval_us * (NSEC_PER_USEC / 2), LIMIT_MIN_NS);
}

/* It may have been told long ago; two clocks differ by less than 244 ppm. */
static s64 drift(u64 since_ns, u64 at_ns)
{
	return max_t(s64, at_ns - since_ns, 0) >> 12;
}

/* off by @dev: true when it has been so for long enough, then @dev is the mean */
static bool stays(struct ec_dc_app *a, s64 *dev, u64 at_ns, s64 lim)
{
	if (!a->odd || abs(*dev - a->first) > lim + drift(a->first_ns, at_ns)) {
		a->odd = 0;
		a->first = *dev;
		a->first_ns = at_ns;
		a->sum = 0;
	}
	a->sum += *dev - a->first;
	if (++a->odd < STAYS)
		return false;
	*dev = a->first + div_s64(a->sum, STAYS);
	return true;
}

/* The mean of about 8 cycles; of what is told less often, the last. */
static void approach(struct ec_dc_app *a, s64 dev, u64 at_ns, s64 lim)
{
	s64 since = at_ns - a->base_ns, span = 16 * lim;

	if (since > 0)
		a->base += since < span ? div64_s64(dev * since, span) : dev;
	a->base_ns = at_ns;
}

/* A time of the set clocks; false: it is not to be used. */
static bool follow(struct ec_dc_app *a, u64 time, u64 at_ns, s64 lim)
{
	s64 dev = time - a->skip - at_ns - a->base;

	a->off = dev;
	if (abs(dev) <= lim + drift(a->base_ns, at_ns)) {
		approach(a, dev, at_ns, lim);
		a->odd = 0;
		return true;
	}
	if (abs(dev) > TELL_NS) {
		a->ignored++;
		a->ignored_ns = dev;
	}
	if (!stays(a, &dev, at_ns, lim))
		return false;
	a->base_ns = a->first_ns;
	a->ignored -= min(a->ignored, a->odd);
	a->odd = 0;
	a->skip += dev;
	a->jumps++;
	a->jump_ns = dev;
	return true;
}

/* Before they are set any time will do; the last ones are remembered. */
static void note(struct ec_dc_app *a, u64 time, u64 at_ns)
{
	a->base = time - at_ns;
	a->base_ns = at_ns;
	a->past[a->n_past++ % EC_DC_APP_PAST] = a->base;
}

/*
 * Whether the application leads the clocks; @now: with this send. It may do so in few
 * cycles, or no longer: then its other time counts again.
 */
static bool leading(struct ec_dc *dc, bool now, u64 at_ns)
{
	u64 gap = at_ns - dc->led_ns;

	lockdep_assert_held(&dc->time_lock);
	if (now) {
		dc->led_gap = dc->led_ns ? gap : 0;
		dc->led_ns = at_ns;
		dc->leads = true;
	} else if (gap > clamp(4 * dc->led_gap, LEAD_NS, 30 * LEAD_NS)) {
		dc->leads = false;
	}
	return dc->leads;
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
 * ec_dc_app_time() - a time that cannot jump: before activation, or the kernel's
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
	dc->told = true;
	ec_write64(&dc->app_time, app_time);
	ec_write64(&dc->app_ktime, at_ns);
	dc->app.n_past = 0;
	dc->app.base = app_time - at_ns;
	dc->app.base_ns = at_ns;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
}

/**
 * ec_dc_told() - the application tells its time with a send
 * @dc: clocks
 * @what: flags (at least one of the times), @app_time and @sync_time; any value
 * @skip: result: jumps of that time, to be taken off
 *
 * An application that leads the clocks means the time it wants to be written: of
 * that its other time only gives the upper half.
 *
 * Context: Cycle owner. RT-safe.
 * Return: true when the time is off: it must not be written to the reference clock.
 */
bool ec_dc_told(struct ec_dc *dc, const struct ec_ioc_send *what, u64 *skip)
{
	bool leads = what->flags & EC_SEND_FLAG_SYNC_REF, good = true;
	unsigned long flags;
	u64 time, at_ns;

	at_ns = ktime_get_ns();
	raw_spin_lock_irqsave(&dc->time_lock, flags);
	if (what->flags & EC_SEND_FLAG_APP_TIME)
		time = what->app_time;
	else
		time = dc->has_phase ? dc->app_time + (at_ns - dc->app_ktime) : what->sync_time;
	set_phase(dc, time);
	dc->told = true;
	ec_write64(&dc->app_time, time);
	ec_write64(&dc->app_ktime, at_ns);
	if (leads)
		time += (s32)((u32)what->sync_time - (u32)time);
	/* the one that is written counts, though it may be told less often */
	if (leading(dc, leads, at_ns) == leads) {
		if (dc->app.set)
			good = follow(&dc->app, time, at_ns, limit(dc));
		else
			note(&dc->app, time, at_ns);
	}
	*skip = dc->app.skip;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
	return leads && !good;
}

/**
 * ec_dc_now() - the application's time at this moment
 * @dc: clocks
 *
 * Without the jumps it has made since the clocks were set.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns; without an application the time since 2000-01-01.
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
 * ec_dc_app_at() - the application's time, as clocks are set to it
 * @dc: clocks
 * @at_ns: when (ktime)
 *
 * The median of its last cycles: each may be late.
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
	return past[n / 2] + at_ns;
}

/**
 * ec_dc_app_set() - the clocks are set, or no longer
 * @dc: clocks
 * @base: the time they were set to, less ktime
 * @set: from now on they shall not jump
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
		a->n_past = 0;	/* from now on follow() keeps @base true */
	} else if (!set) {
		a->n_past = 0;
		a->skip = 0;
		a->odd = 0;
		a->jumps = 0;
		a->ignored = 0;
		a->log_ns = 0;
		dc->leads = false;
		dc->led_ns = 0;
	}
	a->set = set;
	raw_spin_unlock_irqrestore(&dc->time_lock, flags);
}

/**
 * ec_dc_app_log() - tell jumps of the application's time; the cycle cannot
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
	ignored = a->odd ? 0 : a->ignored;	/* it is not clear yet which it is */
	if (a->odd && (s64)(now - a->base_ns) > (s64)HELD_NS)
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
