/* SPDX-License-Identifier: GPL-2.0-only */
/* Delays measured again while nothing changes. */
#ifndef EC_DC_TRACK_H
#define EC_DC_TRACK_H

#include <linux/types.h>

struct ec_dc;
struct ec_riders;

extern bool ec_dc_track_on;	/* track_delays of the module */

int ec_dc_track_init(struct ec_dc *dc, struct ec_riders *riders);
void ec_dc_track_exit(struct ec_dc *dc);

#endif
