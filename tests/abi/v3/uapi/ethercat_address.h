/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* How a command names the slave that it is for; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_ADDRESS_H
#define EC_UAPI_ETHERCAT_ADDRESS_H

#include <linux/types.h>

/* struct ec_ioc_address.kind, and which of its fields name the slave; all others are 0 */
#define EC_ADDRESS_POSITION	0	/* @position in the ring */
#define EC_ADDRESS_ALIAS	1	/* @position: slaves after the first one with @alias */
#define EC_ADDRESS_STATION	2	/* @station: configured station address */
#define EC_ADDRESS_DEVICE	3	/* @device: device number */

/*
 * The slave that a command is for. The master gives each device a number when it gets to know
 * it: from 1 on, never twice while the module is loaded. A device that was disconnected and is
 * the same by its station address or serial number keeps its number. A command with the number
 * of a device that is disconnected fails (-ENODEV), also when another slave has its position.
 */
struct ec_ioc_address {
	__u32 kind;		/* EC_ADDRESS_* */
	__u16 position;
	__u16 alias;
	__u16 station;
	__u16 identification;	/* 0: no kind uses it so far */
	__u8 port;		/* the same */
	__u8 reserved[3];
	__u64 device;
};

#endif
