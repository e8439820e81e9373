// SPDX-License-Identifier: LGPL-2.1-or-later
/* The one way to the kernel, and the one line that says why it failed. */

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>

#include "internal.h"

int ec_ioctl(const struct ec_master *m, unsigned long cmd, void *arg)
{
	return ioctl(m->fd, cmd, arg) < 0 ? -errno : 0;
}

/* One write per line, so that lines of several threads stay whole. */
static void complain(int err, const char *reason, const char *fmt, va_list ap)
{
	char what[160];

	vsnprintf(what, sizeof(what), fmt, ap);
	errno = -err;	/* for %m */
	if (reason && *reason)
		fprintf(stderr, "Failed to %s: %m: %s\n", what, reason);
	else
		fprintf(stderr, "Failed to %s: %m\n", what);
	errno = -err;
}

/* Says that something failed which the kernel was not asked. Returns @err. */
int ec_fail(int err, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	complain(err, NULL, fmt, ap);
	va_end(ap);
	return err;
}

/* Says that an ioctl failed, with the reason the kernel gives. */
int ec_fail_ioctl(const struct ec_master *m, int err, const char *fmt, ...)
{
	struct ec_ioc_reason reason = { 0 };
	va_list ap;

	if (ec_ioctl(m, EC_IOC_REASON, &reason))
		reason.text[0] = '\0';
	reason.text[sizeof(reason.text) - 1] = '\0';
	reason.text[strcspn(reason.text, "\n")] = '\0';
	va_start(ap, fmt);
	complain(err, reason.text, fmt, ap);
	va_end(ap);
	return err;
}
