// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "../lib/tools/attr.h"
#include "boot.h"
#include "dev.h"
#include "nic.h"

static void fill(struct nic *n, const struct ect_card *c)
{
	attr_path(n->name, sizeof(n->name), "%s", c->name);
	attr_path(n->pci, sizeof(n->pci), "%s", c->pci);
	attr_path(n->mac, sizeof(n->mac), "%s", c->mac);
	attr_path(n->driver, sizeof(n->driver), "%s", c->driver);
	attr_path(n->chip, sizeof(n->chip), "%s", c->chip);
	attr_path(n->why_not, sizeof(n->why_not), "%s", c->why_not);
	attr_path(n->by, sizeof(n->by), "%s", c->by);
	n->master = c->of_master;
	n->kept = c->kept;
	n->tested = c->tested;
	n->link_known = c->link_known;
	n->link_up = c->link_up;
	n->speed = c->speed;
	n->vendor = c->vendor;
	n->device = c->device;
	n->boot = *n->pci ? boot_state(n) : BOOT_NONE;
}

static int copy(struct nics *all, const struct ect_list *list)
{
	all->v = calloc(ect_list_count(list) + 1, sizeof(*all->v));
	if (!all->v)
		return fail("out of memory");
	for (; all->n < ect_list_count(list); all->n++)
		fill(&all->v[all->n], ect_list_get(list, all->n));
	return 0;
}

/**
 * nics_read() - all network controllers of this computer
 * @all: result, for nics_free() also after an error
 *
 * Return: 0, or 1 after a message.
 */
int nics_read(struct nics *all)
{
	struct ect_handle *h = ect_new();
	struct ect_list *list = NULL;
	int ret;

	memset(all, 0, sizeof(*all));
	ret = h && !ect_cards_read(h, &list) ? copy(all, list) : fail("out of memory");
	ect_list_free(list);
	ect_free(h);
	return ret;
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
