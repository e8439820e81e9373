/* SPDX-License-Identifier: GPL-2.0-only */
/* Priority and CPU of the thread that runs the cycle. */
#ifndef EC_CYCLE_SCHED_H
#define EC_CYCLE_SCHED_H

#include <linux/types.h>

struct ec_cycle;
struct task_struct;

void ec_cycle_sched_set(const struct ec_cycle *c, struct task_struct *task);
void ec_cycle_sched_log(const struct ec_cycle *c);
void ec_cycle_sched_log_place(struct ec_cycle *c);
void ec_cycle_thread_inherit(struct ec_cycle *c, u32 priority, bool may_interrupt);
void ec_cycle_thread_check_cpu(struct ec_cycle *c);

#endif
