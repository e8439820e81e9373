/* SPDX-License-Identifier: GPL-2.0 WITH Linux-syscall-note */
/*
 * Records of process data: one for each cycle, as inputs were received and outputs were sent.
 *
 * EC_IOC_RECORDER makes an open file a reader of records, also one opened for reading only. It
 * needs an active session, its own or that of another application. From then on read() returns
 * whole records, and poll() reports new ones, at most 20 ms late. Each reader has a position of its
 * own, and takes nothing from others. All readers of a master share one ring of @kept records, at
 * most EC_RECORD_RING bytes: the record behind a gap has the exact number of those that the reader
 * was too slow for. After the end of the session read() returns what is left, then -ENODATA; with
 * rings of three ended sessions the oldest one is dropped for the next: -ENOBUFS.
 *
 * The reader names bytes of the image of all domains (@logical of struct ec_ioc_domain is where a
 * domain begins): @data are two masks of @size / 2 bytes each, first of inputs, then of outputs.
 * Bit n % 8 of byte n / 8 is set: byte n of the image is wanted. A record is struct ec_record, then
 * the wanted bytes of inputs, those of outputs, and zeros up to a multiple of 8 bytes.
 */
#ifndef EC_UAPI_ETHERCAT_RECORD_H
#define EC_UAPI_ETHERCAT_RECORD_H

#include <linux/types.h>

#define EC_RECORD_RING		(16 << 20)
#define EC_RECORDERS		16	/* readers of a master at most, */
#define EC_RECORDERS_READ_ONLY	8	/* of these with a file that is opened for reading only */
#define EC_RECORD_AREAS		8192	/* stretches of bytes that are side by side, at most */

struct ec_record {
	__u32 flags;		/* none */
	__u32 size;		/* bytes of the record, with these */
	__u64 number;		/* never reused */
	__u64 missed;		/* records before this one that this reader has missed */
	__u64 time_ns;		/* of the send, CLOCK_MONOTONIC */
	__u64 app_time_ns;	/* application time, since 2000; 0: none was set */
	__u64 cycle;		/* sends since activation */
	__u64 sent;		/* domains sent in this cycle, bit n: domain n */
	__u64 complete;		/* working counters that were complete when last received */
	__u64 zero;		/* those of which no slave has taken part */
};

struct ec_ioc_recorder {
	__u32 flags;		/* none */
	__u32 size;		/* in: bytes at @data */
	__u64 data;		/* in: the masks */
	__u64 next;		/* out: number of the record that comes next */
	__u32 record_size;	/* out: bytes of a record */
	__u32 kept;		/* out: records that the ring keeps */
};

#endif
