// SPDX-License-Identifier: GPL-2.0-only
/*
 * Distributed clock of one slave.
 *
 * The local time advances by 10 ns a tick, corrected by 1 ns at most: a write
 * to 0x0910 never sets it. Each comparison does two things, as silicon does:
 *
 * - phase: a part of the filtered difference is slewed away, not faster than
 *   1 ns per tick;
 * - rate: the deviation of the clock period, measured from one comparison to
 *   the next, is averaged with the depth of 0x0935 into a rate correction.
 *
 * How much of the phase is taken per comparison is not published; 1/64 gives
 * what is seen on hardware: a burst of some 15000 comparisons settles a clock
 * within noise, at 1 kHz the same takes several seconds.
 */
#include "esc_int.h"

#define PHASE_SHARE	64
#define MAX_SLEW_NS	10000		/* goes on without comparisons: keep small */
#define MAX_ADJ_PPB	763000		/* range of 0x0932 at its default start */
#define MAX_DIFF	0x7fffffffLL
#define DEV_LIMIT_PPB	1000000

static s64 clamp64(s64 v, s64 limit)
{
	return v > limit ? limit : v < -limit ? -limit : v;
}

static bool is_64bit(const struct ec_esc *esc)
{
	return esc->cfg.features & EC_FEAT_DC64;
}

/* phase correction made after @dt ns */
static s64 slewed(const struct ec_esc_dc *dc, s64 dt)
{
	return dt > 0 ? clamp64(dc->slew, div_s64(dt, 10)) : 0;
}

/* local time at @now; @frac gets the fraction in 1e-9 ns */
static u64 local_at(const struct ec_esc *esc, u64 now, s32 *frac)
{
	const struct ec_esc_dc *dc = &esc->dc;
	s64 rate = esc->cfg.drift_ppb + (dc->adj_ppb16 >> 16);
	s64 dt = (s64)(now - dc->base_ns), left = dt, extra = 0, acc;
	s64 f = dc->base_frac;

	while (left) {				/* 1e12 ns a step: no overflow */
		s64 part = clamp64(left, 1000000000000LL);

		acc = part * rate + f;
		extra += div_s64(acc, 1000000000);
		f = acc - div_s64(acc, 1000000000) * 1000000000;
		left -= part;
	}
	if (frac)
		*frac = (s32)f;
	return dc->base_local + (u64)(dt + extra + slewed(dc, dt));
}

/**
 * ec_esc_local_time() - local clock of a slave
 * @esc: slave controller
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns since power-on plus the configured start, corrected by the
 * control loop.
 */
u64 ec_esc_local_time(const struct ec_esc *esc, u64 now)
{
	return local_at(esc, now, NULL);
}

static u64 offset(const struct ec_esc *esc)
{
	u64 v = get_unaligned_le64(esc->mem + EC_REG_DC_OFFSET);

	return ec_esc_bug(esc, EC_SIM_BUG_OFFSET_SIGN) ? -v : v;
}

/**
 * ec_esc_system_time() - local copy of the system time
 * @esc: slave controller
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: ns; 32 bits of it for a 32-bit clock.
 */
u64 ec_esc_system_time(const struct ec_esc *esc, u64 now)
{
	u64 t = ec_esc_local_time(esc, now) + offset(esc);

	return is_64bit(esc) ? t : (u32)t;
}

/*
 * System time that does not wrap: the comparators of a 32-bit SYNC unit go on
 * from one pulse to the next, so only the start has to be within half its range.
 */
static u64 long_time(const struct ec_esc *esc, u64 now)
{
	return ec_esc_local_time(esc, now) + offset(esc);
}

static s64 noise(const struct ec_esc *esc, u64 now, u32 salt)
{
	u32 n = esc->cfg.dc_noise_ns;
	u64 h;

	if (!n)
		return 0;
	h = ec_sim_hash(esc->sim->seed ^ now ^ (u64)esc->index << 40 ^
			(u64)salt << 60);
	return (s64)((u32)h % (n + 1)) - n / 2;
}

/* start a new stretch of constant rate */
static void rebase(struct ec_esc *esc, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	s64 done = slewed(dc, (s64)(now - dc->base_ns));
	s32 frac;

	dc->base_local = local_at(esc, now, &frac);
	dc->base_frac = frac;
	dc->base_ns = now;
	dc->slew -= done;
}

/**
 * ec_esc_dc_jump() - the local clock jumps
 * @esc: slave controller
 * @by: how far, ns; back when negative
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_dc_jump(struct ec_esc *esc, s64 by, u64 now)
{
	rebase(esc, now);
	esc->dc.base_local += (u64)by;
	esc->dc.have_cmp = false;
	ec_esc_dc_schedule(esc, now);
}

void ec_esc_dc_reset(struct ec_esc *esc, u64 now)
{
	memset(&esc->dc, 0, sizeof(esc->dc));
	esc->dc.base_ns = now;
	esc->dc.base_local = esc->cfg.clock_start;
	esc->dc.sync_wake = EC_ESC_NEVER;
	put_unaligned_le16(0x1000, esc->mem + EC_REG_DC_SPEED_START);
	esc->mem[EC_REG_DC_FILTER_DIFF] = 4;
	esc->mem[EC_REG_DC_FILTER_SPEED] = 12;
}

static void reset_filters(struct ec_esc *esc, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;

	rebase(esc, now);
	dc->slew = 0;
	dc->adj_ppb16 = 0;
	dc->diff = 0;
	dc->have_cmp = false;
	dc->dev_ppb16 = 0;
}

static u32 depth(const struct ec_esc *esc, u16 reg)
{
	return esc->mem[reg] & 15;
}

/* a reference time came in */
static void compare(struct ec_esc *esc, u64 received, bool wide, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	u64 local, sys;
	s64 diff, dl, want, done, step;

	done = slewed(dc, (s64)(now - dc->base_ns));
	rebase(esc, now);
	local = dc->base_local;
	sys = local + offset(esc);
	if (!ec_esc_bug(esc, EC_SIM_BUG_DC_DELAY))
		sys -= get_unaligned_le32(esc->mem + EC_REG_DC_DELAY);
	if (wide && is_64bit(esc))
		diff = clamp64((s64)(sys - received), MAX_DIFF);
	else
		diff = (s32)(u32)(sys - received);
	diff = clamp64(diff + noise(esc, now, 5), MAX_DIFF);

	if (!dc->have_cmp) {
		dc->diff = diff * 256;
		dl = 0;
		/* measured with another offset or delay */
		dc->dev_ppb16 = 0;
	} else {
		dc->diff += (diff * 256 - dc->diff) >>
			    depth(esc, EC_REG_DC_FILTER_DIFF);
		dl = (s64)(local - dc->last_cmp);
	}
	if (dl > 0) {
		s64 change = diff - dc->last_diff - done;

		/* a jump is no drift: the offset or delay was written */
		if (change > dl || change < -dl)
			dc->dev_ppb16 = 0;
		else
			dc->dev_ppb16 = clamp64(div64_s64(change * 1000000000,
							  dl),
						DEV_LIMIT_PPB) * 65536;
	}
	step = dc->dev_ppb16 >> depth(esc, EC_REG_DC_FILTER_SPEED);
	if (ec_esc_bug(esc, EC_SIM_BUG_DC_DRIFT))
		step = 0;
	dc->dev_ppb16 -= step;
	dc->adj_ppb16 = clamp64(dc->adj_ppb16 - step, MAX_ADJ_PPB * 65536LL);

	want = -div_s64(dc->diff, 256 * PHASE_SHARE);
	if (!want && dc->diff)
		want = dc->diff > 0 ? -1 : 1;
	dc->slew = clamp64(want, MAX_SLEW_NS);
	dc->last_diff = diff;
	dc->last_cmp = local;
	dc->have_cmp = true;
}

/* SYNC0 pulses up to @sys: the number of the next one */
static u64 sync_number(const struct ec_esc *esc, u64 sys)
{
	u32 cycle = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE0);
	u64 since = sys - esc->dc.start;

	if (since >> 63)	/* start lies ahead */
		return 0;
	return cycle ? div_u64(since, cycle) + 1 : 1;
}

static u64 sync0_time(const struct ec_esc *esc, u64 number)
{
	u32 cycle = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE0);

	number += ec_esc_bug(esc, EC_SIM_BUG_SYNC_LATE);
	return esc->dc.start + number * cycle;
}

/*
 * SYNC0 pulses per SYNC1 pulse. SYNC1 comes its time after a SYNC0, and the next
 * SYNC0 starts that time anew (Beckhoff ESC data sheet, section I, 9.2.3.5): of n
 * pulses it belongs to the last one, so that the first one comes 0x09A4 after the start.
 */
static u32 sync1_factor(const struct ec_esc *esc)
{
	u32 c0 = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE0);
	u32 c1 = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE1);

	return c0 && c1 >= c0 ? c1 / c0 + 1 : 1;
}

static u32 sync1_shift(const struct ec_esc *esc)
{
	u32 c0 = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE0);
	u32 c1 = get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE1);

	return c0 ? c1 % c0 : c1;
}

static u8 activation(const struct ec_esc *esc)
{
	return esc->mem[EC_REG_DC_ACTIVATION];
}

/* pulses of SYNC0 (@which 0) or SYNC1 (1) until now */
static u64 sync_pulses(const struct ec_esc *esc, int which, u64 now)
{
	u64 sys = long_time(esc, now), n;
	u32 f = sync1_factor(esc);

	if (!esc->dc.running || !(activation(esc) & BIT(1 + which)))
		return 0;
	if (!which)
		return sync_number(esc, sys);
	n = sync_number(esc, sys - sync1_shift(esc));
	return div_u64(n, f);
}

/**
 * ec_esc_dc_sync_ran() - did the SYNC signals begin that are switched on?
 * @esc: slave controller
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: one of them has made no pulse since it was started.
 */
bool ec_esc_dc_sync_ran(const struct ec_esc *esc, u64 now)
{
	int i;

	for (i = 0; i < 2; i++)
		if (activation(esc) & BIT(1 + i) && !sync_pulses(esc, i, now))
			return false;
	return true;
}

/*
 * Pulse length 0, acknowledge mode: the signal stays until the PDI reads
 * 0x098e or 0x098f, and meanwhile makes no further edge.
 */
static bool sync_held(const struct ec_esc *esc, int which, u64 pulses)
{
	return !ec_esc_get16(esc, EC_REG_DC_PULSE) &&
	       pulses > esc->dc.sync_acked[which] &&
	       !ec_esc_bug(esc, EC_SIM_BUG_SYNC_NO_ACK);
}

/* the PDI reads 0x098e, 0x098f or both */
void ec_esc_dc_sync_ack(struct ec_esc *esc, u16 ado, u32 len, u64 now)
{
	int i;

	for (i = 0; i < 2; i++) {
		if (!ec_range_hit(ado, len, EC_REG_DC_SYNC0_STATUS + (u32)i, 1))
			continue;
		esc->dc.sync_acked[i] = sync_pulses(esc, i, now);
		esc->al_event &= (u32)~(i ? EC_AL_EVENT_SYNC1 :
					    EC_AL_EVENT_SYNC0);
	}
}

static bool wants_sync(const struct ec_esc *esc)
{
	return esc->dc.running && esc->app_ops && esc->app_ops->sync &&
	       activation(esc) & 0x06 && esc->eep.loaded;
}

/* simulation time at which the system time of the slave reaches @sys */
static u64 sim_time(const struct ec_esc *esc, u64 sys, u64 now)
{
	u64 t = now;
	s64 d;
	int i;

	for (i = 0; i < 4; i++) {
		d = (s64)(sys - long_time(esc, t));
		if (!d)
			break;
		if (d > 0x3fffffffffffffffLL)
			return EC_ESC_NEVER;
		t += (u64)d;
	}
	return max(t, now + 1);
}

/*
 * Plans the next pulse, if the application listens. SYNC1 is reported together with
 * SYNC0 when its shift is 0, else at its own time; the two alternate as
 * numbers 2n and 2n + 1 of sync_next.
 */
void ec_esc_dc_schedule(struct ec_esc *esc, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	u64 n = dc->sync_next >> 1;

	if (!wants_sync(esc) ||
	    (n && !get_unaligned_le32(esc->mem + EC_REG_DC_CYCLE0)))
		dc->sync_wake = EC_ESC_NEVER;
	else
		dc->sync_wake = sim_time(esc, sync0_time(esc, n) +
					 (dc->sync_next & 1 ?
					  sync1_shift(esc) : 0), now);
	ec_sim_touch(esc);
}

/* a planned pulse is due; the clock may have been slowed down meanwhile */
void ec_esc_dc_sync(struct ec_esc *esc, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	u64 n = dc->sync_next >> 1, due;
	bool second = dc->sync_next & 1;
	u64 sys = long_time(esc, now);
	s64 ahead;

	dc->sync_wake = EC_ESC_NEVER;
	if (!wants_sync(esc))
		return;
	due = sync0_time(esc, n) + (second ? sync1_shift(esc) : 0);
	ahead = (s64)(due - sys);
	if (ahead > 0) {
		ec_esc_dc_schedule(esc, now);
		return;
	}
	if (!second) {
		dc->sync_next++;
		if (activation(esc) & 0x02 && !sync_held(esc, 0, n)) {
			esc->al_event |= EC_AL_EVENT_SYNC0;
			esc->app_ops->sync(esc, 0, now);
		}
	} else {
		u32 factor = sync1_factor(esc);
		u64 q = div_u64(n, factor);

		dc->sync_next++;
		if (activation(esc) & 0x04 && n == q * factor + factor - 1 &&
		    !sync_held(esc, 1, q)) {
			esc->al_event |= EC_AL_EVENT_SYNC1;
			esc->app_ops->sync(esc, 1, now);
		}
	}
	if (wants_sync(esc))
		ec_esc_dc_schedule(esc, now);
}

static void activate(struct ec_esc *esc, u8 old, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	u8 act = activation(esc);
	u64 sys = long_time(esc, now);
	s64 ahead;

	if (!(act & 1)) {
		dc->running = false;
		dc->implausible = false;
	} else if (!(old & 1)) {
		dc->start = get_unaligned_le64(esc->mem + EC_REG_DC_START);
		ahead = is_64bit(esc) ? (s64)(dc->start - sys) :
					(s32)(u32)(dc->start - sys);
		dc->start = sys + (u64)ahead;
		/*
		 * A start in the past: with the check it is refused, without
		 * it the comparator waits for the next wrap (64 bit: never).
		 */
		dc->implausible = act & 0x20 &&
			(ahead <= 0 || (act & 0x40 && ahead >= 1LL << 31));
		dc->running = ahead > 0 && !dc->implausible;
		dc->sync_next = 0;
		dc->sync_acked[0] = 0;
		dc->sync_acked[1] = 0;
	}
	ec_esc_dc_schedule(esc, now);
}

static void latch_receive(struct ec_esc *esc, const struct ec_frame_ctx *ctx)
{
	int p;

	if (ec_esc_bug(esc, EC_SIM_BUG_NO_RECV_TIMES))
		return;
	for (p = 0; p < EC_MAX_PORT; p++) {
		u64 t;

		if (!(ctx->recv_mask & BIT(p)))
			continue;
		t = ctx->recv[ec_esc_bug(esc, EC_SIM_BUG_RECV_SAME) ? 0 : p];
		t = ec_esc_local_time(esc, t) + (u64)noise(esc, t, (u32)p);
		put_unaligned_le32((u32)t, esc->mem + EC_REG_DC_RECV(p));
	}
	if (!ec_esc_has_clock(esc))
		return;
	put_unaligned_le64(ec_esc_local_time(esc, ctx->now) +
			   (u64)noise(esc, ctx->now, 0),
			   esc->mem + EC_REG_DC_RECV_PU);
	if (!is_64bit(esc))
		put_unaligned_le32(0, esc->mem + EC_REG_DC_RECV_PU + 4);
}

static void put_sync_time(struct ec_esc *esc, u16 reg, u64 t)
{
	put_unaligned_le64(is_64bit(esc) ? t : (u32)t, esc->mem + reg);
}

/* bring the computed registers up to date */
void ec_esc_dc_refresh(struct ec_esc *esc, u64 now)
{
	struct ec_esc_dc *dc = &esc->dc;
	u8 *m = esc->mem;
	u64 sys, mag, n;
	s64 speed;
	u32 v, s;

	if (!ec_esc_has_clock(esc))
		return;
	put_unaligned_le64(ec_esc_system_time(esc, now), m + EC_REG_DC_SYSTIME);
	sys = long_time(esc, now);

	mag = (u64)(dc->diff < 0 ? -dc->diff : dc->diff) >> 8;
	v = (u32)mag;
	if (ec_esc_bug(esc, EC_SIM_BUG_DIFF_TWOS))
		v = (u32)(dc->diff >> 8);
	else if (dc->have_cmp && dc->diff >= 0)
		v |= (u32)EC_DC_DIFF_AHEAD;
	put_unaligned_le32(v, m + EC_REG_DC_DIFF);

	s = ec_esc_get16(esc, EC_REG_DC_SPEED_START) + 2u;
	speed = div_s64((dc->adj_ppb16 >> 16) * 5 * s * s, 1000000000);
	put_unaligned_le16((u16)(s16)clamp64(speed, s > 0x81 ? s - 0x81 : 0),
			   m + EC_REG_DC_SPEED_DIFF);

	v = dc->implausible ? 0x04 : 0;
	if (activation(esc) & 1) {
		n = dc->running ? sync_number(esc, sys) : 0;
		for (s = 0; s < 2; s++)
			if (activation(esc) & BIT(1 + s) && !sync_pulses(esc, (int)s, now))
				v |= BIT(s);
		put_sync_time(esc, EC_REG_DC_START, sync0_time(esc, n));
		if (dc->running && activation(esc) & 0x04) {
			u64 k = sync_pulses(esc, 1, now) + 1;

			put_sync_time(esc, EC_REG_DC_NEXT_SYNC1, sync1_shift(esc) +
				      sync0_time(esc, k * sync1_factor(esc) - 1));
		}
	}
	/* without it there is anything in its place */
	if (esc->cfg.features & EC_FEAT_DC_ENHANCED)
		m[EC_REG_DC_ACT_STATUS] = (u8)v;
	m[EC_REG_DC_SYNC0_STATUS] = sync_held(esc, 0, sync_pulses(esc, 0, now));
	m[EC_REG_DC_SYNC1_STATUS] = sync_held(esc, 1, sync_pulses(esc, 1, now));
	m[EC_REG_DC_LATCH0_STATUS] = dc->latch_status[0];
	m[EC_REG_DC_LATCH1_STATUS] = dc->latch_status[1];
}

/* reading latch times acknowledges them, for the side that owns the unit */
void ec_esc_dc_read(struct ec_esc *esc, u16 ado, size_t len, bool pdi)
{
	static const u16 reg[4] = {
		EC_REG_DC_LATCH0_POS, EC_REG_DC_LATCH0_NEG,
		EC_REG_DC_LATCH1_POS, EC_REG_DC_LATCH1_NEG,
	};
	int i;

	for (i = 0; i < 4; i++) {
		bool owner = esc->mem[EC_REG_DC_CUC] & BIT(4 + i / 2);

		if (owner == pdi &&
		    ec_range_hit(ado, (u32)len, reg[i], 1))
			esc->dc.latch_status[i / 2] &= (u8)~BIT(i % 2);
	}
	if (!((esc->dc.latch_status[0] | esc->dc.latch_status[1]) & 3)) {
		ec_esc_event(esc, 0, EC_ECAT_EVENT_DC_LATCH);
		esc->al_event &= (u32)~EC_AL_EVENT_DC_LATCH;
	}
}

/**
 * ec_esc_latch() - an edge at a latch input
 * @esc: slave controller
 * @channel: 0 or 1
 * @rising: which edge
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_latch(struct ec_esc *esc, int channel, bool rising, u64 now)
{
	u8 *st = &esc->dc.latch_status[channel];
	u8 bit = rising ? 1 : 2;
	u16 reg = channel ? EC_REG_DC_LATCH1_POS : EC_REG_DC_LATCH0_POS;
	bool single = esc->mem[EC_REG_DC_LATCH0_CTRL + channel] & bit;
	bool pdi = esc->mem[EC_REG_DC_CUC] & BIT(4 + channel);

	*st = (u8)((*st & ~4) | (rising ? 4 : 0));
	if (single && *st & bit)
		return;
	*st |= bit;
	put_unaligned_le64(ec_esc_system_time(esc, now),
			   esc->mem + reg + (rising ? 0 : 8));
	if (pdi)
		esc->al_event |= EC_AL_EVENT_DC_LATCH;
	else
		ec_esc_event(esc, EC_ECAT_EVENT_DC_LATCH, 0);
}

/* a register of the SYNC unit or a latch unit: the bit of 0x0980 it goes by */
static u8 unit_of(u32 a, bool running)
{
	if (a == EC_REG_DC_ACTIVATION ||
	    (a >= EC_REG_DC_START && a < EC_REG_DC_START + 8 && !running) ||
	    (a >= EC_REG_DC_CYCLE0 && a < EC_REG_DC_LATCH0_CTRL))
		return BIT(0);
	return a == EC_REG_DC_LATCH0_CTRL ? BIT(4) :
	       a == EC_REG_DC_LATCH1_CTRL ? BIT(5) : 0;
}

/* registers the master may write, without those that act */
static bool is_plain(const struct ec_esc *esc, u32 a, bool running)
{
	u8 unit = unit_of(a, running);

	if (unit)
		return !(esc->mem[EC_REG_DC_CUC] & unit);
	return (a >= EC_REG_DC_OFFSET && a < EC_REG_DC_DIFF) ||
	       (a >= EC_REG_DC_SPEED_START && a < EC_REG_DC_SPEED_DIFF) ||
	       (a >= EC_REG_DC_FILTER_DIFF && a <= 0x0936) ||
	       a == EC_REG_DC_CUC;
}

/* SYNC and latch units were written */
static void units_written(struct ec_esc *esc, u16 ado, u32 n, u8 old, u64 now)
{
	if (ec_range_hit(ado, n, EC_REG_DC_START, 8) && old & 0x08 &&
	    !(old & 1))
		esc->mem[EC_REG_DC_ACTIVATION] |= 1;	/* auto activation */
	if (activation(esc) != old ||
	    ec_range_hit(ado, n, EC_REG_DC_OFFSET, 8))
		activate(esc, old, now);
}

/* the PDI writes to the units that 0x0980 gives it */
void ec_esc_dc_pdi_write(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len,
			 u64 now)
{
	u8 old = activation(esc);
	u32 i;

	if (!ec_esc_has_clock(esc))
		return;
	for (i = 0; i < len; i++)
		if (esc->mem[EC_REG_DC_CUC] & unit_of(ado + i, old & 1))
			esc->mem[ado + i] = buf[i];
	units_written(esc, ado, len, old, now);
}

/* the master writes the system time, 4 bytes or, if @wide, 8 */
void ec_esc_dc_time(struct ec_esc *esc, const u8 *buf, bool wide, u64 now)
{
	u64 t = wide ? get_unaligned_le64(buf) : get_unaligned_le32(buf);

	if (ec_esc_bug(esc, EC_SIM_BUG_DC_JUMP)) {
		rebase(esc, now);
		esc->dc.base_local = t - offset(esc) +
			get_unaligned_le32(esc->mem + EC_REG_DC_DELAY);
	}
	compare(esc, t, wide, now);
}

void ec_esc_dc_write(struct ec_esc *esc, u16 ado, const u8 *buf, size_t len,
		     const struct ec_frame_ctx *ctx)
{
	u8 old = activation(esc);
	u8 *m = esc->mem;
	u32 n = (u32)len;
	size_t i;

	if (!(esc->cfg.features & EC_FEAT_DC))
		return;
	if (ec_range_hit(ado, n, EC_REG_DC_RECV(0), 4))
		latch_receive(esc, ctx);
	if (!ec_esc_has_clock(esc))
		return;
	if (ado <= EC_REG_DC_SYSTIME && ado + n >= EC_REG_DC_SYSTIME + 4)
		ec_esc_dc_time(esc, buf + (EC_REG_DC_SYSTIME - ado),
			       ado + n >= EC_REG_DC_SYSTIME + 8, ctx->now);

	for (i = 0; i < len; i++)
		if (is_plain(esc, ado + (u32)i, old & 1))
			m[ado + i] = buf[i];
	if (!is_64bit(esc))
		put_unaligned_le32(0, m + EC_REG_DC_OFFSET + 4);
	if (ec_range_hit(ado, n, EC_REG_DC_OFFSET, 12)) {
		rebase(esc, ctx->now);
		esc->dc.slew = 0;
		esc->dc.have_cmp = false;
	}
	if (ec_range_hit(ado, n, EC_REG_DC_SPEED_START, 2))
		reset_filters(esc, ctx->now);
	units_written(esc, ado, n, old, ctx->now);
}
