/* SPDX-License-Identifier: GPL-2.0-only */
/* Slaves as devices of the bus type "ethercat", for the rest of Linux. */
#ifndef EC_SLAVE_DEVICES_H
#define EC_SLAVE_DEVICES_H

#include <linux/types.h>
#include <linux/workqueue.h>
#include <linux/xarray.h>
#include "uevent_rate.h"

struct device;
struct ec_bus;

/**
 * struct ec_slave_devices - devices of the slaves of a master
 *
 * Zeroed until the master has a device of its own. Only @work changes them, and
 * ec_slave_devices_stop() after it.
 */
struct ec_slave_devices {
	/** @bus: slaves; immutable */
	struct ec_bus *bus;
	/** @parent: device of the master; NULL: no device of a slave is made (any more) */
	struct device *parent;
	/** @work: makes and removes devices, behind the monitor; no context waits for it */
	struct delayed_work work;
	/** @table: devices by device number */
	struct xarray table;
	/** @synced: the list of slaves, as counted by @bus->lists, that @table agrees with */
	u32 synced;
	/** @incomplete: but for slaves for which there was no memory: they are tried again */
	bool incomplete;
	/** @rate: uevents of what is at the main device */
	struct ec_uevent_rate rate;
	/** @more: changes without a uevent since the last one of the master */
	unsigned int more;
	/** @change_ns: when the master had that one (ktime) */
	u64 change_ns;
};

void ec_slave_devices_start(struct ec_slave_devices *sd, struct ec_bus *bus,
			    struct device *parent);
void ec_slave_devices_kick(struct ec_slave_devices *sd);
void ec_slave_devices_stop(struct ec_slave_devices *sd);

#endif
