/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* What the application has configured, as other programs see it; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_CONFIG_H
#define EC_UAPI_ETHERCAT_CONFIG_H

#include <linux/types.h>
#include "ethercat_cause.h"
#include "ethercat_common.h"

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
	__u32 group;		/* hot connect group, its member @position: index + 1; 0: none */
	__u32 reserved2;
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

/* struct ec_ioc_config_write.kind */
#define EC_WRITE_KIND_SDO	0
#define EC_WRITE_KIND_IDN	1
#define EC_WRITE_KIND_REG	2

/* what the application has written itself before the slave was in OP; the oldest first */
struct ec_ioc_config_write {
	__u32 flags;		/* out: EC_SDO_FLAG_COMPLETE */
	__u32 index;		/* in */
	__u32 write_pos;	/* in */
	__u16 object;		/* index, IDN, or address of a register */
	__u8 subindex;		/* or drive */
	__u8 kind;		/* EC_WRITE_KIND_* */
	__u32 why;		/* it is not written to a slave that returns; 0: it is */
	__u32 size;		/* in: buffer size; out: bytes; 0 if the value was not kept */
	__u32 total;
	__u32 forgotten;	/* older ones that are not even listed */
	__u64 data;
};

/* a command of the application for a transition, see struct ec_ioc_sc_command */
struct ec_ioc_config_command {
	__u32 flags;		/* out: EC_COMMAND_FLAG_* */
	__u32 index;		/* in */
	__u32 command_pos;	/* in */
	__u16 object;		/* index, IDN, or address of a register */
	__u8 subindex;		/* or drive */
	__u8 kind;		/* EC_WRITE_KIND_* */
	__u8 from;		/* AL state */
	__u8 to;		/* AL state */
	__u16 reserved;
	__u32 timeout_ms;
	__u32 size;		/* in: buffer size; out: bytes of @data: the value to write, the */
	__u32 reserved2;	/* value expected and its mask, as the flags say */
	__u64 data;
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
	__u32 config;		/* its configuration: index + 1; 0: an older module */
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

#endif
