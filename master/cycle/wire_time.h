/* SPDX-License-Identifier: GPL-2.0-only */
/* Wire time that a cycle leaves to acyclic frames. */
#ifndef EC_WIRE_TIME_H
#define EC_WIRE_TIME_H

#include "cycle.h"

int ec_wire_time_check(struct ec_cycle *c, bool clocks);
void ec_wire_time_log(struct ec_cycle *c);

#endif
