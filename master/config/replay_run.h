/* SPDX-License-Identifier: GPL-2.0-only */
/* A slave that returns: it gets what the application has written, or waits for the application. */
#ifndef EC_REPLAY_RUN_H
#define EC_REPLAY_RUN_H

#include "../wire/replay.h"

struct ec_config;
struct ec_result;
struct ec_slave;
struct ec_startup;

enum ec_replay_why ec_replay_why(const struct ec_config *c, const struct ec_startup *u);
struct ec_result ec_replay_run(struct ec_slave *s, const struct ec_config *c);
void ec_replay_forget(struct ec_slave *s);
void ec_replay_reached_op(struct ec_slave *s);
int ec_replay_hold(struct ec_slave *s);
int ec_replay_held(const struct ec_config *c);
int ec_replay_resume(struct ec_config *c, u32 hold);

#endif
