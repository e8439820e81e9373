/* SPDX-License-Identifier: GPL-2.0-only */
/* The time for the clocks behind the break of a ring. */
#ifndef EC_RING_CLOCK_H
#define EC_RING_CLOCK_H

#include <linux/types.h>

struct ec_dc;
struct ec_frame_buf;

/** struct ec_ring_clock - of an active cycle; of the cycle owner */
struct ec_ring_clock {
	/** @break_seen: struct ec_dc_behind.number of the break that the members below are for */
	u32 break_seen;
	/** @station: a clock behind the break */
	u16 station;
	/** @wkc: of the last reply of the reference clock, behind the break; 0: not known */
	u16 wkc;
	/** @samples: times that were read behind the break so far, up to EC_RING_SAMPLES */
	u32 samples;
	/** @sum: of their differences from the time that the reference clock had, ns */
	s64 sum;
	/** @shift: from the time in frames of the main link to that in frames of the backup link */
	s32 shift;
};

/** struct ec_ring_clock_flight - the clock datagrams of a frame behind the break */
struct ec_ring_clock_flight {
	/** @reads: it reads the time of a clock */
	bool reads;
	/** @gives: it gives the clocks the time */
	bool gives;
	/** @break_seen: as struct ec_ring_clock.break_seen, when it was sent */
	u32 break_seen;
	/** @time: expected of the reference clock when a frame of the main link reaches it, ns */
	u32 time;
};

bool ec_ring_clock_wanted(struct ec_ring_clock *r, const struct ec_dc *dc);
bool ec_ring_clock_knows(const struct ec_ring_clock *r);
void ec_ring_clock_fill(const struct ec_ring_clock *r, const struct ec_dc *dc,
			struct ec_frame_buf *fb, u8 index, u64 time, bool unsure,
			struct ec_ring_clock_flight *f);
bool ec_ring_clock_take(struct ec_ring_clock *r, const struct ec_dc *dc,
			const struct ec_ring_clock_flight *f, const u8 **data, u32 *time);

#endif
