// SPDX-License-Identifier: GPL-2.0-only
/* Why something failed, or is not as it should be, for applications in the kernel. */
#include <linux/slab.h>
#include <linux/string.h>
#include "api.h"

/* One line without its end; returns its full length. */
static int copy_line(char *buf, size_t size, const char *text, size_t room)
{
	size_t len = strnlen(text, room);
	const char *end = memchr(text, '\n', len);

	if (end)
		len = end - text;
	if (size) {
		size_t n = min(len, size - 1);

		memcpy(buf, text, n);
		buf[n] = '\0';
	}
	return len;
}

int ecrt_master_reason(const ec_master_t *master, char *buf, size_t size)
{
	struct ec_ioc_reason *r;
	int ret;

	if (!master || (!buf && size))
		return -EINVAL;
	r = kzalloc(sizeof(*r), GFP_KERNEL);
	if (!r)
		return -ENOMEM;
	/* asking is no call that succeeds and has no reason */
	ret = ec_command(master, EC_IOC_REASON, r);
	if (!ret)
		ret = copy_line(buf, size, r->text, sizeof(r->text));
	kfree(r);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_reason);

int ecrt_slave_config_reason(const ec_slave_config_t *sc, char *buf, size_t size)
{
	struct ec_ioc_config_why *why;
	int ret;

	if (!sc || (!buf && size))
		return -EINVAL;
	why = kzalloc(sizeof(*why), GFP_KERNEL);
	if (!why)
		return -ENOMEM;
	why->index = ec_api_config(sc)->index;
	ret = ec_command(ec_api_master(sc), EC_IOC_CONFIG_WHY, why);
	if (!ret)
		ret = copy_line(buf, size, why->text, sizeof(why->text));
	kfree(why);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reason);
