/* SPDX-License-Identifier: GPL-2.0-only */
/* Distributed clocks: measuring delays, setting and checking the clocks. */
#ifndef EC_DC_STATE_H
#define EC_DC_STATE_H

#include <linux/atomic.h>
#include <linux/mutex.h>
#include <linux/types.h>
#include <linux/wait.h>
#include <linux/workqueue.h>
#include "../bus/slave.h"
#include "../carry/armw.h"

struct ec_base;
struct ec_bus;
struct ec_dc_track;
struct ec_ioc_send;
struct ec_links;
struct ec_result;

/* choice of the reference clock that is no station address */
#define EC_DC_ANY	0	/* the first one that has a clock */
#define EC_DC_NOBODY	0xffff	/* the chosen slave is absent */

/**
 * enum ec_dc_state - clocks of a master in a session; ec_dc_set_state() alone changes it
 * @EC_DC_OFF: no session uses them
 * @EC_DC_BUSY: the worker measures and sets them
 * @EC_DC_AWAIT_CYCLE: the worker waits for the first cycles of the application
 * @EC_DC_READY: they are set and near each other: SYNC may start
 * @EC_DC_FAILED: they are not set, and only a change of the bus can help
 * @EC_DC_RETRY_WAIT: they are not set, as frames or replies were lost, the link was down, or
 *	memory was short
 * @EC_DC_RETRY_DUE: the monitor is to begin another attempt
 *
 * ============  ========  ======  =============  ==========  ===============  ============
 * state         begin     end     first job      all set     error            attempt due
 * ============  ========  ======  =============  ==========  ===============  ============
 * OFF           BUSY      OFF
 * BUSY          BUSY      OFF     AWAIT_CYCLE    READY       FAILED,
 *                                                            RETRY_WAIT
 * AWAIT_CYCLE   BUSY      OFF     BUSY (cycles
 *                                 have come)
 * READY         BUSY      OFF                                                 RETRY_DUE
 * FAILED        BUSY      OFF                                                 RETRY_DUE
 * RETRY_WAIT    BUSY      OFF                                                 RETRY_DUE
 * RETRY_DUE     BUSY      OFF
 * ============  ========  ======  =============  ==========  ===============  ============
 *
 * Begin and end first wait for the worker and the watch. Until then the worker changes BUSY
 * and AWAIT_CYCLE, the watch changes the others: when an excluded slave replies, or after
 * RETRY_WAIT.
 */
enum ec_dc_state {
	EC_DC_OFF,
	EC_DC_BUSY,
	EC_DC_AWAIT_CYCLE,
	EC_DC_READY,
	EC_DC_FAILED,
	EC_DC_RETRY_WAIT,
	EC_DC_RETRY_DUE,
};

/** enum ec_dc_mode - what the cycle does with the clocks; the worker changes it */
enum ec_dc_mode {
	/** @EC_DC_IDLE: nothing: they are not set, or are measured */
	EC_DC_IDLE,
	/** @EC_DC_READ: read the time of the reference clock; frames of the worker compensate */
	EC_DC_READ,
	/** @EC_DC_COMPENSATE: send that time to all clocks */
	EC_DC_COMPENSATE,
};

/**
 * enum ec_clock_state - clock of a slave in a session; ec_clock_event() alone changes it
 * @EC_CLOCK_UNSET: not set yet
 * @EC_CLOCK_SET: set
 * @EC_CLOCK_EXCLUDED: not set, and without a valid reply when it was to be set
 * @EC_CLOCK_LOST: set, and without a valid reply since
 *
 * ========  =====  ========  ==========
 * state     SET    SILENT    ACTIVATION
 * ========  =====  ========  ==========
 * UNSET     SET    EXCLUDED  UNSET
 * SET       SET    LOST      UNSET
 * EXCLUDED  SET    EXCLUDED  EXCLUDED
 * LOST      SET    LOST      EXCLUDED
 * ========  =====  ========  ==========
 *
 * The watch polls clocks that are EXCLUDED or LOST; when one replies, another attempt is due.
 */
enum ec_clock_state {
	EC_CLOCK_UNSET,
	EC_CLOCK_SET,
	EC_CLOCK_EXCLUDED,
	EC_CLOCK_LOST,
};

/** enum ec_clock_event - what happens to a clock */
enum ec_clock_event {
	/** @EC_CLOCK_ON_SET: offset and delay were written */
	EC_CLOCK_ON_SET,
	/** @EC_CLOCK_ON_SILENT: no valid reply in EC_DC_OUT_TRIES attempts */
	EC_CLOCK_ON_SILENT,
	/** @EC_CLOCK_ON_ACTIVATION: the clocks of a session are begun */
	EC_CLOCK_ON_ACTIVATION,
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
	/** @measured_after: device number of the slave before it then, 0: none */
	u64 measured_after;
	/** @state: enum ec_clock_state; atomic */
	u32 state;
	/** @delay_unreliable: the receive times contradict the topology; of a measurement */
	bool delay_unreliable;
	/** @outside_window: the last difference was outside the sync window, with hysteresis */
	bool outside_window;
	/** @sync_unsynchronized: SYNC was started before the clock was set; ec_slave.lock */
	bool sync_unsynchronized;
	/** @failed_attempts: to set it since it is excluded, although it replied to the watch */
	u8 failed_attempts;
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

/** struct ec_dc_app - the application time as the clocks have it */
struct ec_dc_app {
	/** @base: that time less ktime, ns */
	u64 base;
	/** @base_ns: when it was that (ktime) */
	u64 base_ns;
	/** @mean: the same, a mean of many cycles, which the reference clock is given */
	u64 mean;
	/** @mean_part: fraction of it, 2^-16 ns */
	s64 mean_part;
	/** @mean_rate: its change with each of them, 2^-16 ns */
	s64 mean_rate;
	/** @n_mean: how many they are */
	u32 n_mean;
	/** @spread: their mean deviation from it, ns */
	s32 spread;
	/** @off: deviation of the last time, ns */
	s64 off;
	/** @skip: all jumps since the clocks are set, ns */
	u64 skip;
	/** @set: the clocks are set: it may not jump */
	bool set;
	/** @past: @base of the last cycles before that */
	u64 past[EC_DC_APP_PAST];
	/** @n_past: such cycles so far, 0: @base counts */
	u32 n_past;
	/** @deviating: last times in a row that deviated by more than the limit */
	u32 deviating;
	/** @first: deviation of the first of them, ns */
	s64 first;
	/** @first_ns: when (ktime) */
	u64 first_ns;
	/** @sum: how much more the others deviated, ns */
	s64 sum;
	/** @jumps: since the last log message */
	u32 jumps;
	/** @jump_ns: the last one */
	s64 jump_ns;
	/** @ignored: isolated errors since the last log message */
	u32 ignored;
	/** @ignored_ns: the last one */
	s64 ignored_ns;
	/** @log_ns: no log message before (ktime) */
	u64 log_ns;
};

/** struct ec_dc_behind - clocks that frames of the backup link reach alone */
struct ec_dc_behind {
	/** @number: of the break; changes with what follows; bit 0: that is changed now */
	u32 number;
	/** @station: of the reference clock if it is behind, else of the first clock; 0: none */
	u16 station;
	/** @ref: it is the reference clock */
	bool ref;
	/** @delay: in its register */
	u32 delay;
	/** @front: slaves before the break */
	u32 front;
	/** @slaves: all */
	u32 slaves;
	/** @given: @shift is valid; else it is seen by the clocks there */
	bool given;
	/** @shift: as struct ec_ring_clock.shift */
	s32 shift;
};

/**
 * struct ec_dc - distributed clocks of a master
 *
 * What one thread sets and another one takes is a flag of its own, not part of @state: @wanted,
 * @changed, @stop and @app_time_seen are valid in several states.
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
	/** @lock: one measurement or setting at a time */
	struct mutex lock;
	/** @state: enum ec_dc_state */
	int state;
	/** @wq: woken when @state changes, or @changed is cleared */
	wait_queue_head_t wq;
	/** @work: sets the clocks while a session is active */
	struct work_struct work;
	/** @watch: polls the difference of all clocks, once a second */
	struct delayed_work watch;
	/** @stop: request: @work and @watch end soon */
	bool stop;
	/** @wanted: the cycle has sent its first clock datagram; set by the cycle owner */
	bool wanted;
	/**
	 * @changed: slaves have connected or disconnected since the last begin; only the
	 * monitor writes it
	 */
	bool changed;
	/** @app_time_seen: an application time has come since the last begin */
	bool app_time_seen;
	/** @retry_ms: time from the last begin to the next attempt */
	u32 retry_ms;
	/** @retry_ns: no other attempt before (ktime) */
	u64 retry_ns;

	/** @choice: station address of the configured reference clock, or EC_DC_ANY... */
	u16 choice;
	/** @ref: reference clock with a reference, or NULL, under bus->topo */
	struct ec_slave *ref;
	/** @ref_station: its station address for the cycle, 0: none */
	u16 ref_station;
	/** @behind: clocks behind the break of a ring; written with bus->topo */
	struct ec_dc_behind behind;
	/** @guessed: those were set without a measurement, as the ring was open; under @lock */
	bool guessed;
	/** @ref_wide: it has 64 bits */
	bool ref_wide;
	/**
	 * @clocks_upstream: there are clocks upstream of it: they take the time that the cycle
	 * predicts
	 */
	bool clocks_upstream;
	/** @ref_minus_ktime: time of the reference clock less ktime, when it is set, ns */
	atomic64_t ref_minus_ktime;

	/** @mode: enum ec_dc_mode */
	int mode;
	/** @path_events: changes of ports that the cycle has seen; only its owner writes it */
	u32 path_events;
	/** @path_scanned: ec_dc_path() that the last scan has taken into account */
	u32 path_scanned;
	/** @delays_written: the worker has written those of the present list of slaves */
	bool delays_written;
	/** @path_known: ec_dc_path() for which the delays are right, else the clocks are held */
	u32 path_known;
	/** @armw: ring position of the reference clock, for slaves that ignore FRMW */
	struct ec_armw armw;
	/** @armw_since_ns: since when that position is not certain (ktime), 0: it is */
	u64 armw_since_ns;
	/** @armw_logged: the log says why; both are the monitor's */
	bool armw_logged;
	/** @extra_dgrams: drift compensation datagrams that the cycle adds to one per send */
	u32 extra_dgrams;
	/** @since_ns: since when drift is compensated (ktime) */
	aligned_u64 since_ns;
	/** @track: of dc_track.c, or NULL; immutable, as is the next one */
	struct ec_dc_track *track;
	/** @again: measures the delays again while nothing changes, or NULL; called by @watch */
	void (*again)(struct ec_dc *dc);
	/** @window_logged: the log says that clocks are outside the sync window */
	bool window_logged;
	/** @window_log_ns: no other message of that before (ktime) */
	u64 window_log_ns;

	/** @time_lock: protects all that follows */
	raw_spinlock_t time_lock;
	/** @phase: first application time of the session, ns; SYNC starts on its grid */
	u64 phase;
	/** @has_phase: @phase is set, with 0 if the clocks are set before that time has come */
	bool has_phase;
	/** @app_time: last application time, ns */
	aligned_u64 app_time;
	/** @app_ktime: when it was that time (ktime), ns */
	aligned_u64 app_ktime;
	/** @app_leads: the application is the time reference of the reference clock */
	bool app_leads;
	/** @led_ns: when it last wrote its time to it (ktime), 0: never */
	u64 led_ns;
	/** @led_gap: time between the last two writes, ns */
	u64 led_gap;
	/** @app: its time as the clocks have it */
	struct ec_dc_app app;
};

/* clocks of the bus that a slave is on */
static inline struct ec_dc *ec_dc_of(const struct ec_slave *s)
{
	return s->bus->ext[EC_EXT_CLOCK];
}

static inline struct ec_clock *ec_clock_of(const struct ec_slave *s)
{
	return s->ext[EC_EXT_CLOCK];
}

static inline bool ec_clock_is_set(const struct ec_slave *s)
{
	u32 state = READ_ONCE(ec_clock_of(s)->state);

	return state == EC_CLOCK_SET || state == EC_CLOCK_LOST;
}

static inline bool ec_clock_is_excluded(const struct ec_slave *s)
{
	return READ_ONCE(ec_clock_of(s)->state) >= EC_CLOCK_EXCLUDED;
}

/* does a session use the clocks? */
static inline bool ec_dc_begun(const struct ec_dc *dc)
{
	return READ_ONCE(dc->state) != EC_DC_OFF;
}

static inline bool ec_dc_busy(const struct ec_dc *dc)
{
	int state = READ_ONCE(dc->state);

	return state == EC_DC_BUSY || state == EC_DC_AWAIT_CYCLE;
}

/* Changes of ports, seen by the cycle or made by the master, for ec_dc_path_is_known(). */
static inline u32 ec_dc_path(const struct ec_dc *dc)
{
	return READ_ONCE(dc->path_events) + READ_ONCE(dc->bus->trials);
}

/* After these changes of ports (ec_dc_path()) the delays are right, as measured or as before. */
static inline void ec_dc_path_is_known(struct ec_dc *dc, u32 path)
{
	WRITE_ONCE(dc->path_known, path);
}

/* Are the delays in the clocks those of the list of slaves, or will no worker write others? */
static inline bool ec_dc_delays_written(const struct ec_dc *dc)
{
	return READ_ONCE(dc->delays_written) || !ec_dc_busy(dc);
}

/* May the delays be wrong? RT-safe */
static inline bool ec_dc_path_changed(const struct ec_dc *dc)
{
	return ec_dc_path(dc) != READ_ONCE(dc->path_known);
}

/* Is the monitor to call ec_dc_begin() for the active session? */
static inline bool ec_dc_due(const struct ec_dc *dc)
{
	if (!ec_dc_begun(dc))
		return READ_ONCE(dc->wanted);
	return READ_ONCE(dc->changed) || READ_ONCE(dc->state) == EC_DC_RETRY_DUE;
}

enum ec_clock_state ec_clock_event(struct ec_clock *c, enum ec_clock_event event);
void ec_dc_set_state(struct ec_dc *dc, enum ec_dc_state state);

#endif
