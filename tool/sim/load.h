/* SPDX-License-Identifier: GPL-2.0-only */
/* A segment from a built-in description or a file. */
#ifndef EC_SIM_LOAD_H
#define EC_SIM_LOAD_H

#include "describe.h"

#define EC_SIM_SEED_MAX	(1ll << 62)	/* as in a description */

extern const struct ec_sim_ops load_ops;

struct ec_sim *load_segment(const char *name, long long seed);
int load_list(void);

#endif
