/* SPDX-License-Identifier: GPL-2.0-only */
/* Contradictions of the graph of a bus. */
#ifndef EC_BUS_DOUBT_STATE_H
#define EC_BUS_DOUBT_STATE_H

#include <linux/types.h>

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

#endif
