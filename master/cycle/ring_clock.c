// SPDX-License-Identifier: GPL-2.0-only
/*
 * On one side of the break of a ring no reference clock is on the way of the frames, so the master
 * gives the time, predicted from the replies of that clock on the other side. The frames of the
 * backup link pass the slaves there in the same order as those of the main link did, so the delays
 * in their registers stay right but for one difference: how much later or earlier the first one is
 * reached. Just after the break the clocks there are right: their time shows that difference.
 */
#include "../clock/dc_state.h"
#include "../wire/frame.h"
#include "../wire/regs.h"
#include "ring_clock.h"

#define EC_RING_SAMPLES	64
/* of a time: before the reference clock delays are negative, of 32 bits */
#define EC_RING_BYTES	4

/**
 * ec_ring_clock_wanted() - is a clock datagram to be sent on the backup link?
 * @r: of the active cycle
 * @dc: clocks
 *
 * Context: The cycle owner. RT-safe.
 * Return: whether clocks are behind a break.
 */
bool ec_ring_clock_wanted(struct ec_ring_clock *r, const struct ec_dc *dc)
{
	/* the number before and behind the rest; pairs with ec_dc_look_behind() */
	u32 number = smp_load_acquire(&dc->behind.number);

	if (number % 2)
		return false;
	if (r->break_seen != number)
		*r = (struct ec_ring_clock){
			.break_seen = number, .shift = READ_ONCE(dc->behind.shift),
			.samples = READ_ONCE(dc->behind.given) ? EC_RING_SAMPLES : 0,
		};
	r->station = READ_ONCE(dc->behind.station);
	/* the rest before the number: else another break, which begins with the next cycle */
	smp_rmb();
	return READ_ONCE(dc->behind.number) == number && r->station &&
	       READ_ONCE(dc->mode) == EC_DC_COMPENSATE;
}

/**
 * ec_ring_clock_knows() - is the way of frames of the backup link known?
 * @r: of the active cycle, after ec_ring_clock_wanted()
 *
 * Context: The cycle owner. RT-safe.
 * Return: whether clocks may get a time.
 */
bool ec_ring_clock_knows(const struct ec_ring_clock *r)
{
	return r->samples == EC_RING_SAMPLES;
}

/*
 * The command that gives clocks the time. Slaves that ignore FRMW get it by a write to all, where
 * no reference clock would be written.
 */
static u8 giving(const struct ec_dc *dc)
{
	return READ_ONCE(dc->armw.wanted) && !READ_ONCE(dc->behind.ref) ? EC_CMD_BWR : EC_CMD_FRMW;
}

/**
 * ec_ring_clock_fill() - add a clock datagram to a frame
 * @r: of the active cycle, after ec_ring_clock_wanted()
 * @dc: clocks
 * @fb: frame
 * @index: of its slot
 * @time: expected of the reference clock when a frame of the main link, sent now, reaches it, ns
 * @unsure: ways may have changed: no clock gets a time
 * @f: result, for ec_ring_clock_take()
 *
 * Register 0x0910.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_ring_clock_fill(const struct ec_ring_clock *r, const struct ec_dc *dc,
			struct ec_frame_buf *fb, u8 index, u64 time, bool unsure,
			struct ec_ring_clock_flight *f)
{
	bool reads = unsure || !ec_ring_clock_knows(r);
	u16 station = reads ? r->station : READ_ONCE(dc->ref_station);
	u8 *p = ec_frame_add(fb, reads ? EC_CMD_FPRD : giving(dc), index, station,
			     EC_REG_DC_SYSTIME, EC_RING_BYTES);

	/* 1 ns more: else each reply might equal it, before its working counter is known */
	time += !reads && !r->wkc && READ_ONCE(dc->behind.ref);
	put_unaligned_le32(reads ? 0 : (u32)time + r->shift, p);
	f->reads = reads && !unsure;
	f->gives = !reads;
	f->break_seen = r->break_seen;
	f->time = (u32)time;
}

/**
 * ec_ring_clock_take() - result of the clock datagram of a frame that has returned
 * @r: of the active cycle
 * @dc: clocks
 * @f: what was sent in that frame
 * @data: of the datagram, matched against what was sent; moved to that of the next one
 * @time: result: time of the reference clock, as a frame of the main link would have brought it, ns
 *
 * Context: The cycle owner. RT-safe.
 * Return: whether the reference clock is behind the break, and has replied.
 */
bool ec_ring_clock_take(struct ec_ring_clock *r, const struct ec_dc *dc,
			const struct ec_ring_clock_flight *f, const u8 **data, u32 *time)
{
	u32 is = get_unaligned_le32(*data);
	u16 wkc = get_unaligned_le16(*data + EC_RING_BYTES);

	*data += EC_RING_BYTES + EC_DGRAM_OVERHEAD;
	if (!wkc || f->break_seen != r->break_seen)
		return false;
	if (f->gives) {
		*time = is - r->shift;
		/* without a reply of the clock it is the time that was sent, and one count less */
		if (*time == f->time && wkc != r->wkc) {
			r->wkc = 0;
			return false;
		}
		r->wkc = wkc;
		return READ_ONCE(dc->behind.ref);
	}
	if (!f->reads || ec_ring_clock_knows(r))
		return false;
	r->sum += (s32)(is - f->time - READ_ONCE(dc->behind.delay));
	if (++r->samples == EC_RING_SAMPLES)
		r->shift = (s32)div_s64(r->sum, EC_RING_SAMPLES);
	return false;
}
