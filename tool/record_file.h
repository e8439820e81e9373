/* SPDX-License-Identifier: GPL-2.0-only */
/* A recording as a file: CSV, or a structured array of NumPy. */
#ifndef EC_TOOL_RECORD_FILE_H
#define EC_TOOL_RECORD_FILE_H

#include "data_types.h"
#include "save.h"

#define RECORD_FIXED	5	/* columns before the values */

/* what a column contains */
struct record_column {
	const char *name;
	const char *unit;	/* "": none */
	enum ec_type_kind kind;	/* EC_KIND_BOOL, _INT, _UINT, _BITS, _FLOAT */
	unsigned int bits;	/* 1 to 64 */
	bool scaled;		/* a real number that was computed: 15 digits are exact */
};

/* one cycle; times are of CLOCK_MONOTONIC */
struct record_row {
	s64 time_ns;
	u64 app_time_ns;
	u64 cycle;
	u64 lost;		/* records before this one that are missing */
	u64 wc_state;		/* ECT_WC_* */
	const u64 *bits;	/* of each column of values */
};

/**
 * struct record_file - a file while it is written
 * @path: of the file, NULL: stdout
 * @old: the file that exists and is replaced at the end; its stream is NULL: @path is new
 * @fd: what is written
 * @regular: a file of a file system, which can be shortened; else a pipe or a device
 * @npy: a NumPy array, else CSV
 * @columns: of values
 * @n: how many
 * @zero_ns: row time that is 0 in the file
 * @wall_ns: the same as time since 1970
 * @title: of the recording
 * @buf: rows that are not written yet
 * @used: bytes there
 * @room: bytes that fit there
 * @head: bytes of the header, 0: there is none so far
 * @rows: so far, also in @buf
 * @written: bytes of the file, whole rows
 * @err: errno of the first failed write, 0: none
 */
struct record_file {
	const char *path;
	struct save old;
	int fd;
	bool regular;
	bool npy;
	const struct record_column *columns;
	size_t n;
	s64 zero_ns;
	s64 wall_ns;
	const char *title;
	char *buf;
	size_t used;
	size_t room;
	size_t head;
	u64 rows;
	u64 written;
	int err;
};

/* 0, or 1 after printing what is wrong */
int record_file_open(struct record_file *f, const char *path, bool force,
		     const struct record_column *columns, size_t n);
/* before the first row */
void record_file_begin(struct record_file *f, s64 zero_ns, s64 wall_ns, const char *title);
void record_file_row(struct record_file *f, const struct record_row *row);
void record_file_flush(struct record_file *f);
/* 0, or 2 after printing what was not written; a file has whole rows in any case */
int record_file_close(struct record_file *f);
/* nothing was recorded: the file is as before */
void record_file_drop(struct record_file *f);

#endif
