/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/* Commands of the application that has reserved the master; the rules of ethercat.h hold. */
#ifndef EC_UAPI_ETHERCAT_APP_H
#define EC_UAPI_ETHERCAT_APP_H

#include <linux/types.h>
#include "ethercat_common.h"

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

/* struct ec_ioc_sc_replay.flags: one object that is replayed in any case, instead of the mode */
#define EC_SC_REPLAY_SDO	1
#define EC_SC_REPLAY_IDN	2

/* what a slave that returns gets again of the writes of the application */
struct ec_ioc_sc_replay {
	__u32 flags;
	__u32 config;		/* in */
	__u32 mode;		/* in: 0 default, 1 none, 2 all */
	__u16 object;		/* in: index, or IDN */
	__u8 subindex;		/* in: or drive */
	__u8 reserved;
};

/* struct ec_ioc_hold.flags: the application has written to the slave */
#define EC_HOLD_FLAG_RESUME	1

/* a slave that has returned and waits in PREOP for the application */
struct ec_ioc_hold {
	__u32 flags;
	__u32 config;		/* in */
	__u32 hold;		/* out, with EC_HOLD_FLAG_RESUME in: number, 0: it does not wait */
	__u32 reserved;
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

/* a request of no slave configuration: datagrams of any command */
struct ec_ioc_datagram_request {
	__u32 flags;
	__u32 size;		/* in: buffer size, bytes, 1..1486 */
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

/*
 * The application leaves its active session, whose cycle the kernel runs without an output stall,
 * to the master: the cycle continues without it, with the current outputs, and no application
 * takes the session over. EC_IOC_OUTPUT sets its outputs, EC_IOC_END_DETACHED ends it.
 */
struct ec_ioc_detach {
	__u32 flags;
	__u32 reserved;
};

#define EC_UAPI_NAMES_MAX	(4U << 20)	/* bytes */

/*
 * EC_IOC_SET_NAMES: what the application says of its values, for tools that show them: in the form
 * of a bus file, which the kernel does not read. It replaces the text before, and is kept as long
 * as the session. EC_IOC_NAMES: the text of the running session.
 */
struct ec_ioc_names {
	__u32 flags;
	__u32 size;	/* in: bytes at @data; EC_IOC_NAMES, out: bytes of the text, 0: none */
	__u64 data;
};

#define EC_OUTPUT_FLAG_HOLD	1	/* no lease: until it is set again, or the session ends */
#define EC_OUTPUT_LEASE_MAX_MS	86400000

/* set outputs of such a session; they become zero when the lease ends */
struct ec_ioc_output {
	__u32 flags;		/* EC_OUTPUT_FLAG_HOLD */
	__u32 domain;		/* in */
	__u32 bit;		/* in: the first one, in the domain */
	__u32 bits;		/* in: 1..64 */
	__u64 value;		/* in: bit 0 is the first one */
	__u64 device;		/* in: number of the device whose outputs they are */
	__u32 lease_ms;		/* in: 1..EC_OUTPUT_LEASE_MAX_MS; 0 with EC_OUTPUT_FLAG_HOLD */
	__u32 reserved;
};

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

#endif
