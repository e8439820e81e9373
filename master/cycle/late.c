// SPDX-License-Identifier: GPL-2.0-only
/*
 * Histogram of send deviations: each cycle updates a count, a sum, a minimum and
 * a maximum in the status page. Only the cycle owner writes there; a caller that
 * resets the figures only sets a flag.
 *
 * The schedule of a kernel cycle is its timer. An application configures its
 * interval, but not its begin. So its schedule is a grid of that interval, which
 * each send shifts by at most 1/1024 of the interval and a microsecond. That is
 * enough for clocks that differ and for a rounded interval, while a late send
 * still deviates.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include "../base/once64.h"
#include "../link/access.h"
#include "late.h"

#define MEASURE_SENDS	64	/* to measure an interval that is not set, then to check it */
#define GAPS_MIN	4	/* gaps before the first median */
#define FAR_GAPS	4	/* in a row: the interval has changed */
#define FAR_SHIFT	2	/* by more than a quarter of it each */

static struct ec_status_cycle *status(const struct ec_late *l)
{
	return &l->status->kernel;
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

/**
 * ec_late_forget() - set the figures of a cycle to zero
 * @st: figures; its state stays
 *
 * Context: Any; the only writer of @st.
 */
void ec_late_forget(struct ec_status_cycle *st)
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

static noinline void reset(struct ec_late *l)
{
	unsigned long flags = ec_status_begin(l->status);

	ec_late_forget(status(l));
	ec_status_end(l->status, flags);
	/* the figures are zero before a reader may read them again */
	smp_store_release(&l->reset, false);
}

static __always_inline void late_add(struct ec_late *l, u32 late)
{
	struct ec_status_cycle *st = status(l);
	unsigned int i = bucket(late);
	unsigned long flags;

	if (unlikely(READ_ONCE(l->reset)))
		reset(l);
	flags = ec_status_begin(l->status);
	WRITE_ONCE(st->late[i], st->late[i] + 1);
	WRITE_ONCE(st->late_sum, st->late_sum + late);
	if (!st->late_count || late < st->late_min)
		WRITE_ONCE(st->late_min, late);
	if (late > st->late_max)
		WRITE_ONCE(st->late_max, late);
	WRITE_ONCE(st->late_count, st->late_count + 1);
	ec_status_end(l->status, flags);
}

/**
 * ec_late_count() - count one send
 * @l: of the active cycle
 * @ns: its deviation; negative counts as 0
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_late_count(struct ec_late *l, s64 ns)
{
	late_add(l, clamp_t(s64, ns, 0, U32_MAX));
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

/* How much one send may shift the schedule, ns. */
static u32 step_ns(const struct ec_schedule *sc)
{
	return (sc->interval_ns >> 10) + NSEC_PER_USEC;
}

static void set_interval_us(struct ec_late *l, u32 ns)
{
	WRITE_ONCE(l->access->interval_us,
		   max_t(u32, 1, DIV_ROUND_CLOSEST(ns, NSEC_PER_USEC)));
}

/*
 * The interval, when the application has not configured it. For the first sends it is a
 * mean that changes quickly, since acyclic frames depend on it.
 */
static noinline void late_measure(struct ec_late *l, struct ec_schedule *sc, u64 ns)
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
		set_interval_us(l, late_median(sc));
}

/* A new interval, if the mean is beyond what sends may shift, twice in a row to the same side. */
static void check_mean(struct ec_late *l, struct ec_schedule *sc, u64 now)
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
		set_interval_us(l, sc->interval_ns);
		side = 0;
	}
	sc->mean_side = side;
	sc->before_ns = sc->block_ns;
	sc->block_ns = now;
	sc->n_block = 0;
}

/* The interval that was measured may have changed: a little, or so that it is measured again. */
static noinline void late_check(struct ec_late *l, struct ec_schedule *sc, u64 now, s64 off)
{
	s8 side = abs(off) <= sc->interval_ns >> FAR_SHIFT ? 0 : off > 0 ? 1 : -1;

	sc->far = side && side == sc->far_side ? sc->far + 1 : !!side;
	sc->far_side = side;
	if (sc->far == FAR_GAPS) {
		sc->sends = 0;
		sc->n_gaps = 0;
	} else if (sc->n_block >= MEASURE_SENDS) {
		check_mean(l, sc, now);
	}
}

/* An interval that is not configured: measure it, then check that it is still the same. */
static void late_learn(struct ec_late *l, struct ec_schedule *sc, u64 now)
{
	u64 ns = now - ec_read64(&l->access->last_send_ns);
	s64 off = ns - sc->interval_ns;

	sc->n_block++;
	if (sc->sends < MEASURE_SENDS)
		late_measure(l, sc, ns);
	else if (unlikely(sc->far || sc->n_block >= MEASURE_SENDS ||
			  abs(off) > sc->interval_ns >> FAR_SHIFT))
		late_check(l, sc, now, off);
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

/* A whole interval late or more: the sends in between are skipped. */
static noinline s64 late_skip(struct ec_late *l, s64 off)
{
	struct ec_schedule *sc = &l->schedule;
	u64 n = div_u64(off, sc->interval_ns);

	ec_status_add(l->status, &status(l)->overruns, n);
	sc->due_ns += n * sc->interval_ns;
	return sc->last_ns - sc->due_ns;
}

/* More than half an interval early: it was due before, perhaps skipped. */
static noinline s64 go_back(struct ec_schedule *sc, s64 off)
{
	sc->due_ns -= div_u64(sc->interval_ns / 2 - off, sc->interval_ns) * sc->interval_ns;
	return sc->last_ns - sc->due_ns;
}

/**
 * ec_late_send() - an application that runs the cycle sends
 * @l: of the active cycle
 * @now: time of the send (ktime, ns); @last_send_ns is still that of the previous one
 *
 * The first send only begins the schedule. If the interval is measured, so do
 * the first %MEASURE_SENDS, and those after a change of the interval.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_late_send(struct ec_late *l, u64 now)
{
	struct ec_schedule *sc = &l->schedule;
	bool set = READ_ONCE(l->access->interval_set);
	s32 step;
	s64 off;

	if (set)
		sc->interval_ns = ec_access_interval_us(l->access) *
				 (u32)NSEC_PER_USEC;
	else if (sc->sends)
		late_learn(l, sc, now);
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
	late_add(l, min_t(u64, abs(off), U32_MAX));
	if (unlikely(off >= sc->interval_ns))
		off = late_skip(l, off);
	step = step_ns(sc);
	sc->due_ns += clamp_t(s64, off, -step, step);
}

/**
 * ec_late_work() - count how long a cycle of the kernel took
 * @l: of the active cycle
 * @ns: from its begin until the callers are woken
 *
 * Context: The cycle owner, also in hard interrupt. RT-safe.
 */
void ec_late_work(struct ec_late *l, s64 ns)
{
	struct ec_status_cycle *st = status(l);
	u32 work = clamp_t(s64, ns, 0, U32_MAX);
	unsigned long flags;

	flags = ec_status_begin(l->status);
	WRITE_ONCE(st->work_ns, work);
	WRITE_ONCE(st->work_sum, st->work_sum + work);
	WRITE_ONCE(st->work_count, st->work_count + 1);
	if (work > st->work_max)
		WRITE_ONCE(st->work_max, work);
	ec_status_end(l->status, flags);
}
