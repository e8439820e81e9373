// SPDX-License-Identifier: GPL-2.0-only
/*
 * Delays change with temperature. So they are measured again beside the cycle, while nothing else
 * changes: in frames of the cycle, by riders. The median of some measurements counts, and the delay
 * of a running clock moves by 1 ns per write.
 */
#include <linux/ktime.h>
#include <linux/minmax.h>
#include <linux/mm.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/sort.h>
#include "../carry/rider.h"
#include "dc_job.h"
#include "dc_track.h"

#define RIDERS		4	/* in a frame */
#define EVERY		2	/* looks of the watch for one measurement */
#define ROUNDS		5	/* measurements of which the median counts */
#define PART		3	/* of the difference: a delay then moves by it, as there is noise */
#define STEPS		16	/* ns, by which it moves then at most */
#define LIMIT_NS	(2 * NSEC_PER_SEC)	/* of a measurement */

bool ec_dc_track_on = true;
module_param_named(track_delays, ec_dc_track_on, bool, 0644);
MODULE_PARM_DESC(track_delays,
		 "Measure propagation delays again while a cycle runs, in its frames (Y)");

/**
 * struct ec_dc_track - measurements so far
 * @riders: of the master, immutable
 * @rider: those of the measurement
 * @looks: since the last measurement
 * @scan: after which they were made, as ec_clock.measured
 * @ref: station address of the reference clock
 * @n: slaves
 * @rounds: measurements
 * @delay: of each slave in each of them
 */
struct ec_dc_track {
	struct ec_riders *riders;
	struct ec_rider rider[RIDERS];
	unsigned int looks;
	u32 scan;
	u16 ref;
	unsigned int n;
	unsigned int rounds;
	s32 (*delay)[ROUNDS];
};

/* a measurement of the job */
struct round {
	struct ec_dc_track *t;
	struct ec_dc_job *j;
	u64 until_ns;
	/* of which slave each rider is, and for which bytes of its receive times */
	unsigned int who[RIDERS];
	unsigned int half[RIDERS];
};

static void track_set_rider(struct ec_rider *r, u8 cmd, u16 adp, u16 ado, u16 len)
{
	r->cmd = cmd;
	r->adp = adp;
	r->ado = ado;
	r->len = len;
	memset(r->data, 0, sizeof(r->data));
}

/* Nothing else changes: no port, no list of slaves, no clock that is being set. */
static bool track_is_quiet(struct ec_dc *dc)
{
	return READ_ONCE(dc->state) == EC_DC_READY && READ_ONCE(dc->mode) == EC_DC_COMPENSATE &&
	       !READ_ONCE(dc->extra_dgrams) && !READ_ONCE(dc->changed) && !READ_ONCE(dc->stop) &&
	       !ec_dc_path_changed(dc);
}

static int track_send(struct round *m, unsigned int n)
{
	unsigned int i;
	int ret;

	if (!track_is_quiet(m->j->dc) || ktime_get_ns() > m->until_ns)
		return -ECANCELED;
	ret = ec_rider_exchange_all(m->t->riders, m->t->rider, n);
	for (i = 0; i < n && !ret; i++)
		if (!m->t->rider[i].wkc)
			ret = -EIO;
	return ret;
}

/* Which halves of its receive times are needed? A slave at an end has the frame in no time. */
static bool is_needed(const struct ec_dc_node *node, unsigned int half)
{
	return node->dc && hweight8(node->open) > 1 && node->open >> 2 * half & 3;
}

static int track_take(struct round *m, unsigned int n)
{
	unsigned int i;
	int ret = track_send(m, n);

	for (i = 0; i < n && !ret; i++)
		memcpy(m->j->recv[m->who[i]] + 8 * m->half[i], m->t->rider[i].data, 8);
	return ret;
}

/* Latch, then read the receive times of all slaves, some in each cycle. */
static int track_measure(struct round *m)
{
	struct ec_dc_job *j = m->j;
	unsigned int i, half, n = 0;
	int ret;

	track_set_rider(&m->t->rider[0], EC_CMD_BWR, 0, EC_REG_DC_RECV(0), 4);
	ret = track_send(m, 1);
	for (i = 0; i < 2 * j->n && !ret; i++) {
		half = i % 2;
		if (!is_needed(&j->nodes[i / 2], half))
			continue;
		m->who[n] = i / 2;
		m->half[n] = half;
		track_set_rider(&m->t->rider[n++], EC_CMD_FPRD, j->slaves[i / 2]->station,
			  EC_REG_DC_RECV(2 * half), 8);
		if (n < RIDERS)
			continue;
		ret = track_take(m, n);
		n = 0;
	}
	return ret ?: n ? track_take(m, n) : 0;
}

/* Times of two latches, or of a frame that had not returned, contradict the topology. */
static bool is_reliable(const struct ec_dc_job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (j->nodes[i].unreliable && !ec_job_clock(j, i)->delay_unreliable)
			return false;
	return true;
}

static bool is_measured(const struct ec_dc_job *j, u32 scan)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (j->nodes[i].dc && ec_job_clock(j, i)->measured != scan)
			return false;
	return j->ref < j->n && j->slaves[j->ref]->station == READ_ONCE(j->dc->ref_station);
}

/* Measurements of other slaves, or by another reference clock, do not count. */
static int track_begin(struct ec_dc_track *t, const struct ec_dc_job *j, u32 scan)
{
	u16 ref = j->slaves[j->ref]->station;

	if (t->delay && t->scan == scan && t->ref == ref && t->n == j->n)
		return 0;
	kvfree(t->delay);
	t->delay = kvcalloc(j->n, sizeof(*t->delay), GFP_KERNEL);
	t->scan = scan;
	t->ref = ref;
	t->n = j->n;
	t->rounds = 0;
	return t->delay ? 0 : -ENOMEM;
}

static int compare(const void *a, const void *b)
{
	const s32 *x = a, *y = b;

	return *x < *y ? -1 : *x > *y;
}

/* By how much a delay is to move, ns. */
static s32 steps_of(struct ec_dc_track *t, const struct ec_dc_job *j, unsigned int i)
{
	s32 *v = t->delay[i];

	if (i == j->ref || !ec_dc_chosen(j, i, EC_DC_CLOCKS) ||
	    READ_ONCE(ec_job_clock(j, i)->state) != EC_CLOCK_SET)
		return 0;
	sort(v, ROUNDS, sizeof(*v), compare, NULL);
	return clamp((s32)(v[ROUNDS / 2] - ec_job_clock(j, i)->delay) / PART, -STEPS, STEPS);
}

/* Write some delays, each 1 ns nearer to what was measured. */
static int track_write(struct round *m, s32 *steps, unsigned int n)
{
	unsigned int i;
	int ret;

	for (i = 0; i < n; i++) {
		unsigned int who = m->who[i];

		track_set_rider(&m->t->rider[i], EC_CMD_FPWR, m->j->slaves[who]->station,
			  EC_REG_DC_DELAY, 4);
		put_unaligned_le32(ec_job_clock(m->j, who)->delay + (steps[who] > 0 ? 1 : -1),
				   m->t->rider[i].data);
	}
	ret = track_send(m, n);
	for (i = 0; i < n && !ret; i++) {
		s32 step = steps[m->who[i]] > 0 ? 1 : -1;

		ec_job_clock(m->j, m->who[i])->delay += step;
		steps[m->who[i]] -= step;
	}
	return ret;
}

/* Move the delays in turn: each at most once per cycle. */
static void track_move(struct round *m, s32 *steps)
{
	unsigned int i, n, more;
	int ret = 0;

	do {
		more = 0;
		for (i = 0, n = 0; i < m->j->n && !ret; i++) {
			if (steps[i])
				m->who[n++] = i;
			if (n < RIDERS && (i + 1 < m->j->n || !n))
				continue;
			ret = track_write(m, steps, n);
			more += n;
			n = 0;
		}
	} while (more && !ret);
}

static void track_decide(struct round *m)
{
	s32 *steps = kvcalloc(m->j->n, sizeof(*steps), GFP_KERNEL);
	unsigned int i;

	m->t->rounds = 0;
	for (i = 0; steps && i < m->j->n; i++)
		steps[i] = steps_of(m->t, m->j, i);
	m->until_ns = ktime_get_ns() + LIMIT_NS;
	if (steps)
		track_move(m, steps);
	kvfree(steps);
}

static void track_job(struct ec_dc_track *t, struct ec_dc_job *j)
{
	struct round m = { .t = t, .j = j, .until_ns = ktime_get_ns() + LIMIT_NS };
	u32 scan = ec_dc_scan(j);
	unsigned int i;

	lockdep_assert_held(&j->dc->lock);
	if (!is_measured(j, scan) || track_begin(t, j, scan) || track_measure(&m) ||
	    ec_dc_scan(j) != scan)
		return;
	ec_dc_compute(j);
	if (!is_reliable(j))
		return;
	for (i = 0; i < j->n; i++)
		t->delay[i][t->rounds] = j->nodes[i].delay;
	if (++t->rounds == ROUNDS)
		track_decide(&m);
}

static void track_again(struct ec_dc *dc)
{
	struct ec_dc_track *t = dc->track;
	struct ec_dc_job j;

	/* in a ring frames do not return through the ports */
	if (!dc->links->only)
		return;
	if (!READ_ONCE(ec_dc_track_on) || !track_is_quiet(dc) || ++t->looks % EVERY ||
	    ec_dc_job_init(&j, dc, false))
		return;
	mutex_lock(&dc->lock);
	track_job(t, &j);
	mutex_unlock(&dc->lock);
	ec_dc_job_free(&j);
}

/**
 * ec_dc_track_init() - prepare the measurements
 * @dc: clocks of a master
 * @riders: of the master
 *
 * Context: Process.
 * Return: 0, -ENOMEM or -ENOSPC.
 */
int ec_dc_track_init(struct ec_dc *dc, struct ec_riders *riders)
{
	struct ec_dc_track *t = kzalloc(sizeof(*t), GFP_KERNEL);
	unsigned int i;
	int ret = 0;

	if (!t)
		return -ENOMEM;
	t->riders = riders;
	dc->track = t;
	dc->again = track_again;
	for (i = 0; i < RIDERS && !ret; i++)
		ret = ec_rider_register(riders, &t->rider[i]);
	return ret;
}

/**
 * ec_dc_track_exit() - free the measurements
 * @dc: clocks after ec_dc_exit()
 *
 * Context: Process.
 */
void ec_dc_track_exit(struct ec_dc *dc)
{
	if (dc->track)
		kvfree(dc->track->delay);
	kfree(dc->track);
	dc->track = NULL;
}
