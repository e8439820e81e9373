/* SPDX-License-Identifier: GPL-2.0-only */
/* The time of the reference clock as the master knows it. */
#ifndef EC_DC_TIME_H
#define EC_DC_TIME_H

#include "dc_state.h"

void ec_dc_clock(struct ec_dc *dc, u64 time, u64 at_ns);
void ec_dc_clock_predict(struct ec_dc *dc, u64 time, u64 at_ns);
u64 ec_dc_clock_at(struct ec_dc *dc, u64 at_ns);
u64 ec_dc_clock_now(struct ec_dc *dc);
u64 ec_dc_extend32(struct ec_dc *dc, u32 low, u64 at_ns);

#endif
