/* SPDX-License-Identifier: GPL-2.0-only */
/* The ring position of the reference clock, for ARMW. */
#ifndef EC_DC_ARMW_H
#define EC_DC_ARMW_H

#include <linux/types.h>

struct ec_dc;

void ec_dc_armw_want(struct ec_dc *dc, bool wanted);
void ec_dc_armw_locate(struct ec_dc *dc, bool known, u32 path);

#endif
