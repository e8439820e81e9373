/* SPDX-License-Identifier: GPL-2.0-only */
/* INIT to PREOP or BOOT. */
#ifndef EC_LEAVE_INIT_H
#define EC_LEAVE_INIT_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

int ec_leave_init(struct ec_slave *s, u8 state, u32 timeout_ms);
void ec_leave_init_all(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool clean);

#endif
