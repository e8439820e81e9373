// SPDX-License-Identifier: LGPL-2.1-or-later
/* Commands of the kernel, and the line that reports why one failed. */

#include <sys/ioctl.h>

#include "internal.h"

int ec_command(const struct ec_master *m, unsigned int cmd, void *arg)
{
	return ioctl(m->fd, cmd, arg) < 0 ? -errno : 0;
}

/* A device file cannot be opened, cause in errno: print a line with the remedy. */
int ec_cannot_open(const char *path)
{
	const char *hint = "";
	int err = errno;

	if (err == ENOENT || err == ENXIO || err == ENODEV)
		hint = ": start the masters: 'ethercatctl start', or load ec_master with main_devices=...";
	else if (err == EACCES || err == EPERM)
		hint = ": members of the group that owns the file may use it";
	fprintf(stderr, "Failed to open %s: %m%s\n", path, hint);
	errno = err;
	return -err;
}

/* Print a line on stderr; it ends with the reason of a command that failed. */
int ec_complain(const struct ec_master *m, const struct ec_slave_config *sc, int err,
		bool with_reason, const char *fmt, ...)
{
	struct ec_ioc_reason reason = { 0 };
	char what[160], slave[48] = "";
	va_list ap;

	if (!err || (with_reason && !m))
		return err;
	if (with_reason && ec_command(m, EC_IOC_REASON, &reason))
		reason.text[0] = '\0';
	reason.text[sizeof(reason.text) - 1] = '\0';
	reason.text[strcspn(reason.text, "\n")] = '\0';
	va_start(ap, fmt);
	vsnprintf(what, sizeof(what), fmt, ap);
	va_end(ap);
	if (sc && sc->group)
		snprintf(slave, sizeof(slave), " of member %u of group %u", sc->position,
			 sc->group - 1);
	else if (sc)
		snprintf(slave, sizeof(slave), " of slave %u:%u", sc->alias, sc->position);
	errno = -err;	/* for %m */
	/* one write per line, so that lines of several threads stay whole */
	fprintf(stderr, "Failed to %s%s: %m%s%s\n", what, slave, *reason.text ? ": " : "",
		reason.text);
	errno = -err;
	return err;
}
