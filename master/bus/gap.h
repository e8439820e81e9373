/* SPDX-License-Identifier: GPL-2.0-only */
/* Time between the frames of a trial. */
#ifndef EC_BUS_GAP_H
#define EC_BUS_GAP_H

#include "../carry/dg.h"

struct ec_links;

#define EC_GAP_FRAMES	4	/* of a gap, at most */

bool ec_gap_fits(const struct ec_links *l, u32 branch_ns, u32 bytes);
unsigned int ec_gap_add(struct ec_dg *dg, u32 ns);

#endif
