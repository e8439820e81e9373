/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Version, master, devices and slaves; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_INFO_H
#define EC_UAPI_ETHERCAT_INFO_H

#include <linux/types.h>
#include "ethercat_address.h"
#include "ethercat_cause.h"
#include "ethercat_common.h"

/* bits of struct ec_ioc_version.features */
#define EC_FEATURE_APP_CYCLE	(1ULL << 0)
#define EC_FEATURE_COE		(1ULL << 1)
#define EC_FEATURE_KERNEL_CYCLE	(1ULL << 2)
#define EC_FEATURE_SOE		(1ULL << 3)
#define EC_FEATURE_VOE		(1ULL << 4)
#define EC_FEATURE_FOE		(1ULL << 5)
#define EC_FEATURE_EVENTS	(1ULL << 6)

/* the first command of a program */
struct ec_ioc_version {
	__u32 flags;
	__u32 abi;		/* EC_UAPI_VERSION; in: of the program, out: of the module */
	__u64 features;
	__u32 master_count;
	__u32 ecrt;		/* ECRT_VERSION_MAGIC of the module */
	char release[EC_UAPI_STRING];
};

struct ec_ioc_reason {
	__u32 flags;
	__u32 len;
	char text[EC_UAPI_REASON];
};

/* struct ec_ioc_device.state */
#define EC_DEVICE_WAITING	0
#define EC_DEVICE_ATTACHED	1

struct ec_ioc_device {
	__u32 flags;
	__u32 index;		/* in: 0 main, 1 backup; < struct ec_ioc_master.device_count */
	__u8 address[6];
	__u8 state;
	__u8 link_up;
	__u32 slaves;		/* slaves that responded to the last broadcast */
	char name[EC_UAPI_STRING];
	__u32 speed;		/* of a native device with link, Mbit/s; 0: not known here */
	__u64 tx_frames;
	__u64 tx_bytes;
	__u64 rx_frames;
	__u64 rx_bytes;
	__u64 tx_errors;
	__u64 lost;		/* no reply */
	__u64 late;		/* reply a cycle or more late, or after the timeout */
	__u64 unmatched;	/* EtherCAT, but no reply to a sent frame, or damaged */
	__u64 foreign;		/* other protocols on the wire */
	__u32 tx_frame_rate[EC_UAPI_RATES];	/* per second */
	__u32 rx_frame_rate[EC_UAPI_RATES];
	__u32 tx_byte_rate[EC_UAPI_RATES];
	__u32 rx_byte_rate[EC_UAPI_RATES];
	__u32 loss_rate[EC_UAPI_RATES];
	__u32 al_states;	/* OR of all slaves: 1 INIT, 2 PREOP, 4 SAFEOP, 8 OP */
};

/* struct ec_ioc_master.phase */
#define EC_PHASE_WAITING	0	/* for its device */
#define EC_PHASE_IDLE		1
#define EC_PHASE_OPERATION	2

/* struct ec_ioc_master.session */
#define EC_SESSION_NONE		0	/* the master is not reserved */
#define EC_SESSION_RESERVED	1
#define EC_SESSION_ACTIVE	2
#define EC_SESSION_DETACHED	3	/* active, the application has exited */

struct ec_ioc_master {
	__u32 flags;
	__u32 index;
	__u8 phase;
	__u8 active;
	__u8 scan_busy;
	__u8 al_states;		/* OR of 1 INIT, 2 PREOP, 4 SAFEOP, 8 OP */
	__u32 slave_count;
	__u32 slaves_responding;
	__u32 scan_index;	/* slaves read; less than scan_slaves while a scan runs */
	__u32 config_count;
	__u32 domain_count;
	__u32 device_count;
	__u32 debug_level;
	__u64 app_time;
	__u64 dc_ref_time;
	__s32 ref_clock;	/* ring position, -1 none */
	__u32 scan_us;		/* duration of the last scan */
	__u64 scan_frames;	/* frames of the last scan */
	__u32 scan_count;	/* bus scans finished so far */
	__u32 session;		/* EC_SESSION_* */
	__u32 cycle_lock;	/* EC_CYCLE_LOCK_*, of struct ec_status_cycle */
	__u32 lock_losses;	/* likewise */
	__s32 phase_error;	/* likewise */
	__s32 rate_ppb;		/* likewise */
	/* while active; wire times of 100 Mbit/s, preamble and gap included */
	__u32 cycle_interval_us;	/* cycle time, configured or measured */
	__u32 cycle_datagrams;	/* of a cycle that sends all domains */
	__u32 cycle_frames;
	__u32 cycle_wire_ns;
	__u32 sent_frames;	/* of the last send, clock datagrams included */
	__u32 sent_wire_ns;
	__u32 acyclic_slack_ns;	/* free wire time for acyclic frames */
	__u32 acyclic_need_ns;	/* wire time of the shortest acyclic frame */
	__u32 late_per_s;	/* limit of delayed cycles per second */
	__u32 late_cycles;	/* cycles delayed by acyclic frames */
	__u32 scan_slaves;	/* slaves of the running scan; otherwise slave_count */
	__u32 not_captured;	/* frames that were not captured, of all devices */
	__u32 acyclic_max;	/* acyclic frames of one send, at most */
	__u32 sii_limit;	/* bytes of EEPROM images, at most */
	__u64 sii_bytes;	/* of all slaves */
	__u32 no_cycle;		/* active, but the application sends no cyclic frames */
	__u32 held;		/* the list of slaves is held, see ecrt_master_reserve() */
	__u32 links_up;		/* bit n: device n has a link */
	__u32 reserved;
	char owner[EC_UAPI_STRING];	/* application that has reserved the master, or empty */
	__u32 left;		/* detached by EC_IOC_DETACH: EC_IOC_OUTPUT works */
	__u32 ring;		/* EC_RING_* */
	/* of an open ring */
	__u32 ring_slave;	/* before the break; EC_EVENT_NONE: the main device */
	__u32 ring_port;	/* its port there; EC_EVENT_NONE: not known */
	__u32 ring_next;	/* behind the break; EC_EVENT_NONE: the backup device */
	__u32 ring_exchanged;	/* device 0 has the name of the backup device */
	__u32 ring_turned;	/* 1 + position of a slave that is the wrong way round; 0: none */
	__u32 reserved2;
};

/* struct ec_ioc_master.ring */
#define EC_RING_NONE		0	/* no backup device */
#define EC_RING_UNKNOWN		1	/* no reply so far */
#define EC_RING_CLOSED		2
#define EC_RING_OPEN		3

/* a port of a slave */
struct ec_ioc_port {
	__u32 flags;
	__u32 port;		/* in, < EC_UAPI_PORTS */
	struct ec_ioc_address slave;	/* in */
	__u32 receive_time;
	__u32 delay_to_next_dc;
	__u8 type;		/* 0 none, 1 not configured, 2 EBUS, 3 MII */
	__u8 link_up;
	__u8 loop_closed;
	__u8 signal;
	__u16 next_slave;	/* EC_UAPI_NONE16: none */
	__u16 reserved;
	__u32 kept;		/* EC_PORT_*: why it is closed although it has a link */
	__u32 wait_s;		/* EC_PORT_LOSSES: it opens after so many s of link without loss */
	/* from EC_PORT_OTHER on: the device behind it; 0: not read */
	__u32 vendor_id;
	__u32 product_code;
	__u32 revision_number;
	__u32 serial_number;
	__u32 slaves;		/* with those behind it */
	__u16 alias;
	__u16 identification;
	char name[EC_UAPI_STRING];
	/*
	 * errors of this port that its registers do not contain any more, as the master has cleared
	 * them since a counter was full: invalid frames, errors of the receiver, forwarded errors
	 */
	__u32 cleared[3];
	__u32 reserved2;
	/*
	 * errors of this port as the master has read them last, with those that it has cleared:
	 * invalid frames, errors of the receiver, forwarded errors, lost links
	 */
	__u32 errors[4];
	__u32 errors_known;	/* of them, from the first on; 0: not read */
	__u32 errors_age_ms;	/* time since they were read */
};

#define EC_PORT_NOT_KEPT	0
#define EC_PORT_NO_REPLY	1	/* no slave replies behind it */
#define EC_PORT_LOOPS		2	/* a slave that does not keep 0x0101, others behind it */
#define EC_PORT_LOSSES		3	/* it has lost its link too often */
/* a device that is not let in, but by EC_IOC_LET_IN; see the module parameter border */
#define EC_PORT_OTHER		4	/* no head of a hot connect group of this port */
#define EC_PORT_SIGN		5	/* one with another alias or identification */
#define EC_PORT_SERIAL		6	/* one with another serial number */
#define EC_PORT_SECOND		7	/* a slave of the bus has its alias or identification */
#define EC_PORT_REVERSED	8	/* not connected by port 0 */
#define EC_PORT_BOOT		9	/* in BOOT */
#define EC_PORT_UNREADABLE	10	/* its EEPROM or identification cannot be read */
#define EC_PORT_UNKNOWN		11	/* neither known nor expected anywhere */
#define EC_PORT_WRONG_WAY	12	/* connected the wrong way round, others behind it */
#define EC_PORT_SWALLOWS	13	/* no frame returned while it was open */
#define EC_PORT_NO_TIME		14	/* too little time beside the cycle for a trial */
#define EC_PORT_EARLY		15	/* of a slave connected the wrong way round */

/* let the device behind a port in; only if it is the one with this identity */
struct ec_ioc_let_in {
	__u32 flags;
	__u32 port;
	struct ec_ioc_address slave;
	__u32 vendor_id;
	__u32 product_code;
	__u32 revision_number;
	__u32 serial_number;
};

/* slaves that were disconnected and have not returned, behind one port */
struct ec_ioc_absent {
	__u32 flags;
	__u32 index;		/* in: of the port, from 0 */
	__u64 device;		/* number of the slave whose port it is, 0: the main device */
	__u64 since_ns;		/* they were last seen so long ago */
	__u32 slaves;		/* 0: @index is behind the last one */
	__u16 first;		/* ring position that the first of them had */
	__u16 last;
	__u8 port;
	__u8 reserved[7];
	char name[EC_UAPI_STRING];	/* of the first one */
};

/* struct ec_ioc_slave.coe_details: bits as in SII general byte 5 */
/* struct ec_ioc_slave.error */
#define EC_SLAVE_OK		0
#define EC_SLAVE_SCAN_FAILED	1
#define EC_SLAVE_CONFIG_FAILED	2

struct ec_ioc_slave {
	__u32 flags;
	__u32 config;		/* attached or different configuration: index + 1; 0: none */
	struct ec_ioc_address slave;	/* in */
	__u64 device;		/* device number */
	__u16 position;
	__u16 station;
	__u16 alias;
	__u16 alias_pos;	/* number of slaves after the slave with the alias */
	__u16 alias_group;	/* alias of this slave or of one upstream, 0: none */
	__u16 al_status;	/* register 0x0130 */
	__u16 al_code;		/* register 0x0134 */
	__u8 al_requested;
	__u8 error;
	__u32 vendor_id;
	__u32 product_code;
	__u32 revision_number;
	__u32 serial_number;
	__u16 boot_rx_offset;
	__u16 boot_rx_size;
	__u16 boot_tx_offset;
	__u16 boot_tx_size;
	__u16 std_rx_offset;
	__u16 std_rx_size;
	__u16 std_tx_offset;
	__u16 std_tx_size;
	__u16 mbox_protocols;
	__u8 has_general;
	__u8 coe_details;
	__u8 general_flags;
	__u8 foe_details;
	__s16 current_ma;
	__u8 fmmu_bit;
	__u8 dc_supported;	/* 0 no, 1: 32 bit, 2: 64 bit */
	__u8 dc_delay_only;
	__u8 sm_count;
	__u8 fmmu_count;
	__u8 device_index;	/* 0 main, 1 backup */
	__u16 dl_status;
	__u16 features;		/* register 0x0008 */
	__u16 reserved;
	__u32 transmission_delay;
	__u32 sii_words;
	__u32 differs;		/* identity differs from @config */
	__u64 dc_offset;	/* register 0x0920, ns */
	__s32 dc_diff;		/* difference to the reference clock at the last read, ns */
	__u16 dc_set;		/* synchronized for the active application */
	__u16 dc_odd;		/* delay unreliable: receive times contradict the topology */
	__u16 identification;	/* explicit device identification, 0: none */
	__u16 missing_before;	/* slaves of the closed ring that are missing before this one */
	__u16 reserved2[2];
};

/* what the EEPROM of a slave calls it */
struct ec_ioc_slave_names {
	__u32 flags;
	__u32 reserved;
	struct ec_ioc_address slave;	/* in */
	char group[EC_UAPI_STRING];
	char image[EC_UAPI_STRING];
	char order[EC_UAPI_STRING];
	char name[EC_UAPI_STRING];
};

/* what is wrong with a slave */
struct ec_ioc_slave_why {
	__u32 flags;
	__u32 reserved;
	struct ec_ioc_address slave;	/* in */
	char why[EC_UAPI_REASON];	/* cause of struct ec_ioc_slave.error */
	char warning[EC_UAPI_WARNING];	/* uncertain process data, wrong EEPROM or revision */
	struct ec_cause cause;	/* of @why; without one of @warning */
};

struct ec_ioc_sm {
	__u32 flags;
	__u8 sm;		/* in */
	__u8 control;
	__u8 enable;
	__u8 type;
	struct ec_ioc_address slave;	/* in */
	__u16 start;
	__u16 default_size;
	__u16 pdo_count;
	__u16 reserved;
};

struct ec_ioc_pdo {
	__u32 flags;
	__u8 sm;		/* in */
	__u8 reserved;
	__u16 pdo_pos;		/* in */
	struct ec_ioc_address slave;	/* in */
	__u16 index;
	__u16 entry_count;
	__u32 reserved2;
	char name[EC_UAPI_STRING];
};

struct ec_ioc_pdo_entry {
	__u32 flags;
	__u8 sm;		/* in */
	__u8 reserved;
	__u16 pdo_pos;		/* in */
	struct ec_ioc_address slave;	/* in */
	__u16 entry_pos;	/* in */
	__u16 index;
	__u8 subindex;
	__u8 bits;
	__u16 reserved2;
	char name[EC_UAPI_STRING];
};

/* the EEPROM image as read by the last scan; no bus traffic */
struct ec_ioc_sii {
	__u32 flags;
	__u32 offset;		/* in, bytes */
	struct ec_ioc_address slave;	/* in */
	__u32 size;		/* in: buffer size; out: bytes copied */
	__u32 reserved;
	__u64 data;
};

/* struct ec_ioc_sii_write.flags and ec_ioc_alias.flags */
#define EC_SII_FLAG_FORCE	1	/* while the slave runs; image of another device */
#define EC_SII_FLAG_UNSAFE	2	/* an image that may make the slave unreachable */
#define EC_SII_FLAG_REPAIR	4	/* alias: the checksum may be wrong before */
#define EC_SII_FLAG_DRY_RUN	8	/* check and compare, write nothing */

/*
 * The EEPROM from word 0 on: only words that differ are written, words 0 to 7 at last, and all are
 * read back. When it is interrupted, the same command continues.
 */
struct ec_ioc_sii_write {
	__u32 flags;		/* in: FORCE, UNSAFE, DRY_RUN */
	__u32 size;		/* in, bytes, even */
	struct ec_ioc_address slave;	/* in */
	__u64 data;		/* in */
	__u64 done;		/* in: address of a __u64 for the words done so far, or 0 */
	__u32 differ;		/* out: words that differed */
	__u32 written;		/* out: words written; fewer after -EIO */
	__u16 register_alias;	/* out: register 0x0012: not word 4 before a power cycle */
	__u8 renewed;		/* out: the master has read the slave again */
	__u8 reserved[5];
};

/* words 4 and 7 of the EEPROM */
struct ec_ioc_alias {
	__u32 flags;		/* in: FORCE, REPAIR */
	__u16 alias;		/* in; 0: none */
	__u16 register_alias;	/* out: register 0x0012 */
	struct ec_ioc_address slave;	/* in */
	__u8 renewed;		/* out */
	__u8 reserved[7];
};

struct ec_ioc_reg {
	__u32 flags;
	__u16 address;		/* in */
	__u16 reserved;
	struct ec_ioc_address slave;	/* in */
	__u32 size;		/* in, bytes, 1..1024 */
	__u32 reserved2;
	__u64 data;
};

#define EC_REG_FLAG_EMERGENCY	1	/* write by ring position, unscanned bus */

/* any EtherCAT command; what slaves do not change of the data stays */
struct ec_ioc_datagram {
	__u32 flags;
	__u32 address;		/* in: logical, or position or station and, from bit 16, register */
	__u8 command;		/* in: of ETG.1000.4, 0 NOP to 14 FRMW */
	__u8 reserved;
	__u16 working_counter;	/* out */
	__u32 size;		/* in, bytes, 1..1486 */
	__u64 data;
};

struct ec_ioc_state {
	__u32 flags;
	__u32 timeout_ms;	/* in: of each transition on the way to it, 0: the usual limits */
	struct ec_ioc_address slave;	/* in */
	__u8 state;		/* in: 1, 2, 3, 4, 8 */
	__u8 reserved[7];
};

struct ec_ioc_debug {
	__u32 flags;
	__u32 level;		/* 0, 1, 2 */
};

#define EC_DEVICE_FLAG_BACKUP	1	/* the backup device, at the other end of a ring */

/* needs CAP_NET_ADMIN, and that no application has the master */
struct ec_ioc_device_use {
	__u32 flags;		/* EC_DEVICE_FLAG_* */
	__u32 reserved;
	char name[EC_UAPI_STRING];	/* MAC or PCI address, or name; backup device: "": none */
};

#endif
