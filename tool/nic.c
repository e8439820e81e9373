// SPDX-License-Identifier: GPL-2.0-only
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "attr.h"
#include "boot.h"
#include "dev.h"
#include "nic.h"
#include "sys.h"

#define INTEL	0x8086
#define MASTERS	32

static const struct {
	unsigned int device;
	const char *name;
	bool tested, me;
} chips[] = {
#define EC_CHIP(id, text, type, runs)	{ id, text, runs, false },
#define EC_CHIP_ME(id, text)		{ id, text, false, true },
#include "../devices/intel/chips.h"
#undef EC_CHIP_ME
#undef EC_CHIP
};

/* the last part of what a symbolic link points to; false: there is none */
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

static struct nic *add(struct nics *all)
{
	struct nic *v = realloc(all->v, (all->n + 1) * sizeof(*v));

	if (!v)
		return NULL;
	all->v = v;
	v += all->n++;
	memset(v, 0, sizeof(*v));
	return v;
}

/* chip and native driver of a PCI function */
static void fill_pci(struct nic *n)
{
	unsigned int i;
	char dir[512], override[32];

	attr_path(dir, sizeof(dir), "%s/bus/pci/devices/%s", sys_fs(), n->pci);
	n->vendor = (unsigned int)attr_number(dir, "vendor");
	n->device = (unsigned int)attr_number(dir, "device");
	n->boot = boot_state(n);
	target(dir, "driver", n->driver, sizeof(n->driver));
	n->kept = !*n->driver && attr_read(dir, "driver_override", override, sizeof(override)) &&
		  !strcmp(override, NIC_NATIVE);
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
static int add_interface(struct nics *all, const char *name)
{
	char dir[512], device[600], pci[32], text[32];
	struct nic *n;

	attr_path(dir, sizeof(dir), "%s/class/net/%s", sys_fs(), name);
	attr_path(device, sizeof(device), "%s/device", dir);
	if (attr_number(dir, "type") != 1 || access(device, F_OK))
		return 0;
	n = add(all);
	if (!n)
		return fail("out of memory");
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

static int add_interfaces(struct nics *all)
{
	char path[256];
	struct dirent *e;
	int ret = 0;
	DIR *d;

	attr_path(path, sizeof(path), "%s/class/net", sys_fs());
	d = opendir(path);
	while (d && !ret && (e = readdir(d)))
		if (*e->d_name != '.')
			ret = add_interface(all, e->d_name);
	if (d)
		closedir(d);
	return ret;
}

/* controllers that have no network interface: a native driver has them, or none */
static int add_controllers(struct nics *all)
{
	size_t known = all->n, i;
	char path[256], dir[600];
	struct dirent *e;
	struct nic *n;
	int ret = 0;
	DIR *d;

	attr_path(path, sizeof(path), "%s/bus/pci/devices", sys_fs());
	d = opendir(path);
	while (d && !ret && (e = readdir(d))) {
		attr_path(dir, sizeof(dir), "%s/%s", path, e->d_name);
		/* PCI class 02 00: Ethernet controller */
		if (*e->d_name == '.' || attr_number(dir, "class") >> 8 != 0x0200)
			continue;
		for (i = 0; i < known && strcmp(all->v[i].pci, e->d_name); i++)
			;
		attr_path(dir, sizeof(dir), "%s/%s/net", path, e->d_name);
		if (i < known || !access(dir, F_OK))
			continue;
		n = add(all);
		if (!n) {
			ret = fail("out of memory");
			break;
		}
		attr_path(n->pci, sizeof(n->pci), "%s", e->d_name);
		fill_pci(n);
	}
	if (d)
		closedir(d);
	return ret;
}

static void claim(struct nics *all, unsigned int master, unsigned int side,
		  const struct ec_ioc_device *d)
{
	for (size_t i = 0; i < all->n; i++) {
		struct nic *n = &all->v[i];

		if (d->state != EC_DEVICE_ATTACHED ||
		    strcmp(d->name, *n->name ? n->name : n->pci))
			continue;
		attr_path(n->by, sizeof(n->by), "Master%u %s", master, side ? "backup" : "main");
		if (!*n->mac)
			attr_path(n->mac, sizeof(n->mac), "%02x:%02x:%02x:%02x:%02x:%02x",
			    d->address[0], d->address[1], d->address[2], d->address[3],
			    d->address[4], d->address[5]);
		n->master = true;
		n->link_known = true;
		n->link_up = d->link_up;
		if (d->speed)
			n->speed = d->speed;
	}
}

/* what the masters have; without the module none has anything */
static void ask_masters(struct nics *all)
{
	struct master m;

	for (unsigned int i = 0; i < MASTERS; i++) {
		char path[32];
		int fd;

		attr_path(path, sizeof(path), "/dev/EtherCAT%u", i);
		fd = sys_open(path, O_RDONLY);
		if (fd < 0)
			break;
		if (!master_read(fd, &m))
			for (unsigned int side = 0; side < m.device_count; side++)
				claim(all, i, side, &m.devices[side]);
		sys_close(fd);
	}
}

static int by_place(const void *a, const void *b)
{
	const struct nic *x = a, *y = b;

	/* those without PCI address last */
	if (!*x->pci != !*y->pci)
		return !*x->pci ? 1 : -1;
	return strcmp(*x->pci ? x->pci : x->name, *y->pci ? y->pci : y->name);
}

/**
 * nics_read() - all network controllers of this computer
 * @all: result, for nics_free() also after an error
 *
 * Return: 0, or 1 after a message.
 */
int nics_read(struct nics *all)
{
	memset(all, 0, sizeof(*all));
	if (add_interfaces(all) || add_controllers(all))
		return 1;
	ask_masters(all);
	if (all->n)
		qsort(all->v, all->n, sizeof(*all->v), by_place);
	return 0;
}

void nics_free(struct nics *all)
{
	free(all->v);
	all->v = NULL;
	all->n = 0;
}

/* "08:00.0" is short for "0000:08:00.0" */
static bool is_pci(const char *name, const char *pci)
{
	return *pci && (!strcasecmp(name, pci) ||
			(!strncmp(pci, "0000:", 5) && !strcasecmp(name, pci + 5)));
}

struct nic *nic_lookup(struct nics *all, const char *name)
{
	for (size_t i = 0; i < all->n; i++) {
		struct nic *n = &all->v[i];

		if ((*n->name && !strcmp(name, n->name)) || is_pci(name, n->pci) ||
		    (*n->mac && !strcasecmp(name, n->mac)))
			return n;
	}
	return NULL;
}

struct nic *nic_find(struct nics *all, const char *name)
{
	struct nic *n = nic_lookup(all, name);

	if (!n)
		fail("there is no network card %s; give an interface, MAC or PCI address of 'ethercat devices'",
		     name);
	return n;
}

int nic_write(const char *path, const char *text)
{
	int fd = open(path, O_WRONLY | O_CLOEXEC), err = 0;

	if (fd < 0)
		return -errno;
	if (write(fd, text, strlen(text)) < 0)
		err = -errno;
	close(fd);
	return err;
}
