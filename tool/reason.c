// SPDX-License-Identifier: GPL-2.0-only
/* The reason of a failure. */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "dev.h"

/* The cause alone: @text names SDO and slave already, "SDO 0x1018:01 of slave 1: no CoE mailbox". */
static const char *cause_of(const char *reason, const char *text)
{
	const char *of = strstr(reason, " of slave "), *colon = of ? strchr(of, ':') : NULL;
	char slave[16];

	if (!colon || colon - of >= (int)sizeof(slave) || colon[1] != ' ')
		return reason;
	snprintf(slave, sizeof(slave), "%.*s:", (int)(colon - of - 4), of + 4);
	return strstr(text, slave) ? colon + 2 : reason;
}

/* report the failure @err of the library, with its reason */
int dev_fail(struct dev *d, int err, const char *fmt, ...)
{
	const char *reason = ect_reason(d->h);
	char text[512];
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(text, sizeof(text), fmt, ap);
	va_end(ap);
	return fail_cause(-err, reason, cause_of(reason, text), "%s", text);
}
