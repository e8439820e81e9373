// SPDX-License-Identifier: LGPL-2.1-or-later
/* Network interfaces and controllers of this computer, from sysfs. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/ethtool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "attr.h"
#include "internal.h"
#include "sys.h"
#include "text.h"

#define INTEL	0x8086
#define MASTERS	32
#define NATIVE	"ec_intel"	/* the native driver */

static const struct {
	unsigned int device;
	const char *name;
	bool tested, me;
} chips[] = {
#define EC_CHIP(id, text, type, runs)	{ id, text, runs, false },
#define EC_CHIP_ME(id, text)		{ id, text, false, true },
#include "../../devices/intel/chips.h"
#undef EC_CHIP_ME
#undef EC_CHIP
};

/* the last part of the target of a symbolic link; false: no such link */
static bool target(const char *dir, const char *name, char *buf, size_t size)
{
	char path[512], to[512];
	const char *last;
	ssize_t n;

	*buf = '\0';
	attr_path(path, sizeof(path), "%s/%s", dir, name);
	n = readlink(path, to, sizeof(to) - 1);
	if (n <= 0)
		return false;
	to[n] = '\0';
	last = strrchr(to, '/');
	attr_path(buf, size, "%s", last ? last + 1 : to);
	return true;
}

static struct ect_card *card(const struct ect_list *all, size_t i)
{
	return ect_list_at(all, i);
}

/* chip and native driver of a PCI function */
static void fill_pci(struct ect_card *n)
{
	unsigned int i;
	char dir[512], override[32];

	attr_path(dir, sizeof(dir), "%s/bus/pci/devices/%s", ect_sys_fs(), n->pci);
	n->vendor = (u32)attr_number(dir, "vendor");
	n->device = (u32)attr_number(dir, "device");
	target(dir, "driver", n->driver, sizeof(n->driver));
	n->kept = !*n->driver && attr_read(dir, "driver_override", override, sizeof(override)) &&
		  !strcmp(override, NATIVE);
	attr_path(n->why_not, sizeof(n->why_not), "no native driver for %04x:%04x", n->vendor,
		  n->device);
	for (i = 0; n->vendor == INTEL && i < sizeof(chips) / sizeof(*chips); i++) {
		if (chips[i].device != n->device)
			continue;
		attr_path(n->chip, sizeof(n->chip), "%s", chips[i].name);
		n->tested = chips[i].tested;
		attr_path(n->why_not, sizeof(n->why_not), "%s", chips[i].me ?
			 "its PHY is shared with the management engine" : "");
	}
}

/* the PCI function of a device, perhaps some levels up; not that of a USB host */
static bool find_pci(const char *device, char *pci, size_t size)
{
	char path[PATH_MAX], bus[32];
	char *last;

	if (!realpath(device, path))
		return false;
	while ((last = strrchr(path, '/')) && last != path) {
		if (target(path, "subsystem", bus, sizeof(bus)) && !strcmp(bus, "pci")) {
			attr_path(pci, size, "%s", last + 1);
			return attr_number(path, "class") >> 16 == 0x02;
		}
		*last = '\0';
	}
	return false;
}

/* Ethernet with hardware of its own; bridges, VLANs and the like have none */
static int add_interface(struct ect_list *all, const char *name)
{
	char dir[512], device[600], pci[32], text[32];
	struct ect_card *n;

	attr_path(dir, sizeof(dir), "%s/class/net/%s", ect_sys_fs(), name);
	attr_path(device, sizeof(device), "%s/device", dir);
	if (attr_number(dir, "type") != 1 || access(device, F_OK))
		return 0;
	n = ect_list_add(all);
	if (!n)
		return -ENOMEM;
	attr_path(n->name, sizeof(n->name), "%s", name);
	attr_read(dir, "address", n->mac, sizeof(n->mac));
	if (find_pci(device, pci, sizeof(pci))) {
		attr_path(n->pci, sizeof(n->pci), "%s", pci);
		fill_pci(n);
	} else {
		attr_path(n->why_not, sizeof(n->why_not), "not a PCI device");
	}
	target(device, "driver", n->driver, sizeof(n->driver));
	/* readable only while the interface is up */
	n->link_known = attr_read(dir, "carrier", text, sizeof(text));
	n->link_up = n->link_known && *text == '1';
	if (n->link_up && attr_read(dir, "speed", text, sizeof(text)) && isdigit(*text))
		n->speed = (unsigned int)atoi(text);
	if (target(dir, "master", text, sizeof(text)))
		attr_path(n->by, sizeof(n->by), "%s (its port)", text);
	else if (attr_number(dir, "flags") & 1)
		attr_path(n->by, sizeof(n->by), "the system (up)");
	return 0;
}

static int add_interfaces(struct ect_list *all)
{
	char path[256];
	struct dirent *e;
	int ret = 0;
	DIR *d;

	attr_path(path, sizeof(path), "%s/class/net", ect_sys_fs());
	d = opendir(path);
	while (d && !ret && (e = readdir(d)))
		if (*e->d_name != '.')
			ret = add_interface(all, e->d_name);
	if (d)
		closedir(d);
	return ret;
}

/* controllers that have no network interface: a native driver has them, or none */
static int add_controllers(struct ect_list *all)
{
	size_t known = all->n, i;
	char path[256], dir[600];
	struct dirent *e;
	struct ect_card *n;
	int ret = 0;
	DIR *d;

	attr_path(path, sizeof(path), "%s/bus/pci/devices", ect_sys_fs());
	d = opendir(path);
	while (d && !ret && (e = readdir(d))) {
		attr_path(dir, sizeof(dir), "%s/%s", path, e->d_name);
		/* PCI class 02 00: Ethernet controller */
		if (*e->d_name == '.' || attr_number(dir, "class") >> 8 != 0x0200)
			continue;
		for (i = 0; i < known && strcmp(card(all, i)->pci, e->d_name); i++)
			;
		attr_path(dir, sizeof(dir), "%s/%s/net", path, e->d_name);
		if (i < known || !access(dir, F_OK))
			continue;
		n = ect_list_add(all);
		if (!n) {
			ret = -ENOMEM;
			break;
		}
		attr_path(n->pci, sizeof(n->pci), "%s", e->d_name);
		fill_pci(n);
	}
	if (d)
		closedir(d);
	return ret;
}

static void claim(struct ect_list *all, unsigned int master, const struct ect_device *d)
{
	for (size_t i = 0; i < all->n; i++) {
		struct ect_card *n = card(all, i);

		if (!d->attached || strcmp(d->name, *n->name ? n->name : n->pci))
			continue;
		attr_path(n->by, sizeof(n->by), "Master%u %s", master, d->index ? "backup" : "main");
		if (!*n->mac)
			attr_path(n->mac, sizeof(n->mac), "%02x:%02x:%02x:%02x:%02x:%02x",
				  d->address[0], d->address[1], d->address[2], d->address[3],
				  d->address[4], d->address[5]);
		n->of_master = true;
		n->link_known = true;
		n->link_up = d->link_up;
		if (d->speed)
			n->speed = d->speed;
	}
}

/* the devices of the masters; without the module there are none */
static int ask_masters(struct ect_list *all)
{
	struct ect_handle *h = ect_new();
	int ret = 0;

	if (!h)
		return -ENOMEM;
	for (unsigned int i = 0; i < MASTERS && !ect_open(h, i, 0); i++) {
		struct ect_list *devices;

		ret = ect_devices_read(h, &devices);
		for (size_t k = 0; !ret && k < devices->n; k++)
			claim(all, i, ect_list_at(devices, k));
		if (!ret)
			ect_list_free(devices);
		ect_close(h);
	}
	ect_free(h);
	return ret == -ENOMEM ? ret : 0;
}

static int by_place(const void *a, const void *b)
{
	const struct ect_card *x = a, *y = b;

	/* those without PCI address last */
	if (!*x->pci != !*y->pci)
		return !*x->pci ? 1 : -1;
	return strcmp(*x->pci ? x->pci : x->name, *y->pci ? y->pci : y->name);
}

int ect_cards_read(struct ect_handle *h, struct ect_list **list)
{
	struct ect_list *all = ect_list_new(sizeof(struct ect_card));
	int ret;

	if (!all)
		return ect_no_memory(h);
	ret = add_interfaces(all);
	ret = ret ? ret : add_controllers(all);
	ret = ret ? ret : ask_masters(all);
	if (ret) {
		ect_list_free(all);
		return ect_no_memory(h);
	}
	if (all->n)
		qsort(all->at, all->n, all->size, by_place);
	*list = all;
	return 0;
}

int ect_card_settings(struct ect_handle *h, const char *interface, struct ect_card_settings *s)
{
	struct ethtool_coalesce coalesce = { .cmd = ETHTOOL_GCOALESCE };
	struct ethtool_eee eee = { .cmd = ETHTOOL_GEEE };
	struct ethtool_pauseparam pause = { .cmd = ETHTOOL_GPAUSEPARAM };
	struct ect_card_settings own = { .struct_size = sizeof(own) };

	own.coalesce_error = ect_sys_ethtool(interface, &coalesce);
	own.rx_usecs = coalesce.rx_coalesce_usecs;
	own.adaptive_rx = !!coalesce.use_adaptive_rx_coalesce;
	own.eee_error = ect_sys_ethtool(interface, &eee);
	own.eee = !!eee.eee_enabled;
	own.pause_error = ect_sys_ethtool(interface, &pause);
	own.pause_rx = !!pause.rx_pause;
	own.pause_tx = !!pause.tx_pause;
	return ect_give(h, s, &own, sizeof(own));
}
