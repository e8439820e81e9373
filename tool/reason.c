// SPDX-License-Identifier: GPL-2.0-only
/* The kernel's reason for a failure. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "dev.h"
#include "sys.h"
#include "text.h"

/* the kernel's reason for the failure @err of the last dev_ioctl(), "" if there is none */
void dev_reason(struct dev *d, int err, char *buf, size_t size)
{
	struct ec_ioc_reason reason = { 0 };
	char older[128];

	if (sys_ioctl(d->fd, EC_IOC_REASON, &reason))
		reason.text[0] = 0;
	string_clean(reason.text, sizeof(reason.text));
	if (err == ENOTTY && !reason.text[0] && d->version.abi != EC_UAPI_VERSION) {
		snprintf(older, sizeof(older), "the module has interface version %u, this tool %u",
			 d->version.abi, EC_UAPI_VERSION);
		memcpy(reason.text, older, sizeof(older));
	}
	snprintf(buf, size, "%s", reason.text);
}

/* What was done to which slave is in @text already: "SDO 0x1018:01 of slave 1: no CoE mailbox". */
static const char *cause_of(const char *reason, const char *text)
{
	const char *of = strstr(reason, " of slave "), *colon = of ? strchr(of, ':') : NULL;
	char slave[16];

	if (!colon || colon - of >= (int)sizeof(slave) || colon[1] != ' ')
		return reason;
	snprintf(slave, sizeof(slave), "%.*s:", (int)(colon - of - 4), of + 4);
	return strstr(text, slave) ? colon + 2 : reason;
}

/* report the failure @err of the last dev_ioctl(), with the kernel's reason */
int dev_fail(struct dev *d, int err, const char *fmt, ...)
{
	char text[512], reason[EC_UAPI_REASON];
	va_list ap;

	dev_reason(d, err, reason, sizeof(reason));
	va_start(ap, fmt);
	vsnprintf(text, sizeof(text), fmt, ap);
	va_end(ap);
	return fail_cause(err, reason, cause_of(reason, text), "%s", text);
}
