/* SPDX-License-Identifier: GPL-2.0-only */
/* What many slaves do together is one event. */
#ifndef EC_PENDING_H
#define EC_PENDING_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

/**
 * struct ec_pending - changes of a slave that have no event so far, protected by note_lock
 * @from: AL state before the first of them, 0: there are none
 * @lowest: the lowest AL state since then
 * @back_ms: it is in OP again, after so long; 0: that is recorded
 */
struct ec_pending {
	u8 from;
	u8 lowest;
	u32 back_ms;
};

void ec_pending_al(struct ec_slave *s, u8 before, u8 state);
void ec_pending_back(struct ec_slave *s, u64 ms);
void ec_pending_before(struct ec_slave *s);
void ec_pending_flush(struct ec_bus *bus, bool all);

#endif
