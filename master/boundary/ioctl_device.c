// SPDX-License-Identifier: GPL-2.0-only
/* The command that changes the main device of a master. */
#include <linux/capability.h>
#include "ioctl.h"
#include "master.h"
#include "../link/device.h"
#include "../link/spec.h"
#include "../session/session.h"
#include "../bus/bus_list.h"

static int check_name(struct ec_call *call, const struct ec_ioc_device_use *i)
{
	size_t len = strnlen(i->name, sizeof(i->name));

	if (len < sizeof(i->name) && ec_spec_is_valid(i->name))
		return 0;
	return ec_refuse(call, -EINVAL,
			 "\"%*pE\" is neither a MAC address, as 00:11:22:33:44:55, nor a PCI address, as 0000:01:00.0, nor the name of an interface",
			 (int)len, i->name);
}

/*
 * A scan without a device forgets the slaves of the old one. Otherwise slaves at the new device
 * with the same addresses would be taken for them.
 */
static int change(struct ec_call *call, const char *name)
{
	struct ec_master *m = call->master;
	char was[EC_UAPI_STRING];
	unsigned int rival;
	int ret, back;

	ec_links_name(&m->links, ec_links_named(&m->links, 0), was, sizeof(was));
	ret = ec_device_release(&m->links, name, &rival);
	if (ret == -EEXIST)
		return 0;
	if (ret)
		return ec_refuse(call, ret, "%s is the device of master %u", name, rival);
	ec_bus_rescan(&m->bus);
	ret = ec_bus_wait_scan(&m->bus) ?: ec_device_use(&m->links, name);
	if (!ret) {
		ec_info(m, "main device %s instead of %s\n", name, was);
		ec_bus_wait_scan(&m->bus);
		return 0;
	}
	back = ec_device_use(&m->links, was);
	if (ret == -EINTR)
		return ret;
	return ec_refuse(call, ret,
			 "no driver offers %s, or it cannot be used ('dmesg'); load ec_generic, or the driver of the card; master %u %s %s",
			 name, m->base->index, back ? "waits for" : "keeps", was);
}

int ec_ioc_device_use(struct ec_call *call)
{
	const struct ec_ioc_device_use *i = call->arg;
	int ret;

	/* no other program can use the interface afterwards */
	if (!capable(CAP_NET_ADMIN))
		return ec_refuse(call, -EPERM, "a change of the device needs root (CAP_NET_ADMIN)");
	ret = check_name(call, i);
	if (ret)
		return ret;
	if (ec_sessions_pause(&call->master->sessions, "is about to use another device"))
		return ec_ioc_refuse_reserved(call);
	ret = change(call, i->name);
	ec_sessions_resume(&call->master->sessions);
	return ret;
}
