// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "dc.h"
#include "master.h"
#include "once64.h"
#include "slave.h"
#include "wire/dc.h"
#include "xfer.h"

#define ROUNDS		16	/* latches; the times have 10 ns of noise */
#define TOGETHER	4	/* of them before clocks that are set are corrected again */
#define CORRECT_CYCLES	8	/* in so many cycles */
#define CORRECT_MS	20	/* and within that time */
#define BATCH		1500	/* datagrams in one ec_xfer() */
#define BOOST		16000	/* left to the cycle */
#define REGS		32	/* 0x0900-0x091F */
#define APP_WAIT_MS	2000	/* for the first time an application's cycle tells */
#define APP_CYCLES	20	/* or for so many that tell none */
#define CYCLE_BOOST	12000	/* comparisons when the cycle alone compensates */
#define CYCLE_WAIT_MS	3000	/* for them */
#define TRIES		20	/* to set the clocks while frames are lost */
#define OUT_TRIES	5	/* of them that one slave may spoil */
#define TRY_MS		50	/* between them */

/* all slaves of the segment, in ring order */
struct job {
	struct ec_master *m;
	unsigned int n;
	struct ec_slave **slaves;
	struct ec_dc_node *nodes;
	u8 (*regs)[REGS];
	s64 *sum;
	struct ec_dg *dg;
	u8 *spoiled;		/* tries, by it */
	bool *silent;		/* in the last all() */
	u16 followed;		/* station address of the clock the others follow, or 0 */
	unsigned int ref;	/* index, n: none */
	u64 latch_ns;		/* when the last latch was sent */
	bool running;		/* the cycle has corrected clocks until now */
};

static void job_free(struct job *j)
{
	unsigned int i;

	for (i = 0; j->slaves && i < j->n; i++)
		if (j->slaves[i])
			ec_slave_unref(j->slaves[i]);
	kvfree(j->slaves);
	kvfree(j->nodes);
	kvfree(j->regs);
	kvfree(j->sum);
	kvfree(j->dg);
	kvfree(j->spoiled);
	kvfree(j->silent);
}

static bool has_times(const struct ec_slave *s)
{
	return ec_slave_features(s) & EC_FEAT_DC && s->error != EC_SLAVE_SCAN_FAILED;
}

static bool is_clock(const struct job *j, unsigned int i)
{
	return j->nodes[i].dc && !READ_ONCE(j->slaves[i]->dc_delay_only);
}

static void fill_node(struct job *j, unsigned int i)
{
	const struct ec_slave *s = j->slaves[i];
	struct ec_dc_node *n = &j->nodes[i];
	unsigned int p;

	n->parent = s->next[s->upstream] < j->n ? s->next[s->upstream] : EC_DC_NONE;
	n->entry = s->upstream;
	n->dc = has_times(s);
	for (p = 0; p < EC_DC_PORTS; p++) {
		if (s->dl_status & EC_DLS_COMM(p) && !(s->dl_status & EC_DLS_LOOP(p)))
			n->open |= BIT(p);
		if (n->parent != EC_DC_NONE && j->slaves[n->parent]->next[p] == i)
			n->parent_port = p;
	}
}

/* The clock with this station address, or the first one; @n: there is none. */
static unsigned int find(const struct job *j, u16 station)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (is_clock(j, i) && (station == EC_DC_ANY || j->slaves[i]->station == station))
			break;
	return i;
}

/**
 * ec_dc_can_be() - is there a clock to be the reference?
 * @m: master
 * @choice: station address of the reference clock, or EC_DC_ANY...
 *
 * Context: Process. May sleep.
 * Return: whether there is.
 */
bool ec_dc_can_be(struct ec_master *m, u16 choice)
{
	bool ret = false;
	unsigned int i;

	down_read(&m->topo);
	for (i = 0; i < m->n_slaves && !ret; i++)
		ret = has_times(m->slaves[i]) && ec_slave_has_clock(m->slaves[i]) &&
		      (choice == EC_DC_ANY || m->slaves[i]->station == choice);
	up_read(&m->topo);
	return ret;
}

static bool any_set(const struct job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++)
		if (j->slaves[i]->dc_set)
			return true;
	return false;
}

/*
 * The chosen reference clock; else the one the others follow already, so that
 * a slave that comes in front of it changes nothing; else the first one, though
 * it may have only 32 bits: what is in front of the reference gets no time from
 * it. When the chosen one is lost, another stands in, so that the clocks stay
 * together; without it they are not set at all.
 */
static void choose(struct job *j)
{
	u16 choice = READ_ONCE(j->m->dc.choice);

	j->ref = j->n;
	if (choice != EC_DC_ANY) {
		j->ref = find(j, choice);
		if (j->ref == j->n && !any_set(j))
			return;
	}
	if (j->ref == j->n)
		j->ref = find(j, j->followed);
}

static int job_init(struct job *j, struct ec_master *m)
{
	unsigned int i;

	*j = (struct job){ .m = m };
	down_read(&m->topo);
	j->n = m->n_slaves;
	j->slaves = kvcalloc(j->n + 1, sizeof(*j->slaves), GFP_KERNEL);
	for (i = 0; j->slaves && i < j->n; i++)
		j->slaves[i] = ec_slave_ref(m->slaves[i]);
	if (m->dc.ref && m->dc.ref->dc_set && !m->dc.ref->gone)
		j->followed = m->dc.ref->station;
	up_read(&m->topo);
	j->nodes = kvcalloc(j->n + 1, sizeof(*j->nodes), GFP_KERNEL);
	j->regs = kvcalloc(j->n + 1, sizeof(*j->regs), GFP_KERNEL);
	j->sum = kvcalloc(j->n + 1, sizeof(*j->sum), GFP_KERNEL);
	j->dg = kvcalloc(max_t(unsigned int, j->n + 1, BATCH), sizeof(*j->dg), GFP_KERNEL);
	j->spoiled = kvcalloc(j->n + 1, sizeof(*j->spoiled), GFP_KERNEL);
	j->silent = kvcalloc(j->n + 1, sizeof(*j->silent), GFP_KERNEL);
	if (!j->slaves || !j->nodes || !j->regs || !j->sum || !j->dg || !j->spoiled ||
	    !j->silent) {
		job_free(j);
		return -ENOMEM;
	}
	for (i = 0; i < j->n; i++)
		fill_node(j, i);
	choose(j);
	return 0;
}

/* all with receive times; all clocks; those not set yet; of these 64 and 32 bits */
enum who { TIMES, ANY, NEW, NEW_WIDE, NEW_NARROW };

static bool chosen(const struct job *j, unsigned int i, enum who who)
{
	const struct ec_slave *s = j->slaves[i];
	bool wide = ec_slave_features(s) & EC_FEAT_DC64;

	if (who == TIMES)
		return j->nodes[i].dc;
	if (!is_clock(j, i) || who == ANY)
		return is_clock(j, i);
	return !s->dc_set && (who == NEW || wide == (who == NEW_WIDE));
}

/* The same register of every slave with such a clock; its data are at @data. */
static int all(struct job *j, enum who who, u8 cmd, u16 ado, u16 len, u8 *data, size_t stride)
{
	unsigned int i, k, n = 0;
	int ret;

	for (i = 0; i < j->n; i++)
		if (chosen(j, i, who))
			j->dg[n++] = (struct ec_dg)EC_DG(cmd, j->slaves[i]->station, ado, len,
							 data + i * stride);
	ret = ec_xfer(j->m, j->dg, n);
	for (i = 0, k = 0; i < j->n; i++) {
		j->silent[i] = chosen(j, i, who) && j->dg[k++].wkc != 1;
		if (!ret && j->silent[i])
			ret = -EAGAIN;	/* the bus has changed meanwhile */
	}
	return ret;
}

/*
 * Who does not answer while others do is left out after some tries: one bad slave
 * does not keep the others from being set. ec_dc_watch_start() goes on asking it.
 */
static void leave_out(struct job *j)
{
	unsigned int i;

	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->slaves[i];

		if (!j->silent[i] || ++j->spoiled[i] < OUT_TRIES)
			continue;
		j->nodes[i].dc = false;
		if (s->dc_delay_only)
			continue;
		if (!s->dc_out && !s->gone)
			ec_slave_warn(s, "does not answer as it should while the clocks are set: its clock is left out and tried again later\n");
		WRITE_ONCE(s->dc_out, true);
		if (s->station == j->followed)
			j->followed = 0;
		if (i == j->ref)
			choose(j);
	}
}

static int latch(struct job *j)
{
	u8 any[4] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BWR, 0, EC_REG_DC_RECV(0), sizeof(any), any);
	unsigned int i, p;
	int ret;

	ret = ec_xfer(j->m, &dg, 1);
	if (ret < 0)
		return ret;
	j->latch_ns = dg.sent_ns;
	ret = all(j, TIMES, EC_CMD_FPRD, EC_REG_DC_RECV(0), REGS, j->regs[0], REGS);
	for (i = 0; i < j->n; i++)
		for (p = 0; p < EC_DC_PORTS; p++)
			j->nodes[i].recv[p] = get_unaligned_le32(j->regs[i] + 4 * p);
	return ret;
}

/*
 * A clock that is being corrected runs too fast or too slow to measure; but those
 * that are set drift apart as long as they are not.
 */
static void correct_between(struct job *j, u32 cycles, unsigned int limit_ms)
{
	u32 polls = READ_ONCE(j->m->polls);
	unsigned int ms;

	WRITE_ONCE(j->m->dc.running, j->running);
	for (ms = 0; ms < limit_ms && READ_ONCE(j->m->polls) - polls < cycles; ms++)
		usleep_range(1000, 1100);
	WRITE_ONCE(j->m->dc.running, false);
}

static int measure(struct job *j)
{
	unsigned int i, round;
	int ret = 0;

	for (round = 0; round < ROUNDS && !ret; round++) {
		if (j->running && round && round % TOGETHER == 0)
			correct_between(j, CORRECT_CYCLES, CORRECT_MS);
		ret = latch(j);
		ec_dc_delays(j->nodes, j->n, j->ref);
		for (i = 0; i < j->n; i++)
			j->sum[i] += (s32)j->nodes[i].delay;
	}
	for (i = 0; i < j->n && !ret; i++)
		if (j->nodes[i].dc) {
			j->slaves[i]->dc_delay = (u32)div_s64(j->sum[i], ROUNDS);
			j->slaves[i]->dc_hop = j->nodes[i].hop;
			WRITE_ONCE(j->slaves[i]->dc_odd, j->nodes[i].odd);
		}
	return ret;
}

static bool has_front(const struct job *j)
{
	unsigned int i;

	for (i = 0; i < j->ref; i++)
		if (is_clock(j, i))
			return true;
	return false;
}

static void set_ref(struct job *j)
{
	struct ec_dc *dc = &j->m->dc;
	struct ec_slave *old, *ref = j->ref < j->n ? ec_slave_ref(j->slaves[j->ref]) : NULL;

	down_write(&j->m->topo);
	ec_change_begin(j->m);
	old = dc->ref;
	dc->ref = ref;
	WRITE_ONCE(dc->ref_wide, ref && ec_slave_features(ref) & EC_FEAT_DC64);
	WRITE_ONCE(dc->front, ref && has_front(j));
	WRITE_ONCE(dc->ref_station, ref ? ref->station : 0);
	ec_change_end(j->m);
	up_write(&j->m->topo);
	if (old)
		ec_slave_unref(old);
}

/* Receive times no cables make are worth a line. */
static void tell_odd(const struct job *j)
{
	unsigned int i, n = 0, first = 0;

	for (i = j->n; i-- > 0;)
		if (j->nodes[i].odd) {
			first = i;
			n++;
		}
	if (n)
		ec_slave_warn(j->slaves[first], "its receive times and those of %u more slave(s) do not fit to the topology: their clocks may be off; check the cables, then rescan\n",
			      n - 1);
}

/**
 * ec_dc_measure() - find the reference clock and the propagation delays
 * @m: master
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -ENXIO without clocks; -EAGAIN when the bus has changed; -ENOMEM;
 * or as ec_xfer().
 */
int ec_dc_measure(struct ec_master *m)
{
	unsigned int try;
	struct job j;
	int ret = job_init(&j, m);

	if (ret)
		return ret;
	mutex_lock(&m->dc.lock);
	ret = -EAGAIN;
	for (try = 0; j.ref < j.n && ret == -EAGAIN && try <= OUT_TRIES; try++) {
		memset(j.sum, 0, j.n * sizeof(*j.sum));
		ret = measure(&j);
		if (ret == -EAGAIN)
			leave_out(&j);
	}
	if (j.ref == j.n)
		ret = -ENXIO;
	if (ret)
		j.ref = j.n;
	else
		tell_odd(&j);
	set_ref(&j);
	mutex_unlock(&m->dc.lock);
	job_free(&j);
	return ret;
}

/*
 * System time at the reference clock when the last latch was made: what those
 * clocks say that are set already, so that they go on when others join them.
 */
static u64 latch_time(const struct job *j)
{
	u64 t = ec_dc_app_at(j->m, j->latch_ns);
	unsigned int i, set = j->ref;

	for (i = 0; !j->slaves[set]->dc_set && i < j->n; i++)
		if (is_clock(j, i) && j->slaves[i]->dc_set)
			set = i;
	if (j->slaves[set]->dc_set) {
		t = get_unaligned_le64(j->regs[set] + 0x18) + j->slaves[set]->dc_offset -
		    (s64)(s32)j->slaves[set]->dc_delay;
		if (!(ec_slave_features(j->slaves[set]) & EC_FEAT_DC64))
			t = ec_dc_whole(j->m, (u32)t, j->latch_ns);
	}
	ec_dc_clock(j->m, t, j->latch_ns);
	return t;
}

/* System time offset and delay, then the filters: their depths before 0x0930 resets them. */
static int write_clocks(struct job *j)
{
	static u8 depths[2] = { 0, 12 }, reset[2] = { 0x00, 0x10 };
	u64 t = latch_time(j);
	unsigned int i;
	u8 (*v)[12];
	int ret;

	v = kvcalloc(j->n + 1, sizeof(*v), GFP_KERNEL);
	if (!v)
		return -ENOMEM;
	for (i = 0; i < j->n; i++) {
		struct ec_slave *s = j->slaves[i];

		/* counted from the reference, which may be another one now */
		put_unaligned_le32(s->dc_delay, v[i] + 8);
		if (!chosen(j, i, NEW))
			continue;
		s->dc_offset = ec_dc_offset(t, s->dc_delay,
					    get_unaligned_le64(j->regs[i] + 0x18));
		put_unaligned_le64(s->dc_offset, v[i]);
	}
	ret = all(j, NEW_WIDE, EC_CMD_FPWR, EC_REG_DC_OFFSET, 8, v[0], sizeof(v[0])) ?:
	      all(j, NEW_NARROW, EC_CMD_FPWR, EC_REG_DC_OFFSET, 4, v[0], sizeof(v[0])) ?:
	      all(j, ANY, EC_CMD_FPWR, EC_REG_DC_DELAY, 4, v[0] + 8, sizeof(v[0])) ?:
	      all(j, NEW, EC_CMD_FPWR, EC_REG_DC_FILTER_DIFF, 2, depths, 0) ?:
	      all(j, NEW, EC_CMD_FPWR, EC_REG_DC_SPEED_START, 2, reset, 0);
	for (i = 0; i < j->n && !ret; i++)
		if (is_clock(j, i)) {
			WRITE_ONCE(j->slaves[i]->dc_out, false);
			WRITE_ONCE(j->slaves[i]->dc_set, true);
		}
	if (!ret)
		ec_dc_app_set(j->m, t - j->latch_ns, true);
	kvfree(v);
	return ret;
}

/*
 * Drift compensation. Each frame gives a slave one measurement of its rate,
 * with 10 ns of noise over the time since the last frame, and as many steps
 * towards it as it has datagrams. So: first many short frames, to come near;
 * then fewer and long ones with ever smaller steps, to lose the noise; then the
 * cycle alone, with some more datagrams than usual (@boost). What noise is left
 * after the first stage, some ppm, must go soon: the second one is quick, too, and
 * ends before slaves begin to use their clocks, whose frames would slow it down.
 */
static const struct stage {
	u16 syncs;	/* datagrams of a frame that carry the time */
	u16 pad;	/* bytes of one without effect that makes it longer */
	u16 batch;	/* frames at once, at most */
	u16 frames;	/* in all */
} near = { .syncs = 15, .batch = 100, .frames = 1600 },
  nearer = { .syncs = 8, .pad = 560, .batch = 30, .frames = 900 },
  quiet = { .syncs = 8, .pad = 1320, .batch = 15, .frames = 1200 },
  calm = { .syncs = 1, .pad = 1460, .batch = 15, .frames = 2400 };

/*
 * With slaves in front of the reference only the cycle may tell the time: what
 * waits in a queue tells them one that has passed.
 */
static int compensate_by_cycle(struct ec_dc *dc)
{
	unsigned int ms;

	WRITE_ONCE(dc->boost, CYCLE_BOOST);
	for (ms = 0; ms < CYCLE_WAIT_MS && READ_ONCE(dc->boost); ms++) {
		if (READ_ONCE(dc->stop))
			return -ECANCELED;
		usleep_range(1000, 1100);
	}
	return 0;
}

/*
 * Bytes that make a frame longer: less beside a short cycle, whose own frames keep
 * them apart.
 */
static u16 pad_bytes(const struct job *j, const struct stage *st, u16 bytes)
{
	u16 syncs = st->syncs * (bytes + EC_DGRAM_OVERHEAD), room = ec_cycle_room(j->m);

	return room > syncs ? min_t(u16, st->pad, room - syncs) : 0;
}

/*
 * Frames at once. Half of the cycle stays free, so that none of them is close before
 * the cycle's: over a short distance the noise looks like some 1000 ppm.
 */
static u16 batch(const struct job *j, const struct stage *st, u16 bytes, u16 pad)
{
	u32 frame_ns = ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD + pad +
					st->syncs * (bytes + EC_DGRAM_OVERHEAD));
	u32 fit = READ_ONCE(j->m->interval_us) * (u32)(NSEC_PER_USEC / 2) / frame_ns;

	return st->pad ? clamp_t(u32, fit, 1, st->batch) : st->batch;
}

static int compensate(struct job *j, const struct stage *st)
{
	static u8 pad[EC_DGRAM_DATA_MAX];
	struct ec_dc *dc = &j->m->dc;
	u16 bytes = READ_ONCE(dc->ref_wide) ? 8 : 4;
	unsigned int i, k, n, done, frames;
	u8 t[8];
	int ret = 0;

	if (READ_ONCE(dc->front))
		return st == &near ? compensate_by_cycle(dc) : 0;
	for (done = 0; done < st->frames && !ret; done += frames) {
		u16 ref = READ_ONCE(dc->ref_station), len = pad_bytes(j, st, bytes);

		if (!ref || READ_ONCE(dc->stop))
			return -ECANCELED;
		frames = batch(j, st, bytes, len);
		/* for the case that the reference does not answer */
		put_unaligned_le64(ec_dc_clock_now(j->m), t);
		/* far from the frame of the cycle, too */
		n = 0;
		if (st->pad)
			j->dg[n++] = (struct ec_dg)EC_DG(EC_CMD_NOP, 0, 0, ec_cycle_room(j->m),
							 pad);
		for (i = 0; i < frames; i++) {
			for (k = 0; k < st->syncs; k++)
				j->dg[n++] = (struct ec_dg)EC_DG(EC_CMD_FRMW, ref,
								 EC_REG_DC_SYSTIME, bytes, t);
			if (len)
				j->dg[n++] = (struct ec_dg)EC_DG(EC_CMD_NOP, 0, 0, len, pad);
		}
		for (i = 0; i < n; i++)
			j->dg[i].repeat = false;
		ret = ec_xfer_clock(j->m, j->dg, n);
		if (ret == -ETIMEDOUT || ret == -EBUSY)
			ret = 0;	/* one more or less */
	}
	return ret;
}

/* What each slave says of its difference to the reference, register 0x092C. */
static int check(struct job *j)
{
	u8 (*v)[4] = kvcalloc(j->n + 1, sizeof(*v), GFP_KERNEL);
	unsigned int i;
	int ret;

	if (!v)
		return -ENOMEM;
	ret = all(j, ANY, EC_CMD_FPRD, EC_REG_DC_DIFF, 4, v[0], sizeof(v[0]));
	/* one that is silent now was set before */
	if (ret == -EAGAIN)
		ret = 0;
	for (i = 0; i < j->n && !ret; i++)
		if (is_clock(j, i) && !j->silent[i])
			ec_dc_verdict(j->slaves[i], get_unaligned_le32(v[i]));
	kvfree(v);
	return ret;
}

/*
 * Applications may tell quite another time in their cycle than before activation.
 * Their first cycle is awaited, so that the clocks begin with what they go on with.
 */
static void await_time(struct ec_master *m, u64 since)
{
	u32 polls = READ_ONCE(m->polls);
	unsigned int i;

	for (i = 0; i < 500; i++) {
		if (!READ_ONCE(m->dc.has_phase) || READ_ONCE(m->dc.stop) ||
		    READ_ONCE(m->dc.wanted) ||
		    (s64)(ec_read64(&m->dc.app_ktime) - since) >= 0 ||
		    READ_ONCE(m->polls) - polls >= 3)
			return;
		usleep_range(900, 1100);
	}
}

static void set_state(struct ec_dc *dc, int state)
{
	WRITE_ONCE(dc->state, state);
	wake_up_all(&dc->wq);
}

/*
 * The time an application tells before its cycle runs may be of another decade
 * than those of the cycle: the clocks shall have the latter.
 */
static void await_cycle(struct ec_master *m)
{
	u32 polls = READ_ONCE(m->polls);
	struct ec_dc *dc = &m->dc;
	unsigned int ms;

	WRITE_ONCE(dc->idle, true);
	for (ms = 0; ms < APP_WAIT_MS && !READ_ONCE(dc->told) && !READ_ONCE(dc->stop) &&
	     READ_ONCE(m->polls) - polls < APP_CYCLES; ms++)
		usleep_range(1000, 1100);
	WRITE_ONCE(dc->idle, false);
}

/* Another reference than before, or none, is worth a line. */
static void tell_ref(const struct job *j, bool lost)
{
	struct ec_master *m = j->m;
	u16 choice = READ_ONCE(m->dc.choice);
	u16 now = READ_ONCE(m->dc.ref_station), at = now ? j->slaves[j->ref]->position : 0;

	if (!now)
		ec_warn(m, "the reference clock is gone; the clocks run free until it is back\n");
	else if (choice != EC_DC_ANY && choice != now)
		ec_warn(m, "the reference clock is gone; slave %u stands in for it until it is back\n",
			at);
	else if (lost)
		ec_warn(m, "the reference clock is gone; slave %u is the reference clock now\n", at);
	else
		ec_info(m, "slave %u is the reference clock now\n", at);
}

static void change_ref(struct job *j, bool found)
{
	struct ec_master *m = j->m;
	u16 before = READ_ONCE(m->dc.ref_station), now;
	bool lost = before && m->dc.ref && m->dc.ref->gone;

	if (found)
		set_ref(j);
	else	/* until it is back or the session ends; the bus has not lost it */
		WRITE_ONCE(m->dc.ref_station, 0);
	now = READ_ONCE(m->dc.ref_station);
	if (!m->dc.fresh && before != now)
		tell_ref(j, lost);
}

static bool passes(int ret)
{
	return ret == -EAGAIN || ret == -ETIMEDOUT || ret == -EBUSY;
}

/*
 * Frames may be lost, and slaves may be busy with leaving or coming. Until a new
 * reference clock is set, the cycle goes on with the one before.
 */
static int set(struct job *j)
{
	struct ec_dc *dc = &j->m->dc;
	unsigned int try;
	int ret = -ENXIO;

	if (j->ref == j->n)
		change_ref(j, false);
	for (try = 0; j->ref < j->n && try < TRIES; try++) {
		memset(j->sum, 0, j->n * sizeof(*j->sum));
		ret = measure(j) ?: write_clocks(j);
		if (!ret)
			change_ref(j, true);
		if (!passes(ret) || READ_ONCE(dc->stop))
			break;
		if (ret == -EAGAIN)
			leave_out(j);
		correct_between(j, ~0, TRY_MS);
	}
	if (j->ref < j->n || !try)
		return ret;
	/* the only one there may be does not answer */
	change_ref(j, false);
	return -ENXIO;
}

static void work(struct work_struct *work)
{
	struct ec_dc *dc = container_of(work, struct ec_dc, work);
	struct ec_master *m = container_of(dc, struct ec_master, dc);
	unsigned int i;
	struct job j;
	bool was;
	u64 t0;
	int ret;

	if (dc->fresh)
		await_cycle(m);
	if (READ_ONCE(dc->stop))
		return;
	t0 = ktime_get_ns();
	ret = job_init(&j, m);
	if (ret) {
		set_state(dc, EC_DC_OFF);
		return;
	}
	if (j.ref < j.n && !j.slaves[j.ref]->dc_set)
		await_time(m, t0);
	if (READ_ONCE(dc->stop)) {
		job_free(&j);
		return;
	}
	mutex_lock(&dc->lock);
	was = READ_ONCE(dc->running);
	j.running = was;
	WRITE_ONCE(dc->running, false);
	ret = set(&j);
	ec_write64(&dc->begun_ns, ktime_get_ns());
	/* those that were set before need the cycle in any case */
	WRITE_ONCE(dc->running, !ret || (was && ret != -ENXIO));
	ret = ret ?: compensate(&j, &near) ?: compensate(&j, &nearer) ?: check(&j);
	mutex_unlock(&dc->lock);
	if (!ret)
		ec_info(m, "clocks set in %llu us, reference clock is slave %u\n",
			div_u64(ktime_get_ns() - t0, 1000), j.slaves[j.ref]->position);
	else if (ret != -ENXIO && ret != -ECANCELED)
		ec_warn(m, "clocks could not be set (%pe)\n", ERR_PTR(ret));
	WRITE_ONCE(dc->boost, ret || READ_ONCE(dc->front) ? 0 : BOOST);
	WRITE_ONCE(dc->failed, passes(ret));
	set_state(dc, ret ? EC_DC_OFF : EC_DC_READY);
	/* ec_dc_sync_start() has the other half of this barrier */
	smp_mb();
	for (i = 0; !ret && i < j.n; i++)
		if (READ_ONCE(j.slaves[i]->dc_set))
			ec_dc_sync_again(j.slaves[i]);
	if (!ret)
		ret = compensate(&j, &quiet) ?: compensate(&j, &calm);
	job_free(&j);
}

static void stop(struct ec_dc *dc)
{
	WRITE_ONCE(dc->stop, true);
	cancel_work_sync(&dc->work);
	ec_dc_watch_stop(dc);
}

/**
 * ec_dc_begin() - set the clocks of a session, or of slaves that join it
 * @m: master
 * @all: all of them, from the application's time; else only new ones, from the
 *	reference clock
 * @choice: station address of the reference clock, or EC_DC_ANY...
 *
 * Context: Process. May sleep.
 */
void ec_dc_begin(struct ec_master *m, bool all, u16 choice)
{
	unsigned int i;

	stop(&m->dc);
	down_read(&m->topo);
	for (i = 0; all && i < m->n_slaves; i++) {
		WRITE_ONCE(m->slaves[i]->dc_set, false);
		m->slaves[i]->dc_vain = 0;
	}
	up_read(&m->topo);
	WRITE_ONCE(m->dc.stop, false);
	if (all)
		ec_dc_app_set(m, 0, false);
	/* that of the application before is none of this one */
	if (all && !ec_dc_can_be(m, choice))
		WRITE_ONCE(m->dc.ref_station, 0);
	/* who joins before the application has told its time does not set another one */
	m->dc.fresh = all || (m->dc.fresh && !m->dc.app.set);
	ec_dc_watch_begun(&m->dc);
	WRITE_ONCE(m->dc.told, false);
	WRITE_ONCE(m->dc.choice, choice);
	m->dc.begun = true;
	if (all)
		m->dc.far_told = false;
	set_state(&m->dc, EC_DC_BUSY);
	queue_work(m->service, &m->dc.work);
	ec_dc_watch_start(m);
}

/**
 * ec_dc_end() - the session ends: its phase means nothing any more
 * @m: master
 *
 * Context: Process. May sleep.
 */
void ec_dc_end(struct ec_master *m)
{
	unsigned long flags;

	stop(&m->dc);
	WRITE_ONCE(m->dc.running, false);
	raw_spin_lock_irqsave(&m->dc.time_lock, flags);
	m->dc.has_phase = false;
	ec_write64(&m->dc.app_time, 0);
	m->dc.choice = EC_DC_ANY;
	m->dc.begun = false;
	m->dc.wanted = false;
	m->dc.again = false;
	m->dc.failed = false;
	raw_spin_unlock_irqrestore(&m->dc.time_lock, flags);
	ec_dc_app_set(m, 0, false);
	down_read(&m->topo);
	WRITE_ONCE(m->dc.ref_station, m->dc.ref ? m->dc.ref->station : 0);
	up_read(&m->topo);
	set_state(&m->dc, EC_DC_OFF);
}

void ec_dc_init(struct ec_master *m)
{
	struct ec_dc *dc = &m->dc;

	mutex_init(&dc->lock);
	INIT_WORK(&dc->work, work);
	ec_dc_watch_init(dc);
	init_waitqueue_head(&dc->wq);
	raw_spin_lock_init(&dc->time_lock);
}

void ec_dc_exit(struct ec_master *m)
{
	stop(&m->dc);
	if (m->dc.ref)
		ec_slave_unref(m->dc.ref);
	m->dc.ref = NULL;
}
