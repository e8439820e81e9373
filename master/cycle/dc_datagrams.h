/* SPDX-License-Identifier: GPL-2.0-only */
/* The clock datagrams of a cycle, and the time of the reference clock that they bring. */
#ifndef EC_DC_DATAGRAMS_H
#define EC_DC_DATAGRAMS_H

#include <linux/types.h>
#include "ethercat.h"
#include "ring_clock.h"

struct ec_access;
struct ec_dc;
struct ec_frame_buf;

/* a frame with datagrams for clocks behind the break of a ring, and nothing else */
#define EC_DC_BEHIND	0x4000

/* flags of a send that make datagrams */
#define EC_CYC_CLOCKS	(EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | \
			 EC_SEND_FLAG_MONITOR | EC_SEND_FLAG_REF_TIME)

/** struct ec_dc_datagrams - clock datagrams of an active cycle; of the cycle owner */
struct ec_dc_datagrams {
	/** @dc: distributed clocks of the master; immutable, as are the next two */
	struct ec_dc *dc;
	/** @access: interval of the cycle */
	const struct ec_access *access;
	/** @clocked_ns: wire time of the cycle with one of each clock datagram */
	u32 clocked_ns;
	/** @asked: those that the application requested since the last receive, EC_SEND_FLAG_* */
	u32 asked;
	/** @back: which of them were received */
	u32 back;
	/** @sent: time in the last send that went to the slaves, ns */
	u64 sent;
	/** @wkc: working counter of the last reply of the reference clock */
	u16 wkc;
	/** @unsure: the last receive had no reply to @asked: no ARMW before the next one */
	bool unsure;
	/** @silent: sends without a reply of the reference clock since then, as far as is known */
	u32 silent;
	/** @time: last time of the reference clock, ns */
	u64 time;
	/** @time_ns: when the frame that brought it was sent (ktime) */
	u64 time_ns;
	/** @time64: whole time of the reference clock when it was last read, ns */
	u64 time64;
	/** @then: an earlier @time, from which the rate of that clock is calculated */
	u64 then;
	/** @then_ns: @time_ns of it (ktime) */
	u64 then_ns;
	/** @ppb: how much faster than ktime the reference clock runs, 1e-9 */
	s32 ppb;
	/** @diff: last value of register 0x092C, of all slaves */
	u32 diff;
	/** @hold: the application time is wrong: it is not sent to the reference clock */
	bool hold;
	/** @port_event: the last receive had the event of a port */
	bool port_event;
	/** @path_held: the delays may be wrong: the time is not sent to the slaves */
	bool path_held;
	/** @path_held_us: how long that was so recently */
	u32 path_held_us;
	/** @lead: application time less ktime, ns */
	u64 lead;
	/** @ring: time for clocks behind the break of a ring */
	struct ec_ring_clock ring;
};

/** struct ec_dc_flight - the clock datagrams of a frame in flight */
struct ec_dc_flight {
	/** @dgrams: as from ec_dc_datagrams_wanted(), or with EC_DC_BEHIND */
	u32 dgrams;
	/** @time: time that was sent in them, ns */
	u64 time;
	/** @behind: of EC_DC_BEHIND */
	struct ec_ring_clock_flight behind;
};

u32 ec_dc_datagrams_reserve_ns(const struct ec_dc_datagrams *k);
u32 ec_dc_datagrams_wanted(struct ec_dc_datagrams *k, u32 flags);
void ec_dc_datagrams_fill(struct ec_dc_datagrams *k, struct ec_frame_buf *fb, u8 index, u32 dc,
			  u64 now);
u32 ec_dc_datagrams_behind(struct ec_dc_datagrams *k, u32 dc);
void ec_dc_datagrams_fill_behind(struct ec_dc_datagrams *k, struct ec_frame_buf *fb, u8 index,
				 u32 dc, u64 now, struct ec_ring_clock_flight *f);
void ec_dc_datagrams_take_behind(struct ec_dc_datagrams *k, const struct ec_dc_flight *f,
				 u64 sent_ns, const u8 *data);
const u8 *ec_dc_datagrams_take(struct ec_dc_datagrams *k, const struct ec_dc_flight *f,
			       u64 sent_ns, const u8 *data);
void ec_dc_datagrams_events(struct ec_dc_datagrams *k, u16 irq);
void ec_dc_datagrams_judge(struct ec_dc_datagrams *k, struct ec_status *st);

#endif
