/* SPDX-License-Identifier: GPL-2.0-only */
/* Device numbers: a device keeps its number through loss and return. */
#ifndef EC_KNOWN_H
#define EC_KNOWN_H

#include <linux/list.h>
#include <linux/types.h>

#define EC_KNOWN_BITS	5
#define EC_KNOWN_HEADS	(1 << EC_KNOWN_BITS)

struct ec_bus;
struct ec_slave;

/**
 * struct ec_known - the numbers of a bus, changed with topo and ec_show_change_begin()
 * @last: number given last
 * @present: slaves of the list, by number
 * @lost: devices that were disconnected, by number
 * @by_station: the same by station address
 * @by_serial: the same by serial number, if they have one
 * @oldest: the same, the first one that was disconnected first
 * @n_lost: their number
 */
struct ec_known {
	u64 last;
	struct hlist_head present[EC_KNOWN_HEADS];
	struct hlist_head lost[EC_KNOWN_HEADS];
	struct hlist_head by_station[EC_KNOWN_HEADS];
	struct hlist_head by_serial[EC_KNOWN_HEADS];
	struct list_head oldest;
	unsigned int n_lost;
};

void ec_known_init(struct ec_bus *bus);
void ec_known_exit(struct ec_bus *bus);
void ec_known_update(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n);
struct ec_slave *ec_known_slave(const struct ec_bus *bus, u64 number);
size_t ec_known_text(const struct ec_bus *bus, u64 number, char *buf, size_t size);

#endif
