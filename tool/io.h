/* SPDX-License-Identifier: GPL-2.0-only */
/* Values on the command line, in files and on stdout; functions print errors. */
#ifndef EC_TOOL_IO_H
#define EC_TOOL_IO_H

#include "tool.h"
#include "value.h"

int io_number(const char *what, const char *text, u64 max, u64 *v);
int io_type(const char *name, const struct ec_type **t);
int io_read_any(const char *path, u8 **data, size_t *size);
int io_read(const char *path, u8 **data, size_t *size);
int io_value(const struct ec_type *t, const char *text, u8 **data, size_t *size);
int io_print(const struct ec_type *t, const u8 *data, size_t size);

#endif
