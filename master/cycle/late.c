// SPDX-License-Identifier: GPL-2.0-only
/*
 * Histogram of the distance of each send from its schedule: one count, one sum,
 * one least and one most a cycle, in the status page. Only the cyclic caller
 * writes there; whoever wants the figures reset leaves it a word.
 *
 * The schedule of a cycle the kernel runs is its timer. An application tells
 * its interval but not when it begins, so its schedule is a grid of that
 * interval which follows the sends, by no more than 1/1024 of the interval and a
 * microsecond each: that is enough for clocks that differ and for an interval
 * that was rounded, while a late send stays late against it.
 */
#include <linux/bitops.h>
#include <linux/compiler.h>
#include <linux/ktime.h>
#include <linux/math64.h>
#include <linux/minmax.h>
#include <linux/string.h>
#include "cycle_thread.h"
#include "late.h"
#include "../master.h"
#include "../base/once64.h"
#include "../session/session.h"

#define MEASURE_SENDS	64	/* to know the interval when nobody tells it */
#define GAPS_MIN	4	/* gaps after which a new median is worth it */
#define OUTLIER_SHIFT	6	/* one send changes a measured interval by 1/64 of 1/16 */

static struct ec_status_cycle *status(const struct ec_session *s)
{
	return &s->shared->status->kernel;
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

static void forget(struct ec_status_cycle *st)
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

/**
 * ec_late_count() - count one send
 * @s: active session
 * @ns: distance from its schedule; negative counts as 0
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_late_count(struct ec_session *s, s64 ns)
{
	struct ec_status_cycle *st = status(s);
	u32 late = clamp_t(s64, ns, 0, U32_MAX);
	unsigned int i = bucket(late);

	if (unlikely(READ_ONCE(s->master->late_reset))) {
		ec_status_begin(s->shared->status);
		forget(st);
		ec_status_end(s->shared->status);
		/* the figures are zero before anybody may read them again */
		smp_store_release(&s->master->late_reset, false);
	}
	ec_status_begin(s->shared->status);
	WRITE_ONCE(st->late[i], st->late[i] + 1);
	WRITE_ONCE(st->late_sum, st->late_sum + late);
	if (!st->late_count || late < st->late_min)
		WRITE_ONCE(st->late_min, late);
	if (late > st->late_max)
		WRITE_ONCE(st->late_max, late);
	WRITE_ONCE(st->late_count, st->late_count + 1);
	ec_status_end(s->shared->status);
}

/* The median of the last gaps: single delayed sends do not change it. */
static u32 median(const struct ec_schedule *c)
{
	unsigned int n = min_t(unsigned int, c->n_gaps, EC_SCHEDULE_GAPS), i, k;
	u32 sorted[EC_SCHEDULE_GAPS];

	for (i = 0; i < n; i++) {
		for (k = i; k && sorted[k - 1] > c->gaps[i]; k--)
			sorted[k] = sorted[k - 1];
		sorted[k] = c->gaps[i];
	}
	return sorted[n / 2];
}

/*
 * The interval, when nobody tells it. The schedule needs a mean that single sends hardly
 * change; the frames between two sends need to know soon what it has become.
 */
static void measure(struct ec_master *m, struct ec_schedule *c, u64 ns)
{
	s64 off = ns - c->interval_ns;
	s64 limit = c->sends < MEASURE_SENDS ? NSEC_PER_SEC : c->interval_ns >> OUTLIER_SHIFT;

	if (c->sends < 2)
		c->interval_ns = min_t(u64, ns, NSEC_PER_SEC);
	else
		c->interval_ns += (s32)clamp(off, -limit, limit) / 16;
	/* a pause is no interval */
	if (ns >= NSEC_PER_SEC)
		return;
	c->gaps[c->n_gaps++ % EC_SCHEDULE_GAPS] = ns;
	if (c->n_gaps >= GAPS_MIN && (c->n_gaps < MEASURE_SENDS || !(c->n_gaps % GAPS_MIN)))
		WRITE_ONCE(m->links.access.interval_us, max_t(u32, 1, DIV_ROUND_CLOSEST(median(c),
									   NSEC_PER_USEC)));
}

/* A whole interval late or more: what was due in between is left out. */
static s64 skip(struct ec_session *s, s64 off)
{
	struct ec_schedule *c = &s->cycle.schedule;
	u64 n = div_u64(off, c->interval_ns);

	ec_status_add(s->shared->status, &status(s)->overruns, n);
	c->due_ns += n * c->interval_ns;
	return c->last_ns - c->due_ns;
}

/* More than half an interval early: it was due before, perhaps left out. */
static s64 go_back(struct ec_schedule *c, s64 off)
{
	c->due_ns -= div_u64(c->interval_ns / 2 - off, c->interval_ns) * c->interval_ns;
	return c->last_ns - c->due_ns;
}

/**
 * ec_late_send() - an application that runs the cycle sends
 * @s: active session
 * @now: time of the send (ktime, ns); @last_send_ns is still that of the one before
 *
 * The first send only begins the schedule; without a told interval so do the
 * first %MEASURE_SENDS.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_late_send(struct ec_session *s, u64 now)
{
	struct ec_schedule *c = &s->cycle.schedule;
	bool told = READ_ONCE(s->master->links.access.interval_set);
	s64 off, step;

	if (told)
		c->interval_ns = READ_ONCE(s->master->links.access.interval_us) *
				 (u32)NSEC_PER_USEC;
	else if (c->sends)
		measure(s->master, c, now - s->master->links.access.last_send_ns);
	c->last_ns = now;
	if (unlikely(c->sends < (told ? 1 : MEASURE_SENDS) || !c->interval_ns)) {
		c->sends++;
		c->due_ns = now;
		return;
	}
	c->due_ns += c->interval_ns;
	off = now - c->due_ns;
	if (unlikely(off < -(s64)(c->interval_ns / 2)))
		off = go_back(c, off);
	ec_late_count(s, abs(off));
	if (unlikely(off >= c->interval_ns))
		off = skip(s, off);
	step = (c->interval_ns >> 10) + NSEC_PER_USEC;
	c->due_ns += clamp(off, -step, step);
}

/**
 * ec_late_work() - count how long a cycle of the kernel took
 * @s: active session
 * @ns: from the wake-up of the thread until it goes to sleep
 *
 * Context: The thread that runs the cycle. RT-safe.
 */
void ec_late_work(struct ec_session *s, s64 ns)
{
	struct ec_status_cycle *st = status(s);
	u32 work = clamp_t(s64, ns, 0, U32_MAX);

	ec_status_begin(s->shared->status);
	WRITE_ONCE(st->work_ns, work);
	WRITE_ONCE(st->work_sum, st->work_sum + work);
	WRITE_ONCE(st->work_count, st->work_count + 1);
	if (work > st->work_max)
		WRITE_ONCE(st->work_max, work);
	ec_status_end(s->shared->status);
}

/* Facts of a session beside its figures. */
static void describe(const struct ec_session *s, struct ec_ioc_cycle_stats *info)
{
	bool kernel = s->kernel.period_ns;

	info->active = 1;
	info->kind = kernel ? EC_CYCLE_BY_KERNEL : EC_CYCLE_BY_APP;
	info->told = kernel || s->master->links.access.interval_set;
	info->interval_ns = kernel ? s->kernel.period_ns :
				     READ_ONCE(s->cycle.schedule.interval_ns);
	info->cpu = kernel ? s->kernel.cpu : -1;
	info->cpu_losses = s->cpu_losses;
	info->priority = kernel ? s->priority : 0;
	info->priority_wanted = kernel ? s->kernel.priority ?: EC_CYCLE_PRIORITY : 0;
}

static void get(struct ec_session *s, struct ec_ioc_cycle_stats *info,
		struct ec_status_cycle *st)
{
	/* figures that somebody wants to be forgotten are already */
	bool forgotten = smp_load_acquire(&s->master->late_reset);

	describe(s, info);
	ec_status_copy(s->shared->status, st, status(s), sizeof(*st));
	if (forgotten)
		forget(st);
}

/**
 * ec_late_end() - keep the figures of a session that ends
 * @s: session, active until now, its layout still there
 *
 * Context: Process, session_lock held; nobody runs the cycle any more.
 */
void ec_late_end(struct ec_session *s)
{
	struct ec_late_report *r = &s->master->late;

	get(s, &r->info, &r->status);
	r->info.active = 0;
	WRITE_ONCE(s->master->late_reset, false);
}

/**
 * ec_late_get() - figures of the cycle that runs, else of the last one
 * @m: master
 * @info: filled but for @size and @data
 * @st: filled
 *
 * While the cycle runs it may be one send ahead in some of the figures.
 *
 * Context: Process, after ec_show_begin().
 */
void ec_late_get(struct ec_master *m, struct ec_ioc_cycle_stats *info,
		 struct ec_status_cycle *st)
{
	if (m->session && m->session->wanted.active) {
		get(m->session, info, st);
		return;
	}
	info->active = 0;
	info->kind = m->late.info.kind;
	info->told = m->late.info.told;
	info->interval_ns = m->late.info.interval_ns;
	info->cpu = m->late.info.cpu;
	info->cpu_losses = m->late.info.cpu_losses;
	info->priority = m->late.info.priority;
	info->priority_wanted = m->late.info.priority_wanted;
	*st = m->late.status;
}

/**
 * ec_late_reset() - forget the figures
 * @m: master
 *
 * Context: Process, session_lock held. May sleep.
 */
void ec_late_reset(struct ec_master *m)
{
	if (m->session && m->session->wanted.active)
		WRITE_ONCE(m->late_reset, true);
	else
		forget(&m->late.status);
}
