/* SPDX-License-Identifier: GPL-2.0-only */
/* Reset and link of an Intel network controller. */
#ifndef EC_INTEL_NIC_H
#define EC_INTEL_NIC_H

#include <linux/if_ether.h>
#include <linux/io.h>
#include "chip.h"

/**
 * struct intel_nic - the controller without its rings
 */
struct intel_nic {
	/** @regs: BAR 0 */
	void __iomem *regs;
	/** @class: its registers */
	const struct intel_class *class;
	/** @mac: its address */
	u8 mac[ETH_ALEN];
	/** @up: link state when it was last read */
	bool up;
	/** @gone: it does not answer: unplugged */
	bool gone;
	/** @speed: Mbit/s, when @up */
	u16 speed;
	/** @slow: half duplex or 10 Mbit/s, when @up */
	bool slow;
};

static inline u32 ec_nic_read(const struct intel_nic *nic, u32 reg)
{
	return readl(nic->regs + reg);
}

static inline void ec_nic_write(const struct intel_nic *nic, u32 reg, u32 value)
{
	writel(value, nic->regs + reg);
}

int ec_nic_reset(struct intel_nic *nic);
void ec_nic_quiet(struct intel_nic *nic);
int ec_nic_connect(struct intel_nic *nic);
void ec_nic_look(struct intel_nic *nic);

#endif
