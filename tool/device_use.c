// SPDX-License-Identifier: GPL-2.0-only
/* A master gets another network card. */
#include <ifaddrs.h>
#include <net/if.h>
#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>

#include "dev.h"
#include "device_use.h"
#include "nic.h"

/* An interface with an IP address of its own, not one that it has given itself. */
static bool has_address(const char *name, char *text, socklen_t size)
{
	struct ifaddrs *all, *i;
	bool found = false;

	if (getifaddrs(&all))
		return false;
	for (i = all; i && !found; i = i->ifa_next) {
		const struct sockaddr_in6 *in6 = (const void *)i->ifa_addr;
		socklen_t len;

		if (!i->ifa_addr || strcmp(i->ifa_name, name))
			continue;
		if (i->ifa_addr->sa_family == AF_INET)
			len = sizeof(struct sockaddr_in);
		else if (i->ifa_addr->sa_family == AF_INET6 &&
			 !IN6_IS_ADDR_LINKLOCAL(&in6->sin6_addr))
			len = sizeof(*in6);
		else
			continue;
		found = !getnameinfo(i->ifa_addr, len, text, size, NULL, 0, NI_NUMERICHOST);
	}
	freeifaddrs(all);
	return found;
}

/* It may be the interface that the user is logged in by. */
static int check_address(const struct tool *t, const char *interface)
{
	char address[64];

	if (t->force || !has_address(interface, address, sizeof(address)))
		return 0;
	return fail("%s has the address %s; 'ip address flush dev %s' first, or use --force",
		    interface, address, interface);
}

/*
 * The name by which the master knows the card: the whole PCI address of a card with its native
 * driver, otherwise the MAC address or interface that the user has given.
 */
static int name_of(const struct tool *t, struct nics *all, const char *name, char *buf, size_t size)
{
	const struct nic *n = nic_find(all, name);

	if (!n)
		return 1;
	if (!strcmp(n->driver, NIC_NATIVE))
		snprintf(buf, size, "%s", n->pci);
	else if (!strcmp(name, n->name) || !strcasecmp(name, n->mac))
		return check_address(t, n->name);
	else if (*n->name)
		return fail("%s has not its native driver; use its interface %s, or 'ethercat device bind %s' first",
			    n->pci, n->name, n->pci);
	else
		return fail("%s has no driver; 'ethercat device bind %s' first", n->pci, n->pci);
	return 0;
}

static int name_for_master(const struct tool *t, const char *name, char *buf, size_t size)
{
	struct nics all;
	int ret;

	snprintf(buf, size, "%s", name);
	if (!strncmp(name, "sim", 3) || !strcasecmp(name, "ff:ff:ff:ff:ff:ff") ||
	    (t->backup && !strcmp(name, "none")))
		return 0;
	/* 'ethercat devices' does not list those of software */
	if (if_nametoindex(name))
		return check_address(t, name);
	ret = nics_read(&all) || name_of(t, &all, name, buf, size);
	nics_free(&all);
	return ret;
}

int device_use(const struct tool *t, const char *name)
{
	char own[ECT_STRING];
	struct dev d;
	int err;

	if (t->boot)
		return usage_error("use has no --boot; write main_devices= and backup_devices= of ec_master into /etc/modprobe.d");
	if (name_for_master(t, name, own, sizeof(own)) || dev_open_single(&d, t, true))
		return 1;
	if (t->backup)
		err = ect_backup_use(d.h, strcmp(own, "none") ? own : NULL);
	else
		err = ect_device_use(d.h, own);
	if (err)
		dev_fail(&d, err, "Master%u: cannot use %s", d.master, name);
	dev_close(&d);
	return err != 0;
}
