/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Interface between /dev/EtherCAT<n> and its users.
 *
 * Rules: fixed-width types only; pointers are passed as __u64; no padding by the compiler, so that
 * structures are the same for programs of 32 and 64 bits. Every structure starts with a flags word,
 * whose unknown bits are refused (-EOPNOTSUPP). It may grow at its end: the kernel takes the size
 * from the command number, zero-fills fields that an older program does not have, and refuses
 * (-E2BIG) an unknown tail that is not zero. Reserved fields are zero, otherwise -EOPNOTSUPP. A
 * structure shorter than its first version is refused (-EINVAL). Numbers are never reused. No
 * structure contains an array of structures: a command of its own has their index, or a buffer.
 *
 * After a failure EC_IOC_REASON on the same open file returns a line with cause and remedy.
 */
#ifndef EC_UAPI_ETHERCAT_H
#define EC_UAPI_ETHERCAT_H

#include <linux/ioctl.h>
#include <linux/types.h>
#include "ethercat_address.h"
#include "ethercat_cause.h"
#include "ethercat_event.h"
#include "ethercat_map.h"
#include "ethercat_mbox.h"

/*
 * From EC_UAPI_FIRST on no number and no member changes: such programs run on each later module.
 * EC_IOC_VERSION refuses older ones (-EPROTO).
 */
#define EC_UAPI_VERSION		3
#define EC_UAPI_FIRST		3
#define EC_UAPI_STRING		64
#define EC_UAPI_REASON		256
#define EC_UAPI_WARNING		192
#define EC_UAPI_PORTS		4
#define EC_UAPI_RATES		3	/* averages over 1, 10, 60 s */
#define EC_UAPI_DC_WINDOW_NS	1000	/* sync window of a clock */
#define EC_UAPI_NONE16		0xffff
#define EC_UAPI_NONE32		0xffffffff

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
};

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

/* needs CAP_NET_ADMIN, and that no application has the master */
struct ec_ioc_device_use {
	__u32 flags;		/* none yet */
	__u32 reserved;
	char name[EC_UAPI_STRING];	/* MAC address, PCI address or name of the device */
};

/* configured by the application -------------------------------------------*/

struct ec_ioc_config {
	__u32 flags;
	__u32 index;		/* in: of the configuration */
	__u16 alias;
	__u16 position;
	__u32 vendor_id;
	__u32 product_code;
	__s32 slave_position;	/* -1: not attached */
	__u16 al_status;
	__u16 watchdog_divider;
	__u16 watchdog_intervals;
	__u16 dc_assign_activate;
	__u32 dc_cycle[2];
	__s32 dc_shift[2];
	__u32 sdo_count;
	__u32 state;		/* EC_STATUS_SC_*, as in struct ec_status */
	__u32 flag_count;
	__u32 reserved;
	__u64 device;		/* number of the attached device, 0: none */
};

struct ec_ioc_config_sm {
	__u32 flags;
	__u32 index;		/* in */
	__u8 sm;		/* in */
	__u8 dir;		/* 0 not configured, 1 output, 2 input */
	__u8 watchdog;		/* 0 default, 1 enable, 2 disable */
	__u8 reserved;
	__u32 pdo_count;
};

struct ec_ioc_config_pdo {
	__u32 flags;
	__u32 index;		/* in */
	__u8 sm;		/* in */
	__u8 reserved[3];
	__u32 pdo_pos;		/* in */
	__u16 pdo_index;
	__u16 entry_count;
};

struct ec_ioc_config_entry {
	__u32 flags;
	__u32 index;		/* in */
	__u8 sm;		/* in */
	__u8 reserved[3];
	__u32 pdo_pos;		/* in */
	__u32 entry_pos;	/* in */
	__u16 entry_index;
	__u8 subindex;
	__u8 bits;
};

struct ec_ioc_config_flag {
	__u32 flags;
	__u32 index;		/* in */
	__u32 flag_pos;		/* in */
	__s32 value;
	char key[EC_UAPI_STRING];
};

/* options of a domain, see struct ec_ioc_domain_options */
#define EC_DOMAIN_OPT_OVERLAP	1	/* inputs at logical addresses of outputs */
#define EC_DOMAIN_OPT_SEPARATE	2	/* LRD and LWR instead of LRW */
#define EC_DOMAIN_OPT_OWN_FRAME	4	/* shares no frame with another domain */
#define EC_DOMAIN_OPT_ALL	7

/* reason why a configured slave is not in OP; empty: it is in OP */
struct ec_ioc_config_why {
	__u32 flags;
	__u32 index;		/* in */
	__u32 len;
	__u32 reserved;
	char text[EC_UAPI_REASON];
	struct ec_cause cause;
};

struct ec_ioc_domain {
	__u32 flags;
	__u32 index;		/* in */
	__u32 size;
	__u32 logical;
	__u32 working_counter;
	__u32 expected;
	__u32 fmmu_count;
	__u32 max_age;		/* of its process data, sends; 0: no limit */
	__u32 options;		/* EC_DOMAIN_OPT_* */
	__u32 datagram_count;	/* while active */
	__u32 datagram_bytes;	/* their headers and working counters included */
	__u32 age;		/* sends since that of the data, while active */
	__u32 wc_state;		/* EC_STATUS_WC_*, while active */
	__u32 unsent;		/* sends since activation while none has had it, else 0 */
};

struct ec_ioc_domain_fmmu {
	__u32 flags;
	__u32 index;		/* in: domain */
	__u32 fmmu;		/* in */
	__u16 alias;
	__u16 position;
	__u8 sm;
	__u8 dir;
	__u16 reserved;
	__u32 logical;
	__u32 size;
	__u32 offset;		/* in the domain */
};

struct ec_ioc_domain_data {
	__u32 flags;
	__u32 index;		/* in */
	__u32 size;		/* in: buffer size; out: bytes copied */
	__u32 reserved;
	__u64 data;
};

/* struct ec_ioc_cycle_stats.kind */
#define EC_CYCLE_BY_NOBODY	0	/* no cycle has run */
#define EC_CYCLE_BY_APP		1
#define EC_CYCLE_BY_KERNEL	2

/*
 * struct ec_ioc_cycle_stats.place: where a cycle of the kernel runs. With EC_CYCLE_FLAG_INTERRUPT
 * all but EC_CYCLE_PLACE_INTERRUPT are reasons why its thread runs it.
 */
#define EC_CYCLE_PLACE_THREAD	0	/* as configured */
#define EC_CYCLE_PLACE_INTERRUPT 1	/* in the interrupt of its timer */
#define EC_CYCLE_PLACE_RIGHT	2	/* CAP_SYS_NICE or RLIMIT_RTPRIO 99 is missing */
#define EC_CYCLE_PLACE_DEVICE	3	/* the device needs a thread */
#define EC_CYCLE_PLACE_LONG	4	/* it left too little time to the threads of its CPU */
#define EC_CYCLE_PLACE_CPU	5	/* its CPU is offline */
#define EC_CYCLE_PLACE_DEBUG	6	/* frames are printed: EC_IOC_DEBUG */
#define EC_CYCLE_PLACE_QUIET	7	/* it sends no frames */

/* statistics of the running cycle, otherwise of the last one */
struct ec_ioc_cycle_stats {
	__u32 flags;
	__u32 kind;
	__u32 active;		/* the cycle runs */
	__u32 interval_set;	/* interval was configured, not measured */
	__u32 interval_ns;
	__u32 size;		/* in: buffer size; out: bytes copied */
	__u64 data;		/* of struct ec_status_cycle */
	/* kernel: the thread */
	__s32 cpu;		/* configured, -1: any */
	__u32 cpu_losses;	/* times this CPU went offline */
	__u32 priority;		/* SCHED_FIFO; 0: SCHED_OTHER */
	__u32 priority_wanted;	/* as configured */
	__u32 place;		/* EC_CYCLE_PLACE_* */
	__u32 stall;		/* EC_STALL_* */
};

/* application ---------------------------------------------------------------*/

struct ec_ioc_create_domain {
	__u32 flags;
	__u32 index;		/* out */
};

struct ec_ioc_domain_options {
	__u32 flags;
	__u32 domain;		/* in */
	__u32 options;		/* in: EC_DOMAIN_OPT_* */
	__u32 reserved;
};

#define EC_DOMAIN_MAX_AGE	2	/* initial */

struct ec_ioc_domain_age {
	__u32 flags;
	__u32 domain;		/* in */
	__u32 max_age;		/* in: stale above this number of sends; 0: no limit */
	__u32 reserved;
};

struct ec_ioc_late {
	__u32 flags;
	__u32 per_s;		/* in: limit of cycles delayed by acyclic frames; 0: none */
};

struct ec_ioc_sc_overlap {
	__u32 flags;
	__u32 config;		/* in */
	__u32 overlap;		/* in: 0 or 1: inputs at logical addresses of its outputs */
	__u32 reserved;
};

struct ec_ioc_slave_config {
	__u32 flags;
	__u16 alias;		/* in */
	__u16 position;		/* in */
	__u32 vendor_id;	/* in */
	__u32 product_code;	/* in */
	__u32 index;		/* out */
};

struct ec_ioc_sc_sync {
	__u32 flags;
	__u32 config;		/* in */
	__u8 sm;		/* in */
	__u8 dir;		/* in: 1 output, 2 input */
	__u8 watchdog;		/* in */
	__u8 reserved;
};

struct ec_ioc_sc_watchdog {
	__u32 flags;
	__u32 config;
	__u16 divider;
	__u16 intervals;
};

/* op of struct ec_ioc_sc_pdo */
#define EC_SC_PDO_ASSIGN_ADD	0	/* @pdo to @sm */
#define EC_SC_PDO_ASSIGN_CLEAR	1	/* @sm */
#define EC_SC_PDO_MAP_ADD	2	/* entry to @pdo */
#define EC_SC_PDO_MAP_CLEAR	3	/* @pdo */

struct ec_ioc_sc_pdo {
	__u32 flags;
	__u32 config;
	__u8 op;
	__u8 sm;
	__u16 pdo;
	__u16 entry_index;
	__u8 subindex;
	__u8 bits;
};

#define EC_REG_ENTRY_BY_POS	1
#define EC_REG_ENTRY_ALIGNED	2	/* -EFAULT if the entry is not byte-aligned */

struct ec_ioc_reg_entry {
	__u32 flags;		/* EC_REG_ENTRY_* */
	__u32 config;		/* in */
	__u32 domain;		/* in */
	__u16 entry_index;	/* in, without BY_POS */
	__u8 subindex;
	__u8 sm;		/* in, with BY_POS */
	__u32 pdo_pos;
	__u32 entry_pos;
	__u32 offset;		/* out: byte in the domain */
	__u32 bit;		/* out: 0..7 */
};

struct ec_ioc_sc_dc {
	__u32 flags;
	__u32 config;
	__u16 assign_activate;
	__u16 reserved;
	__u32 cycle0;
	__s32 shift0;
	__u32 cycle1;
	__s32 shift1;
	__u32 reserved2;
};

struct ec_ioc_sc_flag {
	__u32 flags;
	__u32 config;
	__s32 value;
	__u32 reserved;
	char key[EC_UAPI_STRING];
};

/* struct ec_ioc_sc_timeout.flags: of replies to SDOs and IDNs, not of a state */
#define EC_SC_TIMEOUT_REPLY	1
struct ec_ioc_sc_timeout {
	__u32 flags;
	__u32 config;
	__u8 from;
	__u8 to;
	__u16 reserved;
	__u32 timeout_ms;
};

/* kind of struct ec_ioc_sc_request */
#define EC_REQUEST_SDO		0
#define EC_REQUEST_REG		1
#define EC_REQUEST_SOE		2
#define EC_REQUEST_VOE		3
#define EC_REQUEST_FOE		4
#define EC_REQUEST_SDO_INFO	5

struct ec_ioc_sc_request {
	__u32 flags;
	__u32 config;		/* in */
	__u32 kind;		/* in */
	__u32 size;		/* in: buffer size, bytes */
	__u32 index;		/* out: in the session */
	__u32 reserved;
};

struct ec_ioc_sc_emerg {
	__u32 flags;
	__u32 config;
	__u32 count;		/* emergencies to keep */
	__u32 reserved;
};

struct ec_ioc_activate {
	__u32 flags;
	__u32 image_size;	/* out, bytes, multiple of the page size */
	__u32 status_size;	/* out, same */
	__u32 request_size;	/* out, same; 0: neither requests nor emergencies */
	__u32 exchange_size;	/* out, same; 0: the application runs the cycle */
	__u32 preset_size;	/* in, bytes at @preset: all domains', or 0 */
	__u64 preset;		/* in: initial content of the image; otherwise zeros */
	__u32 taken_over;	/* out: 1: a detached session was taken over */
	__u32 reserved;
};

/* before activation: position of the domain with the entries registered so far */
struct ec_ioc_domain_offset {
	__u32 flags;
	__u32 domain;		/* in */
	__u32 offset;		/* out: in the image */
	__u32 size;		/* out */
};

#define EC_SEND_FLAG_APP_TIME	1	/* @app_time is set */
#define EC_SEND_FLAG_SYNC_REF	2	/* write @sync_time to the reference clock */
#define EC_SEND_FLAG_SYNC_SLAVES 4	/* drift compensation datagram */
#define EC_SEND_FLAG_MONITOR	8	/* read the differences of all slaves */
#define EC_SEND_FLAG_REQUESTS	16	/* a request was started */
#define EC_SEND_FLAG_REF_TIME	32	/* read all 64 bits of the reference clock */
#define EC_SEND_FLAG_ALL	63

/* argument of EC_IOC_SEND; @queued: bit n queues domain n */
struct ec_ioc_send {
	__u32 flags;		/* EC_SEND_FLAG_* */
	__u32 reserved;
	__u64 queued;
	__u64 app_time;		/* ns, as in EC_IOC_APP_TIME */
	__u64 sync_time;	/* ns */
};

/*
 * The same as EC_IOC_RECEIVE and EC_IOC_SEND by posix_fadvise(fd, app_time, queued, advice), which
 * enters the kernel by a shorter entry. EC_ADVICE_SEND is or-ed with EC_SEND_FLAG_*; @sync_time is
 * app_time. EINVAL: the same command has not come by ioctl() on this open file before, with any
 * result, or the module was loaded with short_entry=0.
 */
#define EC_ADVICE_RECEIVE	0x0ec00
#define EC_ADVICE_SEND		0x0ed00

struct ec_ioc_interval {
	__u32 flags;
	__u32 interval_us;
};

struct ec_ioc_app_time {
	__u32 flags;
	__u32 reserved;
	__u64 app_time;
};

/* selects the reference clock */
struct ec_ioc_ref_clock {
	__u32 flags;
	__u32 config;		/* EC_UAPI_NONE32: the first suitable slave */
};

/* reaction to an output stall: no new outputs for stall_cycles */
#define EC_STALL_HOLD		0	/* send the last outputs */
#define EC_STALL_ZERO		1	/* send zeros until there are new outputs */
#define EC_STALL_STOP		2	/* stop sending */

/* flags of struct ec_ioc_cycle */
#define EC_CYCLE_FLAG_DETACH	1	/* detach the session when the application exits */
#define EC_CYCLE_FLAG_WAIT	2	/* the first frame waits for outputs */
#define EC_CYCLE_FLAG_INTERRUPT	8	/* in the interrupt of its timer, where possible */
#define EC_CYCLE_FLAG_ALL	11

/* the kernel runs the cycle of the next activation; period_ns 0: the application */
struct ec_ioc_cycle {
	__u32 flags;		/* EC_CYCLE_FLAG_* */
	__u32 period_ns;	/* 10000..1000000000 */
	__u32 phase_ns;		/* < period_ns, of CLOCK_MONOTONIC; of the SYNC grid */
	__s32 cpu;		/* -1: any */
	/*
	 * SCHED_FIFO, 1..98; 0: 50. Limited by CAP_SYS_NICE and RLIMIT_RTPRIO of the caller; with
	 * neither: SCHED_OTHER.
	 */
	__u32 priority;
	__u32 stall;		/* EC_STALL_* */
	__u32 stall_cycles;	/* 0: no stall */
	/* EC_SEND_FLAG_SYNC_REF, _SYNC_SLAVES, _MONITOR, _REF_TIME, or below */
	__u32 dc;
};

/* bit of struct ec_ioc_cycle.dc; with _SYNC_SLAVES, without _SYNC_REF */
#define EC_CYCLE_DC_FOLLOW	256U	/* phase-locked to the reference clock */

/* exchange the domain in every @division-th cycle of the kernel */
struct ec_ioc_division {
	__u32 flags;
	__u32 domain;
	__u32 division;		/* 1..1000 */
	__u32 phase;		/* < division: cycle of the first exchange */
};

/* process data copy before each send: input bits to output bits */
struct ec_ioc_copy {
	__u32 flags;
	__u32 from_domain;
	__u32 from_bit;		/* bit in the domain */
	__u32 to_domain;
	__u32 to_bit;
	__u32 bits;
};

struct ec_ioc_wait {
	__u32 flags;
	__u32 timeout_us;	/* 0: none */
	__u64 cycle;		/* in: last known cycle; out: a newer one */
};

#define EC_IOC_TYPE		0xec
#define EC_IOC_R(nr, t)		_IOR(EC_IOC_TYPE, nr, t)
#define EC_IOC_W(nr, t)		_IOW(EC_IOC_TYPE, nr, t)
#define EC_IOC_RW(nr, t)	_IOWR(EC_IOC_TYPE, nr, t)
#define EC_IOC_N(nr)		_IO(EC_IOC_TYPE, nr)

/* any open file, no bus traffic */
#define EC_IOC_VERSION		EC_IOC_RW(0x00, struct ec_ioc_version)
#define EC_IOC_REASON		EC_IOC_R(0x01, struct ec_ioc_reason)
#define EC_IOC_MASTER		EC_IOC_R(0x02, struct ec_ioc_master)
#define EC_IOC_SLAVE		EC_IOC_RW(0x03, struct ec_ioc_slave)
#define EC_IOC_SM		EC_IOC_RW(0x04, struct ec_ioc_sm)
#define EC_IOC_PDO		EC_IOC_RW(0x05, struct ec_ioc_pdo)
#define EC_IOC_PDO_ENTRY	EC_IOC_RW(0x06, struct ec_ioc_pdo_entry)
#define EC_IOC_SII		EC_IOC_RW(0x07, struct ec_ioc_sii)
#define EC_IOC_CONFIG		EC_IOC_RW(0x08, struct ec_ioc_config)
#define EC_IOC_CONFIG_SM	EC_IOC_RW(0x09, struct ec_ioc_config_sm)
#define EC_IOC_CONFIG_PDO	EC_IOC_RW(0x0a, struct ec_ioc_config_pdo)
#define EC_IOC_CONFIG_ENTRY	EC_IOC_RW(0x0b, struct ec_ioc_config_entry)
#define EC_IOC_CONFIG_SDO	EC_IOC_RW(0x0c, struct ec_ioc_config_sdo)
#define EC_IOC_DOMAIN		EC_IOC_RW(0x0d, struct ec_ioc_domain)
#define EC_IOC_DOMAIN_FMMU	EC_IOC_RW(0x0e, struct ec_ioc_domain_fmmu)
#define EC_IOC_DOMAIN_DATA	EC_IOC_RW(0x0f, struct ec_ioc_domain_data)
#define EC_IOC_CONFIG_IDN	EC_IOC_RW(0x12, struct ec_ioc_config_idn)
#define EC_IOC_CONFIG_FLAG	EC_IOC_RW(0x10, struct ec_ioc_config_flag)
#define EC_IOC_CYCLE_STATS	EC_IOC_RW(0x11, struct ec_ioc_cycle_stats)
#define EC_IOC_CONFIG_IP	EC_IOC_RW(0x18, struct ec_ioc_sc_ip)
#define EC_IOC_CONFIG_WHY	EC_IOC_RW(0x19, struct ec_ioc_config_why)
#define EC_IOC_EMERGENCIES	EC_IOC_RW(0x1a, struct ec_ioc_emergencies)
#define EC_IOC_EVENTS		EC_IOC_RW(0x1b, struct ec_ioc_events)
#define EC_IOC_DEVICE		EC_IOC_RW(0x1c, struct ec_ioc_device)
#define EC_IOC_PORT		EC_IOC_RW(0x1d, struct ec_ioc_port)
#define EC_IOC_SLAVE_NAMES	EC_IOC_RW(0x1e, struct ec_ioc_slave_names)
#define EC_IOC_SLAVE_WHY	EC_IOC_RW(0x1f, struct ec_ioc_slave_why)

/* opened for writing: traffic or change */
#define EC_IOC_SDO_UPLOAD	EC_IOC_RW(0x20, struct ec_ioc_sdo)
#define EC_IOC_SDO_DOWNLOAD	EC_IOC_RW(0x21, struct ec_ioc_sdo)
#define EC_IOC_REG_READ		EC_IOC_RW(0x22, struct ec_ioc_reg)
#define EC_IOC_REG_WRITE	EC_IOC_RW(0x23, struct ec_ioc_reg)
#define EC_IOC_REG_RDWR		EC_IOC_RW(0x32, struct ec_ioc_reg)	/* data: in, out */
#define EC_IOC_STATE		EC_IOC_W(0x24, struct ec_ioc_state)
#define EC_IOC_RESCAN		EC_IOC_N(0x25)
#define EC_IOC_DEBUG		EC_IOC_W(0x26, struct ec_ioc_debug)
#define EC_IOC_RESET		EC_IOC_N(0x27)
#define EC_IOC_CYCLE_RESET	EC_IOC_N(0x28)
#define EC_IOC_SDO_INFO		EC_IOC_RW(0x2f, struct ec_ioc_sdo_info)
#define EC_IOC_IP_SET		EC_IOC_RW(0x30, struct ec_ioc_ip)
#define EC_IOC_IP_GET		EC_IOC_RW(0x31, struct ec_ioc_ip)
#define EC_IOC_SOE_READ		EC_IOC_RW(0x29, struct ec_ioc_soe)
#define EC_IOC_SOE_WRITE	EC_IOC_RW(0x2a, struct ec_ioc_soe)
#define EC_IOC_END_DETACHED	EC_IOC_N(0x2b)
#define EC_IOC_DEVICE_USE	EC_IOC_W(0x2c, struct ec_ioc_device_use)
#define EC_IOC_FOE_READ		EC_IOC_RW(0x2d, struct ec_ioc_foe)
#define EC_IOC_FOE_WRITE	EC_IOC_RW(0x2e, struct ec_ioc_foe)

/* reserved by this open file: the application */
#define EC_IOC_RESERVE		EC_IOC_N(0x40)
#define EC_IOC_RELEASE		EC_IOC_N(0x41)
#define EC_IOC_CREATE_DOMAIN	EC_IOC_RW(0x42, struct ec_ioc_create_domain)
#define EC_IOC_SLAVE_CONFIG	EC_IOC_RW(0x43, struct ec_ioc_slave_config)
#define EC_IOC_SC_SYNC		EC_IOC_W(0x44, struct ec_ioc_sc_sync)
#define EC_IOC_SC_WATCHDOG	EC_IOC_W(0x45, struct ec_ioc_sc_watchdog)
#define EC_IOC_SC_PDO		EC_IOC_W(0x46, struct ec_ioc_sc_pdo)
#define EC_IOC_SC_SDO		EC_IOC_W(0x47, struct ec_ioc_sc_sdo)
#define EC_IOC_REG_ENTRY	EC_IOC_RW(0x48, struct ec_ioc_reg_entry)
#define EC_IOC_SC_DC		EC_IOC_W(0x49, struct ec_ioc_sc_dc)
#define EC_IOC_SC_FLAG		EC_IOC_W(0x4a, struct ec_ioc_sc_flag)
#define EC_IOC_SC_TIMEOUT	EC_IOC_W(0x4b, struct ec_ioc_sc_timeout)
#define EC_IOC_ACTIVATE		EC_IOC_RW(0x4c, struct ec_ioc_activate)
#define EC_IOC_DEACTIVATE	EC_IOC_N(0x4d)
#define EC_IOC_DOMAIN_OFFSET	EC_IOC_RW(0x4e, struct ec_ioc_domain_offset)
#define EC_IOC_INTERVAL		EC_IOC_W(0x4f, struct ec_ioc_interval)
#define EC_IOC_APP_TIME		EC_IOC_W(0x50, struct ec_ioc_app_time)
#define EC_IOC_RECEIVE		EC_IOC_N(0x51)
#define EC_IOC_SEND		EC_IOC_W(0x52, struct ec_ioc_send)
#define EC_IOC_REF_CLOCK	EC_IOC_W(0x53, struct ec_ioc_ref_clock)
#define EC_IOC_SC_REQUEST	EC_IOC_RW(0x54, struct ec_ioc_sc_request)
#define EC_IOC_SC_EMERG		EC_IOC_W(0x55, struct ec_ioc_sc_emerg)
#define EC_IOC_SLAVES_DOWN	EC_IOC_N(0x71)
#define EC_IOC_SC_IP		EC_IOC_W(0x70, struct ec_ioc_sc_ip)
#define EC_IOC_SC_IDN		EC_IOC_W(0x56, struct ec_ioc_sc_idn)
#define EC_IOC_CYCLE		EC_IOC_W(0x60, struct ec_ioc_cycle)
#define EC_IOC_WAIT		EC_IOC_RW(0x61, struct ec_ioc_wait)
#define EC_IOC_DIVISION		EC_IOC_W(0x62, struct ec_ioc_division)
#define EC_IOC_COPY		EC_IOC_W(0x63, struct ec_ioc_copy)
#define EC_IOC_SC_OVERLAP	EC_IOC_W(0x78, struct ec_ioc_sc_overlap)
#define EC_IOC_LATE		EC_IOC_W(0x7a, struct ec_ioc_late)
#define EC_IOC_DOMAIN_AGE	EC_IOC_W(0x7b, struct ec_ioc_domain_age)
#define EC_IOC_DOMAIN_OPTIONS	EC_IOC_W(0x79, struct ec_ioc_domain_options)

#endif
