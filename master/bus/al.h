/* SPDX-License-Identifier: GPL-2.0-only */
/* AL states: read, acknowledge, request. */
#ifndef EC_BUS_AL_H
#define EC_BUS_AL_H

#include <linux/types.h>

struct ec_slave;

int ec_al_read(struct ec_slave *slave);
int ec_al_ack(struct ec_slave *slave);
int ec_al_set(struct ec_slave *slave, u8 state, u32 timeout_ms);

#endif
