/* SPDX-License-Identifier: GPL-2.0-only */
/* Network interfaces and controllers of this computer, from sysfs. */
#ifndef EC_TOOL_NIC_H
#define EC_TOOL_NIC_H

#include <stdbool.h>
#include <stddef.h>

#include "../master/wire/env.h"

#define NIC_NATIVE	"ec_intel"	/* the native driver */

/**
 * struct nic - one of them
 * @name: network interface, "" without
 * @pci: address of its PCI function, "" without
 * @mac: of the interface or of the master's device, "" when unknown
 * @driver: "" without
 * @chip: name of the chip in the native driver's list, "" when it is not in the list
 * @why_not: why there is no native driver, "" when there is
 * @by: user of the card, "": none
 * @master: of a master; else of the system, if @by is not ""
 * @kept: only the native driver may have it, which is not loaded
 * @tested: tests run the chip with the native driver, in QEMU
 * @link_known: @link_up is known
 * @link_up: the cable is plugged in
 * @speed: Mbit/s, 0 when unknown
 * @vendor: of the PCI function
 * @device: of the PCI function
 * @boot: enum boot
 */
struct nic {
	char name[32];
	char pci[32];
	char mac[18];
	char driver[32];
	char chip[16];
	char why_not[80];
	char by[48];
	bool master;
	bool kept;
	bool tested;
	bool link_known;
	bool link_up;
	unsigned int speed;
	unsigned int vendor;
	unsigned int device;
	unsigned int boot;
};

struct nics {
	size_t n;
	struct nic *v;
};

int nics_read(struct nics *all);
void nics_free(struct nics *all);
/* by PCI address, interface or MAC address; NULL after a message */
struct nic *nic_find(struct nics *all, const char *name);
/* the same without a message */
struct nic *nic_lookup(struct nics *all, const char *name);

/* 0 or -errno */
int nic_write(const char *path, const char *text);

#endif
