// SPDX-License-Identifier: GPL-2.0-only
/*
 * Offsets: data sheets of the 8254x (section 13.4), 82574 (10.2), 82576 and i210 (8.1).
 */
#include <linux/kernel.h>
#include <linux/stddef.h>
#include "chip.h"
#include "regs.h"

static const struct intel_class c8254x = {
	.name = "8254x", .rx = 0x2800, .tx = 0x3800,
};

/*
 * What the chip needs to work for long (its data sheet and errata): without the last two its
 * transmitter may hang after a completion of PCIe that is late, as with power saving of the link.
 */
static const struct intel_bits bits_82574[] = {
	{ R_CTRL, BIT(29), 0 },
	{ R_CTRL_EXT, BIT(23), BIT(22) },
	{ R_TXDCTL, 0, BIT(22) },
	{ R_TARC0, GENMASK(30, 27), BIT(26) },
	{ R_GCR, 0, BIT(22) | BIT(27) },
	{ R_GCR2, 0, BIT(0) },
	{}
};

static const struct intel_class c82574 = {
	.name = "82574", .rx = 0x2800, .tx = 0x3800, .pcie = true, .phy_owner = true,
	.bits = bits_82574,
};

#define ADVANCED \
	.rx = 0xc000, .tx = 0xe000, .advanced = true, .queue_enable = true, .pcie = true, \
	.phy_sync = true

static const struct intel_class c82576 = {
	.name = "82576", ADVANCED,
};

/* Images of the NVM may keep the link off until a driver comes. */
static const struct intel_bits bits_82580[] = {
	{ R_PHPM, PHPM_GO_LINKD, 0 },
	{}
};

static const struct intel_class c82580 = {
	.name = "82580", .bits = bits_82580, ADVANCED,
};

/* A link that falls asleep between two frames needs many microseconds to wake. */
static const struct intel_bits bits_i350[] = {
	{ R_PHPM, PHPM_GO_LINKD, 0 },
	{ R_IPCNFG, IPCNFG_EEE, 0 },
	{ R_EEER, EEER_ALL, 0 },
	{}
};

static const struct intel_class ci350 = {
	.name = "I350", .bits = bits_i350, ADVANCED,
};

static const struct intel_chip chips[] = {
#define EC_CHIP(id, text, type, runs) \
	{ .device = id, .name = text, .class = &type, .tested = runs },
#define EC_CHIP_ME(id, text) \
	{ .device = id, .name = text, .why_not = "its PHY is shared with the management engine" },
#include "chips.h"
#undef EC_CHIP_ME
#undef EC_CHIP
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
