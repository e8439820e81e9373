/* SPDX-License-Identifier: GPL-2.0-only */
/* The table of device numbers; known.c gives them. */
#ifndef EC_KNOWN_TABLE_H
#define EC_KNOWN_TABLE_H

#include <linux/kref.h>
#include <linux/list.h>
#include <linux/types.h>
#include "../wire/sii.h"

struct ec_absent;

/**
 * struct ec_image - EEPROM image of a device that was disconnected
 * @kref: references
 * @bytes: of @sii
 * @flaw: found when it was read
 * @sii: image
 */
struct ec_image {
	struct kref kref;
	size_t bytes;
	struct ec_sii_flaw flaw;
	u8 sii[];
};

#define EC_KNOWN_BITS	5
#define EC_KNOWN_HEADS	(1 << EC_KNOWN_BITS)

/**
 * struct ec_lost - a device that was disconnected
 * @number: its device number
 * @by_number: in struct ec_known @lost
 * @by_station: in struct ec_known @by_station
 * @by_serial: in struct ec_known @by_serial, unless @serial is 0
 * @age: in struct ec_known @oldest
 * @since_ns: when its loss was found (ktime)
 * @vendor: of its identity; 0 with @product 0: it was not readable
 * @product: likewise
 * @serial: likewise
 * @station: its station address
 * @position: its ring position
 * @label: what people call it
 * @image: of its EEPROM, NULL: none was read, or it is not kept any more
 * @up: device number of the slave that it hung at, 0: at the main device
 * @up_port: at that port
 * @seen_ns: when it was last seen (ktime)
 * @forgotten: a user has requested a scan since then
 * @rooted: list of slaves for which @root is valid
 * @root: device number of the slave where the way to it breaks, 0: the main device
 * @root_port: at that port
 */
struct ec_lost {
	u64 number;
	struct hlist_node by_number;
	struct hlist_node by_station;
	struct hlist_node by_serial;
	struct list_head age;
	u64 since_ns;
	u32 vendor;
	u32 product;
	u32 serial;
	u16 station;
	u16 position;
	char label[24];
	struct ec_image *image;
	u64 up;
	u8 up_port;
	u64 seen_ns;
	bool forgotten;
	u32 rooted;
	u64 root;
	u8 root_port;
};

/**
 * struct ec_known - the numbers of a bus, changed with topo and ec_show_change_begin()
 * @last: number given last
 * @present: slaves of the list, by number
 * @lost: devices that were disconnected, by number
 * @by_station: the same by station address
 * @by_serial: the same by serial number, if they have one
 * @oldest: the same, the first one that was disconnected first
 * @n_lost: their number
 * @most: most slaves that were in the list so far
 * @absent: ports behind which they hung, NULL: none so far
 * @n_absent: entries in @absent
 */
struct ec_known {
	u64 last;
	struct hlist_head present[EC_KNOWN_HEADS];
	struct hlist_head lost[EC_KNOWN_HEADS];
	struct hlist_head by_station[EC_KNOWN_HEADS];
	struct hlist_head by_serial[EC_KNOWN_HEADS];
	struct list_head oldest;
	unsigned int n_lost;
	unsigned int most;
	struct ec_absent *absent;
	unsigned int n_absent;
};

void ec_known_init(struct ec_known *k);
void ec_known_exit(struct ec_known *k);
void ec_image_put(struct ec_image *image);
void ec_known_drop(struct ec_known *k, struct ec_lost *l);

#endif
