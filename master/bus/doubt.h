/* SPDX-License-Identifier: GPL-2.0-only */
/* When the graph is to be found again, because what slaves report contradicts it. */
#ifndef EC_BUS_DOUBT_H
#define EC_BUS_DOUBT_H

#include <linux/types.h>

struct ec_bus;

/**
 * struct ec_doubt - contradictions of the graph, of the monitor alone
 * @due_ns: when it is found again (ktime), 0: not planned
 * @looks: how often it was, since the slaves changed or the contradiction ended
 * @look: the next scan reads ports and receive times of all slaves and forgets all neighbors
 */
struct ec_doubt {
	u64 due_ns;
	u8 looks;
	bool look;
};

bool ec_doubt_is_due(struct ec_bus *bus);
void ec_doubt_judge(struct ec_bus *bus, bool changed, bool contradicted);

#endif
