// SPDX-License-Identifier: LGPL-2.1-or-later
/* The one way to the kernel, and the one line that says why it failed. */

#include <sys/ioctl.h>

#include "internal.h"

int ec_command(const struct ec_master *m, unsigned int cmd, void *arg)
{
	return ioctl(m->fd, cmd, arg) < 0 ? -errno : 0;
}

/* One write per line, so that lines of several threads stay whole. */
static void print(int err, const char *what, const char *slave, const char *reason)
{
	errno = -err;	/* for %m */
	fprintf(stderr, "Failed to %s%s: %m%s%s\n", what, slave, *reason ? ": " : "", reason);
	errno = -err;
}

/* A line on stderr; it ends with the reason the kernel gives, when it was asked. */
void ec_complain(const struct ec_master *m, const struct ec_slave_config *sc, int err,
		 bool with_reason, const char *fmt, va_list ap)
{
	struct ec_ioc_reason reason = { 0 };
	char what[160], slave[32] = "";

	if (with_reason && ec_command(m, EC_IOC_REASON, &reason))
		reason.text[0] = '\0';
	reason.text[sizeof(reason.text) - 1] = '\0';
	reason.text[strcspn(reason.text, "\n")] = '\0';
	vsnprintf(what, sizeof(what), fmt, ap);
	if (sc)
		snprintf(slave, sizeof(slave), " of slave %u:%u", sc->alias, sc->position);
	print(err, what, slave, reason.text);
}
