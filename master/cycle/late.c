// SPDX-License-Identifier: GPL-2.0-only
/*
 * Histogram of the distance of each send from its schedule: one count, one sum,
 * one least and one most a cycle, in the status page. Only the cyclic caller
 * writes there; a caller that resets the figures only sets a flag.
 *
 * The schedule of a cycle the kernel runs is its timer. An application sets
 * its interval but not when it begins, so its schedule is a grid of that
 * interval which follows the sends, by no more than 1/1024 of the interval and a
 * microsecond each: that is enough for clocks that differ and for an interval
 * that was rounded, while a late send stays late against it.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include "cycle.h"
#include "cycle_thread.h"
#include "../base/once64.h"

#define MEASURE_SENDS	64	/* to measure the interval that is not set, then to check it */
#define GAPS_MIN	4	/* gaps after which a new median is worth it */
#define FAR_GAPS	4	/* in a row: the interval has changed */
#define FAR_SHIFT	2	/* by more than a quarter of it each */

static struct ec_status_cycle *status(const struct ec_cycle *c)
{
	return &c->shared->status->kernel;
}

/* As described at EC_CYCLE_BUCKETS. */
static unsigned int bucket(u32 ns)
{
	unsigned int shift;

	if (ns < 8)
		return ns;
	shift = fls(ns) - 4;
	return (shift + 1) * 8 + (ns >> shift & 7);
}

static void late_forget(struct ec_status_cycle *st)
{
	st->overruns = 0;
	st->missed = 0;
	st->late_sum = 0;
	st->late_count = 0;
	st->late_min = 0;
	st->late_max = 0;
	st->work_max = 0;
	st->work_sum = 0;
	st->work_count = 0;
	memset(st->late, 0, sizeof(st->late));
}

static noinline void reset(struct ec_cycle *c)
{
	unsigned long flags = ec_status_begin(c->shared->status);

	late_forget(status(c));
	ec_status_end(c->shared->status, flags);
	/* the figures are zero before a reader may read them again */
	smp_store_release(&c->cycles->late_reset, false);
}

static __always_inline void late_add(struct ec_cycle *c, u32 late)
{
	struct ec_status_cycle *st = status(c);
	unsigned int i = bucket(late);
	unsigned long flags;

	if (unlikely(READ_ONCE(c->cycles->late_reset)))
		reset(c);
	flags = ec_status_begin(c->shared->status);
	WRITE_ONCE(st->late[i], st->late[i] + 1);
	WRITE_ONCE(st->late_sum, st->late_sum + late);
	if (!st->late_count || late < st->late_min)
		WRITE_ONCE(st->late_min, late);
	if (late > st->late_max)
		WRITE_ONCE(st->late_max, late);
	WRITE_ONCE(st->late_count, st->late_count + 1);
	ec_status_end(c->shared->status, flags);
}

/**
 * ec_late_count() - count one send
 * @c: active cycle
 * @ns: distance from its schedule; negative counts as 0
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_late_count(struct ec_cycle *c, s64 ns)
{
	late_add(c, clamp_t(s64, ns, 0, U32_MAX));
}

/* The median of the last gaps: single delayed sends do not change it. */
static u32 late_median(const struct ec_schedule *sc)
{
	unsigned int n = min_t(unsigned int, sc->n_gaps, EC_SCHEDULE_GAPS), i, k;
	u32 sorted[EC_SCHEDULE_GAPS];

	for (i = 0; i < n; i++) {
		for (k = i; k && sorted[k - 1] > sc->gaps[i]; k--)
			sorted[k] = sorted[k - 1];
		sorted[k] = sc->gaps[i];
	}
	return sorted[n / 2];
}

/* How far the schedule can follow each send, ns. */
static u32 step_ns(const struct ec_schedule *sc)
{
	return (sc->interval_ns >> 10) + NSEC_PER_USEC;
}

static void set_interval_us(struct ec_cycle *c, u32 ns)
{
	WRITE_ONCE(c->links->access.interval_us,
		   max_t(u32, 1, DIV_ROUND_CLOSEST(ns, NSEC_PER_USEC)));
}

/*
 * The interval, when the application has not set it: for the first sends a mean that
 * follows quickly. The frames between two sends need to know it soon.
 */
static noinline void late_measure(struct ec_cycle *c, struct ec_schedule *sc, u64 ns)
{
	s64 off = ns - sc->interval_ns, limit = NSEC_PER_SEC;

	if (sc->sends < 2)
		sc->interval_ns = min_t(u64, ns, NSEC_PER_SEC);
	else
		sc->interval_ns += (s32)clamp(off, -limit, limit) / 16;
	/* a pause is no interval */
	if (ns >= NSEC_PER_SEC)
		return;
	sc->gaps[sc->n_gaps++ % EC_SCHEDULE_GAPS] = ns;
	if (sc->n_gaps >= GAPS_MIN)
		set_interval_us(c, late_median(sc));
}

/* A mean that the schedule cannot follow, twice in a row to the same side. */
static void check_mean(struct ec_cycle *c, struct ec_schedule *sc, u64 now)
{
	u64 mean = min_t(u64, div_u64(now - sc->block_ns, MEASURE_SENDS), NSEC_PER_SEC);
	s64 off = mean - sc->interval_ns;
	s8 side = abs(off) <= step_ns(sc) + NSEC_PER_USEC / 2 ? 0 : off > 0 ? 1 : -1;

	if (!sc->before_ns) {
		sc->interval_ns = mean;
		side = 0;
	} else if (side && side == sc->mean_side) {
		mean = div_u64(now - sc->before_ns, 2 * MEASURE_SENDS);
		sc->interval_ns = min_t(u64, mean, NSEC_PER_SEC);
		sc->due_ns = now - sc->interval_ns;
		set_interval_us(c, sc->interval_ns);
		side = 0;
	}
	sc->mean_side = side;
	sc->before_ns = sc->block_ns;
	sc->block_ns = now;
	sc->n_block = 0;
}

/* The interval that was measured may have changed: a little, or so that it is measured again. */
static noinline void late_check(struct ec_cycle *c, struct ec_schedule *sc, u64 now, s64 off)
{
	s8 side = abs(off) <= sc->interval_ns >> FAR_SHIFT ? 0 : off > 0 ? 1 : -1;

	sc->far = side && side == sc->far_side ? sc->far + 1 : !!side;
	sc->far_side = side;
	if (sc->far == FAR_GAPS) {
		sc->sends = 0;
		sc->n_gaps = 0;
	} else if (sc->n_block >= MEASURE_SENDS) {
		check_mean(c, sc, now);
	}
}

/* Without a set interval: measure it, and then see whether it is still the same. */
static void late_learn(struct ec_cycle *c, struct ec_schedule *sc, u64 now)
{
	u64 ns = now - ec_read64(&c->links->access.last_send_ns);
	s64 off = ns - sc->interval_ns;

	sc->n_block++;
	if (sc->sends < MEASURE_SENDS)
		late_measure(c, sc, ns);
	else if (unlikely(sc->far || sc->n_block >= MEASURE_SENDS ||
			  abs(off) > sc->interval_ns >> FAR_SHIFT))
		late_check(c, sc, now, off);
}

/* The first send, or the first one of another interval. */
static void late_begin(struct ec_schedule *sc, u64 now)
{
	sc->block_ns = now;
	sc->before_ns = 0;
	sc->n_block = 0;
	sc->far = 0;
	sc->mean_side = 0;
}

/* A whole interval late or more: what was due in between is left out. */
static noinline s64 late_skip(struct ec_cycle *c, s64 off)
{
	struct ec_schedule *sc = &c->schedule;
	u64 n = div_u64(off, sc->interval_ns);

	ec_status_add(c->shared->status, &status(c)->overruns, n);
	sc->due_ns += n * sc->interval_ns;
	return sc->last_ns - sc->due_ns;
}

/* More than half an interval early: it was due before, perhaps left out. */
static noinline s64 go_back(struct ec_schedule *sc, s64 off)
{
	sc->due_ns -= div_u64(sc->interval_ns / 2 - off, sc->interval_ns) * sc->interval_ns;
	return sc->last_ns - sc->due_ns;
}

/**
 * ec_late_send() - an application that runs the cycle sends
 * @c: active cycle
 * @now: time of the send (ktime, ns); @last_send_ns is still that of the one before
 *
 * The first send only begins the schedule; without a set interval so do the
 * first %MEASURE_SENDS, also of an interval that differs from the one before.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_late_send(struct ec_cycle *c, u64 now)
{
	struct ec_schedule *sc = &c->schedule;
	bool set = READ_ONCE(c->links->access.interval_set);
	s32 step;
	s64 off;

	if (set)
		sc->interval_ns = ec_access_interval_us(&c->links->access) *
				 (u32)NSEC_PER_USEC;
	else if (sc->sends)
		late_learn(c, sc, now);
	sc->last_ns = now;
	if (unlikely(sc->sends < (set ? 1 : MEASURE_SENDS) || !sc->interval_ns)) {
		if (!sc->sends++)
			late_begin(sc, now);
		sc->due_ns = now;
		return;
	}
	sc->due_ns += sc->interval_ns;
	off = now - sc->due_ns;
	if (unlikely(off < -(s64)(sc->interval_ns / 2)))
		off = go_back(sc, off);
	late_add(c, min_t(u64, abs(off), U32_MAX));
	if (unlikely(off >= sc->interval_ns))
		off = late_skip(c, off);
	step = step_ns(sc);
	sc->due_ns += clamp_t(s64, off, -step, step);
}

/**
 * ec_late_work() - count how long a cycle of the kernel took
 * @c: active cycle
 * @ns: from its begin until the callers are woken
 *
 * Context: Who runs the cycle, also in hard interrupt. RT-safe.
 */
void ec_late_work(struct ec_cycle *c, s64 ns)
{
	struct ec_status_cycle *st = status(c);
	u32 work = clamp_t(s64, ns, 0, U32_MAX);
	unsigned long flags;

	flags = ec_status_begin(c->shared->status);
	WRITE_ONCE(st->work_ns, work);
	WRITE_ONCE(st->work_sum, st->work_sum + work);
	WRITE_ONCE(st->work_count, st->work_count + 1);
	if (work > st->work_max)
		WRITE_ONCE(st->work_max, work);
	ec_status_end(c->shared->status, flags);
}

/* Facts of a cycle beside its figures. */
static void describe(const struct ec_cycle *c, struct ec_ioc_cycle_stats *info)
{
	bool kernel = c->kernel.period_ns;

	info->active = 1;
	info->kind = kernel ? EC_CYCLE_BY_KERNEL : EC_CYCLE_BY_APP;
	info->interval_set = kernel || c->links->access.interval_set;
	info->interval_ns = kernel ? c->kernel.period_ns :
				     READ_ONCE(c->schedule.interval_ns);
	info->cpu = kernel ? c->kernel.cpu : -1;
	info->place = kernel ? READ_ONCE(c->place) : EC_CYCLE_PLACE_THREAD;
	info->cpu_losses = c->cpu_losses;
	info->priority = kernel ? c->priority : 0;
	info->stall = kernel ? c->kernel.stall : 0;
	info->priority_wanted = kernel ? c->kernel.priority ?: EC_CYCLE_PRIORITY : 0;
}

static void get(struct ec_cycle *c, struct ec_ioc_cycle_stats *info,
		struct ec_status_cycle *st)
{
	/* figures about to be reset count as zero already */
	bool forgotten = smp_load_acquire(&c->cycles->late_reset);

	describe(c, info);
	ec_status_copy(c->shared->status, st, status(c), sizeof(*st));
	if (forgotten)
		late_forget(st);
}

/**
 * ec_late_end() - keep the figures of a cycle that ends
 * @c: cycle, active until now, its layout still there
 *
 * Context: Process, lock of the configuration held; the cycle does not run any more.
 */
void ec_late_end(struct ec_cycle *c)
{
	struct ec_late_report *r = &c->cycles->late;

	lockdep_assert_held(c->wanted->lock);
	get(c, &r->info, &r->status);
	r->info.active = 0;
	WRITE_ONCE(c->cycles->late_reset, false);
}

/**
 * ec_late_get() - figures of the cycle that runs, else of the last one
 * @cycles: of the master
 * @info: filled but for @size and @data
 * @st: filled
 *
 * While the cycle runs it may be one send ahead in some of the figures.
 *
 * Context: Process, after ec_show_begin().
 */
void ec_late_get(struct ec_cycles *cycles, struct ec_ioc_cycle_stats *info,
		 struct ec_status_cycle *st)
{
	u64 data;

	if (cycles->active) {
		get(cycles->active, info, st);
		return;
	}
	data = info->data;
	*info = cycles->late.info;
	info->data = data;
	*st = cycles->late.status;
}

/**
 * ec_late_reset() - forget the figures
 * @cycles: of the master
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_late_reset(struct ec_cycles *cycles)
{
	ec_cycle_assert_held(cycles->active);
	if (cycles->active)
		WRITE_ONCE(cycles->late_reset, true);
	else
		late_forget(&cycles->late.status);
}
