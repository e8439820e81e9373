/* SPDX-License-Identifier: GPL-2.0-only */
/* The time of the application. */
#ifndef EC_DC_APP_H
#define EC_DC_APP_H

#include "dc_state.h"

struct ec_ioc_send;

void ec_dc_app_time(struct ec_dc *dc, u64 app_time, u64 at_ns);
void ec_dc_app_forget(struct ec_dc *dc);
bool ec_dc_update_app_time(struct ec_dc *dc, const struct ec_ioc_send *what, u64 *lead);
u64 ec_dc_phase(struct ec_dc *dc);
u64 ec_dc_now(struct ec_dc *dc);
u64 ec_dc_app_at(struct ec_dc *dc, u64 at_ns);
void ec_dc_app_set(struct ec_dc *dc, u64 base, bool set);
bool ec_dc_app_due(const struct ec_dc *dc);
void ec_dc_app_log(struct ec_dc *dc);

#endif
