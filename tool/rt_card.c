// SPDX-License-Identifier: GPL-2.0-only
/* Interrupts, and the network cards of the masters. */
#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../lib/tools/attr.h"
#include "dev.h"
#include "nic.h"
#include "rt.h"
#include "sys.h"

#define SHOWN	4

/* what an interrupt is for: the kernel makes a folder for each of its actions */
static bool action(const char *dir, char *name, size_t size)
{
	struct dirent *e;
	DIR *d = opendir(dir);

	*name = '\0';
	while (d && !*name && (e = readdir(d)))
		if (*e->d_name != '.' && e->d_type == DT_DIR)
			attr_path(name, size, "%s", e->d_name);
	if (d)
		closedir(d);
	return *name;
}

/* Is it that of a master's network card? It belongs to the CPU of the cycle. */
static bool is_card(const struct nics *all, const char *name)
{
	for (size_t i = 0; i < all->n; i++) {
		size_t len = strlen(all->v[i].name);

		if (all->v[i].master && len && !strncmp(name, all->v[i].name, len) &&
		    (!name[len] || name[len] == '-' || name[len] == ':'))
			return true;
	}
	return false;
}

static bool has_generic(const struct nics *all)
{
	for (size_t i = 0; i < all->n; i++) {
		const struct nic *n = &all->v[i];

		if (n->master && *n->name && *n->pci && strcmp(n->driver, NIC_NATIVE))
			return true;
	}
	return false;
}

static bool comes_to_reserved(const struct rt *r, const char *dir)
{
	char list[128];
	bool cpus[RT_CPUS];

	if (!attr_read(dir, "effective_affinity_list", list, sizeof(list)))
		attr_read(dir, "smp_affinity_list", list, sizeof(list));
	rt_cpus(list, cpus);
	for (unsigned int i = 0; i < RT_CPUS; i++)
		if (cpus[i] && r->isolated[i])
			return true;
	return false;
}

/* interrupts, SHOWN of them by name */
struct irqs {
	unsigned int n;
	char text[192];
};

static void add_irq(struct irqs *q, const char *irq, const char *name)
{
	size_t len = strlen(q->text);

	if (q->n++ < SHOWN)
		attr_path(q->text + len, sizeof(q->text) - len, "%s%s (%s)", len ? ", " : "", irq,
			  name);
}

static void check_affinity(struct rt *r, const struct nics *all)
{
	char path[512], dir[800], name[64];
	struct irqs others = { 0 }, away = { 0 };
	unsigned int seen = 0, cards = 0;
	struct dirent *e;
	DIR *d;

	attr_path(path, sizeof(path), "%s/irq", sys_proc());
	d = opendir(path);
	while (d && (e = readdir(d))) {
		bool card;

		attr_path(dir, sizeof(dir), "%s/%s", path, e->d_name);
		if (!isdigit((unsigned char)*e->d_name) || !action(dir, name, sizeof(name)))
			continue;
		seen++;
		card = is_card(all, name);
		cards += card;
		if (card != comes_to_reserved(r, dir))
			add_irq(card ? &away : &others, e->d_name, name);
	}
	if (d)
		closedir(d);
	if (!seen)
		rt_find(r, "interrupts", RT_UNKNOWN, NULL, "%s cannot be read", path);
	else if (others.n)
		rt_find(r, "interrupts", RT_ERROR,
			"kernel parameter irqaffinity=, or echo LIST > /proc/irq/N/smp_affinity_list",
			"%u come to a reserved CPU: %s", others.n, others.text);
	else
		rt_find(r, "interrupts", RT_OK, NULL, "none but the master's comes to CPU %s",
			r->list);
	if (away.n)
		rt_find(r, "card", RT_WARNING,
			"echo CPU > /proc/irq/N/smp_affinity_list, with a reserved CPU",
			"%u interrupt(s) of a master's card come to no reserved CPU, other load may delay them: %s",
			away.n, away.text);
	else if (cards)
		rt_find(r, "card", RT_OK, NULL, "interrupts of the masters' cards come to CPU %s",
			r->list);
	else if (has_generic(all))
		rt_find(r, "card", RT_UNKNOWN, NULL,
			"no interrupt has the name of a master's card: see /proc/interrupts");
}

static bool runs(const char *program)
{
	char dir[512], name[32];
	bool found = false;
	struct dirent *e;
	DIR *d = opendir(sys_proc());

	while (d && !found && (e = readdir(d))) {
		if (!isdigit((unsigned char)*e->d_name))
			continue;
		attr_path(dir, sizeof(dir), "%s/%s", sys_proc(), e->d_name);
		found = attr_read(dir, "comm", name, sizeof(name)) && !strcmp(name, program);
	}
	if (d)
		closedir(d);
	return found;
}

void rt_check_interrupts(struct rt *r)
{
	struct nics all;

	if (runs("irqbalance"))
		rt_find(r, "irqbalance", RT_WARNING, "systemctl disable --now irqbalance",
			"it runs and may move interrupts to the CPU of the cycle");
	else
		rt_find(r, "irqbalance", RT_OK, NULL, "does not run");
	if (!r->n_isolated) {
		rt_find(r, "interrupts", RT_UNKNOWN, NULL,
			"not checked: no CPU is reserved, any may have them");
		return;
	}
	r->failed |= !!nics_read(&all);
	check_affinity(r, &all);
	nics_free(&all);
}

/* whether a setting is known, whose @error the driver has; else there is a finding */
static bool known(struct rt *r, const struct nic *n, const char *check, int error)
{
	if (error == -EOPNOTSUPP)
		rt_find(r, check, RT_OK, NULL, "%s: the driver %s has no such setting", n->name,
			n->driver);
	else if (error)
		rt_find(r, check, RT_UNKNOWN, NULL, "%s: %s", n->name, strerror(-error));
	return !error;
}

/* Their 1 to 3 select a rate by load: at 100 Mbit/s up to 250 us between two interrupts. */
static bool adapts(const struct nic *n, u32 usecs)
{
	static const char *const drivers[] = { "e1000", "e1000e", "igb", "igc" };

	for (size_t i = 0; usecs && usecs <= 3 && i < ARRAY_SIZE(drivers); i++)
		if (!strcmp(n->driver, drivers[i]))
			return true;
	return false;
}

static void check_coalescing(struct rt *r, const struct nic *n, const struct ect_card_settings *c)
{
	char fix[96];

	attr_path(fix, sizeof(fix), "ethtool -C %s rx-usecs 0", n->name);
	if (!known(r, n, "coalescing", c->coalesce_error))
		return;
	/* 1 is off for other drivers */
	if (adapts(n, c->rx_usecs))
		rt_find(r, "coalescing", RT_ERROR, fix,
			"%s: received frames wait by load (rx-usecs %u), up to 250 us", n->name,
			c->rx_usecs);
	else if (c->rx_usecs > 1 || c->adaptive_rx)
		rt_find(r, "coalescing", RT_ERROR, fix, "%s: received frames wait %u us%s", n->name,
			c->rx_usecs, c->adaptive_rx ? ", adaptive" : "");
	else
		rt_find(r, "coalescing", RT_OK, NULL, "%s: received frames do not wait", n->name);
}

static void check_eee(struct rt *r, const struct nic *n, const struct ect_card_settings *c)
{
	char fix[96];

	attr_path(fix, sizeof(fix), "ethtool --set-eee %s eee off", n->name);
	if (!known(r, n, "energy", c->eee_error))
		return;
	if (c->eee)
		rt_find(r, "energy", RT_WARNING, fix, "%s: the link falls asleep between frames",
			n->name);
	else
		rt_find(r, "energy", RT_OK, NULL, "%s: the link does not fall asleep", n->name);
}

static void check_pause(struct rt *r, const struct nic *n, const struct ect_card_settings *c)
{
	char fix[96];

	attr_path(fix, sizeof(fix), "ethtool -A %s rx off tx off autoneg off", n->name);
	if (!known(r, n, "pause frames", c->pause_error))
		return;
	if (c->pause_rx || c->pause_tx)
		rt_find(r, "pause frames", RT_WARNING, fix, "%s: they may hold frames back",
			n->name);
	else
		rt_find(r, "pause frames", RT_OK, NULL, "%s: off", n->name);
}

static void check_power(struct rt *r, const struct nic *n)
{
	char dir[512], text[16], fix[128];

	attr_path(dir, sizeof(dir), "%s/bus/pci/devices/%s/power", sys_fs(), n->pci);
	attr_path(fix, sizeof(fix), "echo on > /sys/bus/pci/devices/%s/power/control", n->pci);
	if (!*n->pci || !attr_read(dir, "control", text, sizeof(text)))
		return;
	if (!strcmp(text, "on"))
		rt_find(r, "power", RT_OK, NULL, "%s: the card stays on", n->name);
	else
		rt_find(r, "power", RT_WARNING, fix, "%s: the card may be switched off (%s)",
			n->name, text);
}

static void check_settings(struct rt *r, const struct nic *n)
{
	struct ect_card_settings c = { .struct_size = sizeof(c) };
	struct ect_handle *h = ect_new();

	if (h && !ect_card_settings(h, n->name, &c)) {
		check_coalescing(r, n, &c);
		check_eee(r, n, &c);
		check_pause(r, n, &c);
	} else {
		r->failed |= !!fail("out of memory");
	}
	ect_free(h);
}

static void check_card(struct rt *r, const struct nic *n)
{
	char fix[128];

	if (!strcmp(n->driver, NIC_NATIVE)) {
		rt_find(r, "card", RT_OK, NULL, "%s: %s with the native driver, no interrupt",
			n->by, n->pci);
		return;
	}
	attr_path(fix, sizeof(fix),
		  "DEVICE_MODULES=\"%s\" in /etc/ethercat.conf, then 'ethercatctl restart'",
		  n->driver);
	if (*n->why_not)
		rt_find(r, "card", RT_OK, NULL, "%s: %s with the driver %s (native: %s)", n->by,
			n->name, n->driver, n->why_not);
	else
		rt_find(r, "card", RT_WARNING, fix,
			"%s: %s with the driver %s and its interrupts; a native driver can have it",
			n->by, n->name, n->driver);
	check_settings(r, n);
	check_power(r, n);
}

int rt_check_cards(struct rt *r)
{
	unsigned int n = 0;
	struct nics all;
	int ret = nics_read(&all);

	for (size_t i = 0; !ret && i < all.n; i++) {
		if (!all.v[i].master)
			continue;
		n++;
		check_card(r, &all.v[i]);
	}
	if (!ret && !n)
		rt_find(r, "card", RT_UNKNOWN, NULL,
			"no master uses a network card; give ec_master one with main_devices= and check again");
	nics_free(&all);
	return ret;
}
