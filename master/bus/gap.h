/* SPDX-License-Identifier: GPL-2.0-only */
/* Time between the frames of a trial. */
#ifndef EC_BUS_GAP_H
#define EC_BUS_GAP_H

#include "../carry/dg.h"

struct ec_links;

#define EC_GAP_FRAMES	4	/* of a gap, at most */

/**
 * struct ec_gaps - gaps of a trial
 * @before_ns: before its port opens
 * @after_ns: before it closes
 */
struct ec_gaps {
	u32 before_ns;
	u32 after_ns;
};

struct ec_gaps ec_gap_find(const struct ec_links *l, u32 passed, u32 bytes);
unsigned int ec_gap_add(struct ec_dg *dg, u32 ns);

#endif
