/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The layer "bus": the slaves that are present, and the scan that finds them. It knows no
 * application.
 */
#ifndef EC_MASTER_BUS_H
#define EC_MASTER_BUS_H

#include <linux/mutex.h>
#include <linux/rwsem.h>
#include <linux/spinlock.h>
#include <linux/wait.h>
#include "../base/base.h"
#include "border_table.h"
#include "doubt_state.h"
#include "known_table.h"
#include "line_watch.h"
#include "ring_places.h"
#include "workers.h"

#define EC_MAX_BEGUN	16	/* interrupted changes of an alias that are remembered */
#define EC_BEGUN_BYTES	24	/* checksum and identity */
#define EC_SCAN_WAIT_MS	30000	/* for the end of scans, then the present list of slaves is used */

struct ec_bus;
struct ec_owed;
struct ec_links;
struct ec_slave;

/* higher layers with a part of their own in the bus and in each slave */
enum ec_bus_ext {
	EC_EXT_CLOCK,
	EC_EXT_CONFIG,
	EC_N_EXT,
};

/** struct ec_bus_ops - what the layer needs of higher ones; each may be NULL */
struct ec_bus_ops {
	/** @configure: bring a slave to the state requested; the slave's worker, may sleep */
	void (*configure)(struct ec_slave *slave);
	/** @attached: an application has configured the slave; any context */
	bool (*attached)(const struct ec_slave *slave);
	/** @wake: the monitor has something to do now; any context */
	void (*wake)(struct ec_bus *bus);
};

/** struct ec_bus - slaves of a master */
struct ec_bus {
	/** @base: of the master, immutable */
	struct ec_base *base;
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @ops: immutable */
	const struct ec_bus_ops *ops;
	/** @ext: structures of higher layers, for these alone; set when they are initialized */
	void *ext[EC_N_EXT];
	/**
	 * @slave_bytes: size of the part of each layer in a slave, struct ec_slave @ext; set
	 * when these are initialized, 0: the layer is absent
	 */
	size_t slave_bytes[EC_N_EXT];

	/**
	 * @topo: protects @slaves and @n_slaves, which the monitor alone writes, and the PDO
	 * lists of the slaves; writers add ec_show_change_begin()
	 */
	struct rw_semaphore topo;
	/** @slaves: by ring position */
	struct ec_slave **slaves;
	/** @n_slaves: entries in @slaves */
	unsigned int n_slaves;
	/**
	 * @front: of an open ring, slaves before the break; at least @n_slaves: there is none
	 * before the last of them
	 */
	unsigned int front;
	/** @break_at: of an open ring: the slave before the break, its port, EC_EVENT_NONE: none */
	u32 break_at[2];
	/** @break_was: @break_at and front before the list that is made now; the monitor's */
	u32 break_was[3];
	/** @ring_told: state and front of the ring as the log has them; the monitor's */
	u32 ring_told[2];
	/** @exit: the monitor's */
	struct ec_ring_exit exit;
	/** @heal: the monitor's */
	struct ec_ring_heal heal;
	/** @probe_ns: last probe of mute links (ktime); the monitor's */
	u64 probe_ns;
	/** @turned: device number of a slave of a ring that is the wrong way round, 0: none */
	u64 turned;
	/** @turned_seen: where the last scan has found such a slave; the monitor's */
	u32 turned_seen;
	/** @turned_ns: all scans since then have (ktime) */
	u64 turned_ns;
	/** @turned_told: @turned as the log has it; the monitor's */
	u64 turned_told;
	/** @places: positions of the closed ring */
	struct ec_ring_places places;
	/** @known: device numbers */
	struct ec_known known;
	/** @border: ports at which not every device is let in */
	struct ec_border border;
	/** @trials: attempts to open a port; only the monitor writes it */
	u32 trials;

	/** @pending: slaves have changed, and there is no event of it so far */
	bool pending;
	/** @pending_ns: the monitor has seen it first (ktime), 0: not yet; the monitor's */
	u64 pending_ns;

	/** @rescan: a scan is requested; it waits while @held */
	bool rescan;
	/** @looked: the bus was scanned, or there is no link, since the device was attached */
	bool looked;
	/** @renew: a slave is to be read again, as its EEPROM was written */
	bool renew;
	/** @writes: EEPROMs that are being written: no user asks for a scan meanwhile */
	atomic_t writes;
	/** @begun_lock: protects @begun and @next_begun */
	struct mutex begun_lock;
	/** @begun: words 0 to 11 of EEPROMs whose change of the alias was interrupted */
	u8 begun[EC_MAX_BEGUN][EC_BEGUN_BYTES];
	/** @next_begun: entry of @begun that is used next */
	unsigned int next_begun;
	/** @down: the computer reboots: no slave is brought beyond PREOP any more */
	bool down;
	/** @guarded: process data run: ports behind which nothing is known are closed */
	bool guarded;
	/** @regroup: hot connect groups are to be looked for, as their slaves may have changed */
	bool regroup;
	/** @retry: ports that wait after losses or a trial without reply are tried at once */
	bool retry;
	/** @scan_lock: no scan begins while an application reserves the master */
	spinlock_t scan_lock;
	/**
	 * @held: no scan changes the list of slaves: an application has reserved the master and
	 * is not active; set with @topo and @scan_lock held
	 */
	bool held;
	/** @awaited: callers that wait for the end of scans; users may ask for none meanwhile */
	atomic_t awaited;
	/** @due: a slave was lost while @held, so a scan follows; the monitor's */
	bool due;
	/** @scan_busy: slaves are being scanned; set with @scan_lock held */
	bool scan_busy;
	/** @scan_noted: the scan that begins now is an event already; the monitor's */
	bool scan_noted;
	/** @scan_slaves: how many slaves this scan has */
	u32 scan_slaves;
	/** @scan_index: how many of them have been read */
	u32 scan_index;
	/** @scan_count: scans so far */
	u32 scan_count;
	/** @scan_us: duration of the last one */
	u32 scan_us;
	/** @scan_frames: frames of the last one */
	aligned_u64 scan_frames;
	/** @next_station: station address given last; the monitor's */
	u16 next_station;
	/** @listed_station: of these, given last when the list of slaves changed; the monitor's */
	u16 listed_station;
	/** @owed: slaves that got the address of another one; the monitor's */
	struct ec_owed *owed;
	/** @n_owed: entries in @owed */
	unsigned int n_owed;
	/** @lists: how often the list of slaves has changed; the monitor's */
	u32 lists;
	/** @thrown_away: scans in a row whose result contradicted the bus; the monitor's */
	unsigned int thrown_away;
	/** @flaps: scans in a row during which slaves have come or gone; the monitor's */
	unsigned int flaps;
	/**
	 * @torn: scans in a row that have read other addresses than slaves had when they were to
	 * get one; the monitor's
	 */
	unsigned int torn;
	/** @doubt: contradictions of the graph */
	struct ec_doubt doubt;
	/** @complete_ns: when all slaves replied last (ktime); the monitor's */
	u64 complete_ns;
	/** @mailboxes_ns: last poll of all mailboxes (ktime); the monitor's */
	u64 mailboxes_ns;
	/** @some_mailboxes_ns: last poll of any */
	u64 some_mailboxes_ns;
	/** @lost_look_ns: last look for ports without link, in work that takes long as well */
	u64 lost_look_ns;
	/** @found: slaves that a scan reads, not in the list yet; the monitor's */
	struct ec_slave **found;
	/** @n_found: of these */
	unsigned int n_found;
	/** @line_watch: where the reading of error counters is; the monitor's */
	struct ec_line_watch line_watch;
	/** @vain_looks: polls in a row that found no message although an event was seen */
	unsigned int vain_looks;
	/** @sii_bytes: memory of all EEPROM images */
	atomic_long_t sii_bytes;

	/** @responding: slaves that replied to the last broadcast */
	u32 responding;
	/** @al_states: OR of AL states, as in struct ec_ioc_master */
	u32 al_states;

	/**
	 * @changes: of the slaves, as far as ec_survey() or the status of an application shows
	 * them; see ec_slave_changed(); wraps
	 */
	atomic_t changes;
	/** @settled: woken when a scan has ended or a slave has settled */
	wait_queue_head_t settled;
	/** @settles: how often it was woken; wraps */
	atomic_t settles;
	/** @workers: threads that bring slaves to their state; they wait for clocks and cycles */
	struct ec_workers workers;
};

/* each slave of @bus: declares @s */
#define ec_for_each_slave(s, bus) \
	for (struct ec_slave **s##_at = (bus)->slaves, *s; \
	     s##_at < (bus)->slaves + (bus)->n_slaves && (s = *s##_at, true); s##_at++)

/* For what reads the table of slaves or their PDOs: topo is held, or they are shown. */
static inline void ec_bus_assert_stays(const struct ec_bus *bus)
{
	lockdep_assert(lockdep_is_held(&bus->topo) || ec_show_begun(&bus->base->show));
}

int ec_bus_init(struct ec_bus *bus, struct ec_base *base, struct ec_links *links,
		const struct ec_bus_ops *ops);
void ec_bus_need_workers(struct ec_bus *bus, unsigned int n);
void ec_bus_stop(struct ec_bus *bus);
bool ec_bus_scan_busy(const struct ec_bus *bus);
bool ec_bus_begin_scan(struct ec_bus *bus);
bool ec_bus_hold(struct ec_bus *bus, bool always);
void ec_bus_unhold(struct ec_bus *bus);
void ec_bus_scan_progress(const struct ec_bus *bus, u32 *index, u32 *count);
void ec_bus_rescan(struct ec_bus *bus);
void ec_bus_settled(struct ec_bus *bus);

#endif
