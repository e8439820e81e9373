/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * What an application writes itself to a slave, by SDO, IDN or register, from its reservation of
 * the master to the first OP of the slave. A slave that returns after that gets it again.
 *
 * A write is recorded when it was successful, as a struct ec_startup with @write: the last value of
 * an object, in the order of the last writes. From the first OP on the record does not change any
 * more, so the worker reads it without a lock, except while the application has the slave held in
 * PREOP: then its writes are recorded again, and the worker does not read them.
 */
#ifndef EC_REPLAY_H
#define EC_REPLAY_H

#include <linux/list.h>
#include <linux/types.h>
#include "../base/limits.h"
#include "../wire/replay.h"

struct ec_config;
struct ec_result;
struct ec_slave;
struct ec_startup;
struct ec_wanted;

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

int ec_replay_name(struct ec_config *c, u8 type, u16 index, u8 sub);
bool ec_replay_is_open(const struct ec_wanted *w, struct ec_slave *s);
void ec_replay_record(struct ec_wanted *w, struct ec_slave *s, const struct ec_startup *what,
		      const void *data);
void ec_replay_adopt(struct ec_config *c);
void ec_replay_free(struct ec_replay *r);
enum ec_replay_why ec_replay_why(const struct ec_config *c, const struct ec_startup *u);
struct ec_result ec_replay_run(struct ec_slave *s, const struct ec_config *c);
void ec_replay_forget(struct ec_slave *s);
void ec_replay_reached_op(struct ec_slave *s);
int ec_replay_hold(struct ec_slave *s);
int ec_replay_held(const struct ec_config *c);
int ec_replay_resume(struct ec_config *c, u32 hold);

#endif
