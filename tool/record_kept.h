/* SPDX-License-Identifier: GPL-2.0-only */
/* The last records before a condition is true, in memory. */
#ifndef EC_TOOL_RECORD_KEPT_H
#define EC_TOOL_RECORD_KEPT_H

#include <stdbool.h>

#include "record_file.h"

/**
 * struct record_kept - rows in a ring that grows
 * @rows: without values
 * @bits: values of all rows
 * @n: values of a row
 * @room: rows that fit
 * @first: the oldest one
 * @count: how many there are
 */
struct record_kept {
	struct record_row *rows;
	u64 *bits;
	size_t n;
	size_t room;
	size_t first;
	size_t count;
};

/* 0, or 1 without memory */
int record_kept_init(struct record_kept *k, size_t n);
void record_kept_free(struct record_kept *k);
/* forgets those before @from_ns, then keeps @row; 0, or a negative errno */
int record_kept_add(struct record_kept *k, const struct record_row *row, s64 from_ns);
/* the oldest one from @from_ns on, valid until the next call; false: there is none */
bool record_kept_take(struct record_kept *k, s64 from_ns, struct record_row *row);

#endif
