/* SPDX-License-Identifier: GPL-2.0-only */
/* Values of SDOs and registers as text. No I/O; wire order is little-endian. */
#ifndef EC_TOOL_VALUE_H
#define EC_TOOL_VALUE_H

#include "data_types.h"

#define VALUE_TEXT	64	/* holds every type but strings and raw */

size_t value_bytes(const struct ec_type *t);
bool value_is_text(const struct ec_type *t);

int number_parse(const char *text, u64 max, u64 *v, const char **why);
int value_parse(const struct ec_type *t, const char *text, size_t len, u8 *buf, size_t cap,
		size_t *size, const char **why);
int value_format(const struct ec_type *t, const u8 *data, size_t size, char *out, size_t cap);
u64 value_unsigned(const u8 *data, size_t size);
s64 value_signed(const struct ec_type *t, const u8 *data, size_t size);
double value_real(const u8 *data, size_t size);

#endif
