/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Memory of an active session that is mapped from /dev/EtherCAT<n>.
 *
 * An application may write any value there: the kernel reads each field once, and checks or
 * limits it.
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
#define EC_REQUEST_OP_READWRITE	2	/* registers: write, and read the old content */
#define EC_REQUEST_OP_READ_NOW	3	/* VoE: read the mailbox at once */

/*
 * One request. The application writes its fields, then changes @start and sets
 * EC_SEND_FLAG_REQUESTS in the next send; when the kernel runs the cycle, the application adds 1
 * to @starts of the area instead. To cancel a request it copies @start to @cancel and notifies the
 * kernel in the same way. The kernel writes the result, then @done. The data are at @data in the
 * area; from @start to @done only the kernel accesses them. FoE: the EC_FOE_NAME bytes before
 * @data have the name of the file; it ends with them, or at a zero.
 */
struct ec_request_record {
	/* application */
	__u32 start;		/* differs from the last value, not 0 */
	__u32 size;		/* bytes to write; registers, datagrams: also to read */
	__u32 timeout_ms;	/* limit of the start; 0: unlimited. Not for VoE */
	__u16 index;		/* object, or type of a list; register address; IDN; VoE: type */
	__u8 subindex;		/* SoE: drive; datagram: command */
	__u8 op;		/* EC_REQUEST_OP_*; datagram: EC_REQUEST_OP_READWRITE */
	__u32 flags;		/* SDO: EC_SDO_FLAG_COMPLETE; SDO information: EC_SDO_INFO_* */
	__u32 vendor_id;	/* VoE; FoE: password; datagram: address */
	/* kernel */
	__u32 done;		/* @start of the last finished request */
	__s32 result;		/* 0 or -errno */
	__u32 got;		/* bytes read */
	__u32 abort_code;	/* of the slave: SDO abort code, SoE or FoE error code */
	__u32 data;		/* offset in the area */
	__u32 got_vendor_id;	/* VoE: of the last received message */
	__u16 got_type;		/* likewise; datagram: working counter */
	__u16 reserved;
	__u32 cancel;		/* application: equal to @start: end this request */
	__u32 progress;		/* FoE: bytes so far; the application sets 0 before @start */
	__u32 reserved2;
};

/* Emergencies of one configuration; both counters wrap. */
struct ec_emerg_ring {
	__u32 tail;		/* number read; application */
	__u32 head;		/* number written; kernel */
	__u32 overruns;		/* number dropped; kernel */
	__u32 count;		/* entries */
	__u32 data;		/* offset in the area of @count times 8 bytes */
	__u32 reserved;
};

#define EC_REQUEST_MAGIC	0x45435251	/* "ECRQ" */
#define EC_EMERG_BYTES		8	/* code, register, data, as in the message */

/* head of EC_MMAP_REQUESTS; offsets count from its begin */
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

/* of a working counter: no slave has taken part, some, or all in each datagram */
#define EC_STATUS_WC_ZERO	0
#define EC_STATUS_WC_INCOMPLETE	1
#define EC_STATUS_WC_COMPLETE	2

/* working counter of one domain, as of the last receive */
struct ec_status_domain {
	__u32 working_counter;
	__u32 wc_state;		/* EC_STATUS_WC_* */
	__u16 redundancy_active;
	__u16 age;		/* sends of the domain since that of the newest received frame */
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
#define EC_CYCLE_LOCK_OFF	0	/* not configured, or no reference clock */
#define EC_CYCLE_LOCK_SEEK	1
#define EC_CYCLE_LOCK_LOCKED	2
#define EC_CYCLE_LOCK_HOLD	3	/* holdover: no reply, last rate kept */

/*
 * Statistics of the cycle. "Late" is the send deviation, ns. The schedule of a cycle run by the
 * kernel is its timer. For a cycle run by the application it is a grid of EC_IOC_INTERVAL,
 * otherwise of the measured interval, that adapts to the sends by at most 1/1024 of the interval
 * and 1 us per send; the deviation may be early or late. EC_IOC_CYCLE_RESET clears all fields
 * except @cycle and @state.
 */
struct ec_status_cycle {
	__u64 cycle;		/* kernel: cycles so far; inputs are in the exchange */
	__u64 overruns;		/* skipped cycles: a period or more passed without a send */
	__u64 missed;		/* kernel: without new outputs, after the first ones */
	__u64 late_sum;
	__u64 late_count;	/* number of sends */
	__u32 late_min;
	__u32 late_max;
	__u32 state;		/* EC_CYCLE_STATE_* */
	__u32 work_ns;		/* kernel: execution time of the last cycle */
	__u32 work_max;
	__u32 takeovers;	/* number of takeovers of a detached session */
	__u64 work_sum;
	__u64 work_count;
	__u64 late[EC_CYCLE_BUCKETS];
	__u32 lock;		/* EC_CYCLE_LOCK_* */
	__s32 phase_error;	/* to the reference clock, ns, positive: late */
	__s32 rate_ppb;		/* of the reference clock against ktime */
	__u32 lock_losses;
};

/* slaves that the main or the backup device reaches */
struct ec_status_link {
	__u32 slaves_responding;
	__u32 al_states;
	__u32 link_up;
	__u32 reserved;
};

/*
 * Read-only page(s) of an activated master. The kernel writes each field by one aligned store;
 * a program may read it at any time. @cycle counts receives. For a 64-bit field this applies to
 * kernels and programs of 64 bits only. Other programs read @sequence until it is even, then the
 * field, then @sequence again, until both are equal. The kernel is not preempted while @sequence
 * is odd.
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
	__u32 dc_time_valid;	/* this datagram was received */
	__u32 dc_monitor;	/* OR of the differences of all slaves, ns; ~0: no reply */
	__u32 dc_ref;		/* there is a reference clock */
	__u32 no_device;	/* kernel: the last cycle had no device */
	struct ec_status_domain domains[EC_STATUS_DOMAINS];
	__u8 configs[EC_STATUS_CONFIGS];
	struct ec_status_cycle kernel;
	__u64 dc_time64;	/* reference clock's, of the last EC_SEND_FLAG_REF_TIME */
	__u32 dc_time64_valid;	/* this datagram was received */
	__u32 link_count;
	struct ec_status_link links[EC_UAPI_DEVICES];
	__u32 sequence;		/* odd: 64-bit values are being written */
	__u32 reserved;
	__u32 units[EC_STATUS_DOMAINS];	/* as struct ec_ioc_unit_info.state */
};

/*
 * Exchange of process images with a cycle run by the kernel: three buffers for outputs, three
 * for inputs. Of each three the writer has one and the reader has one; a word contains the
 * number of the third. After writing its buffer, the writer exchanges its number, with
 * EC_EXCHANGE_NEW, for the word. A reader that finds this bit set exchanges its number for the
 * word. Both exchanges are atomic: no side waits or sees an incomplete image. @app_output and
 * @app_input are the initial buffers of the application; this output buffer has the current
 * image.
 *
 * Output buffer n begins at EC_EXCHANGE_FIRST + n * stride, input buffer n at
 * EC_EXCHANGE_FIRST + (3 + n) * stride: struct ec_exchange_buffer, then the image of all domains.
 * The kernel ignores the input bytes of an output buffer.
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

/* precedes an image; valid for inputs, but for @fed */
struct ec_exchange_buffer {
	__u64 cycle;		/* as struct ec_status_cycle.cycle */
	__u64 time_ns;		/* schedule of that cycle, CLOCK_MONOTONIC */
	union {
		__u64 fed;	/* outputs: domains given since the last cycle, bit n: domain n */
		__u64 reserved[6];
	};
	struct ec_status_domain domains[EC_STATUS_DOMAINS];
};

#endif
