/* SPDX-License-Identifier: GPL-2.0-only */
/* What is expected behind ports, and the devices that wait there; see border.h. */
#ifndef EC_BORDER_TABLE_H
#define EC_BORDER_TABLE_H

#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include "../include/uapi/ethercat.h"

/* of the module parameter */
enum ec_border_mode {
	EC_BORDER_AUTO,		/* ports at which a group is expected */
	EC_BORDER_CLOSED,	/* all: only known devices and groups are let in */
	EC_BORDER_OPEN,		/* none */
};

/**
 * struct ec_border_sign - a device that may be let in: the head of a hot connect group
 * @device: number of the slave at whose port it has to be, 0: it may be anywhere
 * @vendor: vendor id
 * @product: product code, 0 with @vendor 0: any
 * @serial: serial number, 0: any
 * @value: alias or identification
 * @by: EC_GROUP_BY_*
 * @port: that port
 */
struct ec_border_sign {
	u64 device;
	u32 vendor;
	u32 product;
	u32 serial;
	u16 value;
	u8 by;
	u8 port;
};

/**
 * struct ec_behind - a device behind a closed port
 * @kept: EC_PORT_*: why it is not let in
 * @vendor: vendor id; 0 like the next ones: not read
 * @product: product code
 * @revision: revision number
 * @serial: serial number
 * @slaves: how many there are, with those behind it
 * @alias: register 0x0012
 * @identification: explicit device identification, 0: none, or not asked for
 * @name: order number or name in its EEPROM
 */
struct ec_behind {
	u32 kept;
	u32 vendor;
	u32 product;
	u32 revision;
	u32 serial;
	u32 slaves;
	u16 alias;
	u16 identification;
	char name[EC_UAPI_STRING];
};

/**
 * struct ec_border - ports at which not every device is let in
 * @mode: which these are
 * @lock: protects the rest
 * @signs: what the application expects; NULL: there is no session
 * @n_signs: how many
 * @waiting: a slave at whose port a group is expected is not connected
 * @found: struct ec_border_found: what is behind closed ports, and what was let in
 * @n_found: how many
 */
struct ec_border {
	enum ec_border_mode mode;
	raw_spinlock_t lock;
	struct ec_border_sign *signs;
	unsigned int n_signs;
	bool waiting;
	struct list_head found;
	unsigned int n_found;
};

/**
 * struct ec_border_found - what is behind a port, and what a user has let in there
 * @list: in struct ec_border
 * @device: number of the slave whose port it is
 * @port: that port
 * @let: a user has let a device in
 * @let_in: that device
 * @is: device that waits; without one zeros
 */
struct ec_border_found {
	struct list_head list;
	u64 device;
	unsigned int port;
	bool let;
	struct ec_behind let_in;
	struct ec_behind is;
};

void ec_border_init(struct ec_border *b);
void ec_border_clear(struct ec_border *b);

#endif
