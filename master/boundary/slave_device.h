/* SPDX-License-Identifier: GPL-2.0-only */
/* A slave as a device of Linux: its bus type, its attributes, its memory. */
#ifndef EC_SLAVE_DEVICE_H
#define EC_SLAVE_DEVICE_H

#include <linux/device.h>
#include "../wire/regs.h"
#include "uevent_rate.h"

struct ec_bus;
struct ec_slave;

/** struct ec_slave_id - identity, of the EEPROM; all 0 while that was not readable */
struct ec_slave_id {
	/** @vendor: vendor ID */
	u32 vendor;
	/** @product: product code */
	u32 product;
	/** @revision: revision number */
	u32 revision;
	/** @serial: serial number */
	u32 serial;
};

/** struct ec_slave_at - where a slave is */
struct ec_slave_at {
	/** @number: device number */
	u64 number;
	/** @up: that of the slave at which it hangs, 0: the main device */
	u64 up;
	/** @port: of that one */
	u8 port;
	/** @id: identity */
	struct ec_slave_id id;
};

/**
 * struct ec_slave_device - device of a slave
 *
 * It holds no reference to a slave: attributes ask the list for the one with the number. The
 * work of the master has it alone, but for what is immutable.
 */
struct ec_slave_device {
	/** @dev: device of Linux */
	struct device dev;
	/** @bus: where its slave is; immutable, valid until the device is removed */
	const struct ec_bus *bus;
	/** @at: where the slave was in the list last; @number and @id are immutable */
	struct ec_slave_at at;
	/** @lost: the list has no such slave */
	bool lost;
	/** @rate: where its change counts; NULL: it has not changed in this run of the work */
	struct ec_uevent_rate *rate;
	/** @ports: uevents of what hangs at its ports */
	struct ec_uevent_rate ports[EC_MAX_PORT];
	/** @remover: thread that removes it */
	const struct task_struct *remover;
};

int ec_slave_device_register(void);
void ec_slave_device_unregister(void);
void ec_slave_device_locate(const struct ec_slave *s, struct ec_slave_at *at);
struct ec_slave_device *ec_slave_device_alloc(const struct ec_bus *bus, struct device *parent,
					      const struct ec_slave_at *at);
void ec_slave_device_free(struct ec_slave_device *d);
int ec_slave_device_add(struct ec_slave_device *d, bool uevent);
void ec_slave_device_remove(struct ec_slave_device *d, bool uevent);

#endif
