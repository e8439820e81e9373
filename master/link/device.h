/* SPDX-License-Identifier: GPL-2.0-only */
/* Devices offered by drivers and claimed by masters. */
#ifndef EC_DEVICE_H
#define EC_DEVICE_H

#include <linux/if_ether.h>
#include <linux/list.h>
#include "ethercat.h"
#include "../devices/ecdev.h"

struct ec_link;
struct ec_links;

/** struct ecdev - a device a driver offers */
struct ecdev {
	/** @list: in the list of all devices, under the device lock */
	struct list_head list;
	/** @name: "eth0", "sim0"..., immutable */
	char name[EC_UAPI_STRING];
	/** @mac: immutable */
	u8 mac[ETH_ALEN];
	/** @ops: immutable */
	const struct ecdev_ops *ops;
	/** @priv: for @ops, immutable */
	void *priv;
	/** @link: its user, NULL: none; RCU for receivers */
	struct ec_link __rcu *link;
};

void ec_device_register(struct ec_links *l);
void ec_device_unregister(struct ec_links *l);
int ec_device_release(struct ec_links *l, unsigned int as, const char *name, unsigned int *rival);
int ec_device_use(struct ec_links *l, unsigned int as, const char *name);
void ec_device_reopen(struct ec_links *l);
bool ec_device_exchange(struct ec_links *l);

#endif
