// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"
#include "../tools/text.h"

int ecb_report(struct ecb_error *e, const char *file, size_t line, size_t column,
	       const char *fmt, ...)
{
	size_t n;
	va_list ap;

	e->line = line > UINT32_MAX ? UINT32_MAX : (uint32_t)line;
	e->column = column > UINT32_MAX ? UINT32_MAX : (uint32_t)column;
	if (line && column)
		snprintf(e->text, sizeof(e->text), "%.200s:%zu:%zu: ", file, line, column);
	else if (line)
		snprintf(e->text, sizeof(e->text), "%.200s:%zu: ", file, line);
	else
		snprintf(e->text, sizeof(e->text), "%.200s: ", file);
	n = strlen(e->text);
	va_start(ap, fmt);
	vsnprintf(e->text + n, sizeof(e->text) - n, fmt, ap);
	va_end(ap);
	string_clean(e->text, sizeof(e->text));
	return -EINVAL;
}
