/* SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause */
/* One result of the two copies of a frame that enter a ring at both ends. */
#ifndef EC_WIRE_MERGE_H
#define EC_WIRE_MERGE_H

#include "env.h"

u8 *ec_merge_data(u8 *to, u8 *a, const u8 *b, const u8 *sent, size_t len, u16 *cut);
void ec_merge_dgrams(u8 *to, const u8 *a, const u8 *b, const u8 *sent, size_t len);

#endif
