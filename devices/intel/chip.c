// SPDX-License-Identifier: GPL-2.0-only
/*
 * Copper variants only: fibre and backplane need a set-up of the link that no test can run.
 * Offsets: data sheets of the 8254x (section 13.4), 82574 (10.2), 82576 and i210 (8.1).
 */
#include <linux/kernel.h>
#include <linux/stddef.h>
#include "chip.h"

static const struct intel_class c8254x = {
	.name = "8254x", .rx = 0x2800, .tx = 0x3800,
};

static const struct intel_class c82574 = {
	.name = "82574", .rx = 0x2800, .tx = 0x3800, .pcie = true, .phy_owner = true,
};

static const struct intel_class c82576 = {
	.name = "82576", .rx = 0xc000, .tx = 0xe000, .advanced = true, .queue_enable = true,
	.pcie = true,
};

#define ME	"its PHY is shared with the management engine"

static const struct intel_chip chips[] = {
	{ 0x100e, "82540EM", &c8254x, .tested = true },
	{ 0x1015, "82540EM", &c8254x },
	{ 0x1017, "82540EP", &c8254x },
	{ 0x100f, "82545EM", &c8254x },
	{ 0x1026, "82545GM", &c8254x },
	{ 0x1010, "82546EB", &c8254x },
	{ 0x1079, "82546GB", &c8254x },
	{ 0x10d3, "82574L", &c82574, .tested = true },
	{ 0x10f6, "82574LA", &c82574 },
	{ 0x150c, "82583V", &c82574 },
	{ 0x10a7, "82575EB", &c82576 },
	{ 0x10c9, "82576", &c82576, .tested = true },
	{ 0x150e, "82580", &c82576 },
	{ 0x1521, "I350", &c82576 },
	{ 0x1533, "I210", &c82576 },
	{ 0x157b, "I210", &c82576 },
	{ 0x1539, "I211", &c82576 },
	{ 0x153a, "I217-LM", .why_not = ME },
	{ 0x153b, "I217-V", .why_not = ME },
	{ 0x155a, "I218-LM", .why_not = ME },
	{ 0x1559, "I218-V", .why_not = ME },
	{ 0x15a0, "I218-LM", .why_not = ME },
	{ 0x15a1, "I218-V", .why_not = ME },
	{ 0x15a2, "I218-LM", .why_not = ME },
	{ 0x15a3, "I218-V", .why_not = ME },
	{ 0x156f, "I219-LM", .why_not = ME },
	{ 0x1570, "I219-V", .why_not = ME },
	{ 0x15b7, "I219-LM", .why_not = ME },
	{ 0x15b8, "I219-V", .why_not = ME },
};

/**
 * ec_chip_find() - look a chip up
 * @device: PCI device ID
 *
 * Context: Any.
 * Return: the chip, perhaps one that is not supported; NULL: unknown.
 */
const struct intel_chip *ec_chip_find(u16 device)
{
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(chips); i++)
		if (chips[i].device == device)
			return &chips[i];
	return NULL;
}
