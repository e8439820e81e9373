// SPDX-License-Identifier: GPL-2.0-only
/*
 * Clock datagrams of the cycle: the time to the reference clock, from there to all
 * slaves, and the differences that are left. They precede the process data in the
 * first frame, so that their delay after the send is constant. Nothing here
 * allocates, prints or waits.
 */
#include <linux/hash.h>
#include <linux/kernel.h>
#include <linux/math64.h>
#include "../carry/carry.h"
#include "../clock/dc_state.h"
#include "../clock/dc_time.h"
#include "../link/links.h"
#include "../wire/regs.h"
#include "dc_datagrams.h"
#include "layout.h"

#define SYNC_REF	EC_SEND_FLAG_SYNC_REF
#define SYNC_SLAVES	EC_SEND_FLAG_SYNC_SLAVES
#define MONITOR		EC_SEND_FLAG_MONITOR
#define REF_TIME	EC_SEND_FLAG_REF_TIME
#define WIDE		0x8000	/* of this frame: times of 8 bytes */
#define SHIFT		16	/* above it: how many more SYNC_SLAVES */
#define ONE_MORE_NS	((8 + EC_DGRAM_OVERHEAD) * 80u)	/* on the wire */
#define BOOST		11	/* of them in a send: one frame takes 15 datagrams */

/* Writes of the time to the reference clock: one, and half of the additional datagrams. */
static unsigned int refs(u32 dc)
{
	return dc & SYNC_REF ? (dc >> SHIFT) / 2 + 1 : 0;
}

static unsigned int syncs(u32 dc)
{
	unsigned int more = dc >> SHIFT;

	if (!(dc & SYNC_SLAVES))
		return 0;
	return dc & SYNC_REF ? more - more / 2 + 1 : more + 1;
}

static u16 time_bytes(u32 dc)
{
	return dc & WIDE ? 8 : 4;
}

/* Drift compensation datagrams that a send may have beyond one: in half of the free wire time. */
static u32 most(const struct ec_dc_datagrams *k)
{
	u64 used = k->clocked_ns + ec_layout_need_ns();
	u64 budget = ec_access_interval_us(k->access) * 900ULL;

	return budget > used ? min_t(u64, BOOST, (budget - used) / (2 * ONE_MORE_NS)) : 0;
}

/* Drift compensation datagrams of this send beyond one. */
static u32 boost(const struct ec_dc_datagrams *k)
{
	u32 left = READ_ONCE(k->dc->mode) == EC_DC_READ ? 0 : READ_ONCE(k->dc->extra_dgrams);
	u32 n = min(left, most(k));

	if (n)
		WRITE_ONCE(k->dc->extra_dgrams, left - n);
	return n;
}

/**
 * ec_dc_datagrams_reserve_ns() - wire time of drift compensation datagrams to come
 * @k: of the active cycle
 *
 * Not 0 while the clocks are being set, so that acyclic frames are not made longer
 * than the wire time that is free then.
 *
 * Context: The cycle owner. RT-safe.
 * Return: ns.
 */
u32 ec_dc_datagrams_reserve_ns(const struct ec_dc_datagrams *k)
{
	if (!ec_dc_busy(k->dc) && !READ_ONCE(k->dc->extra_dgrams))
		return 0;
	return most(k) * ONE_MORE_NS;
}

#define HELD_MAX_US	1000000	/* clocks that nothing compensates drift apart */
#define HELD_LED_US	250000	/* if the application changes the rate of the reference clock */
#define HELD_AGAIN	4	/* so many times as long until that may last as long again */

/*
 * A clock whose path has another delay than its register has would be moved by the difference. So
 * from the first frame that shows the event of a port until the delays are known again, the time
 * of the reference clock is only read.
 */
static bool hold_for_path(struct ec_dc_datagrams *k)
{
	bool changed = ec_dc_path_changed(k->dc);
	u32 most = READ_ONCE(k->dc->app_leads) ? HELD_LED_US : HELD_MAX_US, us;

	if (likely(!changed && !k->path_held_us))
		return false;
	us = ec_access_interval_us(k->access);
	if (!changed || k->path_held_us >= most) {
		k->path_held_us -= min(k->path_held_us, us / HELD_AGAIN + 1);
		return false;
	}
	k->path_held_us += us;
	return true;
}

/**
 * ec_dc_datagrams_events() - take the events that the replies of a receive have shown
 * @k: of the active cycle
 * @irq: ECAT events of the slaves
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_dc_datagrams_events(struct ec_dc_datagrams *k, u16 irq)
{
	bool event = irq & EC_ECAT_EVENT_DL;

	/* one that stays is no other change */
	if (unlikely(event && !k->port_event))
		WRITE_ONCE(k->dc->path_events, k->dc->path_events + 1);
	k->port_event = event;
}

/**
 * ec_dc_datagrams_wanted() - clock datagrams of this send
 * @k: of the active cycle
 * @flags: EC_SEND_FLAG_*, at least one of EC_CYC_CLOCKS
 *
 * Datagrams that the application requests and the master omits count as not received.
 *
 * Context: The cycle owner. RT-safe.
 * Return: those of @flags that make datagrams, how wide they are, and in the upper
 * half how many more times the time goes to the slaves; 0: none.
 */
u32 ec_dc_datagrams_wanted(struct ec_dc_datagrams *k, u32 flags)
{
	flags &= EC_CYC_CLOCKS;
	k->asked |= flags;
	if (!READ_ONCE(k->dc->wanted))
		WRITE_ONCE(k->dc->wanted, true);
	k->path_held = hold_for_path(k);
	WRITE_ONCE(k->dc->links->carry->clocks_held, k->path_held);
	if (READ_ONCE(k->dc->mode) == EC_DC_IDLE)
		return 0;
	/* no change of the reference clock before the other clocks are synchronized to it */
	if (k->hold || k->path_held || (READ_ONCE(k->dc->mode) == EC_DC_READ && ec_dc_busy(k->dc)))
		flags &= ~SYNC_REF;
	if (!flags)
		return 0;
	if (flags & SYNC_SLAVES)
		flags |= boost(k) << SHIFT;
	/* slaves upstream of the reference clock have a negative delay, of 32 bits */
	if (READ_ONCE(k->dc->ref_wide) && !READ_ONCE(k->dc->clocks_upstream))
		flags |= WIDE;
	return flags;
}

#define PREDICT_US	(100ULL * 24 * 3600 * USEC_PER_SEC)	/* 1000 ppm of it fit in 64 bits */

/*
 * @parts of 1e-6 ns as whole ns, rounded by @now so that the mean is right. A fraction that is
 * always omitted depends on the time since the last reply: slaves would take it for a rate.
 */
static s64 whole_ns(s64 parts, u64 now)
{
	s32 rest;
	s64 up = parts + reciprocal_scale(hash_64(now, 32), USEC_PER_SEC);
	s64 ns = div_s64_rem(up, USEC_PER_SEC, &rest);

	return rest < 0 ? ns - 1 : ns;
}

/*
 * Slaves upstream of the reference clock, and all when it does not reply, take the time that was
 * sent: a prediction from its last replies, at its last rate as long as a cycle is in holdover.
 */
static u64 predicted(const struct ec_dc_datagrams *k, u64 now)
{
	u64 since = now - k->time_ns;
	s64 us = min(div_u64(since, NSEC_PER_USEC), PREDICT_US);

	if (!k->time)
		return ec_dc_clock_at(k->dc, now);
	return k->time + since + whole_ns(us * k->ppb, now);
}

#define RATE_NS	(100 * NSEC_PER_MSEC)

/*
 * The rate of the reference clock over some time, without jumps. Each value has the jitter of two
 * sends, so a mean is kept, which a long holdover depends on.
 */
static void learn_rate(struct ec_dc_datagrams *k)
{
	u64 since = k->time_ns - k->then_ns;
	s64 more = (s64)(k->time - k->then - since);
	s32 ppb;

	if (k->then_ns && since < RATE_NS)
		return;
	if (k->then_ns && abs(more) < div_u64(since, 1000) && since < 10 * RATE_NS) {
		ppb = (s32)div64_s64(more * (s64)NSEC_PER_SEC, since);
		k->ppb = k->ppb ? k->ppb + (ppb - k->ppb) / 8 : ppb;
	}
	k->then = k->time;
	k->then_ns = k->time_ns;
}

static u64 clock_time(struct ec_dc_datagrams *k, const u8 *data, u16 len, s32 shift, u64 sent_ns)
{
	u64 t = len == 8 ? get_unaligned_le64(data) - shift :
			   ec_dc_extend32(k->dc, get_unaligned_le32(data) - shift, sent_ns);

	ec_dc_clock(k->dc, t, sent_ns);
	return t;
}

static void take_time(struct ec_dc_datagrams *k, const u8 *data, u16 len, u64 sent_ns)
{
	k->time = clock_time(k, data, len, 0, sent_ns);
	k->time_ns = sent_ns;
	k->back |= SYNC_SLAVES;
	learn_rate(k);
}

/*
 * Has the reference clock replied? Slaves that take the time also increment the working counter,
 * so without a reply of the reference clock the sent time returns with a working counter above 0.
 * A reply has another time, or the same time with the usual working counter. After a missing
 * reply only another time counts.
 */
static bool answered(struct ec_dc_datagrams *k, const struct ec_dc_flight *f,
		     const u8 *data, u16 len)
{
	/* FRMW or ARMW */
	bool writes = data[-EC_DGRAM_HDR] != EC_CMD_FPRD;
	u16 wkc = get_unaligned_le16(data + len);
	u8 sent[8];

	put_unaligned_le64(f->time, sent);
	if (!wkc ||
	    (writes && !memcmp(data, sent, len) && (k->silent || wkc != k->wkc))) {
		k->silent++;
		return false;
	}
	k->wkc = writes ? wkc : 0;
	k->silent = 0;
	return true;
}

/* The command for the time of the reference clock, and its @adp. */
static u8 sync_command(const struct ec_dc_datagrams *k, u16 *adp)
{
	/* slaves upstream of the reference clock must not get an unknown time */
	bool quiet = k->path_held || READ_ONCE(k->dc->mode) == EC_DC_READ ||
		     (k->dc->clocks_upstream && !k->time);
	u16 ref = *adp;
	u8 cmd = quiet ? EC_CMD_FPRD : ec_armw_command(&k->dc->armw, adp);

	if (likely(cmd != EC_CMD_ARMW) || (!k->unsure && !k->silent))
		return cmd;
	/* without a reply of that clock anything may be at its place */
	*adp = ref;
	return EC_CMD_FPRD;
}

/* The application's time for the reference clock. */
static __always_inline void add_refs(struct ec_frame_buf *fb, u8 index, u32 dc, u16 ref, u32 time)
{
	unsigned int i;

	for (i = 0; i < refs(dc); i++)
		put_unaligned_le32(time, ec_frame_add(fb, EC_CMD_FPWR, index, ref,
						      EC_REG_DC_SYSTIME, 4));
}

/* The datagrams that only read; take_reads() has their results. */
static __always_inline void add_reads(struct ec_frame_buf *fb, u8 index, u32 dc, u16 ref)
{
	u16 len = time_bytes(dc);

	if (dc & REF_TIME)
		memset(ec_frame_add(fb, EC_CMD_FPRD, index, ref, EC_REG_DC_SYSTIME, len), 0, len);
	if (dc & MONITOR)
		put_unaligned_le32(0, ec_frame_add(fb, EC_CMD_BRD, index, 0, EC_REG_DC_DIFF, 4));
}

/**
 * ec_dc_datagrams_fill() - add the clock datagrams to an empty frame
 * @k: of the active cycle
 * @fb: frame
 * @index: of its slot
 * @dc: as from ec_dc_datagrams_wanted()
 * @now: time of the send (ktime)
 *
 * Registers 0x0910, 0x092C.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_dc_datagrams_fill(struct ec_dc_datagrams *k, struct ec_frame_buf *fb, u8 index, u32 dc,
			  u64 now)
{
	u16 ref = READ_ONCE(k->dc->ref_station), adp = ref;
	u8 cmd = sync_command(k, &adp);
	unsigned int i;
	u8 t[8], *p;

	add_refs(fb, index, dc, ref, (u32)(now + k->lead));
	k->sent = predicted(k, now);
	/* clock frames of the worker carry it as well */
	if (k->silent)
		ec_dc_clock_predict(k->dc, k->sent, now);
	/* some ns more, else a reply that equals the prediction would count as missing */
	k->sent += (k->silent ?: !k->wkc) % 4;
	put_unaligned_le64(k->sent, t);
	for (i = 0; i < syncs(dc); i++) {
		p = ec_frame_add(fb, cmd, index, adp, EC_REG_DC_SYSTIME, time_bytes(dc));
		memcpy(p, t, time_bytes(dc));
	}
	add_reads(fb, index, dc, ref);
}

/**
 * ec_dc_datagrams_behind() - clock datagrams of this send for clocks behind the break of a ring
 * @k: of the active cycle
 * @dc: as from ec_dc_datagrams_wanted()
 *
 * Those to the reference clock only if it is one of them.
 *
 * Context: The cycle owner. RT-safe.
 * Return: likewise, with EC_DC_BEHIND; 0: none.
 */
u32 ec_dc_datagrams_behind(struct ec_dc_datagrams *k, u32 dc)
{
	bool ref;

	if (!ec_ring_clock_wanted(&k->ring, k->dc))
		return 0;
	ref = READ_ONCE(k->dc->behind.ref);
	if (!ref)
		dc &= ~(SYNC_REF | REF_TIME);
	/* the time there is not known yet */
	if (!ec_ring_clock_knows(&k->ring))
		dc &= SYNC_SLAVES | MONITOR;
	dc &= ~WIDE;
	if (READ_ONCE(k->dc->ref_wide))
		dc |= WIDE;
	return dc & EC_CYC_CLOCKS ? dc | EC_DC_BEHIND : 0;
}

/**
 * ec_dc_datagrams_fill_behind() - add the datagrams for clocks behind the break of a ring
 * @k: of the active cycle
 * @fb: empty frame, for the backup link
 * @index: of its slot
 * @dc: as from ec_dc_datagrams_behind()
 * @now: time of the send (ktime)
 * @f: result
 *
 * As ec_dc_datagrams_fill(). What depends on the way has the time that a frame of the main link
 * would need less or more.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_dc_datagrams_fill_behind(struct ec_dc_datagrams *k, struct ec_frame_buf *fb, u8 index,
				 u32 dc, u64 now, struct ec_ring_clock_flight *f)
{
	u16 ref = READ_ONCE(k->dc->ref_station);
	unsigned int i;

	add_refs(fb, index, dc, ref, (u32)(now + k->lead + k->ring.shift));
	for (i = 0; i < syncs(dc); i++)
		ec_ring_clock_fill(&k->ring, k->dc, fb, index, predicted(k, now), k->path_held, f);
	add_reads(fb, index, dc, ref);
}

static const u8 *dc_datagrams_skip(const u8 *data, u16 len)
{
	return data + len + EC_DGRAM_OVERHEAD;
}

/* Results of the datagrams that only read; @shift: of the time, ns, 0 on all but a second link. */
static __always_inline const u8 *take_reads(struct ec_dc_datagrams *k, u32 dc, s32 shift,
					    u64 sent_ns, const u8 *data)
{
	u16 len = time_bytes(dc);

	if (dc & REF_TIME) {
		if (get_unaligned_le16(data + len)) {
			k->time64 = clock_time(k, data, len, shift, sent_ns);
			k->back |= REF_TIME;
		}
		data = dc_datagrams_skip(data, len);
	}
	if (dc & MONITOR) {
		if (get_unaligned_le16(data + 4)) {
			/* of the clocks on both sides of a break */
			k->diff = (k->back & MONITOR ? k->diff : 0) | get_unaligned_le32(data);
			k->back |= MONITOR;
		}
		data = dc_datagrams_skip(data, 4);
	}
	return data;
}

/**
 * ec_dc_datagrams_take() - results of the clock datagrams of a returned frame
 * @k: of the active cycle
 * @f: what was sent in that frame
 * @sent_ns: when it was sent (ktime)
 * @data: data of the first datagram, matched against what was sent
 *
 * Context: The cycle owner. RT-safe.
 * Return: data of the first datagram of process data.
 */
const u8 *ec_dc_datagrams_take(struct ec_dc_datagrams *k, const struct ec_dc_flight *f, u64 sent_ns,
			       const u8 *data)
{
	u16 len = time_bytes(f->dgrams);
	u32 dc = f->dgrams;
	unsigned int i;

	for (i = 0; i < refs(dc); i++)
		data = dc_datagrams_skip(data, 4);
	if (dc & SYNC_SLAVES) {
		if (answered(k, f, data, len))
			take_time(k, data, len, sent_ns);
		for (i = 0; i < syncs(dc); i++)
			data = dc_datagrams_skip(data, len);
	}
	return take_reads(k, dc, 0, sent_ns, data);
}

/**
 * ec_dc_datagrams_take_behind() - results of the datagrams for clocks behind the break of a ring
 * @k: of the active cycle
 * @f: what was sent in that frame
 * @sent_ns: when it was sent (ktime)
 * @data: data of the first datagram, matched against what was sent
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_dc_datagrams_take_behind(struct ec_dc_datagrams *k, const struct ec_dc_flight *f,
				 u64 sent_ns, const u8 *data)
{
	unsigned int i;
	u8 time[4];
	u32 t;

	for (i = 0; i < refs(f->dgrams); i++)
		data = dc_datagrams_skip(data, 4);
	for (i = 0; i < syncs(f->dgrams); i++) {
		/* of several the first one, as on the main link */
		if (!ec_ring_clock_take(&k->ring, k->dc, &f->behind, &data, &t) || i)
			continue;
		put_unaligned_le32(t, time);
		take_time(k, time, sizeof(time), sent_ns);
	}
	take_reads(k, f->dgrams, k->ring.shift, sent_ns, data);
}

/**
 * ec_dc_datagrams_judge() - give the application the results of its clock datagrams
 * @k: of the active cycle
 * @st: its status page
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_dc_datagrams_judge(struct ec_dc_datagrams *k, struct ec_status *st)
{
	if (k->asked & SYNC_SLAVES) {
		WRITE_ONCE(st->dc_time, k->time);
		WRITE_ONCE(st->dc_time_valid, !!(k->back & SYNC_SLAVES));
	}
	if (k->asked & REF_TIME) {
		WRITE_ONCE(st->dc_time64, k->time64);
		WRITE_ONCE(st->dc_time64_valid, !!(k->back & REF_TIME));
	}
	if (k->asked & MONITOR)
		WRITE_ONCE(st->dc_monitor, k->back & MONITOR ?
			   k->diff & ~(u32)EC_DC_DIFF_AHEAD : ~0u);
	k->unsure = k->asked & ~k->back & SYNC_SLAVES;
	k->asked = 0;
	k->back = 0;
}
