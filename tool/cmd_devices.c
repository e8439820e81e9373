// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "boot.h"
#include "nic.h"
#include "out.h"
#include "tool.h"

static const char *native(const struct nic *n, char *buf, size_t size)
{
	const char *boot = n->boot == BOOT_SET ? ", at boot" : "";
	const char *run = n->tested ? "run in QEMU only" : "never tested";

	if (*n->why_not)
		snprintf(buf, size, "no: %s%s", n->why_not, boot);
	else
		snprintf(buf, size, "%s: %s, %s%s",
			 strcmp(n->driver, NIC_NATIVE) ? "yes" : "in use", n->chip, run, boot);
	return buf;
}

static const char *link_text(const struct nic *n, char *buf, size_t size)
{
	if (!n->link_known)
		return "unknown";
	if (!n->link_up || !n->speed)
		return n->link_up ? "up" : "down";
	snprintf(buf, size, "up, %u Mbit/s", n->speed);
	return buf;
}

static const char *or_none(const char *text)
{
	return *text ? text : "-";
}

static void show(const struct nic *n)
{
	char link[32], kind[128];

	out_object(NULL);
	out_str("interface", n->name, "%-10s  ", or_none(n->name));
	out_str("pci", n->pci, "%-12s  ", or_none(n->pci));
	out_str("mac", n->mac, "%-17s  ", or_none(n->mac));
	out_str("driver", n->driver, "%-10s  ", or_none(n->driver));
	if (n->link_known)
		out_bool("link_up", n->link_up, NULL);
	else
		out_null("link_up", NULL);
	out_u("speed_mbit_s", n->speed, NULL);
	out_text("%-15s  ", link_text(n, link, sizeof(link)));
	out_str("used_by", n->by, "%-15s  ", or_none(n->by));
	out_bool("native", !*n->why_not, "%s\n", native(n, kind, sizeof(kind)));
	out_str("chip", n->chip, NULL);
	if (n->tested)
		out_str("tested", "QEMU", NULL);
	else
		out_null("tested", NULL);
	out_str("why_not", n->why_not, NULL);
	out_bool("boot", n->boot == BOOT_SET, NULL);
	out_end();
}

static int run(struct tool *t, int argc, char **argv)
{
	struct nics all;
	int ret = nics_read(&all);

	(void)t, (void)argc, (void)argv;
	out_array("devices");
	if (!ret && all.n)
		out_text("%-10s  %-12s  %-17s  %-10s  %-15s  %-15s  %s\n", "INTERFACE", "PCI",
			 "MAC", "DRIVER", "LINK", "USED BY", "NATIVE");
	for (size_t i = 0; !ret && i < all.n; i++)
		show(&all.v[i]);
	out_end();
	if (!ret)
		boot_note_absent(&all);
	nics_free(&all);
	return ret;
}

const struct cmd cmd_devices = {
	.name = "devices",
	.run = run,
	.args = "",
	.opts = "",
	.summary = "List the network cards and their users",
	.help = "NATIVE says whether ec_intel can drive the card ('ethercat device bind'), or why not;\n"
		"the generic device takes any of them. 'run in QEMU only': tests run this chip with\n"
		"ec_intel, but no real card; 'never tested': not even that. 'at boot': 'ethercat\n"
		"device bind --boot' was given. The link is unknown while the interface is down.\n"
		"Needs no master.\n",
	.json = "devices[]: interface, pci, mac, driver, link_up (null: unknown), speed_mbit_s,\n"
		"used_by, native, chip, tested (QEMU or null: never), why_not, boot",
};
