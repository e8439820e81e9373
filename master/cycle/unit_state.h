/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units of a cycle: what is sent for domains that fail, alone. */
#ifndef EC_UNIT_STATE_H
#define EC_UNIT_STATE_H

#include <linux/atomic.h>
#include <linux/jump_label.h>
#include <linux/minmax.h>
#include <linux/types.h>
#include "../base/events.h"
#include "../base/limits.h"
#include "../config/domain.h"
#include "ethercat.h"

struct work_struct;
struct workqueue_struct;

/* the areas of a domain, its outputs first */
struct ec_unit_place {
	const struct ec_domain_area *areas;
	u16 outputs;
	u16 inputs;
};

/* struct ec_cyc_unit.wish: bits; a GIVE is not accepted while another one waits */
#define EC_UNIT_GIVE	1
#define EC_UNIT_TAKE	2
#define EC_UNIT_HOLDER	4	/* it has another holder, or none any more */

/** struct ec_cyc_unit - a sync unit while active */
struct ec_cyc_unit {
	/** @what: as configured; immutable */
	struct ec_ioc_unit what;
	/** @domains: bit n: domain n; immutable */
	u64 domains;
	/** @feeds: those with outputs; immutable */
	u64 feeds;
	/** @run: EC_UNIT_RUN_*; of the cycle owner, as are all below up to @rate */
	u8 run;
	/** @sends: EC_UNIT_SENDS_* of its outputs */
	u8 sends;
	/** @without: what is sent while it has no authority */
	u8 without;
	/** @authority: the outputs of the application are sent */
	bool authority;
	/** @leased: outputs were given once, so the lease runs */
	bool leased;
	/** @ended: the lease has ended */
	bool ended;
	/** @same: receives in a row in which it was complete, while it has failed */
	u32 same;
	/** @off: receives in a row in which a slave was not in OP */
	u32 off;
	/** @waits: receives since it was complete, while all is stopped because of it */
	u32 waits;
	/** @unfed: cycles since all of @feeds were given */
	u32 unfed;
	/** @fed: domains given since */
	u64 fed;
	/** @faults: failures, and ends of the lease */
	u32 faults;
	/** @reported: state in the last event */
	u32 reported;
	/** @rate: of these events */
	struct ec_event_rate rate;
	/** @wish: EC_UNIT_GIVE, EC_UNIT_TAKE, EC_UNIT_HOLDER: commands for the cycle owner */
	atomic_t wish;
	/**
	 * @op: all its slaves are in OP, but for those of groups that are absent; of the monitor
	 */
	bool op;
	/** @down: its slaves are to be in SAFEOP; the cycle owner sets it, a command clears it */
	bool down;
	/**
	 * @holder: open file of another application that gives its outputs, or NULL; under the lock
	 * of the configuration, as is @back
	 */
	const void *holder;
	/** @held: it has one; of the cycle owner */
	bool held;
	/** @bytes: of its domains; immutable, as is @buffers */
	u32 bytes;
	/** @buffers: three buffers for outputs of a holder, or NULL: it is not offered */
	u8 *buffers;
	/** @word: as struct ec_exchange @outputs */
	u32 word;
	/** @front: buffer that the cycle has */
	u32 front;
	/** @back: buffer that the holder has */
	u32 back;
};

/** struct ec_cyc_units - the units of an active cycle */
struct ec_cyc_units {
	/** @places: areas of each domain; immutable, as are the next four */
	struct ec_unit_place places[EC_MAX_DOMAINS];
	/** @areas: all areas */
	struct ec_domain_area *areas;
	/** @of_config: unit of each slave configuration, EC_NO_UNIT: none */
	u8 *of_config;
	/** @queue: runs @alarm */
	struct workqueue_struct *queue;
	/** @alarm: takes slaves to SAFEOP, or to OP again */
	struct work_struct *alarm;
	/**
	 * @seen: bits EC_UNIT_SEEN_* of each slave configuration; under the lock of the
	 * configuration
	 */
	u8 *seen;
	/** @wished: a unit has a wish */
	atomic_t wished;
	/** @looked: a slave has left OP or has reached it; of the monitor */
	bool looked;
	/**
	 * @repeated: domains whose frames are sent at least twice, three times, and so on;
	 * immutable
	 */
	u64 repeated[EC_UNIT_REPEATS];
	/**
	 * @image: sent instead of that of the application, for domains in @replaced; of the cycle
	 * owner, as are the next six
	 */
	u8 *image;
	/** @replaced: domains whose outputs are not those of the application, bit n: domain n */
	aligned_u64 replaced;
	/** @used: domains of the application */
	u64 used;
	/** @stopped: a unit with EC_UNIT_POLICY_STOP has failed: index + 1, 0: none */
	u32 stopped;
	/** @holders: units that another application holds */
	u32 holders;
	/** @bad: exchanges in a row in which a domain was not complete */
	u32 bad[EC_MAX_DOMAINS];
	/**
	 * @calm: all units are complete and there is nothing to report: only what is not steady, a
	 * wish or @looked can change that
	 */
	bool calm;
	/** @n: entries in @unit */
	unsigned int n;
	/** @unit: units */
	struct ec_cyc_unit unit[];
};

#define EC_NO_UNIT	0xff
#define EC_UNIT_PATIENCE	1000

#define EC_UNIT_SEEN_OP	1	/* its slave was in OP since it was attached */
#define EC_UNIT_SEEN_DOWN	2	/* a policy has requested SAFEOP of it */

/**
 * ec_units_state() - the state of a unit for the status page and tools
 * @u: unit
 *
 * Context: Any. RT-safe. A reader beside the cycle owner may get parts of two cycles.
 * Return: as described at EC_UNIT_RUN_STARTING.
 */
static inline u32 ec_units_state(const struct ec_cyc_unit *u)
{
	return READ_ONCE(u->run) | READ_ONCE(u->sends) << 4 |
	       (READ_ONCE(u->authority) ? EC_UNIT_HAS_AUTHORITY : 0) |
	       (READ_ONCE(u->ended) ? EC_UNIT_LEASE_ENDED : 0) |
	       (READ_ONCE(u->down) ? EC_UNIT_DOWN : 0) |
	       (READ_ONCE(u->held) ? EC_UNIT_HAS_HOLDER : 0) |
	       min(READ_ONCE(u->faults), 0xffffu) << 16;
}

/* An active cycle has sync units: without any the tests of a cycle for them are no instructions. */
DECLARE_STATIC_KEY_FALSE(ec_units_used);

/* of struct ec_cycle @c, or NULL; for what runs in each cycle */
#define ec_units_of(c)	(static_branch_unlikely(&ec_units_used) ? (c)->units : NULL)

/**
 * ec_units_are_calm() - does this receive change no unit?
 * @us: units
 * @steady: all domains are complete, as before
 *
 * Context: The cycle owner. RT-safe.
 * Return: true: nothing is to be judged.
 */
static inline bool ec_units_are_calm(const struct ec_cyc_units *us, bool steady)
{
	return steady && us->calm && !READ_ONCE(us->looked) && !atomic_read(&us->wished);
}

/**
 * ec_units_act() - do units change what is sent?
 * @us: units
 * @queued: domains that are sent
 *
 * Context: The cycle owner. RT-safe.
 * Return: true: outputs are replaced, or a command waits.
 */
static inline bool ec_units_act(const struct ec_cyc_units *us, u64 queued)
{
	return us->replaced & queued || us->holders || atomic_read(&us->wished);
}

/**
 * ec_units_may_have() - may a unit have authority now?
 * @us: units
 * @u: one of them
 *
 * Not while its lease has ended or another unit has stopped all. The one that has stopped all waits
 * for units that would stop all again, and EC_UNIT_PATIENCE receives for others with a policy.
 *
 * Context: Any. RT-safe: bounded by the units.
 * Return: true: it is complete, and nothing else is against it.
 */
static inline bool ec_units_may_have(const struct ec_cyc_units *us, const struct ec_cyc_unit *u)
{
	u32 stopped = READ_ONCE(us->stopped);
	unsigned int i;

	if (READ_ONCE(u->run) != EC_UNIT_RUN_COMPLETE || READ_ONCE(u->ended))
		return false;
	if (stopped && stopped != u->what.index + 1)
		return false;
	for (i = 0; stopped && i < us->n; i++) {
		const struct ec_cyc_unit *x = &us->unit[i];

		if (READ_ONCE(x->run) == EC_UNIT_RUN_FAILED &&
		    (x->what.policy == EC_UNIT_POLICY_STOP ||
		     (x->what.policy != EC_UNIT_POLICY_CONTINUE &&
		      READ_ONCE(u->waits) < EC_UNIT_PATIENCE)))
			return false;
	}
	return true;
}

#endif
