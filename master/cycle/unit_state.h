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

/**
 * struct ec_cyc_unit - a sync unit while active
 * @what: as configured; immutable
 * @domains: bit n: domain n; immutable
 * @feeds: those with outputs; immutable
 * @run: EC_UNIT_RUN_*; of the cycle owner, as are all below up to @rate
 * @sends: EC_UNIT_SENDS_* of its outputs
 * @without: what is sent while it has no authority
 * @authority: the outputs of the application are sent
 * @leased: outputs were given once, so the lease runs
 * @ended: the lease has ended
 * @same: receives in a row in which it was complete, while it has failed
 * @off: receives in a row in which a slave was not in OP
 * @waits: receives since it was complete, while all is stopped because of it
 * @unfed: cycles since all of @feeds were given
 * @fed: domains given since
 * @faults: failures, and ends of the lease
 * @reported: state in the last event
 * @rate: of these events
 * @wish: EC_UNIT_GIVE, EC_UNIT_TAKE, EC_UNIT_HOLDER: commands for the cycle owner
 * @op: all its slaves are in OP, but for those of groups that are absent; of the monitor
 * @down: its slaves are to be in SAFEOP; the cycle owner sets it, a command clears it
 * @holder: open file of another application that gives its outputs, or NULL; under the lock of the
 *	configuration, as is @back
 * @held: it has one; of the cycle owner
 * @bytes: of its domains; immutable, as is @buffers
 * @buffers: three buffers for outputs of a holder, or NULL: it is not offered
 * @word: as struct ec_exchange @outputs
 * @front: buffer that the cycle has
 * @back: buffer that the holder has
 */
struct ec_cyc_unit {
	struct ec_ioc_unit what;
	u64 domains;
	u64 feeds;
	u8 run;
	u8 sends;
	u8 without;
	bool authority;
	bool leased;
	bool ended;
	u32 same;
	u32 off;
	u32 waits;
	u32 unfed;
	u64 fed;
	u32 faults;
	u32 reported;
	struct ec_event_rate rate;
	atomic_t wish;
	bool op;
	bool down;
	const void *holder;
	bool held;
	u32 bytes;
	u8 *buffers;
	u32 word;
	u32 front;
	u32 back;
};

/**
 * struct ec_cyc_units - the units of an active cycle
 * @places: areas of each domain; immutable, as are the next four
 * @areas: all areas
 * @of_config: unit of each slave configuration, EC_NO_UNIT: none
 * @queue: runs @alarm
 * @alarm: takes slaves to SAFEOP, or to OP again
 * @seen: bits EC_UNIT_SEEN_* of each slave configuration; under the lock of the configuration
 * @wished: a unit has a wish
 * @image: sent instead of that of the application, for domains in @replaced; of the cycle owner,
 *	as are the next six but for @looked and @repeated
 * @replaced: domains whose outputs are not those of the application, bit n: domain n
 * @used: domains of the application
 * @stopped: a unit with EC_UNIT_POLICY_STOP has failed: index + 1, 0: none
 * @holders: units that another application holds
 * @bad: exchanges in a row in which a domain was not complete
 * @calm: all units are complete and there is nothing to report: only what is not steady, a wish or
 *	@looked can change that
 * @looked: a slave has left OP or has reached it; of the monitor
 * @repeated: domains whose frames are sent at least twice, three times, and so on; immutable
 * @n: entries in @unit
 * @unit: units
 */
struct ec_cyc_units {
	struct ec_unit_place places[EC_MAX_DOMAINS];
	struct ec_domain_area *areas;
	u8 *of_config;
	struct workqueue_struct *queue;
	struct work_struct *alarm;
	u8 *seen;
	atomic_t wished;
	bool looked;
	u64 repeated[EC_UNIT_REPEATS];
	u8 *image;
	aligned_u64 replaced;
	u64 used;
	u32 stopped;
	u32 holders;
	u32 bad[EC_MAX_DOMAINS];
	bool calm;
	unsigned int n;
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
