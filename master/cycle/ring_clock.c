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
	/* the number before the clock; pairs with ec_dc_look_behind() */
	u32 number = smp_load_acquire(&dc->behind.number);

	if (r->break_seen != number)
		*r = (struct ec_ring_clock){ .break_seen = number };
	return READ_ONCE(dc->behind.station) && READ_ONCE(dc->mode) == EC_DC_COMPENSATE;
}

/**
 * ec_ring_clock_fill() - add the clock datagram to an empty frame
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
	bool reads = unsure || r->samples < EC_RING_SAMPLES;
	u16 station = reads ? READ_ONCE(dc->behind.station) : READ_ONCE(dc->ref_station);
	u8 *p = ec_frame_add(fb, reads ? EC_CMD_FPRD : EC_CMD_FRMW, index, station,
			     EC_REG_DC_SYSTIME, 8);

	put_unaligned_le64(reads ? 0 : time + r->shift, p);
	*f = (struct ec_ring_clock_flight){
		.reads = reads && !unsure, .gives = !reads,
		.break_seen = r->break_seen, .time = time,
	};
}

/**
 * ec_ring_clock_take() - result of the clock datagram of a frame that has returned
 * @r: of the active cycle
 * @dc: clocks
 * @f: what was sent in that frame
 * @data: of the datagram, matched against what was sent
 *
 * @time: result: time of the reference clock, as a frame of the main link would have brought it, ns
 *
 * Context: The cycle owner. RT-safe.
 * Return: whether the reference clock is behind the break, and has replied.
 */
bool ec_ring_clock_take(struct ec_ring_clock *r, const struct ec_dc *dc,
			const struct ec_ring_clock_flight *f, const u8 *data, u64 *time)
{
	u16 wkc = get_unaligned_le16(data + 8);

	if (!wkc || f->break_seen != r->break_seen)
		return false;
	if (f->gives) {
		*time = get_unaligned_le64(data) - r->shift;
		/* without a reply of the clock it is the time that was sent */
		return READ_ONCE(dc->behind.ref) && *time != f->time;
	}
	if (!f->reads || r->samples == EC_RING_SAMPLES)
		return false;
	/* clocks of 32 bits as well */
	r->sum += (s32)(get_unaligned_le32(data) - (u32)f->time - READ_ONCE(dc->behind.delay));
	if (++r->samples == EC_RING_SAMPLES)
		r->shift = (s32)div_s64(r->sum, EC_RING_SAMPLES);
	return false;
}
