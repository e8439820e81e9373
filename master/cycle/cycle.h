/* SPDX-License-Identifier: GPL-2.0-only */
/* The cyclic exchange of an activated session. */
#ifndef EC_CYCLE_H
#define EC_CYCLE_H

#include <linux/types.h>
#include "late.h"
#include "../base/limits.h"

struct ec_frame_buf;
struct ec_ioc_send;
struct ec_master;
struct ec_session;
struct ec_slot;

/**
 * struct ec_cyc_dgram - one datagram of the cyclic layout, immutable in use
 * @domain: index
 * @cmd: LRD, LWR or LRW
 * @new_frame: shares no frame with the datagrams before
 * @holes: @n_copies areas do not cover it: clear it first
 * @solid: all of it lies in the image as it lies in the datagram
 * @logical: logical address
 * @len: bytes
 * @expected: working counter when every slave takes part
 * @first_copy: first of what is copied into it, in struct ec_cycle.areas
 * @n_copies: how many
 * @first_input: first of its inputs there
 * @n_plain: inputs that were sent with their last value
 * @n_whole: these, and inputs that come in the place of outputs
 * @n_inputs: these, and inputs of which other datagrams have a part
 */
struct ec_cyc_dgram {
	u16 domain;
	u8 cmd;
	bool new_frame;
	bool holes;
	bool solid;
	u32 logical;
	u16 len;
	u16 expected;
	u32 first_copy;
	u16 n_copies;
	u16 n_plain;
	u16 n_whole;
	u16 n_inputs;
	u32 first_input;
};

/**
 * struct ec_cyc_area - process data to copy into or out of a datagram: values of one
 *	size at equal distances, as slaves of a kind in a row have them
 * @offset: byte in the image
 * @pos: byte in the datagram
 * @len: bytes of a value
 * @count: values
 * @offset_stride: from one to the next in the image, bytes
 * @pos_stride: in the datagram
 * @cut: number in struct ec_cycle.cuts, for inputs of several datagrams
 */
struct ec_cyc_area {
	u32 offset;
	u16 pos;
	u16 len;
	u16 count;
	u16 offset_stride;
	u16 pos_stride;
	u16 cut;
};

/**
 * struct ec_cyc_cut - inputs that are larger than a datagram
 * @offset: byte in the image
 * @len: bytes
 * @parts: datagrams that have a part of them
 * @have: of them back
 * @send: number of the send they belong to
 */
struct ec_cyc_cut {
	u32 offset;
	u32 len;
	u16 parts;
	u16 have;
	u32 send;
};

/**
 * struct ec_cyc_flight - a frame of the cycle that is on its way
 * @slot: frame
 * @send: number of the send it belongs to
 * @first: first datagram of the layout it may carry
 * @count: how many; those of @queued it does
 * @queued: domains of that send, bit n: domain n
 * @missed: a receive has looked for it in vain
 * @direct: sent from struct ec_cycle.direct
 * @dc: clock datagrams in front of them, EC_SEND_FLAG_*
 * @dc_sent: time that was sent in them
 */
struct ec_cyc_flight {
	struct ec_slot *slot;
	u32 send;
	u16 first;
	u16 count;
	u64 queued;
	bool missed;
	bool direct;
	u32 dc;
	u64 dc_sent;
};

#define EC_CYC_FRAMES	128	/* on their way at most */
#define EC_CYC_SENDS	128	/* remembered; the age of data is at most that */

/**
 * struct ec_cyc_domain - what is back of a domain
 * @expected: working counter when every slave takes part
 * @send: number of the newest send that anything is back of
 * @wkc: sum of the working counters of that send
 * @age: sends of the domain since that one
 * @max_age: data that are older are stale, 0: none are
 * @stale: age of the oldest stale data that came back, for the log
 * @stale_told: the log has said so; only the monitor's
 * @image: what the offsets of its datagrams count from
 */
struct ec_cyc_domain {
	u8 *image;
	u32 expected;
	u32 send;
	u32 wkc;
	u32 age;
	u32 max_age;
	u32 stale;
	bool stale_told;
};

/**
 * struct ec_cyc_wire - frames, and how long they occupy the wire
 * @frames: how many
 * @ns: at 100 Mbit/s, preamble, padding, FCS and gap included
 */
struct ec_cyc_wire {
	u32 frames;
	u32 ns;
};

/**
 * struct ec_cycle - cyclic layout and its state; owned by the cyclic caller
 * @dgrams: layout
 * @n_dgrams: entries in @dgrams
 * @areas: what is copied, in order of the datagrams
 * @n_areas: entries in @areas
 * @cuts: inputs of several datagrams
 * @n_cuts: entries in @cuts
 * @stage: an image in which their parts come together, or NULL
 * @plain: frames of a cycle that sends all domains
 * @clocked: the same with all clock datagrams
 * @last: frames of the last send
 * @domains: results
 * @direct: image of the application to send from, its inputs are what it likes;
 *	NULL: those of @domains. While it is used, what the outputs of the latter
 *	are is undefined
 * @flight: frames on their way, the oldest first
 * @n_flight: entries in @flight
 * @send: number of the last send
 * @queued: domains of the last sends, by their number
 * @judged: number of the last send when domains were judged
 * @sent: domains sent since the last receive, bit n: domain n
 * @back: domains of which something is back
 * @cycles: sends so far
 * @schedule: when an application that runs the cycle should send
 * @dc_asked: clock datagrams the application wanted since the last receive,
 *	EC_SEND_FLAG_*
 * @dc_back: which of them are back
 * @dc_sent: time in the last send that went to the slaves, ns
 * @dc_wkc: working counter with the last answer of the reference clock
 * @dc_silent: since then it has not answered so often, as far as can be told
 * @dc_time: last time of the reference clock, ns
 * @dc_time_ns: when the frame that brought it was sent (ktime)
 * @dc_time64: whole time of the reference clock when it was last asked for, ns
 * @dc_then: the same some time ago, to learn the rate of that clock
 * @dc_then_ns: likewise
 * @dc_ppb: how much faster than ktime it runs, 1e-9
 * @dc_diff: last value of register 0x092C, of all slaves
 * @dc_hold: the time for the reference clock is off: it is not sent
 * @dc_skip: jumps of that time, ns; they are taken off
 */
struct ec_cycle {
	struct ec_cyc_dgram *dgrams;
	unsigned int n_dgrams;
	struct ec_cyc_area *areas;
	unsigned int n_areas;
	struct ec_cyc_cut *cuts;
	unsigned int n_cuts;
	u8 *stage;
	struct ec_cyc_wire plain;
	struct ec_cyc_wire clocked;
	struct ec_cyc_wire last;
	struct ec_cyc_domain domains[EC_MAX_DOMAINS];
	const u8 *direct;
	struct ec_cyc_flight flight[EC_CYC_FRAMES];
	unsigned int n_flight;
	u32 send;
	u64 queued[EC_CYC_SENDS];
	u32 judged;
	u64 sent;
	u64 back;
	aligned_u64 cycles;
	struct ec_schedule schedule;
	u32 dc_asked;
	u32 dc_back;
	u64 dc_sent;
	u16 dc_wkc;
	u32 dc_silent;
	u64 dc_time;
	u64 dc_time_ns;
	u64 dc_time64;
	u64 dc_then;
	u64 dc_then_ns;
	s32 dc_ppb;
	u32 dc_diff;
	bool dc_hold;
	u64 dc_skip;
};

/* layout.c */
int ec_cycle_layout(struct ec_session *s);
u32 ec_cycle_need_ns(void);
int ec_cycle_check_room(struct ec_session *s, bool clocks);
void ec_cycle_tell_room(struct ec_session *s);
void ec_cycle_free(struct ec_master *m, struct ec_cycle *c);

/* exchange.c */
void ec_cycle_app_time(struct ec_session *s, const struct ec_ioc_send *what);
int ec_cycle_told(struct ec_session *s, const struct ec_ioc_send *what);
int ec_cycle_do_receive(struct ec_session *s);
void ec_cycle_tell_stale(struct ec_session *s);
void ec_cycle_nothing_back(struct ec_session *s);
int ec_cycle_do_send(struct ec_session *s, const struct ec_ioc_send *what);
int ec_cycle_receive(struct ec_session *s);
int ec_cycle_send(struct ec_session *s, const struct ec_ioc_send *what);

/* dc_datagrams.c */
u32 ec_dc_datagrams_reserve_ns(const struct ec_master *m, const struct ec_cycle *c);
u32 ec_dc_datagrams_wanted(struct ec_master *m, struct ec_cycle *c, u32 flags);
void ec_dc_datagrams_fill(struct ec_session *s, struct ec_frame_buf *fb, u8 index, u32 dc,
			  u64 sync_time, u64 now);
const u8 *ec_dc_datagrams_take(struct ec_session *s, const struct ec_cyc_flight *f, const u8 *data);
void ec_dc_datagrams_judge(struct ec_session *s);

#endif
