/* SPDX-License-Identifier: GPL-2.0-only */
/* The cyclic exchange of process data. */
#ifndef EC_CYCLE_H
#define EC_CYCLE_H

#include "../base/limits.h"
#include "../clock/dc.h"
#include "../config/config.h"
#include "../carry/carry.h"
#include "../carry/rider.h"
#include "ethercat.h"
#include "shared.h"

struct ec_copying;
struct ec_cycle;
struct ec_cycle_thread;
struct ec_waiters;

/**
 * struct ec_cyc_dgram - one datagram of the cyclic layout, immutable in use but for @wrote
 *	and @before
 * @domain: index
 * @cmd: LRD, LWR or LRW
 * @new_frame: shares no frame with the datagrams before
 * @holes: @n_copies areas do not cover it: clear it first
 * @solid: all of it lies in the image as it lies in the datagram
 * @wrote: low half of the number of the last send before its inputs were last written
 * @before: the same without what incomplete replies of that receive have written
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
	bool new_frame : 1;
	bool holes : 1;
	bool solid : 1;
	u16 wrote;
	u16 before;
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

/* It has inputs only, and their last values are in the image. */
static inline bool ec_cyc_from_image(const struct ec_cyc_dgram *d)
{
	return d->cmd == EC_CMD_LRD;
}

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
 * @missed: a receive has not found its reply
 * @direct: sent from struct ec_cycle.direct
 * @dc: clock datagrams in front of them, EC_SEND_FLAG_*
 * @dc_sent: time that was sent in them
 * @riding: riders behind them
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
	struct ec_riding riding;
};

#define EC_CYC_FRAMES	128	/* on their way at most */
#define EC_CYC_SENDS	128	/* remembered; the age of data is at most that */

/**
 * struct ec_cyc_domain - received data of a domain
 * @expected: working counter when every slave takes part
 * @send: number of the newest send of which data were received
 * @wkc: sum of the working counters of that send
 * @partial: one of them was not the expected one; others may make up for it in @wkc
 * @age: sends of the domain since that one
 * @max_age: data that are older are stale, 0: none are
 * @stale: age of the oldest stale data that came back, for the log
 * @stale_logged: the log has said so; only the monitor's
 * @image: what the offsets of its datagrams count from
 * @seen: working counter and its state of the last receive
 * @noted: the counter of the last event about it
 * @noted_state: its state
 * @rate: of these events
 */
struct ec_cyc_domain {
	u8 *image;
	u32 expected;
	u32 send;
	u32 wkc;
	u32 age;
	u32 max_age;
	u32 stale;
	bool stale_logged;
	bool partial;
	u32 seen;
	u32 noted;
	u32 noted_state;
	struct ec_event_rate rate;
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

#define EC_SCHEDULE_GAPS	15

/**
 * struct ec_schedule - when the application is expected to send; owned by the
 *	cyclic caller
 * @due_ns: when the last send was due (ktime)
 * @last_ns: when it was
 * @interval_ns: distance of two sends, set or measured
 * @sends: sends so far, up to the end of the measurement
 * @gaps: the last times between two sends while it is measured, ns
 * @n_gaps: such times so far
 * @block_ns: begin of the sends whose mean is checked next (ktime)
 * @before_ns: begin of those before, 0: none
 * @n_block: sends since @block_ns
 * @far: gaps in a row that are far from @interval_ns, to the same side
 * @far_side: 1: longer, -1: shorter
 * @mean_side: the same of the last mean, 0: near
 */
struct ec_schedule {
	u64 due_ns;
	u64 last_ns;
	u32 interval_ns;
	u32 sends;
	u32 gaps[EC_SCHEDULE_GAPS];
	u64 block_ns;
	u64 before_ns;
	u32 n_block;
	u8 far;
	s8 far_side;
	s8 mean_side;
	u32 n_gaps;
};

/**
 * struct ec_late_report - the last cycle that has ended; under
 *	the lock of the configuration
 * @info: its result of EC_IOC_CYCLE_STATS
 * @status: and its figures
 */
struct ec_late_report {
	struct ec_ioc_cycle_stats info;
	struct ec_status_cycle status;
};

/**
 * struct ec_cycles - all cycles of a master: one at a time runs
 *
 * The first three are immutable.
 */
struct ec_cycles {
	/** @base: name and log */
	struct ec_base *base;
	/** @links: way to the slaves */
	struct ec_links *links;
	/** @carry: what others send beside the cycle */
	struct ec_carry *carry;
	/** @riders: datagrams in its frames */
	struct ec_riders *riders;
	/** @dc: distributed clocks */
	struct ec_dc *dc;

	/** @lock: held by the cyclic caller in receive and send; protects @active */
	struct mutex lock;
	/** @active: the cycle that runs; changed with the lock of its configuration, too */
	struct ec_cycle *active;
	/** @owner: of @active, to be compared without a lock; NULL: none */
	const void *owner;

	/** @late: figures of the last cycle, under the lock of its configuration */
	struct ec_late_report late;
	/** @late_reset: the cyclic caller shall set its figures to zero */
	bool late_reset;

	/** @number: cycles of the thread that runs the cycle */
	aligned_u64 number;
	/** @run: an uneven number while it sends; another number than before: another run */
	u32 run;
	/**
	 * @by_kernel: @active while the kernel runs it; changed under the lock of its
	 * configuration, read under RCU
	 */
	struct ec_cycle __rcu *by_kernel;
};

/**
 * struct ec_cycle - cycle of an application: settings, layout, state
 *
 * Settings and what is logged are under the lock of the configuration; @kernel, @copies
 * and @shared stay as they are while it is active. From @dgrams on all belongs to the
 * cyclic caller then.
 */
struct ec_cycle {
	/** @cycles: of the master; immutable, as are the next four */
	struct ec_cycles *cycles;
	/** @base: name and log */
	struct ec_base *base;
	/** @links: way to the slaves */
	struct ec_links *links;
	/** @carry: what others send beside the cycle */
	struct ec_carry *carry;
	/** @riders: datagrams in its frames */
	struct ec_riders *riders;
	/** @dc: distributed clocks */
	struct ec_dc *dc;
	/** @wanted: slave configurations and domains that it exchanges */
	struct ec_wanted *wanted;

	/** @owner: open file of the application; NULL: it has exited, the cycle continues */
	const void *owner;
	/**
	 * @waiters: callers of @owner that wait for a cycle, or NULL; who runs the cycle
	 * reads it under RCU
	 */
	struct ec_waiters __rcu *waiters;
	/** @shared: memory of the activation: image, status page, exchange */
	struct ec_shared *shared;
	/** @kernel: how the kernel runs the cycle; period 0: the application runs it */
	struct ec_ioc_cycle kernel;
	/**
	 * @priority: SCHED_FIFO priority that the process which set @kernel may use;
	 * 0: none
	 */
	u32 priority;
	/** @may_interrupt: likewise: the cycle may run in an interrupt, before all threads */
	bool may_interrupt;
	/** @place: EC_CYCLE_PLACE_*, where the last cycle ran */
	u32 place;
	/** @places: where cycles have run, bit n: place n */
	u32 places;
	/** @places_logged: the same, as the log knows it */
	u32 places_logged;
	/** @cpu_lost: the CPU of the cycle is offline */
	bool cpu_lost;
	/** @cpu_losses: how often it went offline */
	u32 cpu_losses;
	/** @thread: runs the cycle while active; NULL: the application does */
	struct ec_cycle_thread *thread;
	/** @late_per_s: how many cycles a second acyclic frames may make late */
	u32 late_per_s;
	/** @room_logged: the log says that acyclic frames do not fit */
	bool room_logged;
	/** @slaves_down: the application takes the slaves to PREOP: working counters go down */
	bool slaves_down;
	/** @lock_logged: EC_CYCLE_LOCK_* as the log knows it */
	u32 lock_logged;
	/** @copies: from inputs to outputs, before each send */
	struct ec_ioc_copy *copies;
	/** @n_copies: entries in @copies */
	unsigned int n_copies;

	/** @dgrams: layout; ec_cycle_free() sets it and all that follows to zero */
	struct ec_cyc_dgram *dgrams;
	/** @n_dgrams: entries in @dgrams */
	unsigned int n_dgrams;
	/** @areas: what is copied, in order of the datagrams */
	struct ec_cyc_area *areas;
	/** @n_areas: entries in @areas */
	unsigned int n_areas;
	/** @cuts: inputs of several datagrams */
	struct ec_cyc_cut *cuts;
	/** @n_cuts: entries in @cuts */
	unsigned int n_cuts;
	/** @stage: an image in which their parts come together, or NULL */
	u8 *stage;
	/** @copying: what @copies need while active, or NULL */
	struct ec_copying *copying;
	/** @plain: frames of a cycle that sends all domains */
	struct ec_cyc_wire plain;
	/** @clocked: the same with all clock datagrams */
	struct ec_cyc_wire clocked;
	/** @last: frames of the last send */
	struct ec_cyc_wire last;
	/** @domains: results */
	struct ec_cyc_domain domains[EC_MAX_DOMAINS];
	/**
	 * @direct: image of the application to send from, its inputs may have any value;
	 * NULL: those of @domains. While it is used, the outputs of the latter are
	 * undefined
	 */
	const u8 *direct;
	/** @flight: frames on their way, the oldest first */
	struct ec_cyc_flight flight[EC_CYC_FRAMES];
	/** @n_flight: entries in @flight */
	unsigned int n_flight;
	/** @send: number of the last send */
	u32 send;
	/** @queued: domains of the last sends, by their number */
	u64 queued[EC_CYC_SENDS];
	/** @judged: number of the last send when domains were judged */
	u32 judged;
	/** @sent: domains sent since the last receive, bit n: domain n */
	u64 sent;
	/** @sent_once: domains sent since activation, bit n: domain n */
	aligned_u64 sent_once;
	/** @back: domains of which data were received */
	u64 back;
	/** @sends: so far */
	aligned_u64 sends;
	/** @schedule: when an application that runs the cycle should send */
	struct ec_schedule schedule;

	/**
	 * @dc_asked: clock datagrams the application wanted since the last receive,
	 * EC_SEND_FLAG_*
	 */
	u32 dc_asked;
	/** @dc_back: which of them were received */
	u32 dc_back;
	/** @dc_sent: time in the last send that went to the slaves, ns */
	u64 dc_sent;
	/** @dc_wkc: working counter with the last answer of the reference clock */
	u16 dc_wkc;
	/** @dc_silent: sends since then that it has not answered, as far as is known */
	u32 dc_silent;
	/** @dc_time: last time of the reference clock, ns */
	u64 dc_time;
	/** @dc_time_ns: when the frame that brought it was sent (ktime) */
	u64 dc_time_ns;
	/** @dc_time64: whole time of the reference clock when it was last asked for, ns */
	u64 dc_time64;
	/** @dc_then: the same some time ago, to learn the rate of that clock */
	u64 dc_then;
	/** @dc_then_ns: when that was (ktime) */
	u64 dc_then_ns;
	/** @dc_ppb: how much faster than ktime the reference clock runs, 1e-9 */
	s32 dc_ppb;
	/** @dc_diff: last value of register 0x092C, of all slaves */
	u32 dc_diff;
	/** @dc_hold: the time for the reference clock is wrong: it is not sent */
	bool dc_hold;
	/** @dc_lead: that time less ktime, ns */
	u64 dc_lead;
};

/* @c may be NULL. What a master has of its cycle is under the lock of the one that is active. */
static inline void ec_cycle_assert_held(const struct ec_cycle *c)
{
	lockdep_assert(!c || lockdep_is_held(c->wanted->lock));
}

/* cycle.c */
void ec_cycles_init(struct ec_cycles *cycles, struct ec_base *base, struct ec_carry *carry,
		    struct ec_riders *riders, struct ec_dc *dc);
void ec_cycle_init(struct ec_cycle *c, struct ec_cycles *cycles, struct ec_wanted *wanted);
void ec_cycle_clear(struct ec_cycle *c);
void ec_cycle_set_active(struct ec_cycles *cycles, struct ec_cycle *c);
void ec_cycle_set_owner(struct ec_cycle *c, const void *owner, struct ec_waiters *waiters);
void ec_cycles_nothing_back(struct ec_cycles *cycles);

/* layout.c */
int ec_cycle_layout(struct ec_cycle *c);
u32 ec_cycle_need_ns(void);
int ec_cycle_check_room(struct ec_cycle *c, bool clocks);
void ec_cycle_tell_room(struct ec_cycle *c);
void ec_cycle_free(struct ec_cycle *c);

/* receive.c */
int ec_cycle_do_receive(struct ec_cycle *c);
void ec_cycle_tell_stale(struct ec_cycle *c);

/* send.c */
void ec_cycle_app_time(struct ec_cycle *c, const struct ec_ioc_send *what);
int ec_cycle_do_send(struct ec_cycle *c, const struct ec_ioc_send *what);

/**
 * ec_cycle_take_request() - what the application gives with a send, without requests
 * @c: active cycle
 * @what: its flags are known ones
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: 0; -ENOENT a domain is queued that there is not.
 */
static inline int ec_cycle_take_request(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	unsigned int n = c->wanted->n_domains;

	if (what->flags & (EC_SEND_FLAG_APP_TIME | EC_SEND_FLAG_SYNC_REF))
		ec_cycle_app_time(c, what);
	return n < 64 && what->queued >> n ? -ENOENT : 0;
}

/**
 * ec_cycle_receive() - ec_cycle_do_receive(), links and all
 * @c: active cycle
 *
 * Context: The master's single cyclic caller. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
static inline int ec_cycle_receive(struct ec_cycle *c)
{
	int ret;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	ec_links_enter(c->links);
	ret = ec_cycle_do_receive(c);
	ec_links_leave(c->links);
	return ret;
}

/**
 * ec_cycle_send() - ec_cycle_do_send(), links and all
 * @c: active cycle
 * @what: as there
 *
 * Context: The master's single cyclic caller. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
static inline int ec_cycle_send(struct ec_cycle *c, const struct ec_ioc_send *what)
{
	int ret;

	if (!ec_links_attached(c->links))
		return -ENODEV;
	ec_links_enter(c->links);
	ret = ec_cycle_do_send(c, what);
	ec_links_leave(c->links);
	return ret;
}

/* dc_datagrams.c */
#define EC_CYC_CLOCKS	(EC_SEND_FLAG_SYNC_REF | EC_SEND_FLAG_SYNC_SLAVES | \
			 EC_SEND_FLAG_MONITOR | EC_SEND_FLAG_REF_TIME)	/* those make datagrams */
u32 ec_dc_datagrams_reserve_ns(const struct ec_cycle *c);
u32 ec_dc_datagrams_wanted(struct ec_cycle *c, u32 flags);
void ec_dc_datagrams_fill(struct ec_cycle *c, struct ec_frame_buf *fb, u8 index, u32 dc,
			  u64 now);
const u8 *ec_dc_datagrams_take(struct ec_cycle *c, const struct ec_cyc_flight *f, const u8 *data);
void ec_dc_datagrams_judge(struct ec_cycle *c);

/* late.c */
void ec_late_count(struct ec_cycle *c, s64 ns);
void ec_late_send(struct ec_cycle *c, u64 now);
void ec_late_work(struct ec_cycle *c, s64 ns);
void ec_late_end(struct ec_cycle *c);
void ec_late_get(struct ec_cycles *cycles, struct ec_ioc_cycle_stats *info,
		 struct ec_status_cycle *status);
void ec_late_reset(struct ec_cycles *cycles);

/* copy.c */
int ec_copy_add(struct ec_cycle *c, const struct ec_ioc_copy *copy);
int ec_copy_begin(struct ec_cycle *c);
void ec_copy_run(struct ec_cycle *c);

#endif
