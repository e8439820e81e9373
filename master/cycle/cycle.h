/* SPDX-License-Identifier: GPL-2.0-only */
/* The cyclic exchange of process data. */
#ifndef EC_CYCLE_H
#define EC_CYCLE_H

#include "../base/limits.h"
#include "../carry/carry.h"
#include "../carry/rider.h"
#include "../clock/dc_state.h"
#include "../config/config.h"
#include "copy.h"
#include "cyc_domain.h"
#include "dc_datagrams.h"
#include "ethercat.h"
#include "late.h"
#include "layout.h"
#include "shared.h"

struct ec_cycle;
struct ec_cycle_thread;
struct ec_recorder;
struct ec_cyc_units;
struct ec_waiters;

#define EC_CYCLE_PRIORITY	50	/* SCHED_FIFO, when none is configured */

/** struct ec_cyc_flight - a frame of the cycle in flight */
struct ec_cyc_flight {
	/** @slot: frame */
	struct ec_slot *slot;
	/** @send: number of the send it belongs to */
	u32 send;
	/** @first: first datagram of the layout that it may carry */
	u16 first;
	/** @count: datagrams from @first on; it carries those of domains in @queued */
	u16 count;
	/** @queued: domains of that send, bit n: domain n */
	u64 queued;
	/** @missed: a receive has not found its reply */
	bool missed;
	/** @in_time: mask of the links whose copy a receive before the next send has found */
	u8 in_time;
	/** @direct: domains sent from struct ec_cycle.direct, bit n: domain n */
	u64 direct;
	/** @clocks: clock datagrams before them */
	struct ec_dc_flight clocks;
	/** @riding: riders behind them */
	struct ec_riding riding;
};

#define EC_CYC_FRAMES	128	/* in flight at most */
#define EC_CYC_SENDS	128	/* remembered; the age of data is at most that */

/** struct ec_cycle_report - the last cycle that has ended */
struct ec_cycle_report {
	/** @info: its result of EC_IOC_CYCLE_STATS */
	struct ec_ioc_cycle_stats info;
	/** @status: and its figures */
	struct ec_status_cycle status;
};

/** struct ec_cycles - all cycles of a master: one at a time runs */
struct ec_cycles {
	/** @base: name and log; immutable, as are the next four */
	struct ec_base *base;
	/** @links: way to the slaves */
	struct ec_links *links;
	/** @carry: what others send beside the cycle */
	struct ec_carry *carry;
	/** @riders: datagrams in its frames */
	struct ec_riders *riders;
	/** @dc: distributed clocks */
	struct ec_dc *dc;

	/** @lock: held by the cycle owner in receive and send; protects @active */
	struct mutex lock;
	/** @active: the cycle that runs; changed with the lock of its configuration as well */
	struct ec_cycle *active;
	/** @owner: of @active, to be compared without a lock; NULL: none */
	const void *owner;

	/** @report: the last cycle that has ended, under the lock of its configuration */
	struct ec_cycle_report report;

	/** @number: cycles of the thread that runs the cycle */
	aligned_u64 number;
	/** @run: an uneven number while it sends; another number than before: another run */
	u32 run;
	/**
	 * @by_kernel: @active while the kernel runs it; changed under the lock of its
	 * configuration, read under RCU
	 */
	struct ec_cycle __rcu *by_kernel;
	/** @recorder: copies of each cycle, NULL: they have no reader */
	struct ec_recorder __rcu *recorder;
};

/** struct ec_ring_look - a look of the monitor at an open ring, for ring_sides.c */
struct ec_ring_look {
	/** @changes: struct ec_bus.changes */
	u32 changes;
	/** @moves: struct ec_cycle.moves */
	u16 moves;
	/** @steady: the list of slaves is up to date */
	bool steady;
	/** @known: struct ec_cyc_dgram.sides are up to date */
	bool known;
};

/** struct ec_cycle_setup - what an application has set; under the lock of the configuration */
struct ec_cycle_setup {
	/** @kernel: how the kernel runs the cycle; period 0: the application runs it */
	struct ec_ioc_cycle kernel;
	/** @priority: SCHED_FIFO priority that the process which set @kernel may use; 0: none */
	u32 priority;
	/** @may_interrupt: likewise: the cycle may run in an interrupt, before all threads */
	bool may_interrupt;
	/** @late_per_s: how many cycles a second acyclic frames may delay */
	u32 late_per_s;
	/** @copies: from inputs to outputs, before each send */
	struct ec_copies copies;
};

/** struct ec_cycle_watch - what the monitor has seen; under the lock of the configuration */
struct ec_cycle_watch {
	/** @places_logged: struct ec_cycle @places, as the log has them */
	u32 places_logged;
	/** @cpu_lost: the CPU of the cycle is offline */
	bool cpu_lost;
	/** @cpu_losses: how often it went offline */
	u32 cpu_losses;
	/** @wire_logged: the log has that acyclic frames do not fit */
	bool wire_logged;
	/** @lock_logged: EC_CYCLE_LOCK_* as the log has it */
	u32 lock_logged;
};

/**
 * struct ec_cycle - cycle of an application
 *
 * Its parts by their writer: the application that configures (@setup), the monitor (@watch),
 * an activation (@layout, @copying and the pointers of the others), and the cycle owner.
 */
struct ec_cycle {
	/** @cycles: of the master; immutable, as are the next six */
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

	/** @setup: what the application has set; immutable while active but for a takeover */
	struct ec_cycle_setup setup;
	/** @watch: what the monitor has seen */
	struct ec_cycle_watch watch;
	/**
	 * @owner: open file of the application; NULL: it has exited, the cycle continues; under
	 * the lock of the configuration
	 */
	const void *owner;
	/**
	 * @waiters: callers of @owner that wait for a cycle, or NULL; changed under the lock of
	 * the configuration, read under RCU
	 */
	struct ec_waiters __rcu *waiters;
	/** @shared: memory of the activation: image, status page, exchange; immutable in use */
	struct ec_shared *shared;
	/**
	 * @thread: runs the cycle while active; NULL: the application does; immutable while
	 * active
	 */
	struct ec_cycle_thread *thread;
	/** @slaves_down: the application takes the slaves to PREOP: working counters go down */
	bool slaves_down;
	/** @place: EC_CYCLE_PLACE_*, where the last cycle of the kernel ran; of the cycle owner */
	u32 place;
	/** @places: where cycles have run, bit n: place n; likewise */
	u32 places;

	/** @layout: datagrams; ec_cycle_free() sets it and all that follows to zero */
	struct ec_layout layout;
	/** @copying: the copies while active, or NULL; of the cycle owner, as is all below */
	struct ec_copying *copying;
	/** @units: sync units, or NULL */
	struct ec_cyc_units *units;
	/** @clock: clock datagrams */
	struct ec_dc_datagrams clock;
	/** @late: send deviations */
	struct ec_late late;
	/** @domains: received data */
	struct ec_cyc_domain domains[EC_MAX_DOMAINS];
	/**
	 * @direct: image of the application to send from, its inputs may have any value;
	 * NULL: those of @domains. While it is used, the outputs of the latter are
	 * undefined
	 */
	const u8 *direct;
	/** @flight: frames in flight, the oldest first */
	struct ec_cyc_flight flight[EC_CYC_FRAMES];
	/** @n_flight: entries in @flight */
	unsigned int n_flight;
	/** @mute: links of a ring whose copy of the last frame is missing, and not late either */
	u8 mute;
	/** @copies_late: late copies that @mute knows of */
	u64 copies_late;
	/**
	 * @from_backup: domains with data that slaves have processed in the copy of the backup
	 * link, which has returned there: the ring is open
	 */
	u64 from_backup;
	/** @shown_backup: the same in the status page */
	u64 shown_backup;
	/** @opened: changes with each frame by which a ring has opened or closed */
	u16 opened;
	/**
	 * @moves: changes with each frame of a ring that not the same slaves have processed as the
	 * last one
	 */
	u16 moves;
	/** @crossed: the last frame has crossed the ring */
	bool crossed;
	/** @ring_look: the last one; of the monitor, under the lock of the configuration */
	struct ec_ring_look ring_look;
	/** @last: frames of the last send */
	struct ec_cyc_wire last;
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
};

/* For data of a master about its cycle: the lock of the active one, @c, which may be NULL. */
static inline void ec_cycle_assert_held(const struct ec_cycle *c)
{
	lockdep_assert(!c || lockdep_is_held(c->wanted->lock));
}

void ec_cycles_init(struct ec_cycles *cycles, struct ec_base *base, struct ec_carry *carry,
		    struct ec_riders *riders, struct ec_dc *dc);
void ec_cycle_init(struct ec_cycle *c, struct ec_cycles *cycles, struct ec_wanted *wanted);
void ec_cycle_clear(struct ec_cycle *c);
int ec_cycle_layout(struct ec_cycle *c);
void ec_cycle_free(struct ec_cycle *c);
void ec_cycle_set_active(struct ec_cycles *cycles, struct ec_cycle *c);
void ec_cycle_set_owner(struct ec_cycle *c, const void *owner, struct ec_waiters *waiters);
void ec_cycles_nothing_back(struct ec_cycles *cycles);

#endif
