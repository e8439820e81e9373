/* SPDX-License-Identifier: GPL-2.0-only */
/* Requests of an application with a cycle: what libethercat does with their memory. */
#ifndef EC_REQ_H
#define EC_REQ_H

#include "cyc.h"

u32 req_add(struct cyc *c, u32 config, u32 kind, u32 size);
struct ec_request_area *req_area(struct cyc *c);
struct ec_request_record *req_rec(struct cyc *c, u32 i);
u8 *req_data(struct cyc *c, u32 i);
void req_begin(struct cyc *c, u32 i, u16 index, u8 sub, u8 op, u32 size);
bool req_over(struct cyc *c, u32 i);
int req_end(struct cyc *c, u32 i, u32 limit_ms);
int req_do(struct cyc *c, u32 i, u16 index, u8 sub, u8 op, u32 size);

#endif
