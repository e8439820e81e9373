/* SPDX-License-Identifier: GPL-2.0-only */
/* Distributed clocks: measuring delays, setting and checking the clocks. */
#ifndef EC_DC_H
#define EC_DC_H

#include <linux/atomic.h>
#include <linux/mutex.h>
#include <linux/types.h>
#include <linux/wait.h>
#include <linux/workqueue.h>
#include "../bus/slave.h"

struct ec_base;
struct ec_bus;
struct ec_ioc_send;
struct ec_links;

/* choice of the reference clock that is no station address */
#define EC_DC_ANY	0	/* the first one that has a clock */
#define EC_DC_NOBODY	0xffff	/* the chosen slave is not there */

enum ec_dc_state {
	EC_DC_OFF,	/* no clocks, or not measured since the last scan */
	EC_DC_BUSY,	/* clocks are being set */
	EC_DC_READY,	/* set and compensated; SYNC may start */
};

/* a larger difference to the reference clock is reported */
#define EC_DC_LIMIT_NS	EC_UAPI_DC_WINDOW_NS

#define EC_DC_APP_PAST	15

/** struct ec_clock - clock of a slave, changed with ec_dc.lock held where not said otherwise */
struct ec_clock {
	/** @delay: propagation delay from the reference clock, ns, register 0x0928 */
	u32 delay;
	/** @prev_delay: propagation delay from the clock upstream, ns */
	u32 prev_delay;
	/** @measured: 1 + number of the scan after which the two were measured, 0: never */
	u32 measured;
	/** @delay_unreliable: the receive times contradict the topology */
	bool delay_unreliable;
	/** @outside_window: the last difference was outside the sync window, with hysteresis */
	bool outside_window;
	/** @set: the clock was set for this session */
	bool set;
	/** @excluded: it gave no valid reply when it was to be set */
	bool excluded;
	/** @failed_attempts: to set it since, although it had replied to the watch */
	u8 failed_attempts;
	/** @sync_unsynchronized: SYNC signals run by a clock that was not set; ec_slave.lock */
	bool sync_unsynchronized;
	/** @diff: last difference to the reference clock, ns, positive: ahead */
	s32 diff;
	/** @offset: of the system time, ns, register 0x0920 */
	u64 offset;
	/** @sync_due_ns: first SYNC signals, not checked yet (ktime), or 0; ec_slave.lock */
	u64 sync_due_ns;
};

/** struct ec_dc_sync - SYNC signals that an application wants of a slave */
struct ec_dc_sync {
	/** @assign: AssignActivate word of the ESI, 0: none */
	u16 assign;
	/** @period: SYNC0 and SYNC1 cycle time, ns */
	u32 period[2];
	/** @shift: of the two, ns */
	s32 shift[2];
};

/**
 * struct ec_dc_app - the application's time as the clocks have it
 * @base: that time less ktime, ns
 * @base_ns: when it was told so (ktime)
 * @off: by how much the last time told was, ns
 * @skip: what it has jumped since, ns
 * @set: the clocks are set: it may not jump
 * @past: @base of the last cycles before that
 * @n_past: such cycles so far, 0: @base counts
 * @odd: last times told in a row that were off
 * @first: by how much the first of them was, ns
 * @first_ns: when (ktime)
 * @sum: how much more the others were, ns
 * @jumps: since the log has told
 * @jump_ns: the last one
 * @ignored: times that were far off, since the log has told
 * @ignored_ns: by how much the last one was
 * @log_ns: when the log may tell again (ktime)
 */
struct ec_dc_app {
	u64 base;
	u64 base_ns;
	s64 off;
	u64 skip;
	bool set;
	u64 past[EC_DC_APP_PAST];
	u32 n_past;
	u32 odd;
	s64 first;
	u64 first_ns;
	s64 sum;
	u32 jumps;
	s64 jump_ns;
	u32 ignored;
	s64 ignored_ns;
	u64 log_ns;
};

/**
 * struct ec_dc - distributed clocks of a master
 * @lock: one measurement at a time
 * @state: enum ec_dc_state
 * @choice: station address of the wanted reference clock, or EC_DC_ANY...
 * @ref: reference clock with a reference, or NULL, under bus->topo
 * @ref_station: its station address for the cycle, 0: none
 * @ref_wide: it has 64 bits
 * @front: slaves with a clock are in front of it: they get the time the cycle
 *	predicts, and nothing that waits in a queue
 * @begun: the session's clocks were begun to be set, under lock of the configuration
 * @wanted: the application sends clock datagrams
 * @running: the clocks are set: the cycle may correct them
 * @framed: by frames of @work; the cycle only asks for the time
 * @stop: @work shall end
 * @fresh: @work sets all clocks from the application's time
 * @idle: and waits for the first one of its cycle
 * @told: which has come
 * @changed: slaves have come or gone since the clocks were begun to be set; only the
 *	monitor writes it
 * @again: so it is without that: setting them is worth another try
 * @failed: the last try has failed, but another may not
 * @again_ms: between two tries
 * @again_ns: not before (ktime)
 * @begun_ns: since when drift is compensated (ktime)
 * @ahead: time of the reference clock less ktime, when they are set, ns
 * @boost: comparisons the cycle shall make beyond one per send
 * @far_told: the log says that clocks are outside the sync window
 * @far_next_ns: when it may say more of that (ktime)
 * @work: sets the clocks while a session is active
 * @watch: looks at the sync window of all slaves, once a second
 * @wq: woken when @state changes
 * @phase: first application time of the session, ns; SYNC starts on its grid
 * @has_phase: @phase is set
 * @app_time: last application time, ns
 * @app_ktime: when it was that time (ktime), ns
 * @leads: the application tells the reference clock its time
 * @led_ns: when it did so last (ktime), 0: never
 * @led_gap: how long after the time before, ns
 * @app: its time as the clocks have it
 * @time_lock: protects @phase to @app
 */
struct ec_dc {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @bus: slaves, immutable */
	struct ec_bus *bus;
	/** @service: queue of @work and @watch, immutable */
	struct workqueue_struct *service;
	struct mutex lock;
	int state;
	u16 choice;
	struct ec_slave *ref;
	u16 ref_station;
	bool ref_wide;
	bool front;
	bool begun;
	bool wanted;
	bool running;
	bool framed;
	bool stop;
	bool fresh;
	bool idle;
	bool told;
	bool changed;
	bool again;
	bool failed;
	u32 again_ms;
	u64 again_ns;
	aligned_u64 begun_ns;
	atomic64_t ahead;
	u32 boost;
	bool far_told;
	u64 far_next_ns;
	struct work_struct work;
	struct delayed_work watch;
	wait_queue_head_t wq;
	raw_spinlock_t time_lock;
	u64 phase;
	bool has_phase;
	aligned_u64 app_time;
	aligned_u64 app_ktime;
	bool leads;
	u64 led_ns;
	u64 led_gap;
	struct ec_dc_app app;
};

void ec_dc_init(struct ec_dc *dc, struct ec_base *base, struct ec_links *links, struct ec_bus *bus,
		struct workqueue_struct *service);
void ec_dc_exit(struct ec_dc *dc);
int ec_dc_measure(struct ec_dc *dc);
bool ec_dc_can_be(struct ec_dc *dc, u16 choice);
void ec_dc_begin(struct ec_dc *dc, bool all, u16 choice);
void ec_dc_end(struct ec_dc *dc);

/* dc_app.c */
void ec_dc_app_time(struct ec_dc *dc, u64 app_time, u64 at_ns);
bool ec_dc_told(struct ec_dc *dc, const struct ec_ioc_send *what, u64 *skip);
u64 ec_dc_now(struct ec_dc *dc);
u64 ec_dc_app_at(struct ec_dc *dc, u64 at_ns);
void ec_dc_app_set(struct ec_dc *dc, u64 base, bool set);
void ec_dc_app_log(struct ec_dc *dc);

/* dc_time.c */
void ec_dc_clock(struct ec_dc *dc, u64 time, u64 at_ns);
u64 ec_dc_clock_at(struct ec_dc *dc, u64 at_ns);
u64 ec_dc_clock_now(struct ec_dc *dc);
u64 ec_dc_whole(struct ec_dc *dc, u32 low, u64 at_ns);

/* dc_watch.c */
void ec_dc_verdict(struct ec_slave *s, u32 value);
void ec_dc_watch_init(struct ec_dc *dc);
void ec_dc_watch_start(struct ec_dc *dc);
void ec_dc_watch_stop(struct ec_dc *dc);
void ec_dc_watch_begun(struct ec_dc *dc);

/* dc_sync.c */
int ec_dc_wait(struct ec_slave *s);
void ec_dc_sync_again(struct ec_slave *s);
int ec_dc_sync_stop(struct ec_slave *s);
void ec_dc_sync_compare(struct ec_slave *s, const struct ec_dc_sync *c);
int ec_dc_sync_start(struct ec_slave *s, const struct ec_dc_sync *c);
int ec_dc_sync_check(struct ec_slave *s, const struct ec_dc_sync *c);

/* clocks of the bus that a slave is on */
static inline struct ec_dc *ec_dc_of(const struct ec_slave *s)
{
	return s->bus->ext[EC_EXT_CLOCK];
}

static inline struct ec_clock *ec_clock_of(const struct ec_slave *s)
{
	return s->ext[EC_EXT_CLOCK];
}

/* set for this session, though it may have been silent since */
static inline bool ec_clock_is_set(const struct ec_slave *s)
{
	return READ_ONCE(ec_clock_of(s)->set);
}

#endif
