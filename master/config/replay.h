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

#include <linux/types.h>

struct ec_config;
struct ec_replay;
struct ec_slave;
struct ec_startup;
struct ec_wanted;

int ec_replay_name(struct ec_config *c, u8 type, u16 index, u8 sub);
bool ec_replay_is_open(const struct ec_wanted *w, struct ec_slave *s);
void ec_replay_record(struct ec_wanted *w, struct ec_slave *s, const struct ec_startup *what,
		      const void *data);
void ec_replay_adopt(struct ec_config *c);
void ec_replay_free(struct ec_replay *r);

#endif
