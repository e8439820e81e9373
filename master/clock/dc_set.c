// SPDX-License-Identifier: GPL-2.0-only
/* Offsets and delays of all clocks, drift compensation, and its result. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "dc_app.h"
#include "dc_job.h"
#include "dc_set.h"
#include "dc_time.h"
#include "dc_watch.h"

#define SYNCS		72	/* datagrams of a frame: phase and rate settle alike */
#define QUIET_SYNCS	12	/* of a frame shortly behind another one */
#define LOOK_FRAMES	78	/* between two checks of 2 frames: two sends of 20 ms carry all */
#define NEAR_NS		500	/* clocks that differ by less may be used */
#define NEAR_MOST	1600	/* frames at most until then */
#define QUIET_FRAMES	312	/* which remove the rest of the rates */
#define CALM_CYCLES	120	/* whose frames remove the noise */
#define CALM_US		10000	/* several of them in a transfer if they are short */
#define LAST_CYCLES	150	/* and the noise of those frames */
#define LAST_SYNCS	24	/* in short cycles by smaller steps */
#define LAST_GAP	4	/* in long cycles by few frames far from each other */
#define LAST_FRAMES	17	/* of which so many are enough */
#define CYCLE_DGRAMS	12000	/* extra datagrams when the cycle alone compensates */
#define CYCLE_WAIT_MS	3000
#define CYCLE_REST	16000	/* which then remove the rest of the rates */

/*
 * System time at the reference clock at the last latch, by a clock that is set already on this side
 * of a break, so that set clocks continue when others connect. Returns whether there is one.
 */
static bool set_time(const struct ec_dc_job *j, bool other, u64 *t)
{
	unsigned int i, set = j->n;

	for (i = 0; i < j->n; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS) && j->nodes[i].other == other &&
		    ec_clock_is_set(j->slaves[i]) && (set == j->n || i == j->ref))
			set = i;
	if (set == j->n)
		return false;
	*t = get_unaligned_le64(j->unit[set]) + ec_job_clock(j, set)->offset -
	     (s64)(s32)ec_job_clock(j, set)->delay;
	if (!(ec_slave_features(j->slaves[set]) & EC_FEAT_DC64))
		*t = ec_dc_extend32(j->dc, (u32)*t, j->latch_ns);
	return true;
}

/* That time on both sides of a break, [1]: behind it. */
static void latch_time(struct ec_dc_job *j, u64 t[2])
{
	bool at = j->nodes[j->ref].other, here = set_time(j, at, &t[at]);
	bool there = set_time(j, !at, &t[!at]);

	if (!here)
		t[at] = there ? t[!at] - j->shift : ec_dc_app_at(j->dc, j->latch_ns);
	if (!there)
		t[!at] = t[at] + j->shift;
	/* clocks behind the break that are all new have it from here */
	j->given = !(at ? here : there) && ec_dc_has_clocks(j, true, false);
	j->shift_behind = t[1] - t[0];
	/* and maybe without a measurement */
	j->guessed = j->given && j->shifted;
	ec_dc_clock(j->dc, t[0], j->latch_ns);
}

/* Clocks that were set without a measurement, as the ring was open, show what was wrong. */
static void report_guess(struct ec_dc_job *j, u64 t)
{
	struct ec_dc *dc = j->dc;
	unsigned int i;
	s32 most = 0;

	if (j->guessed && !dc->guessed)
		ec_warn(dc,
			"ring open: clocks behind the break set by the time of sending; they may differ by some us until it is closed, if cables or cards of the two ends do\n");
	dc->guessed |= j->guessed;
	if (!dc->guessed || j->ring != EC_RING_CLOSED)
		return;
	for (i = 0; i < j->n; i++) {
		const struct ec_clock *c = ec_job_clock(j, i);
		s32 off = (u32)get_unaligned_le64(j->unit[i]) + (u32)c->offset - c->delay - (u32)t;

		if (ec_dc_chosen(j, i, EC_DC_CLOCKS) && ec_clock_is_set(j->slaves[i]) &&
		    abs(off) > abs(most))
			most = off;
	}
	dc->guessed = false;
	ec_info(dc,
		"ring closed: clocks that were set behind its break are off by up to %d ns, which is compensated now\n",
		most);
}

/* written to a slave: offset and delay, in the order of the registers */
struct values {
	u8 offset[8];
	u8 delay[4];
};

static struct values *compute(struct ec_dc_job *j, const u64 t[2])
{
	struct values *v = kvcalloc(j->n + 1, sizeof(*v), GFP_KERNEL);
	unsigned int i;

	for (i = 0; v && i < j->n; i++) {
		struct ec_clock *c = ec_job_clock(j, i);

		/* counted from the reference clock, which may have changed */
		put_unaligned_le32(c->delay, v[i].delay);
		if (!ec_dc_chosen(j, i, EC_DC_NEW))
			continue;
		c->offset = ec_dc_offset(t[j->nodes[i].other], c->delay,
					 get_unaligned_le64(j->unit[i]));
		put_unaligned_le64(c->offset, v[i].offset);
	}
	return v;
}

/* Offset and delay in one datagram where they are neighbours. */
static int write_values(struct ec_dc_job *j, struct values *v)
{
	/* clocks that are set get the delay alone */
	unsigned int wide = ec_dc_add(j, 0, EC_DC_NEW_WIDE, EC_CMD_FPWR, EC_REG_DC_OFFSET,
				      sizeof(*v), v->offset, sizeof(*v));
	unsigned int narrow = ec_dc_add(j, wide, EC_DC_NEW_NARROW, EC_CMD_FPWR, EC_REG_DC_OFFSET,
					4, v->offset, sizeof(*v));
	unsigned int n = narrow, i;
	int ret;

	for (i = 0; i < j->n; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS) && !ec_dc_chosen(j, i, EC_DC_NEW_WIDE))
			j->dg[n++] = EC_FPWR(j->slaves[i]->station, EC_REG_DC_DELAY, 4, v[i].delay);
	memset(j->silent, 0, j->n * sizeof(*j->silent));
	ret = ec_xfer_clock(j->dc->links, j->dg, n);
	ret = ret ?: ec_dc_answers(j, 0, EC_DC_NEW_WIDE);
	ret = ret ?: ec_dc_answers(j, wide, EC_DC_NEW_NARROW);
	for (i = 0, n = narrow; i < j->n && !ret; i++) {
		if (!ec_dc_chosen(j, i, EC_DC_CLOCKS) || ec_dc_chosen(j, i, EC_DC_NEW_WIDE))
			continue;
		j->silent[i] |= j->dg[n++].wkc != 1;
		if (j->silent[i])
			ret = -EAGAIN;
	}
	return ret;
}

/* The depths of the filters before 0x0930 resets them; all at once if all clocks are new. */
static int reset_filters(struct ec_dc_job *j)
{
	static u8 depths[2] = { 0, 12 }, reset[2] = { 0x00, 0x10 };
	unsigned int clocks = ec_dc_count(j, EC_DC_CLOCKS), n, end;
	int ret;

	if (ec_dc_count(j, EC_DC_NEW) == clocks) {
		struct ec_dg all[] = {
			EC_DG(EC_CMD_BWR, 0, EC_REG_DC_FILTER_DIFF, 2, depths),
			EC_DG(EC_CMD_BWR, 0, EC_REG_DC_SPEED_START, 2, reset),
		};

		ret = ec_xfer_clock(j->dc->links, all, ARRAY_SIZE(all));
		if (!ret && all[0].wkc >= clocks && all[1].wkc >= clocks)
			return 0;
	}
	n = ec_dc_add(j, 0, EC_DC_NEW, EC_CMD_FPWR, EC_REG_DC_FILTER_DIFF, 2, depths, 0);
	/* a scan may have taken a slave out of the group meanwhile */
	end = ec_dc_add(j, n, EC_DC_NEW, EC_CMD_FPWR, EC_REG_DC_SPEED_START, 2, reset, 0);
	ret = ec_xfer_clock(j->dc->links, j->dg, end);
	return ret ?: ec_dc_answers(j, 0, EC_DC_NEW) ?: ec_dc_answers(j, n, EC_DC_NEW);
}

/**
 * ec_dc_write() - set the clocks
 * @j: job with delays and a latch
 *
 * Context: Process, dc.lock held. Waits for bus traffic.
 * Return: 0; -EAGAIN when slaves do not answer; -ENOMEM; or as ec_xfer().
 */
int ec_dc_write(struct ec_dc_job *j)
{
	struct values *v;
	unsigned int i;
	u64 t[2];
	int ret;

	lockdep_assert_held(&j->dc->lock);
	latch_time(j, t);
	report_guess(j, t[0]);
	v = compute(j, t);
	if (!v)
		return -ENOMEM;
	ret = write_values(j, v) ?: reset_filters(j);
	for (i = 0; i < j->n && !ret; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS))
			ec_clock_event(ec_job_clock(j, i), EC_CLOCK_ON_SET);
	if (!ret)
		ec_dc_app_set(j->dc, t[0] - j->latch_ns, true);
	kvfree(v);
	return ret;
}

/* A frame with up to @most datagrams; 0: a frame that only keeps others apart. */
static unsigned int add_frame(struct ec_dc_job *j, unsigned int n, unsigned int most)
{
	static u8 none[EC_DGRAM_DATA_MAX];
	u16 bytes = READ_ONCE(j->dc->ref_wide) ? 8 : 4, ref = READ_ONCE(j->dc->ref_station);
	u16 bytes_left = ec_share_clock_bytes(j->dc->links), pad;
	unsigned int syncs = min(max(1u, bytes_left / (u32)(bytes + EC_DGRAM_OVERHEAD)), most);
	unsigned int end = n + syncs;

	for (; n < end; n++) {
		j->dg[n] = EC_DG(EC_CMD_FRMW, ref, EC_REG_DC_SYSTIME, bytes, j->time);
		j->dg[n].keep = true;
	}
	/* of equal length, so that their distance is equal */
	pad = syncs * (bytes + EC_DGRAM_OVERHEAD) + EC_DGRAM_OVERHEAD;
	pad = min_t(u16, bytes_left - min(bytes_left, pad), EC_DGRAM_DATA_MAX);
	if (pad || !most)
		j->dg[n++] = EC_DG(EC_CMD_NOP, 0, 0, pad ?: 1, none);
	return n;
}

/* clock frames that one send may carry */
static unsigned int per_send(const struct ec_dc_job *j)
{
	u32 interval_us = ec_access_interval_us(&j->dc->links->access);

	return max(1u, interval_us * EC_SHARE_CLOCKS_PER_MS / 1000);
}

/*
 * Drift compensation. Each frame gives a slave one measurement of its rate, with 10 ns
 * of noise over the time since the last frame, and as many steps of 1/4096 towards it as
 * the frame has datagrams; but one step of 1/64 of the phase, however many it has. So
 * the first frames have as many as they may. When the clocks are near, slaves may use
 * them. Meanwhile the rest of the rates and then the noise are removed: only the first
 * frame of a send, which measures over a whole cycle, still has many (@first); the
 * others have few (@more), or none except each @gap frames. The cycle only reads the time
 * meanwhile: its datagrams shortly before a frame would disturb the measurement.
 */
static unsigned int add_frames(struct ec_dc_job *j, unsigned int frames, unsigned int first,
			       unsigned int more, unsigned int gap)
{
	unsigned int i, at, start, n = 0, per = per_send(j);

	/* if the reference clock does not reply; written again when the frame leaves */
	put_unaligned_le64(ec_dc_clock_now(j->dc), j->time);
	for (i = 0; i < frames; i++) {
		at = i % per;
		start = n;
		n = add_frame(j, n, !at ? first : at % gap ? 0 : more);
		j->dg[start].first = !at;
	}
	for (i = 0; i < n; i++)
		j->dg[i].repeat = false;
	return n;
}

/* A single lost frame does not matter. */
static int tolerate(int ret)
{
	return ret == -ETIMEDOUT || ret == -EBUSY ? 0 : ret;
}

static bool dc_set_canceled(const struct ec_dc *dc)
{
	return !READ_ONCE(dc->ref_station) || READ_ONCE(dc->stop);
}

/*
 * Largest difference in @v, of the clocks that have replied to the datagrams from @at on.
 * U32_MAX when a frame was lost.
 */
static u32 worst(const struct ec_dc_job *j, unsigned int at, u8 (*v)[4])
{
	u32 max = 0;
	unsigned int i;

	for (i = 0; i < j->n; i++) {
		const struct ec_dg *dg = &j->dg[at];

		if (!ec_dc_chosen(j, i, EC_DC_CLOCKS))
			continue;
		at++;
		if (dg->err)
			max = U32_MAX;
		else if (i != j->ref && dg->wkc == 1)
			max = max_t(u32, max, abs(ec_dc_diff(get_unaligned_le32(v[i]))));
	}
	return max;
}

/* Compensate by some frames, then read the differences. */
static int check_once(struct ec_dc_job *j, unsigned int more, u8 (*v)[4], u32 *max)
{
	unsigned int first, n;
	int ret;

	if (dc_set_canceled(j->dc))
		return -ECANCELED;
	first = add_frames(j, LOOK_FRAMES, SYNCS, more, 1);
	n = ec_dc_add(j, first, EC_DC_CLOCKS, EC_CMD_FPRD, EC_REG_DC_DIFF, 4, v[0], sizeof(v[0]));
	ret = ec_xfer_clock(j->dc->links, j->dg, n);
	*max = worst(j, first, v);
	return tolerate(ret);
}

/* Slower beside clocks in use, which these frames reach as well. */
static int by_frames(struct ec_dc_job *j, u8 (*v)[4])
{
	unsigned int more = j->compensated ? QUIET_SYNCS : SYNCS, done;
	u32 max = U32_MAX;
	int ret = 0;

	WRITE_ONCE(j->dc->mode, EC_DC_READ);
	for (done = 0; done < NEAR_MOST && max > NEAR_NS && !ret; done += LOOK_FRAMES)
		ret = check_once(j, more, v, &max);
	return ret;
}

/* A poll: the cycle wakes no thread of the master. Returns when @ms has reached the limit. */
static int cycle_once(struct ec_dc *dc, unsigned int *ms)
{
	WRITE_ONCE(dc->extra_dgrams, CYCLE_DGRAMS);
	for (; *ms < CYCLE_WAIT_MS && READ_ONCE(dc->extra_dgrams); ++*ms) {
		if (READ_ONCE(dc->stop))
			return -ECANCELED;
		usleep_range(1000, 1100);
	}
	return 0;
}

static int by_cycle(struct ec_dc_job *j, u8 (*v)[4])
{
	unsigned int ms = 0, n;
	u32 max = U32_MAX;
	int ret = 0;

	while (ms < CYCLE_WAIT_MS && max > NEAR_NS && !ret) {
		ret = cycle_once(j->dc, &ms);
		if (ret)
			break;
		n = ec_dc_add(j, 0, EC_DC_CLOCKS, EC_CMD_FPRD, EC_REG_DC_DIFF, 4, v[0],
			      sizeof(v[0]));
		ret = tolerate(ec_xfer_clock(j->dc->links, j->dg, n));
		max = worst(j, 0, v);
	}
	/* if the reference clock is lost soon, the next one continues at its own rate */
	if (!ret && !j->compensated)
		WRITE_ONCE(j->dc->extra_dgrams, CYCLE_REST);
	return ret;
}

/**
 * ec_dc_near() - compensate the drift until the clocks may be used
 * @j: job whose clocks are set
 *
 * With clocks upstream of the reference or behind the break of a ring only the cycle compensates:
 * they take the time that was sent, which it predicts.
 *
 * Context: Process, dc.lock held. Waits for bus traffic.
 * Return: 0; -ECANCELED; -ENOMEM; or as ec_xfer().
 */
int ec_dc_near(struct ec_dc_job *j)
{
	u8 (*v)[4];
	int ret;

	lockdep_assert_held(&j->dc->lock);
	/* a single clock has no other to be synchronized to */
	if (ec_dc_count(j, EC_DC_CLOCKS) < 2)
		return 0;
	v = kvcalloc(j->n + 1, sizeof(*v), GFP_KERNEL);
	if (!v)
		return -ENOMEM;
	if (READ_ONCE(j->dc->clocks_upstream) || ec_dc_has_clocks(j, true, false))
		ret = by_cycle(j, v);
	else
		ret = by_frames(j, v);
	kvfree(v);
	return ret;
}

static int compensate(struct ec_dc_job *j, unsigned int n)
{
	if (dc_set_canceled(j->dc))
		return -ECANCELED;
	return tolerate(ec_xfer_clock(j->dc->links, j->dg, n));
}

/* The rate measured from the frames behind the first one is noise, more so for close frames. */
static int calm(struct ec_dc_job *j, unsigned int cycles, bool last)
{
	unsigned int per = per_send(j), frames = min_t(unsigned int, cycles * per, LOOK_FRAMES);

	if (!last)
		return compensate(j, add_frames(j, frames, SYNCS, 1, 1));
	if (per < 2 * LAST_GAP)
		return compensate(j, add_frames(j, frames, LAST_SYNCS, 1, 1));
	if (cycles == 1)
		frames = min_t(unsigned int, frames, LAST_FRAMES);
	return compensate(j, add_frames(j, frames, SYNCS, 1, LAST_GAP));
}

/**
 * ec_dc_settle() - continue to compensate, beside slaves that use their clocks
 * @j: job whose clocks are near
 *
 * Omits the noise when the application is the time reference: it changes the rate.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_dc_settle(struct ec_dc_job *j)
{
	struct ec_dc *dc = j->dc;
	u32 interval_us = max(1u, ec_access_interval_us(&dc->links->access));
	unsigned int i, cycles = max(1u, CALM_US / interval_us);
	int ret = 0;

	if (READ_ONCE(dc->mode) != EC_DC_READ)
		return;
	for (i = 0; i < QUIET_FRAMES && !ret; i += LOOK_FRAMES)
		ret = compensate(j, add_frames(j, LOOK_FRAMES, SYNCS, QUIET_SYNCS, 1));
	for (i = 0; i < CALM_CYCLES + LAST_CYCLES && !ret && !READ_ONCE(dc->app_leads); i += cycles)
		ret = calm(j, cycles, i >= CALM_CYCLES);
	WRITE_ONCE(dc->mode, EC_DC_COMPENSATE);
}

/**
 * ec_dc_check() - read the difference of each slave to the reference, register 0x092C
 * @j: job whose clocks were compensated
 *
 * Context: Process, dc.lock held. Waits for bus traffic.
 * Return: 0; -ENOMEM; or as ec_xfer().
 */
int ec_dc_check(struct ec_dc_job *j)
{
	u8 (*v)[4] = kvcalloc(j->n + 1, sizeof(*v), GFP_KERNEL);
	unsigned int i;
	int ret;

	lockdep_assert_held(&j->dc->lock);
	if (!v)
		return -ENOMEM;
	memset(j->silent, 0, j->n * sizeof(*j->silent));
	ret = ec_xfer_clock(j->dc->links, j->dg,
			    ec_dc_add(j, 0, EC_DC_CLOCKS, EC_CMD_FPRD, EC_REG_DC_DIFF, 4, v[0],
				      sizeof(v[0])));
	/* a clock without reply now was set before */
	if (!ret)
		ec_dc_answers(j, 0, EC_DC_CLOCKS);
	for (i = 0; i < j->n && !ret; i++)
		if (ec_dc_chosen(j, i, EC_DC_CLOCKS) && !j->silent[i])
			ec_dc_update_diff(j->slaves[i], get_unaligned_le32(v[i]));
	kvfree(v);
	return ret;
}
