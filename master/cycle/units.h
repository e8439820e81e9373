/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units: made by an activation, and what commands do with them. */
#ifndef EC_UNITS_H
#define EC_UNITS_H

#include "unit_state.h"

struct ec_cycle;

int ec_units_make(struct ec_cycle *c, struct workqueue_struct *queue, struct work_struct *alarm);
void ec_units_end(struct ec_cyc_units *us);
int ec_units_give(struct ec_cycle *c, u32 unit);
void ec_units_take(struct ec_cycle *c, u32 unit);
void ec_units_take_over(struct ec_cycle *c);
int ec_units_hold(struct ec_cycle *c, u32 unit, const void *holder);
int ec_units_leave(struct ec_cycle *c, u32 unit, const void *holder);
void ec_units_look(struct ec_cycle *c);
bool ec_units_keep_down(const struct ec_cycle *c, u32 config);
bool ec_units_turns(struct ec_cycle *c, u32 config);

#endif
