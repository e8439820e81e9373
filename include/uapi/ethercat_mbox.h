/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Arguments of the commands that use mailboxes of slaves; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_MBOX_H
#define EC_UAPI_ETHERCAT_MBOX_H

#include <linux/types.h>
#include "ethercat_address.h"

#define EC_IP_NAME		32
#define EC_FOE_NAME		64

struct ec_ioc_sdo {
	__u32 flags;		/* EC_SDO_FLAG_* */
	__u16 index;		/* in */
	__u8 subindex;		/* in */
	__u8 reserved;
	struct ec_ioc_address slave;	/* in */
	__u32 abort_code;	/* out */
	__u32 size;		/* download: bytes; upload: buffer size, then result */
	__u32 timeout_ms;	/* in; 0: default */
	__u32 reserved2;
	__u64 data;
};

#define EC_SDO_FLAG_COMPLETE	1

/* struct ec_ioc_sdo_info.what */
#define EC_SDO_INFO_LIST	1
#define EC_SDO_INFO_OBJECT	3
#define EC_SDO_INFO_ENTRY	5
#define EC_SDO_INFO_FORGET	0x80	/* drop the kept answers of the slave; no data */

/* value info of ETG.1000.6: optional fields, which follow the description in this order */
#define EC_SDO_VALUE_UNIT	0x08	/* 2 or 4 bytes */
#define EC_SDO_VALUE_DEFAULT	0x10	/* the size of the entry, also minimum and maximum */
#define EC_SDO_VALUE_MIN	0x20
#define EC_SDO_VALUE_MAX	0x40
#define EC_SDO_VALUE_ALL	0x78

/*
 * Object dictionary of a slave, as it describes itself (SDO information). In data the answer of
 * ETG.1000.6 clause 5.6.3: indexes (of list 0: five counts), or the description with its index.
 * The master keeps up to 64 KiB of answers per slave until the slave goes through INIT or BOOT.
 */
struct ec_ioc_sdo_info {
	__u32 flags;
	__u16 index;		/* in; of a list its type, 0..5 */
	__u8 subindex;		/* in; 0 unless it is an entry */
	__u8 what;		/* in: EC_SDO_INFO_* */
	struct ec_ioc_address slave;	/* in */
	__u8 value_info;	/* in, of an entry: EC_SDO_VALUE_*; what the slave sends it says */
	__u8 reserved[3];
	__u32 abort_code;	/* out: of the slave, after -EIO */
	__u32 size;		/* in: buffer size; out: bytes */
	__u32 timeout_ms;	/* in; 0: default */
	__u64 data;
};

/* so many the master keeps of each slave */
#define EC_EMERGENCIES		16

struct ec_emergency {
	__u64 time_ns;		/* when the master has fetched it, since 1970 */
	__u16 code;
	__u8 error_register;
	__u8 data[5];
};

/* the last emergencies of a slave, the oldest first */
struct ec_ioc_emergencies {
	__u32 flags;
	__u32 size;		/* in: buffer size, bytes; out: bytes copied */
	struct ec_ioc_address slave;	/* in */
	__u32 total;		/* out: of this slave since it was found */
	__u32 profile;		/* out: of the slave, 402: a drive; 0: not known */
	__u64 data;		/* of struct ec_emergency, at most EC_EMERGENCIES */
};

/* struct ec_ioc_soe.flags: elements of the IDN, in the order of their data; none: the value */
#define EC_SOE_ELEMENT_STATE	0x01	/* data state */
#define EC_SOE_ELEMENT_NAME	0x02
#define EC_SOE_ELEMENT_ATTRIBUTE 0x04
#define EC_SOE_ELEMENT_UNIT	0x08
#define EC_SOE_ELEMENT_MIN	0x10
#define EC_SOE_ELEMENT_MAX	0x20
#define EC_SOE_ELEMENT_VALUE	0x40
#define EC_SOE_ELEMENT_DEFAULT	0x80
#define EC_SOE_ELEMENT_ALL	0xff

/* elements of an IDN of a servo drive; one is written at a time */
struct ec_ioc_soe {
	__u32 flags;		/* in: EC_SOE_ELEMENT_* */
	__u16 idn;		/* in */
	__u8 drive;		/* in: 0..7 */
	__u8 reserved;
	struct ec_ioc_address slave;	/* in */
	__u32 error_code;	/* out: of the slave, after -EIO */
	__u32 size;		/* write: bytes; read: buffer size, then result */
	__u32 timeout_ms;	/* in; 0: default */
	__u32 reserved2;
	__u64 data;
};

/* file of a slave (FoE) */
struct ec_ioc_foe {
	__u32 flags;
	__u32 password;		/* in; 0: none */
	struct ec_ioc_address slave;	/* in */
	__u32 error_code;	/* out: of the slave, after -EIO */
	__u32 size;		/* write: bytes; read: buffer size, then result */
	__u32 timeout_ms;	/* in, per message; 0: default */
	__u32 reserved;
	__u64 data;
	__u64 done;		/* where the bytes so far are kept as __u64, 0: nowhere */
	char name[EC_FOE_NAME];	/* in: of the file on the slave; all bytes, or up to a zero */
};

/* struct ec_ip_params.which */
#define EC_IP_MAC		0x01
#define EC_IP_ADDRESS		0x02
#define EC_IP_MASK		0x04
#define EC_IP_GATEWAY		0x08
#define EC_IP_DNS		0x10
#define EC_IP_HOSTNAME		0x20
#define EC_IP_ALL		0x3f

/* IP parameters of a slave with EoE; addresses in network order */
struct ec_ip_params {
	__u32 which;		/* EC_IP_*: the valid fields */
	__u8 mac[6];
	__u8 reserved[2];
	__u8 ip[4];
	__u8 mask[4];
	__u8 gateway[4];
	__u8 dns[4];
	char name[EC_IP_NAME];	/* terminated by 0 if it is shorter */
};

struct ec_ioc_ip {
	__u32 flags;
	__u32 result;		/* out: EoE result code, with -EIO; 0: no reply */
	struct ec_ioc_address slave;	/* in */
	struct ec_ip_params params;
	__u32 reserved;
};

struct ec_ioc_config_sdo {
	__u32 flags;		/* out: EC_SDO_FLAG_COMPLETE */
	__u32 index;		/* in */
	__u32 sdo_pos;		/* in */
	__u16 sdo_index;
	__u8 subindex;
	__u8 reserved;
	__u32 size;		/* in: buffer size; out: full size */
	__u32 reserved2;
	__u64 data;
};

struct ec_ioc_config_idn {
	__u32 flags;
	__u32 index;		/* in */
	__u32 idn_pos;		/* in */
	__u16 idn;
	__u8 drive;
	__u8 state;		/* state in which the master writes it: 2 PREOP, 4 SAFEOP */
	__u32 size;		/* in: buffer size; out: full size */
	__u32 reserved;
	__u64 data;
};

struct ec_ioc_sc_sdo {
	__u32 flags;		/* EC_SDO_FLAG_COMPLETE */
	__u32 config;
	__u16 index;
	__u8 subindex;
	__u8 reserved;
	__u32 size;
	__u64 data;
};

/* a startup IDN */
struct ec_ioc_sc_idn {
	__u32 flags;
	__u32 config;
	__u16 idn;
	__u8 drive;		/* 0..7 */
	__u8 state;		/* in: 2 PREOP, 4 SAFEOP */
	__u32 size;
	__u64 data;
};

/* struct ec_ioc_sc_command.flags; without WRITE and CHECK it does nothing and is refused */
#define EC_COMMAND_FLAG_WRITE	1
#define EC_COMMAND_FLAG_CHECK	2	/* read until it is as expected */
#define EC_COMMAND_FLAG_COMPLETE 4	/* SDO: whole object */

/* a command of the application before a transition of a slave is requested */
struct ec_ioc_sc_command {
	__u32 flags;
	__u32 config;		/* in */
	__u8 from;		/* in: AL state */
	__u8 to;		/* in: AL state */
	__u8 kind;		/* in: EC_REQUEST_SDO, EC_REQUEST_REG or EC_REQUEST_SOE */
	__u8 subindex;		/* in: or drive */
	__u16 index;		/* in: object, register or IDN */
	__u16 reserved;
	__u32 timeout_ms;	/* in: limit of CHECK, at most 60000 */
	__u32 size;		/* in: of @data, which has the value to write (WRITE), the value */
	__u64 data;		/* expected and its mask (CHECK), of the same size each */
};

struct ec_ioc_sc_ip {
	__u32 flags;
	__u32 config;		/* in */
	struct ec_ip_params params;
};

#endif
