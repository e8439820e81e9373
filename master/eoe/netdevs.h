/* SPDX-License-Identifier: GPL-2.0-only */
/* The network devices of a master's slaves with EoE. */
#ifndef EC_EOE_NETDEVS_H
#define EC_EOE_NETDEVS_H

#include <linux/if_ether.h>
#include <linux/mutex.h>
#include <linux/types.h>
#include <linux/workqueue.h>
#include <linux/xarray.h>

struct device;
struct ec_bus;
struct ec_ioc_eoe;

/**
 * struct ec_eoe - network devices of the slaves of a master
 *
 * A reader of @table takes no lock: a device is freed a grace period after it has left it.
 */
struct ec_eoe {
	/** @bus: slaves; NULL: nothing is to be done (any more) */
	struct ec_bus *bus;
	/** @parent: device of the master, or NULL; immutable */
	struct device *parent;
	/** @automatic: each slave with EoE has a network device, unless it is not wished */
	bool automatic;
	/** @main: address of the main device, when the first device was made */
	u8 main[ETH_ALEN];
	/** @lock: protects changes of @wishes */
	struct mutex lock;
	/** @wishes: EC_EOE_WISH_ON or EC_EOE_WISH_OFF by device number */
	struct xarray wishes;
	/** @table: struct ec_eoe_netdev by device number of their slaves; changed by @work */
	struct xarray table;
	/** @synced: list of slaves, counted by @bus->lists, that @table agrees with; by @work */
	u32 synced;
	/** @stale: @table has to be compared in any case; may be set by others */
	bool stale;
	/** @work: makes, removes and connects devices */
	struct delayed_work work;
};

void ec_eoe_init(struct ec_eoe *eoe);
void ec_eoe_start(struct ec_eoe *eoe, struct ec_bus *bus, struct device *parent, bool automatic);
void ec_eoe_stop(struct ec_eoe *eoe);
void ec_eoe_look(struct ec_eoe *eoe);
void ec_eoe_kick(struct ec_eoe *eoe);
int ec_eoe_wish(struct ec_eoe *eoe, u64 device, unsigned int wish);
int ec_eoe_show(struct ec_eoe *eoe, struct ec_ioc_eoe *info);

#endif
