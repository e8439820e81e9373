/* SPDX-License-Identifier: GPL-2.0-only */
/* Emergencies of a slave, kept for the application in mapped memory. */
#ifndef EC_EMERG_H
#define EC_EMERG_H

#include <linux/types.h>

struct ec_emerg_ring;
struct ec_emergency;
struct ec_mbox;

/** struct ec_emerg - the kernel's side of a ring; under ec_desk.unasked_lock */
struct ec_emerg {
	/** @ring: mapped by the application; of it only @tail is read, and not trusted */
	struct ec_emerg_ring *ring;
	/** @data: entries, mapped */
	u8 *data;
	/** @count: how many */
	u32 count;
	/** @head: emergencies put in so far */
	u32 head;
	/** @overruns: emergencies lost so far */
	u32 overruns;
};

void ec_emerg_set(struct ec_mbox *mb, struct ec_emerg *e);
void ec_emerg_describe(struct ec_mbox *mb, struct ec_emerg *e, u32 data);
unsigned int ec_emerg_last(struct ec_mbox *mb, struct ec_emergency *entry, u32 *total);
void ec_emerg_push(struct ec_mbox *mb, const u8 *message);

#endif
