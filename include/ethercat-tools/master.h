/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: a master, its network devices, its cycle. */
#ifndef ETHERCAT_TOOLS_MASTER_H
#define ETHERCAT_TOOLS_MASTER_H

#include "handle.h"

#ifdef __cplusplus
extern "C" {
#endif

#define ECT_RATES	3	/* averages over 1, 10 and 60 s */

/* struct ect_master.phase */
#define ECT_PHASE_WAITING	0	/* for its network device */
#define ECT_PHASE_IDLE		1
#define ECT_PHASE_OPERATION	2

/* struct ect_master.session */
#define ECT_SESSION_NONE	0	/* no application */
#define ECT_SESSION_RESERVED	1
#define ECT_SESSION_ACTIVE	2
#define ECT_SESSION_DETACHED	3	/* active, the application has exited */

/* struct ect_master.cycle_lock: a kernel cycle and the reference clock */
#define ECT_LOCK_OFF	0
#define ECT_LOCK_SEEK	1
#define ECT_LOCK_LOCKED	2
#define ECT_LOCK_HOLD	3	/* no reply, the last rate is kept */

/* struct ect_master.ring */
#define ECT_RING_NONE		0	/* no backup device */
#define ECT_RING_UNKNOWN	1	/* no reply so far */
#define ECT_RING_CLOSED		2
#define ECT_RING_OPEN		3

struct ect_master {
	uint32_t struct_size;
	uint32_t index;
	uint8_t phase;		/* ECT_PHASE_* */
	uint8_t active;		/* an application has activated the master */
	uint8_t scan_busy;	/* a bus scan is running */
	uint8_t al_states;	/* of all slaves: 1 INIT, 2 PREOP, 4 SAFEOP, 8 OP */
	uint32_t slave_count;
	uint32_t slaves_responding;
	uint32_t scan_index;	/* slaves that the running scan has read */
	uint32_t scan_slaves;	/* slaves of the running scan */
	uint32_t config_count;
	uint32_t domain_count;
	uint32_t device_count;	/* network devices: 1, or 2 with a backup device */
	uint32_t debug_level;
	int32_t ref_clock;	/* ring position, -1: none */
	uint64_t app_time;	/* of the application, ns since 2000 */
	uint64_t dc_ref_time;	/* of the reference clock, likewise */
	uint64_t scan_frames;	/* of the last scan */
	uint32_t scan_us;	/* likewise */
	uint32_t scan_count;	/* scans so far */
	uint32_t session;	/* ECT_SESSION_* */
	uint32_t cycle_lock;	/* ECT_LOCK_* */
	uint32_t lock_losses;
	int32_t phase_error;	/* ns, positive: late */
	int32_t rate_ppb;	/* of the reference clock against the computer */
	/* while active; wire times at 100 Mbit/s, preamble and gap included */
	uint32_t cycle_interval_us;	/* configured or measured */
	uint32_t cycle_datagrams;	/* of a cycle that sends all domains */
	uint32_t cycle_frames;
	uint32_t cycle_wire_ns;
	uint32_t sent_frames;		/* of the last send */
	uint32_t sent_wire_ns;
	uint32_t acyclic_slack_ns;	/* that a cycle leaves for acyclic frames */
	uint32_t acyclic_need_ns;	/* that the shortest of them needs */
	uint32_t late_per_s;	/* limit of cycles that acyclic frames delay, per second */
	uint32_t late_cycles;	/* so many were delayed */
	uint32_t not_captured;	/* frames for which a capture program had no room */
	uint32_t acyclic_max;	/* acyclic frames of one send, at most */
	uint32_t sii_limit;	/* bytes of EEPROM images, at most */
	uint32_t no_cycle;	/* active, but the application sends no cyclic frames */
	uint64_t sii_bytes;	/* of all slaves */
	uint32_t held;		/* an application has the list of slaves held: no scan */
	uint32_t links_up;	/* bit n: network device n has a link */
	char owner[ECT_STRING];	/* the application that has reserved the master, or "" */
	uint32_t left;		/* detached and left to the master: ect_run_leave() */
	uint32_t reserved;
	uint32_t ring;		/* ECT_RING_* */
	/* of an open ring */
	uint32_t ring_slave;	/* before the break; ECT_NONE32: the main device */
	uint32_t ring_port;	/* its port there; ECT_NONE32: not known */
	uint32_t ring_next;	/* behind the break; ECT_NONE32: the backup device */
	uint32_t ring_exchanged;	/* the main device has the name of the backup device */
	uint32_t ring_turned;	/* 1 + position of a slave that is the wrong way round; 0: none */
};

/* the main device of a master, or its backup device */
struct ect_device {
	uint32_t struct_size;
	uint32_t index;		/* 0 main, 1 backup */
	uint8_t address[6];	/* MAC */
	uint8_t attached;	/* else @address and @name are those that are waited for */
	uint8_t link_up;
	uint32_t slaves;	/* that replied last */
	uint32_t speed;		/* of a native device with link, Mbit/s; 0: not known */
	uint64_t tx_frames;
	uint64_t tx_bytes;
	uint64_t rx_frames;
	uint64_t rx_bytes;
	uint64_t tx_errors;
	uint64_t lost;		/* frames without reply */
	uint64_t late;		/* frames whose reply came a cycle or more late */
	uint64_t unmatched;	/* EtherCAT frames that are no reply, or damaged */
	uint64_t foreign;	/* frames of other protocols */
	uint32_t tx_frame_rate[ECT_RATES];	/* per second */
	uint32_t rx_frame_rate[ECT_RATES];
	uint32_t tx_byte_rate[ECT_RATES];
	uint32_t rx_byte_rate[ECT_RATES];
	uint32_t loss_rate[ECT_RATES];
	uint32_t al_states;	/* as in struct ect_master */
	char name[ECT_STRING];	/* interface or PCI address */
};

/* struct ect_cycle.kind */
#define ECT_CYCLE_BY_NOBODY	0	/* no cycle has run */
#define ECT_CYCLE_BY_APP	1
#define ECT_CYCLE_BY_KERNEL	2

/* struct ect_cycle.place: where a cycle of the kernel runs, or why its thread runs it */
#define ECT_PLACE_THREAD	0	/* as configured */
#define ECT_PLACE_INTERRUPT	1	/* in the interrupt of its timer */
#define ECT_PLACE_RIGHT		2	/* CAP_SYS_NICE or RLIMIT_RTPRIO 99 is missing */
#define ECT_PLACE_DEVICE	3	/* the device needs a thread */
#define ECT_PLACE_LONG		4	/* it left too little time to the threads of its CPU */
#define ECT_PLACE_CPU		5	/* its CPU is offline */
#define ECT_PLACE_DEBUG		6	/* frames are printed */
#define ECT_PLACE_QUIET		7	/* it sends no frames */

/* struct ect_cycle.state */
#define ECT_CYCLE_NONE		0	/* the application runs the cycle */
#define ECT_CYCLE_RUNNING	1
#define ECT_CYCLE_STALLED	2	/* the application gives no outputs */
#define ECT_CYCLE_STOPPED	3	/* likewise, and the cycle has stopped */
#define ECT_CYCLE_WAITING	4	/* for the first outputs */

/* struct ect_cycle.stall: what happens without new outputs */
#define ECT_STALL_HOLD	0	/* the last ones are sent */
#define ECT_STALL_ZERO	1	/* zeros are sent */
#define ECT_STALL_STOP	2	/* nothing is sent */

#define ECT_BUCKETS	240	/* of the histogram of send deviations */

/* the cycle that runs, otherwise the last one, and its send deviations */
struct ect_cycle {
	uint32_t struct_size;
	uint32_t kind;		/* ECT_CYCLE_BY_* */
	uint32_t active;	/* the cycle runs */
	uint32_t interval_set;	/* the interval was configured, not measured */
	uint32_t interval_ns;
	int32_t cpu;		/* of the kernel's thread, -1: any */
	uint32_t cpu_losses;	/* times this CPU went offline */
	uint32_t priority;	/* SCHED_FIFO, 0: SCHED_OTHER */
	uint32_t priority_wanted;
	uint32_t place;		/* ECT_PLACE_* */
	uint32_t stall;		/* ECT_STALL_* */
	uint32_t state;		/* ECT_CYCLE_* */
	uint64_t overruns;	/* skipped cycles */
	uint64_t missed;	/* cycles of the kernel without new outputs */
	uint64_t late_sum;	/* of send deviations, ns */
	uint64_t late_count;	/* sends */
	uint32_t late_min;	/* ns */
	uint32_t late_max;
	uint64_t work_sum;	/* execution times of a cycle of the kernel, ns */
	uint64_t work_count;
	uint32_t work_max;
	uint32_t work_ns;	/* of the last one */
	uint32_t takeovers;	/* of a detached session */
	uint32_t histogram;	/* buckets of @late that are valid: %ECT_BUCKETS */
	uint64_t late[ECT_BUCKETS];	/* sends by their deviation, ect_bucket_ns() */
};

/**
 * ect_master_read() - the state of a master
 * @h: master
 * @m: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_master_read(struct ect_handle *h, struct ect_master *m);

/**
 * ect_devices_read() - the network devices of a master
 * @h: master
 * @list: result, elements are struct ect_device: main, backup
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_devices_read(struct ect_handle *h, struct ect_list **list);

/**
 * ect_rescan() - request a bus scan
 * @h: master, open for writing
 *
 * The scan has ended when @scan_count of struct ect_master has changed and @scan_busy is 0.
 *
 * Context: The thread of the handle.
 * Return: 0, -EBUSY while an application has the list of slaves held, or another negative errno.
 */
int ect_rescan(struct ect_handle *h);

/**
 * ect_debug() - set how much the master writes to the kernel log
 * @h: master, open for writing
 * @level: 0 normal, 1 more events, 2 also the content of all frames
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_debug(struct ect_handle *h, unsigned int level);

/**
 * ect_end_detached() - end a detached session
 * @h: master, open for writing
 *
 * Context: The thread of the handle.
 * Return: 0, -ENOENT without session, or another negative errno.
 */
int ect_end_detached(struct ect_handle *h);

/**
 * ect_device_use() - give a master another network device
 * @h: master, open for writing; needs CAP_NET_ADMIN
 * @name: interface, MAC address or PCI address
 *
 * Context: The thread of the handle; waits for the device.
 * Return: 0, -EBUSY while an application has the master, or another negative errno.
 */
int ect_device_use(struct ect_handle *h, const char *name);

/**
 * ect_backup_use() - give a master another backup device, at the other end of its ring
 * @h: master, open for writing; needs CAP_NET_ADMIN
 * @name: interface, MAC address or PCI address; NULL: none, the bus is no ring any more
 *
 * Context: The thread of the handle; waits for the device.
 * Return: as ect_device_use().
 */
int ect_backup_use(struct ect_handle *h, const char *name);

/**
 * ect_cycle_read() - statistics of the cycle
 * @h: master
 * @c: result, with its @struct_size
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0 or a negative errno.
 */
int ect_cycle_read(struct ect_handle *h, struct ect_cycle *c);

/**
 * ect_cycle_reset() - begin the statistics of the cycle again
 * @h: master, open for writing
 *
 * Context: The thread of the handle.
 * Return: 0 or a negative errno.
 */
int ect_cycle_reset(struct ect_handle *h);

/**
 * ect_bucket_ns() - where a bucket of the histogram begins
 * @bucket: index in @late of struct ect_cycle; that of the next one is the end
 *
 * Context: Any.
 * Return: ns.
 */
uint64_t ect_bucket_ns(unsigned int bucket);

/**
 * ect_cycle_quantile() - deviation below which a share of the sends is
 * @c: statistics
 * @permille: 999: 99.9 % of the sends
 *
 * Context: Any.
 * Return: ns, the end of a bucket; 0 without sends.
 */
uint64_t ect_cycle_quantile(const struct ect_cycle *c, unsigned int permille);

#ifdef __cplusplus
}
#endif

#endif
