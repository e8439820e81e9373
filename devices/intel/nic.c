// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bitfield.h>
#include <linux/delay.h>
#include <linux/errno.h>
#include <linux/etherdevice.h>
#include <linux/iopoll.h>
#include "master/kernel/compat.h"
#include "nic.h"
#include "phy.h"
#include "regs.h"

#define MASTER_US	80000	/* until pending requests are done (82574, 5.2.3.1: 80 ms) */
#define RESET_US	20000

static void mask_interrupts(const struct intel_nic *nic)
{
	ec_nic_write(nic, R_IMC, ~0u);
	if (nic->class->advanced)
		ec_nic_write(nic, R_EIMC, ~0u);
	ec_nic_read(nic, R_ICR);
}

/**
 * ec_nic_quiet() - no frame in either direction, no interrupt, no DMA
 * @nic: controller
 *
 * Context: Process. May sleep.
 */
void ec_nic_quiet(struct intel_nic *nic)
{
	u32 status;

	mask_interrupts(nic);
	if (nic->class->pcie)
		ec_nic_write(nic, R_CTRL_EXT, ec_nic_read(nic, R_CTRL_EXT) & ~CTRL_EXT_DRV_LOAD);
	ec_nic_write(nic, R_RCTL, 0);
	ec_nic_write(nic, R_TCTL, TCTL_PSP);
	ec_nic_read(nic, R_STATUS);
	usleep_range(10000, 11000);
	if (!nic->class->pcie)
		return;
	ec_nic_write(nic, R_CTRL, ec_nic_read(nic, R_CTRL) | CTRL_GIO_DISABLE);
	readl_poll_timeout(nic->regs + R_STATUS, status, !(status & STATUS_GIO_ENABLED), 100,
			   MASTER_US);
}

static void get_mac(struct intel_nic *nic)
{
	put_unaligned_le32(ec_nic_read(nic, R_RAL0), nic->mac);
	put_unaligned_le16(ec_nic_read(nic, R_RAH0), nic->mac + 4);
}

/* without a memory of its own the controller loses it in a reset */
static void set_mac(const struct intel_nic *nic)
{
	ec_nic_write(nic, R_RAL0, get_unaligned_le32(nic->mac));
	ec_nic_write(nic, R_RAH0, get_unaligned_le16(nic->mac + 4) | RAH_VALID);
}

/**
 * ec_nic_reset() - reset the controller; it is quiet afterwards
 * @nic: controller with @regs and @class
 *
 * Context: Process. May sleep.
 * Return: 0, -ENODEV when it does not answer, -EIO when it does not end its reset,
 * -EMEDIUMTYPE when its NVM selects fibre or SGMII, -EADDRNOTAVAIL without a valid MAC address.
 */
int ec_nic_reset(struct intel_nic *nic)
{
	const struct intel_bits *b;
	unsigned int i;
	u32 ctrl;

	if (ec_nic_read(nic, R_STATUS) == ~0u)
		return -ENODEV;
	if (is_zero_ether_addr(nic->mac))
		get_mac(nic);
	ec_nic_quiet(nic);
	ec_nic_write(nic, R_CTRL, ec_nic_read(nic, R_CTRL) | CTRL_RST);
	/* it does not answer correctly at once */
	usleep_range(10000, 11000);
	if (readl_poll_timeout(nic->regs + R_CTRL, ctrl, !(ctrl & CTRL_RST), 1000, RESET_US))
		return -EIO;
	mask_interrupts(nic);
	if (nic->class->advanced && ec_nic_read(nic, R_CTRL_EXT) & CTRL_EXT_LINK_MODE)
		return -EMEDIUMTYPE;
	for (b = nic->class->bits; b && (b->clear | b->set); b++)
		ec_nic_write(nic, b->reg, (ec_nic_read(nic, b->reg) & ~b->clear) | b->set);
	if (!is_valid_ether_addr(nic->mac))
		get_mac(nic);
	if (!is_valid_ether_addr(nic->mac))
		return -EADDRNOTAVAIL;
	set_mac(nic);
	for (i = 0; i < 128; i++)
		ec_nic_write(nic, R_MTA + 4 * i, 0);
	/* one queue, no filter, descriptors as the class says */
	ec_nic_write(nic, R_MRQC, 0);
	if (nic->class->pcie)
		ec_nic_write(nic, R_RFCTL, 0);
	return 0;
}

/**
 * ec_nic_connect() - bring the link up and let frames pass, once the rings are set
 * @nic: controller after ec_nic_reset()
 *
 * Context: Process. May sleep.
 * Return: as ec_phy_wake(); frames pass all the same if there is a link.
 */
int ec_nic_connect(struct intel_nic *nic)
{
	u32 ctrl = ec_nic_read(nic, R_CTRL);
	int ret;

	/* a pause frame would stop the cycle for up to 335 ms */
	ctrl &= ~(CTRL_FORCE_SPEED | CTRL_FORCE_DUPLEX | CTRL_GIO_DISABLE | CTRL_PAUSE);
	/* the speed is the one the PHY reports, as with the drivers of the system */
	ctrl |= CTRL_SLU | CTRL_FD;
	ec_nic_write(nic, R_CTRL, ctrl);
	/* management firmware leaves the link to a driver that is there */
	if (nic->class->pcie)
		ec_nic_write(nic, R_CTRL_EXT, ec_nic_read(nic, R_CTRL_EXT) | CTRL_EXT_DRV_LOAD);
	/* after its reset the chip sets its PHY up */
	usleep_range(25000, 26000);
	ret = ec_phy_wake(nic, true);
	ec_nic_write(nic, R_TIPG, TIPG_COPPER);
	ec_nic_write(nic, R_TCTL, TCTL_EN | TCTL_PSP | TCTL_COLLISIONS);
	/* EtherCAT slaves change the source address only, but other frames are counted too */
	ec_nic_write(nic, R_RCTL, RCTL_EN | RCTL_UPE | RCTL_MPE | RCTL_BAM | RCTL_SECRC);
	return ret;
}

/**
 * ec_nic_look() - read the link state
 * @nic: controller
 *
 * A read of a register takes up to 2 us on PCIe: not for the cycle.
 *
 * Context: Process, one caller at a time.
 */
void ec_nic_look(struct intel_nic *nic)
{
	static const u16 speeds[] = { 10, 100, 1000, 1000 };
	u32 status = ec_nic_read(nic, R_STATUS);

	nic->gone = status == ~0u;
	WRITE_ONCE(nic->speed, speeds[FIELD_GET(STATUS_SPEED, status)]);
	nic->slow = !(status & STATUS_FD) || nic->speed < 100;
	WRITE_ONCE(nic->up, !nic->gone && status & STATUS_LU);
}
