/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Hot connect groups: slaves that come and go together; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_GROUP_H
#define EC_UAPI_ETHERCAT_GROUP_H

#include <linux/types.h>
#include "ethercat_common.h"

/* struct ec_ioc_group.by: what the first slave of the group, its head, is known by */
#define EC_GROUP_BY_ALIAS	1	/* @value: alias */
#define EC_GROUP_BY_ID		2	/* @value: explicit device identification */
#define EC_GROUP_BY_PORT	3	/* @at and @port */

#define EC_GROUP_FLAG_MANDATORY	1	/* without it the working counters are not complete */
#define EC_GROUP_FLAG_FAST	2	/* its port is opened as soon as it has a link; with @at */

struct ec_ioc_group {
	__u32 flags;		/* in: EC_GROUP_FLAG_* */
	__u32 index;		/* out */
	__u32 by;		/* in */
	__u16 value;		/* in */
	__u8 port;		/* in: 1 to 3, with @at */
	__u8 reserved;
	__u32 at;		/* in: configuration of the slave; EC_UAPI_NONE32: anywhere */
	__u32 reserved2;
	char name[EC_UAPI_STRING];	/* in: letter, then letters, digits, '_', '-', '.' */
};

struct ec_ioc_group_config {
	__u32 flags;
	__u32 group;		/* in */
	__u16 member;		/* in: 0 the head, then in the order of the ring */
	__u16 reserved;
	__u32 vendor_id;	/* in */
	__u32 product_code;	/* in */
	__u32 index;		/* out: of the configuration */
};

/* the group of a configuration; EC_CAUSE_NONE and "": it is on the bus */
struct ec_ioc_config_group {
	__u32 flags;
	__u32 index;		/* in: of the configuration */
	__u32 group;		/* index */
	__u32 by;
	__u16 value;
	__u8 port;
	__u8 mandatory;
	__u32 at;
	__u32 members;
	__u32 position;		/* of the head, or of the slave in the way; EC_UAPI_NONE16: none */
	__u32 cause;		/* EC_CAUSE_* */
	__u32 reserved;
	char name[EC_UAPI_STRING];
	char why[EC_UAPI_REASON];
};

#endif
