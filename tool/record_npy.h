/* SPDX-License-Identifier: GPL-2.0-only */
/* The format of numpy.load(): a header that describes a structure, then structures. */
#ifndef EC_TOOL_RECORD_NPY_H
#define EC_TOOL_RECORD_NPY_H

#include "record_file.h"

void record_wall_text(s64 wall_ns, char *buf, size_t size);

/* bytes of a row */
size_t record_npy_row(const struct record_file *f);
void record_npy_begin(struct record_file *f);
/* the number of rows so far into the header */
void record_npy_count(struct record_file *f);
void record_npy_add(struct record_file *f, const struct record_row *row);

#endif
