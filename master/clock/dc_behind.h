/* SPDX-License-Identifier: GPL-2.0-only */
/* The clocks behind the break of a ring. */
#ifndef EC_DC_BEHIND_H
#define EC_DC_BEHIND_H

#include "dc_state.h"

void ec_dc_look_behind(struct ec_dc *dc, const s32 *shift);

#endif
