/* SPDX-License-Identifier: GPL-2.0-only */
/* What differs between the chips of the native Intel driver. */
#ifndef EC_INTEL_CHIP_H
#define EC_INTEL_CHIP_H

#include <linux/types.h>

/**
 * struct intel_bits - bits of a register that are not as a reset leaves them
 */
struct intel_bits {
	/** @reg: offset of the register */
	u32 reg;
	/** @clear: bits that have to be 0 */
	u32 clear;
	/** @set: bits that have to be 1; neither: behind the last one */
	u32 set;
};

/**
 * struct intel_class - chips with the same registers and descriptors
 */
struct intel_class {
	/** @name: for messages */
	const char *name;
	/** @rx: offset of the registers of receive queue 0 */
	u32 rx;
	/** @tx: offset of the registers of transmit queue 0 */
	u32 tx;
	/** @advanced: descriptors are the advanced ones, else the legacy ones */
	bool advanced;
	/** @queue_enable: a queue runs only after it was enabled (RXDCTL, TXDCTL) */
	bool queue_enable;
	/** @pcie: PCIe; master requests can be disabled before a reset */
	bool pcie;
	/** @bits: changed after each reset, NULL: none */
	const struct intel_bits *bits;
	/** @phy_owner: software takes the MDIO interface before it uses it (EXTCNF_CTRL) */
	bool phy_owner;
	/** @phy_sync: software shares the PHY with firmware by a semaphore (SW_FW_SYNC) */
	bool phy_sync;
};

/**
 * struct intel_chip - a chip
 */
struct intel_chip {
	/** @device: PCI device ID; the vendor is Intel */
	u16 device;
	/** @name: of the chip */
	const char *name;
	/** @class: its registers; NULL: not supported */
	const struct intel_class *class;
	/** @why_not: reason when @class is NULL */
	const char *why_not;
	/** @tested: the tests run it, in QEMU */
	bool tested;
};

const struct intel_chip *ec_chip_find(u16 device);

#endif
