/* SPDX-License-Identifier: GPL-2.0-only */
/* What the configuration of a slave has of the writes of the application, see replay.h. */
#ifndef EC_WRITES_H
#define EC_WRITES_H

#include <linux/list.h>
#include <linux/types.h>
#include "../base/limits.h"

/* what is replayed; numbers of the interface */
enum ec_replay_mode {
	EC_REPLAY_MODE_DEFAULT,	/* all but what wire/replay.h names */
	EC_REPLAY_MODE_NONE,	/* only objects that are named */
	EC_REPLAY_MODE_ALL,	/* registers of the master are not */
	EC_REPLAY_MODES
};

/* of a slave that has returned */
enum ec_hold {
	EC_HOLD_NONE,
	EC_HOLD_HELD,		/* in PREOP, the application writes */
	EC_HOLD_RESUMED,	/* it has written */
};

/* an object that is replayed in any case; @type: EC_STARTUP_SDO or EC_STARTUP_IDN */
struct ec_replay_name {
	u8 type;
	u8 sub;
	u16 index;
};

/**
 * struct ec_replay - writes of the application to one slave, under the lock of the session
 * @writes: struct ec_startup, the last write is the last entry
 * @n: entries
 * @n_values: those whose value is kept
 * @bytes: of these values
 * @forgotten: writes that are not even listed
 * @mode: EC_REPLAY_MODE_*; the configuration
 * @n_named: entries in @named
 * @named: objects that are replayed in any case; the configuration
 * @was_op: the slave was in OP since activation; under writes_lock as well, as is @hold
 * @hold: EC_HOLD_*
 * @holds: times it was held
 */
struct ec_replay {
	struct list_head writes;
	unsigned int n;
	unsigned int n_values;
	u32 bytes;
	u32 forgotten;
	u8 mode;
	u8 n_named;
	bool was_op;
	u8 hold;
	u32 holds;
	struct ec_replay_name named[EC_MAX_SC_REPLAYS];
};

#endif
