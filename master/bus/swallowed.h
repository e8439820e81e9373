/* SPDX-License-Identifier: GPL-2.0-only */
/* A device that lets no frame return, where slaves were. */
#ifndef EC_SWALLOWED_H
#define EC_SWALLOWED_H

#include <linux/types.h>

struct ec_bus;

bool ec_swallowed(struct ec_bus *bus);

#endif
