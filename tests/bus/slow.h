/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * A device with a transmit ring that drains slower than the CPU fills it. Nothing leaves
 * before the doorbell. What it has received stays until its next poll, not longer.
 */
#ifndef EC_SLOW_H
#define EC_SLOW_H

#include "bus.h"

struct slow;

struct slow *slow_plug(struct bus *b, u32 ring, u32 slowness);
void slow_destroy(struct slow *s);
void slow_claim(struct slow *s, u32 slaves);
void slow_refuse(struct slow *s, u8 cmd, u32 pass, u32 frames);
u32 slow_to_refuse(const struct slow *s);
void slow_stop(struct slow *s, bool stop);
u32 slow_doorbells(const struct slow *s);
u32 slow_sent(const struct slow *s);
u32 slow_full(const struct slow *s);

#endif
