// SPDX-License-Identifier: GPL-2.0-only
/*
 * The kernel cycle is synchronized to the reference clock: its frame has to pass
 * that clock at a configured time after the grid of the SYNC signals. The controller
 * (wire/dc_lock.c) gets the time of the clock when the frame passed it, less the
 * grid, as its error. So it also compensates the usual delay of thread and device,
 * and averages their jitter.
 */
#include <linux/ktime.h>
#include "../base/report.h"
#include "cycle.h"
#include "pll.h"
#include "../clock/dc_app.h"

/**
 * ec_pll_init() - reset the time of a cycle
 * @l: time of the cycle
 * @c: cycle with its @kernel
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_pll_init(struct ec_pll *l, const struct ec_cycle *c)
{
	memset(l, 0, sizeof(*l));
	l->follow = c->setup.kernel.dc & EC_CYCLE_DC_FOLLOW;
	l->phase = l->follow ? c->setup.kernel.phase_ns : 0;
	ec_dc_lock_init(&l->pi, c->setup.kernel.period_ns);
}

/* Application time of a cycle: whole periods after the last one. */
static void advance(struct ec_pll *l, u64 due, u64 epoch_ns)
{
	u64 last = l->past[(l->n_past - 1) % EC_PLL_PAST].due;
	u32 period = l->pi.period;

	if (!l->n_past)
		l->time = due + epoch_ns;
	else
		l->time += div_u64(due - last + period / 2, period) * period;
}

/* Application time of the cycle that sent a frame; false: too long ago. */
static bool origin(const struct ec_pll *l, u64 sent_ns, u64 *time)
{
	u32 i, n = min_t(u32, l->n_past, EC_PLL_PAST);

	for (i = 1; i <= n; i++) {
		u32 k = (l->n_past - i) % EC_PLL_PAST;

		if (l->past[k].due > sent_ns)
			continue;
		*time = l->past[k].time;
		return true;
	}
	return false;
}

/* Correct all times of the cycle by whole periods, ns. */
static void shift(struct ec_pll *l, s64 ns)
{
	u32 i;

	l->time += ns;
	for (i = 0; i < EC_PLL_PAST; i++)
		l->past[i].time += ns;
}

/* The phase error of the last cycle with a reply of the reference clock; false: no new reply. */
static bool measured(struct ec_pll *l, const struct ec_cycle *c, s32 *error)
{
	u64 time = 0, then;
	s64 ahead;

	if (!c->clock.time_ns || c->clock.time_ns == l->seen)
		return false;
	l->seen = c->clock.time_ns;
	if (!origin(l, c->clock.time_ns, &time))
		return false;
	then = c->clock.time - l->phase;
	ahead = (s64)(then - time);
	*error = ec_dc_lock_wrap(ahead, l->pi.period);
	if (ahead != *error)
		shift(l, ahead - *error);
	return true;
}

static void pll_publish(const struct ec_pll *l, struct ec_status_cycle *st)
{
	if (st->lock >= EC_CYCLE_LOCK_LOCKED && l->pi.state < EC_DC_LOCK_LOCKED)
		WRITE_ONCE(st->lock_losses, st->lock_losses + 1);
	WRITE_ONCE(st->lock, l->pi.state);
	WRITE_ONCE(st->phase_error, l->pi.error);
	WRITE_ONCE(st->rate_ppb, ec_dc_lock_ppb(&l->pi));
}

/**
 * ec_pll_step() - time of a cycle, and the correction for the next one
 * @l: time of the cycle
 * @c: active cycle, after its receive
 * @due: schedule of this cycle (ktime)
 * @epoch_ns: initial application time less ktime, ns
 *
 * Sets the application time of the clocks. @l->time is that of this cycle.
 *
 * Context: The cycle owner. RT-safe.
 * Return: what to add to the period until the next cycle, ns; at most 1/100 of
 * it.
 */
s32 ec_pll_step(struct ec_pll *l, struct ec_cycle *c, u64 due, u64 epoch_ns)
{
	u32 k = l->n_past % EC_PLL_PAST;
	s32 error, correction = 0;

	BUILD_BUG_ON(EC_CYCLE_LOCK_LOCKED != (int)EC_DC_LOCK_LOCKED);
	BUILD_BUG_ON(EC_CYCLE_LOCK_HOLD != (int)EC_DC_LOCK_HOLD);
	advance(l, due, epoch_ns);
	if (l->follow) {
		correction = measured(l, c, &error) ? ec_dc_lock_step(&l->pi, error) :
						      ec_dc_lock_miss(&l->pi);
		pll_publish(l, &c->shared->status->kernel);
	}
	l->past[k].due = due;
	l->past[k].time = l->time;
	/* 0 is the first cycle only */
	l->n_past = l->n_past + 1 ?: EC_PLL_PAST;
	ec_dc_app_time(c->dc, l->time, due - l->phase);
	return correction;
}

/**
 * ec_pll_log() - log changes of the lock; the cycle itself must not print
 * @c: active cycle
 *
 * Context: The monitor thread, lock of the configuration held.
 */
void ec_pll_log(struct ec_cycle *c)
{
	const struct ec_status_cycle *st = &c->shared->status->kernel;
	u32 lock = READ_ONCE(st->lock);

	lockdep_assert_held(c->wanted->lock);
	/* while clocks are measured no frame reads the reference clock */
	if (lock == c->watch.lock_logged ||
	    (lock == EC_CYCLE_LOCK_HOLD && ec_dc_busy(c->dc)))
		return;
	c->watch.lock_logged = lock;
	if (lock != EC_CYCLE_LOCK_OFF)
		ec_report(c->base, EC_EVENT_LOCK, lock, READ_ONCE(st->phase_error),
			  READ_ONCE(st->rate_ppb), !!READ_ONCE(st->lock_losses));
}
