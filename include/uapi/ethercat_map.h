/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Memory of an active session that is mapped from /dev/EtherCAT<n>.
 *
 * What the kernel reads there was written by an application that may be broken:
 * it is read once, and checked or cut.
 */
#ifndef EC_UAPI_ETHERCAT_MAP_H
#define EC_UAPI_ETHERCAT_MAP_H

#include <linux/types.h>

#define EC_UAPI_DEVICES		2

/*
 * Activation lays out the memory to map from the device file:
 *   EC_MMAP_IMAGE     process image of all domains, read-write
 *   EC_MMAP_STATUS    struct ec_status, read-only
 *   EC_MMAP_REQUESTS  struct ec_request_area, read-write
 *   EC_MMAP_EXCHANGE  instead of the image, when the kernel runs the cycle:
 *                     struct ec_exchange and its buffers, read-write
 */
#define EC_MMAP_IMAGE		0x00000000ULL
#define EC_MMAP_STATUS		0x40000000ULL
#define EC_MMAP_REQUESTS	0x60000000ULL
#define EC_MMAP_EXCHANGE	0x80000000ULL

/* struct ec_request_record.op */
#define EC_REQUEST_OP_READ	0
#define EC_REQUEST_OP_WRITE	1
#define EC_REQUEST_OP_READWRITE	2	/* registers: writes, gets what was there */
#define EC_REQUEST_OP_READ_NOW	3	/* VoE: what is in the mailbox, else an error */

/*
 * One request. The application fills in what to do, then changes @start and
 * sets EC_SEND_FLAG_REQUESTS in the next send; when the kernel runs the cycle it
 * adds 1 to @starts of the area instead. The kernel fills in the result,
 * then @done. The data lie at @data in the area: until then the kernel's.
 */
struct ec_request_record {
	/* application */
	__u32 start;		/* any other number than before, not 0 */
	__u32 size;		/* bytes to write; registers: to read, too */
	__u32 timeout_ms;	/* to begin with it; 0: unlimited. VoE: none of it */
	__u16 index;		/* object; register address; IDN; VoE: type */
	__u8 subindex;		/* SoE: drive */
	__u8 op;		/* EC_REQUEST_OP_* */
	__u32 flags;		/* SDO: EC_SDO_FLAG_COMPLETE */
	__u32 vendor_id;	/* VoE */
	/* kernel */
	__u32 done;		/* @start of the last one that has ended */
	__s32 result;		/* 0 or -errno */
	__u32 got;		/* bytes read */
	__u32 abort_code;	/* of the slave: SDO abort code, SoE error code */
	__u32 data;		/* offset in the area */
	__u32 got_vendor_id;	/* VoE: of the message read last */
	__u16 got_type;
	__u16 reserved;
	__u32 reserved2[3];
};

/* Emergencies of one configuration; both counters wrap. */
struct ec_emerg_ring {
	__u32 tail;		/* taken so far; application */
	__u32 head;		/* put in so far; kernel */
	__u32 overruns;		/* lost so far; kernel */
	__u32 count;		/* entries */
	__u32 data;		/* offset in the area of @count times 8 bytes */
	__u32 reserved;
};

#define EC_REQUEST_MAGIC	0x45435251	/* "ECRQ" */
#define EC_EMERG_BYTES		8	/* code, register, data, as in the message */

/* what lies at EC_MMAP_REQUESTS; offsets from its begin */
struct ec_request_area {
	__u32 magic;
	__u32 request_count;
	__u32 requests;		/* offset of struct ec_request_record, by index */
	__u32 ring_count;	/* one per configuration */
	__u32 rings;		/* offset of struct ec_emerg_ring, by configuration */
	__u32 starts;		/* requests started; application */
	__u32 reserved[2];
};

#define EC_STATUS_MAGIC		0x45435354	/* "ECST" */
#define EC_STATUS_DOMAINS	64
#define EC_STATUS_CONFIGS	4096

/* working counter of one domain, as of the last receive */
struct ec_status_domain {
	__u32 working_counter;
	__u32 wc_state;		/* 0 zero, 1 incomplete, 2 complete */
	__u16 redundancy_active;
	__u16 age;		/* sends of the domain since that of the newest frame back */
	__u32 expected;
};

/* bits 0-3 AL state, 4 online, 5 operational */
#define EC_STATUS_SC_AL		0x0f
#define EC_STATUS_SC_ONLINE	0x10
#define EC_STATUS_SC_OP		0x20

/*
 * Buckets of a histogram of times, in ns. Buckets 0 to 7 count 0 to 7 ns. Above,
 * each power of two has eight of the same width: bucket n counts times from
 * (8 + n % 8) << (n / 8 - 1) up to where bucket n + 1 begins. All of 32 bits.
 */
#define EC_CYCLE_BUCKETS	240

/* struct ec_status_cycle.state */
#define EC_CYCLE_STATE_NONE	0	/* the application runs the cycle */
#define EC_CYCLE_STATE_RUNNING	1
#define EC_CYCLE_STATE_STALLED	2	/* no outputs for stall_cycles */
#define EC_CYCLE_STATE_STOPPED	3	/* the same, and EC_STALL_STOP */
#define EC_CYCLE_STATE_WAITING	4	/* for outputs: EC_CYCLE_FLAG_WAIT */

/* struct ec_status_cycle.lock */
#define EC_CYCLE_LOCK_OFF	0	/* not wanted, or no reference clock yet */
#define EC_CYCLE_LOCK_SEEK	1
#define EC_CYCLE_LOCK_LOCKED	2
#define EC_CYCLE_LOCK_HOLD	3	/* no answer; goes on at the last rate */

/*
 * The cycle. "Late" is the distance of a send from its schedule, in ns: of a
 * cycle the kernel runs, from the time of its timer. Of one the application runs,
 * early or late, from a grid of EC_IOC_INTERVAL, or of the measured interval,
 * that follows the sends by at most 1/1024 of the interval and 1 us each.
 * EC_IOC_CYCLE_RESET begins all but @cycle and @state anew.
 */
struct ec_status_cycle {
	__u64 cycle;		/* kernel: cycles so far; inputs are in the exchange */
	__u64 overruns;		/* cycles left out: a period or more late */
	__u64 missed;		/* kernel: without new outputs, after the first ones */
	__u64 late_sum;
	__u64 late_count;	/* sends that were counted */
	__u32 late_min;
	__u32 late_max;
	__u32 state;		/* EC_CYCLE_STATE_* */
	__u32 work_ns;		/* kernel: how long the last cycle took */
	__u32 work_max;
	__u32 takeovers;	/* by another application, after the first detached */
	__u64 work_sum;
	__u64 work_count;
	__u64 late[EC_CYCLE_BUCKETS];
	__u32 lock;		/* EC_CYCLE_LOCK_* */
	__s32 phase_error;	/* to the reference clock, ns, positive: late */
	__s32 rate_ppb;		/* of the reference clock against ktime */
	__u32 lock_losses;
};

/* what the main or the backup device reaches */
struct ec_status_link {
	__u32 slaves_responding;
	__u32 al_states;
	__u32 link_up;
	__u32 reserved;
};

/*
 * Read-only page(s) of an activated master. Each field is written by one
 * aligned store and may be read at any time; @cycle counts receives. A 64-bit field
 * is that for kernels and programs of 64 bits only. Others read @sequence until it
 * is even, then the field, then @sequence, until both are the same. The kernel is not
 * preempted while it is odd.
 */
struct ec_status {
	__u32 magic;
	__u32 size;
	__u64 cycle;
	__u32 slaves_responding;
	__u32 al_states;
	__u32 link_up;
	__u32 config_count;
	__u64 reserved1[2];
	__u64 dc_time;		/* reference clock's, of the last EC_SEND_FLAG_SYNC_SLAVES */
	__u32 dc_time_valid;	/* that datagram came back */
	__u32 dc_monitor;	/* OR of the slaves' differences, ns; ~0: not back */
	__u32 dc_ref;		/* there is a reference clock */
	__u32 no_device;	/* kernel: the last cycle had none to send with */
	struct ec_status_domain domains[EC_STATUS_DOMAINS];
	__u8 configs[EC_STATUS_CONFIGS];
	struct ec_status_cycle kernel;
	__u64 dc_time64;	/* reference clock's, of the last EC_SEND_FLAG_REF_TIME */
	__u32 dc_time64_valid;	/* that datagram came back */
	__u32 link_count;
	struct ec_status_link links[EC_UAPI_DEVICES];
	__u32 sequence;		/* odd: 64-bit values are being written */
	__u32 reserved;
};

/*
 * Exchange of process images with a cycle the kernel runs: three buffers for
 * outputs, three for inputs. Of each three the writer has one, the reader has
 * one, and the third is named by a word. Who has written a buffer exchanges its
 * number, with EC_EXCHANGE_NEW, for the word; who finds that bit set exchanges
 * his number for the word. Both atomically; so nobody ever waits, and nobody sees
 * half an image. @app_output and @app_input are the buffers the application has
 * at first; that output buffer has the whole image as it is at this time.
 *
 * Output buffer n begins at EC_EXCHANGE_FIRST + n * stride, input buffer n at
 * EC_EXCHANGE_FIRST + (3 + n) * stride: struct ec_exchange_buffer, then the
 * image of all domains. The kernel takes the outputs of an output buffer; what lies in
 * the places of inputs there means nothing.
 */
#define EC_EXCHANGE_BUFFERS	3
#define EC_EXCHANGE_NEW		4U
#define EC_EXCHANGE_FIRST	192

struct ec_exchange {
	__u32 outputs;		/* the word of the outputs */
	__u32 reserved[15];
	__u32 inputs;		/* the word of the inputs */
	__u32 reserved2[15];
	__u32 stride;		/* bytes, written before activation ends */
	__u32 app_output;	/* the same */
	__u32 app_input;	/* the same */
	__u32 reserved3[13];
};

/* in front of an image; filled for inputs */
struct ec_exchange_buffer {
	__u64 cycle;		/* as struct ec_status_cycle.cycle */
	__u64 time_ns;		/* schedule of that cycle, CLOCK_MONOTONIC */
	__u64 reserved[6];
	struct ec_status_domain domains[EC_STATUS_DOMAINS];
};

#endif
