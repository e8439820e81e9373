/* SPDX-License-Identifier: GPL-2.0-only */
/* The request of an AL state and its failures. */
#ifndef EC_APPLY_STATE_H
#define EC_APPLY_STATE_H

#include "../bus/al.h"

struct ec_result;
struct ec_slave;

struct ec_result ec_apply_report(struct ec_slave *s, u8 state, struct ec_result r);
void ec_apply_plan(struct ec_slave *s, int err);
void ec_apply_waits_for(struct ec_slave *s, const char *what);
int ec_apply_set_by(struct ec_slave *s, u8 state,
		    int (*set)(struct ec_slave *s, u8 state, u32 timeout_ms));

/* by a request alone; see ec_apply_set_by() */
static inline int ec_apply_set(struct ec_slave *s, u8 state)
{
	return ec_apply_set_by(s, state, ec_al_set);
}

#endif
