/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Files of sysfs and procfs: one line each. */
#ifndef EC_LIB_TOOLS_ATTR_H
#define EC_LIB_TOOLS_ATTR_H

#include <stdbool.h>
#include <stddef.h>

/* printf() to a buffer; a text that does not fit is cut */
void attr_path(char *buf, size_t size, const char *fmt, ...)
	__attribute__((format(printf, 3, 4)));
/* the first line of an attribute; false: there is none, @buf is "" */
bool attr_read(const char *dir, const char *name, char *buf, size_t size);
/* 0 when there is none */
unsigned long attr_number(const char *dir, const char *name);

#endif
