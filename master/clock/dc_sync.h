/* SPDX-License-Identifier: GPL-2.0-only */
/* SYNC signals of a slave. */
#ifndef EC_DC_SYNC_H
#define EC_DC_SYNC_H

#include "dc_state.h"

struct ec_dc_sync;
struct ec_result;

int ec_dc_wait(struct ec_slave *s);
void ec_dc_sync_again(struct ec_slave *s);
int ec_dc_sync_stop(struct ec_slave *s);
void ec_dc_sync_compare(struct ec_slave *s, const struct ec_dc_sync *c);
void ec_dc_sync_compare_cycle(struct ec_slave *s, const struct ec_dc_sync *c);
struct ec_result ec_dc_sync_start(struct ec_slave *s, const struct ec_dc_sync *c);
struct ec_result ec_dc_sync_check(struct ec_slave *s, const struct ec_dc_sync *c);

#endif
