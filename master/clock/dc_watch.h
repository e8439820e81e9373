/* SPDX-License-Identifier: GPL-2.0-only */
/* Clocks that are set are compared from time to time. */
#ifndef EC_DC_WATCH_H
#define EC_DC_WATCH_H

#include "dc_state.h"

void ec_dc_update_diff(struct ec_slave *s, u32 value);
void ec_dc_watch_init(struct ec_dc *dc);
void ec_dc_watch_start(struct ec_dc *dc);
void ec_dc_watch_stop(struct ec_dc *dc);
void ec_dc_watch_begun(struct ec_dc *dc);

#endif
