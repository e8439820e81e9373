/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units of a cycle: what is sent for domains that fail, alone. */
#ifndef EC_UNIT_STATE_H
#define EC_UNIT_STATE_H

#include <linux/minmax.h>
#include <linux/types.h>
#include "../base/events.h"
#include "../base/limits.h"
#include "ethercat.h"

struct work_struct;
struct workqueue_struct;

/* process data of one direction, side by side in the image */
struct ec_unit_area {
	u32 offset;
	u32 len;
};

/* the areas of a domain, its outputs first */
struct ec_unit_place {
	const struct ec_unit_area *areas;
	u16 outputs;
	u16 inputs;
};

/* struct ec_cyc_unit.wish */
#define EC_UNIT_GIVE	1
#define EC_UNIT_TAKE	2

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
 * @same: receives in a row that contradict @run
 * @unfed: cycles since all of @feeds were given
 * @fed: domains given since
 * @faults: failures, and ends of the lease
 * @told: what the last event has said
 * @rate: of these events
 * @wish: EC_UNIT_GIVE, EC_UNIT_TAKE or 0: a command for the cycle owner
 * @op: all its slaves are in OP, but for those of groups that may be absent; of who looks at them
 * @down: its slaves are to be in SAFEOP; the cycle owner sets it, a command clears it
 * @holder: open file of another application that gives its outputs, or NULL; under the lock of the
 *	configuration, as is @back
 * @held: it has one; for the cycle owner
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
	u32 unfed;
	u64 fed;
	u32 faults;
	u32 told;
	struct ec_event_rate rate;
	u32 wish;
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
 * @image: sent instead of that of the application, for domains in @replaced; of the cycle owner,
 *	as are the next three
 * @replaced: domains whose outputs are not those of the application, bit n: domain n
 * @used: domains of the application
 * @stopped: a unit with EC_UNIT_POLICY_STOP has failed: index + 1, 0: none
 * @down: all slaves are to be in SAFEOP; as struct ec_cyc_unit @down
 * @holders: units that another application holds; under the lock of the configuration
 * @n: entries in @unit
 * @unit: units
 */
struct ec_cyc_units {
	struct ec_unit_place places[EC_MAX_DOMAINS];
	struct ec_unit_area *areas;
	u8 *of_config;
	struct workqueue_struct *queue;
	struct work_struct *alarm;
	u8 *image;
	u64 replaced;
	u64 used;
	u32 stopped;
	bool down;
	u32 holders;
	unsigned int n;
	struct ec_cyc_unit unit[];
};

#define EC_NO_UNIT	0xff

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

#endif
