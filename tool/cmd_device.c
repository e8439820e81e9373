// SPDX-License-Identifier: GPL-2.0-only
/* Give a network card its native driver, or the driver of the system; give a master a card. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "boot.h"
#include "device_use.h"
#include "nic.h"
#include "out.h"
#include "sys.h"
#include "tool.h"

static bool is_native(const struct nic *n)
{
	return !strcmp(n->driver, NIC_NATIVE);
}

static int put(const char *what, const char *pci, const char *attribute, const char *text)
{
	char path[256];
	int err;

	snprintf(path, sizeof(path), "%s/bus/pci/devices/%s/%s", sys_fs(), pci, attribute);
	err = nic_write(path, text);
	return err ? fail_full(-err, NULL, 0, "cannot %s %s", what, pci) : 0;
}

/*
 * driver_override names the only driver that may have the card; "\n": any. Then the card is
 * taken from its driver and offered again.
 */
static int rebind(const char *what, const struct nic *n, const char *override)
{
	char path[256];
	int err;

	if (put(what, n->pci, "driver_override", override) ||
	    (*n->driver && put(what, n->pci, "driver/unbind", n->pci)))
		return 1;
	snprintf(path, sizeof(path), "%s/bus/pci/drivers_probe", sys_fs());
	err = nic_write(path, n->pci);
	return err && err != -EINVAL ? fail_full(-err, NULL, 0, "cannot %s %s", what, n->pci) : 0;
}

static bool has_driver(const struct nic *n, const char *driver)
{
	char path[256];

	snprintf(path, sizeof(path), "%s/bus/pci/drivers/%s/%s", sys_fs(), driver, n->pci);
	return !access(path, F_OK);
}

static int check(const struct tool *t, const struct nic *n)
{
	char path[256];

	if (!*n->pci || *n->why_not)
		return fail("%s has no native driver: %s; the generic device can use it",
			    *n->name ? n->name : n->pci, n->why_not);
	if (*n->by && !t->force)
		return fail("%s is used by %s; %s, or use --force",
			    *n->name ? n->name : n->pci, n->by,
			    n->master ? "unload ec_generic first" :
			    "take it down with 'ip link set down'");
	snprintf(path, sizeof(path), "%s/bus/pci/drivers/" NIC_NATIVE, sys_fs());
	if (access(path, F_OK))
		return fail("the driver " NIC_NATIVE " is not loaded; load it with 'modprobe "
			    NIC_NATIVE "'");
	return 0;
}

static int bind(const struct tool *t, const struct nic *n)
{
	struct nic back;

	if (is_native(n)) {
		note("%s has its native driver already", n->pci);
		return 0;
	}
	if (check(t, n) || rebind("bind", n, NIC_NATIVE))
		return 1;
	if (has_driver(n, NIC_NATIVE))
		return 0;
	/* the card must not stay without driver */
	back = *n;
	back.driver[0] = '\0';
	rebind("return", &back, "\n");
	return fail(NIC_NATIVE " refused %s; see 'dmesg'", n->pci);
}

static int unbind(const struct tool *t, const struct nic *n)
{
	char path[256];

	if (!is_native(n) && !n->kept)
		return fail("%s has no native driver", *n->name ? n->name : n->pci);
	if (*n->by && !t->force)
		return fail("%s is used by %s; use --force to take it", n->pci, n->by);
	if (rebind("unbind", n, "\n"))
		return 1;
	snprintf(path, sizeof(path), "%s/bus/pci/devices/%s/driver", sys_fs(), n->pci);
	if (access(path, F_OK))
		note("no driver has taken %s; load the one of the system", n->pci);
	return 0;
}

static int bind_at_boot(const struct tool *t, const struct nic *n)
{
	/* all or nothing: no card that has the driver until the next start only */
	if (*n->pci && !*n->why_not && boot_check(n->pci))
		return 1;
	return bind(t, n) || boot_write(n);
}

/* remove the driver and the rule, as far as they exist */
static int unbind_at_boot(const struct tool *t, const struct nic *n)
{
	bool set = n->boot == BOOT_SET || n->boot == BOOT_OTHER;

	if ((set || n->boot == BOOT_FOREIGN) && boot_check(n->pci))
		return 1;
	if (!set && !is_native(n) && !n->kept)
		return fail("%s has no native driver and is not bound at boot",
			    *n->name ? n->name : n->pci);
	if ((is_native(n) || n->kept) && unbind(t, n))
		return 1;
	return set && boot_remove(n->pci);
}

static int unbind_only(const struct tool *t, const struct nic *n)
{
	int ret = unbind(t, n);

	if (n->boot == BOOT_SET && (!ret || !is_native(n)))
		note("%s is bound again when the computer starts; to change that: 'ethercat device unbind %s --boot'",
		     n->pci, n->pci);
	return ret;
}

/* the address of a card that is absent and has a rule */
static bool absent(const char *name, struct nic *n)
{
	unsigned int domain, bus, slot, function;
	int end = 0;

	if (sscanf(name, "%x:%x:%x.%x%n", &domain, &bus, &slot, &function, &end) != 4) {
		domain = 0;
		if (sscanf(name, "%x:%x.%x%n", &bus, &slot, &function, &end) != 3)
			return false;
	}
	if (name[end])
		return false;
	memset(n, 0, sizeof(*n));
	snprintf(n->pci, sizeof(n->pci), "%04x:%02x:%02x.%x", domain, bus, slot, function);
	n->boot = boot_state(n);
	return n->boot != BOOT_NONE;
}

static int run_one(const struct tool *t, bool on, struct nics *all, const char *name)
{
	struct nic *n = nic_lookup(all, name), left;

	if (!n && !on && t->boot && absent(name, &left))
		return boot_check(left.pci) || boot_remove(left.pci);
	if (!n)
		n = nic_find(all, name);
	if (!n)
		return 1;
	if (t->boot)
		return on ? bind_at_boot(t, n) : unbind_at_boot(t, n);
	return on ? bind(t, n) : unbind_only(t, n);
}

static int run(struct tool *t, int argc, char **argv)
{
	bool on = !strcmp(argv[0], "bind");
	struct nics all;
	int ret;

	(void)argc;
	if (!strcmp(argv[0], "use"))
		return device_use(t, argv[1]);
	if (!on && strcmp(argv[0], "unbind"))
		return usage_error("'%s': use bind, unbind or use", argv[0]);
	if (t->backup)
		return usage_error("%s has no --backup", argv[0]);
	ret = nics_read(&all);
	if (!ret)
		ret = run_one(t, on, &all, argv[1]);
	nics_free(&all);
	return ret;
}

const struct cmd cmd_device = {
	.name = "device",
	.run = run,
	.args = "bind|unbind|use DEVICE",
	.opts = "mfbu",
	.summary = "Give a network card its native driver or to a master, or take it away",
	.help = "DEVICE is an interface, a MAC address or a PCI address as 'ethercat devices' lists them.\n"
		"After bind the interface is absent: a master gets the card by its MAC or PCI address\n"
		"(main_devices=). After unbind the driver of the system has it again.\n"
		"A card in use is refused; --force takes it nevertheless. Needs root.\n"
		"The change lasts until the computer restarts. With --boot, bind writes a udev rule into\n"
		"/etc/udev/rules.d that binds the card at each start, also if it is in use then; unbind\n"
		"removes the rule. For a card that is absent DEVICE is its PCI address.\n"
		"use gives the card to a master (-m), which gives its present one back and scans the\n"
		"bus; with the native driver, or by ec_generic. DEVICE may also be sim0 of the simulator.\n"
		"Refused while an application has the master; an interface with an IP address needs --force.\n"
		"If the card cannot be used, the master keeps its present one. Lasts until ec_master is\n"
		"unloaded.\n"
		"With --backup, use gives it the card at the other end of a ring, instead of the present\n"
		"one if there is one; --backup none takes it away.\n",
	.json = "none",
	.min_args = 2,
	.max_args = 2,
};
