// SPDX-License-Identifier: GPL-2.0-only
/* The command that changes a device of a master. */
#include <linux/capability.h>
#include "ioctl.h"
#include "master.h"
#include "../link/device.h"
#include "../link/spec.h"
#include "../session/session.h"
#include "../bus/bus_list.h"
#include "../bus/ring_break.h"

/* a backup device may be none */
static int check_name(struct ec_call *call, const struct ec_ioc_device_use *i)
{
	size_t len = strnlen(i->name, sizeof(i->name));

	if (len < sizeof(i->name) && ec_spec_is_valid(i->name))
		return 0;
	if (!len && i->flags & EC_DEVICE_FLAG_BACKUP)
		return 0;
	return ec_refuse(call, -EINVAL,
			 "\"%*pE\" is neither a MAC address, as 00:11:22:33:44:55, nor a PCI address, as 0000:01:00.0, nor the name of an interface",
			 (int)len, i->name);
}

static int refuse_release(struct ec_call *call, int err, const char *name, unsigned int rival)
{
	if (err == -EEXIST)
		return 0;
	if (err == -EBUSY)
		return ec_refuse(call, err, "%s is the device of master %u", name, rival);
	if (err == -EINVAL)
		return ec_refuse(call, err,
				 "with a backup device both ends of the ring need the name of their device, not ff:ff:ff:ff:ff:ff");
	return err;
}

static const char *or_none(const char *name)
{
	return *name ? name : "none";
}

/*
 * A scan without a device forgets the slaves of the old one. Otherwise slaves at the new device
 * with the same addresses would be taken for them. A line becomes a ring, and a ring a line, while
 * no slave is known.
 */
static int change(struct ec_call *call, unsigned int as, const char *name, const char *was)
{
	struct ec_master *m = call->master;
	int ret, back;

	ec_bus_rescan(&m->bus);
	ret = ec_bus_wait_scan(&m->bus);
	if (!ret && as == EC_BACKUP)
		ec_ring_forget(&m->bus, !*name);
	ret = ret ?: ec_device_use(&m->links, as, name);
	back = ret ? ec_device_use(&m->links, as, was) : 0;
	if (as == EC_BACKUP)
		ec_device_reopen(&m->links);
	if (!ret) {
		ec_info(m, "%s device %s instead of %s\n", as ? "backup" : "main", or_none(name),
			or_none(was));
		ec_bus_wait_scan(&m->bus);
		return 0;
	}
	if (ret == -EINTR)
		return ret;
	return ec_refuse(call, ret,
			 "no driver offers %s, or it cannot be used ('dmesg'); load ec_generic, or the driver of the card; master %u %s %s",
			 or_none(name), m->base->index, back ? "waits for" : "keeps",
			 *was ? was : "no backup device");
}

static int use(struct ec_call *call, unsigned int as, const char *name)
{
	struct ec_links *l = &call->master->links;
	char was[EC_UAPI_STRING];
	unsigned int rival;
	int ret;

	ec_links_name(l, ec_links_named(l, as), was, sizeof(was));
	ret = ec_device_release(l, as, name, &rival);
	return ret ? refuse_release(call, ret, name, rival) : change(call, as, name, was);
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
	ret = use(call, i->flags & EC_DEVICE_FLAG_BACKUP ? EC_BACKUP : EC_MAIN, i->name);
	ec_sessions_resume(&call->master->sessions);
	return ret;
}
