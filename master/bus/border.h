/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Ports at which not every device is let in: those at which an application expects a hot connect
 * group, or all. What stands behind one of them stays there until a user lets it in.
 */
#ifndef EC_BORDER_H
#define EC_BORDER_H

#include "border_table.h"

struct ec_bus;

#define EC_BORDER_ASKS	1	/* the device behind the port has to be known */
#define EC_BORDER_ID	2	/* by its identification as well */

void ec_border_set(struct ec_bus *bus, struct ec_border_sign *signs, unsigned int n, bool waiting);
unsigned int ec_border_asks(struct ec_bus *bus, u64 device, unsigned int port);
bool ec_border_may_be(struct ec_bus *bus, u64 device, unsigned int port);
u32 ec_border_judge(struct ec_bus *bus, u64 device, unsigned int port, const struct ec_behind *is);
bool ec_border_note(struct ec_bus *bus, u64 device, unsigned int port, const struct ec_behind *is);
void ec_border_forget(struct ec_bus *bus, u64 device, unsigned int port);
bool ec_border_get(struct ec_bus *bus, u64 device, unsigned int port, struct ec_behind *is);
int ec_border_let_in(struct ec_bus *bus, u64 device, unsigned int port,
		     const struct ec_behind *what);

#endif
