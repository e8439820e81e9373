/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Network devices of slaves with EoE; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_EOE_H
#define EC_UAPI_ETHERCAT_EOE_H

#include <linux/types.h>
#include "ethercat_address.h"

#define EC_EOE_NETDEV_NAME	16

/* struct ec_ioc_eoe.state */
#define EC_EOE_CONNECTED	0x01	/* the slave is connected */
#define EC_EOE_UP		0x02	/* the network device is up */
#define EC_EOE_RUNNING		0x04	/* frames pass: the mailbox of the slave runs */

/* a network device; the counters begin when it is made */
struct ec_ioc_eoe {
	__u32 flags;
	__u32 index;		/* in */
	__u64 device;		/* device number of the slave */
	char name[EC_EOE_NETDEV_NAME];	/* empty: in another network namespace */
	__u8 address[6];
	__u16 position;		/* ring position, when it was seen last */
	__u32 state;
	__u32 waiting;		/* frames that wait for the mailbox */
	__u32 room;		/* how many may wait */
	__u32 rx_rate;		/* bytes/s, of the last second */
	__u32 tx_rate;
	__u32 reserved;
	__u64 rx_frames;	/* of the slave */
	__u64 rx_bytes;
	__u64 rx_errors;	/* frames with wrong or missing fragments */
	__u64 rx_missed;	/* messages that came while too many waited */
	__u64 rx_dropped;	/* frames that are not allowed, or for lack of memory */
	__u64 tx_frames;	/* to the slave */
	__u64 tx_bytes;
	__u64 tx_lost;		/* fragments that were lost, perhaps */
	__u64 tx_dropped;	/* frames that are not allowed, or came without a carrier */
};

/* struct ec_ioc_eoe_wish.wish */
#define EC_EOE_WISH_AUTO	0	/* as for all slaves: parameter eoe of ec_master */
#define EC_EOE_WISH_ON		1	/* a network device */
#define EC_EOE_WISH_OFF		2	/* none; one that is up is removed */

struct ec_ioc_eoe_wish {
	__u32 flags;
	__u32 wish;		/* in */
	struct ec_ioc_address slave;	/* in */
	__u32 reserved;
	__u32 reserved2;
};

#endif
