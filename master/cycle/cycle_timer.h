/* SPDX-License-Identifier: GPL-2.0-only */
/* A cycle in the interrupt of its timer. */
#ifndef EC_CYCLE_TIMER_H
#define EC_CYCLE_TIMER_H

#include "cycle_run.h"

void ec_cycle_timer_init(struct ec_cycle_thread *t);
void ec_cycle_timer_exit(struct ec_cycle_thread *t);
bool ec_cycle_timer_run(struct ec_cycle_thread *t);

#endif
