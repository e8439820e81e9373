/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* libethercat-tools: values of a running session, recorded in each cycle. */
#ifndef ETHERCAT_TOOLS_RECORD_H
#define ETHERCAT_TOOLS_RECORD_H

#include "run.h"

#ifdef __cplusplus
extern "C" {
#endif

struct ect_recording;

/* what is recorded, and for how long the reader may be late */
struct ect_record_info {
	uint32_t struct_size;
	uint32_t kept;		/* records that the master keeps for a reader */
	uint32_t record_size;	/* bytes of a record */
	uint32_t reserved;
	uint64_t next;		/* number of the first record */
};

/* one cycle */
struct ect_record {
	uint32_t struct_size;
	uint32_t wc_state;	/* of all recorded domains the worst one, ECT_WC_* */
	uint64_t number;	/* never reused */
	uint64_t missed;	/* records before it that this reader was too slow for */
	uint64_t time_ns;	/* of the send, CLOCK_MONOTONIC */
	uint64_t app_time_ns;	/* application time, since 2000; 0: none was set */
	uint64_t cycle;		/* sends since activation */
	uint64_t sent;		/* domains sent in this cycle, bit n: domain n */
};

/**
 * ect_record_begin() - record values in each cycle from now on
 * @h: master, which reads nothing else; one opened for reading only is enough
 * @values: some of those of ect_values_read()
 * @n: how many
 * @r: result, for ect_record_free()
 * @info: result, with its struct_size; may be NULL
 *
 * Inputs are those that the cycle has received, outputs those that it has sent. The session may be
 * that of an application. The master copies its process data in each cycle while there is a
 * recording, which costs the cycle an instruction for 8 bytes, or two.
 *
 * Context: The thread of the handle; no traffic.
 * Return: 0; -ENOENT without a session; -ERANGE another session has begun since the values were
 * read, which is noticed if its process data are shorter or have fewer domains; -EUSERS too many
 * programs record; -EBUSY the handle reads something else; or another negative errno.
 */
int ect_record_begin(struct ect_handle *h, const struct ect_value *const *values, size_t n,
		     struct ect_recording **r, struct ect_record_info *info);

/**
 * ect_record_read() - the next record
 * @r: recording
 * @to: result, with its struct_size
 *
 * Waits for a record if there is none; poll() on ect_fd() says when there is one, unless
 * ect_record_waiting() is not 0.
 *
 * Context: The thread of the handle.
 * Return: 0; -EINTR a signal has ended the wait; -ENODATA the session has ended;
 * -ENOBUFS likewise, and its last records were dropped for newer recordings; or another
 * negative errno.
 */
int ect_record_read(struct ect_recording *r, struct ect_record *to);

/**
 * ect_record_waiting() - records that ect_record_read() returns without asking the kernel
 * @r: recording
 *
 * Context: The thread of the handle.
 * Return: how many.
 */
size_t ect_record_waiting(const struct ect_recording *r);

/**
 * ect_record_bits() - a value of the record that was read last
 * @r: recording
 * @i: index of the value
 *
 * Context: The thread of the handle.
 * Return: its bits, at most 64; bit 0 is the first one.
 */
uint64_t ect_record_bits(const struct ect_recording *r, size_t i);

/**
 * ect_record_free() - free a recording
 * @r: recording, may be NULL; the master records until the handle is closed
 *
 * Context: The thread of the handle.
 */
void ect_record_free(struct ect_recording *r);

#ifdef __cplusplus
}
#endif

#endif
