// SPDX-License-Identifier: LGPL-2.1-or-later
/* Text that says why something failed, or is not as it should be. */
#include <string.h>

#include "internal.h"

/* One line without its end; returns its full length. */
static int copy_line(char *buf, size_t size, const char *text, size_t room)
{
	size_t len = strnlen(text, room), n;
	const char *end = memchr(text, '\n', len);

	if (end)
		len = (size_t)(end - text);
	n = len < size ? len : size - 1;
	if (size) {
		memcpy(buf, text, n);
		buf[n] = '\0';
	}
	return (int)len;
}

int ecrt_master_reason(const ec_master_t *master, char *buf, size_t size)
{
	struct ec_ioc_reason reason = { 0 };
	int ret;

	if (!master || (!buf && size))
		return -EINVAL;
	ret = ec_ioctl(master, EC_IOC_REASON, &reason);
	return ret ? ret : copy_line(buf, size, reason.text, sizeof(reason.text));
}

int ecrt_slave_config_reason(const ec_slave_config_t *sc, char *buf, size_t size)
{
	struct ec_ioc_config_why why = { 0 };
	int ret;

	if (!sc || (!buf && size))
		return -EINVAL;
	why.index = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_CONFIG_WHY, &why);
	return ret ? ret : copy_line(buf, size, why.text, sizeof(why.text));
}
