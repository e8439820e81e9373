/* SPDX-License-Identifier: GPL-2.0-only */
/* A slave as a device of Linux: its bus type, its attributes, its memory. */
#ifndef EC_SLAVE_DEVICE_H
#define EC_SLAVE_DEVICE_H

#include <linux/device.h>
#include "../wire/regs.h"
#include "uevent_rate.h"

struct ec_bus;
struct ec_slave;

/**
 * struct ec_slave_id - identity, of the EEPROM; all 0 while that was not readable
 * @vendor: vendor ID
 * @product: product code
 * @revision: revision number
 * @serial: serial number
 */
struct ec_slave_id {
	u32 vendor;
	u32 product;
	u32 revision;
	u32 serial;
};

/**
 * struct ec_slave_at - where a slave is
 * @number: device number
 * @up: that of the slave at which it hangs, 0: the main device
 * @port: of that one
 * @id: identity
 */
struct ec_slave_at {
	u64 number;
	u64 up;
	u8 port;
	struct ec_slave_id id;
};

/**
 * struct ec_slave_device - device of a slave
 *
 * It holds no reference to a slave: attributes ask the list for the one with the number. The
 * work of the master has it alone, but for what is immutable.
 *
 * @dev: device of Linux
 * @bus: where its slave is; immutable, valid until the device is removed
 * @at: where the slave was in the list last; @number and @id are immutable
 * @lost: the list has no such slave
 * @rate: where its change counts; NULL: it has not changed in this run of the work
 * @ports: uevents of what hangs at its ports
 * @remover: thread that removes it
 */
struct ec_slave_device {
	struct device dev;
	const struct ec_bus *bus;
	struct ec_slave_at at;
	bool lost;
	struct ec_uevent_rate *rate;
	struct ec_uevent_rate ports[EC_MAX_PORT];
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
