/* SPDX-License-Identifier: GPL-2.0-only */
/* Slaves that were disconnected and have not returned, by the port that they hung behind. */
#ifndef EC_ABSENT_H
#define EC_ABSENT_H

#include <linux/types.h>

struct ec_bus;

#define EC_MAX_ABSENT	64	/* ports with absent slaves that are listed */

/**
 * struct ec_absent - absent slaves behind one port
 * @up: device number of the slave whose port it is, 0: the main device
 * @port: its port
 * @n: how many they are
 * @first: ring position that the first of them had
 * @last: that of the last one
 * @seen_ns: when they were last seen (ktime)
 * @label: what people call the first one
 */
struct ec_absent {
	u64 up;
	u8 port;
	u32 n;
	u16 first;
	u16 last;
	u64 seen_ns;
	char label[24];
};

void ec_absent_update(struct ec_bus *bus, unsigned int n_slaves);
void ec_absent_forget(struct ec_bus *bus);
void ec_absent_get(const struct ec_bus *bus, unsigned int index, struct ec_absent *a);

#endif
