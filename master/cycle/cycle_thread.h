/* SPDX-License-Identifier: GPL-2.0-only */
/* A cycle that a thread of the kernel runs. */
#ifndef EC_CYCLE_THREAD_H
#define EC_CYCLE_THREAD_H

#include <linux/types.h>
#include "cycle_run.h"

int ec_cycle_thread_create(struct ec_cycle *c, u32 image_bytes, const struct ec_cycle_ops *ops);
void ec_cycle_thread_start(struct ec_cycle *c);
void ec_cycle_thread_stop(struct ec_cycle *c);
bool ec_cycle_thread_ended(const struct ec_cycle *c);
int ec_cycle_thread_adopt(struct ec_cycle *c);
int ec_cycle_thread_keep(struct ec_cycle *c, u32 *buffer, u8 *image);
void ec_cycle_thread_outputs(const struct ec_cycle *c, u8 *image, u32 offset, u32 size);

#endif
