/* SPDX-License-Identifier: GPL-2.0-only */
/* When the graph is to be found again, because what slaves report contradicts it. */
#ifndef EC_BUS_DOUBT_H
#define EC_BUS_DOUBT_H

#include <linux/types.h>

struct ec_bus;

bool ec_doubt_is_due(struct ec_bus *bus);
void ec_doubt_judge(struct ec_bus *bus, bool changed, bool contradicted);

#endif
