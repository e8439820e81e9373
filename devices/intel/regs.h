/* SPDX-License-Identifier: GPL-2.0-only */
/* Registers in BAR 0, the same in all chips of chip.c (data sheet of the 82574, chapter 10). */
#ifndef EC_INTEL_REGS_H
#define EC_INTEL_REGS_H

#include <linux/bits.h>

#define R_CTRL		0x0000
#define  CTRL_FD		BIT(0)
#define  CTRL_GIO_DISABLE	BIT(2)	/* PCIe: no new master requests */
#define  CTRL_SLU		BIT(6)
#define  CTRL_FORCE_SPEED	BIT(11)
#define  CTRL_FORCE_DUPLEX	BIT(12)
#define  CTRL_RST		BIT(26)
#define  CTRL_PAUSE		(BIT(27) | BIT(28))	/* obey and send pause frames */
#define R_STATUS	0x0008
#define  STATUS_FD		BIT(0)
#define  STATUS_LU		BIT(1)
#define  STATUS_FUNCTION	GENMASK(3, 2)
#define  STATUS_SPEED		GENMASK(7, 6)	/* 0: 10, 1: 100, others: 1000 Mbit/s */
#define  STATUS_GIO_ENABLED	BIT(19)
#define R_CTRL_EXT	0x0018
#define  CTRL_EXT_LINK_MODE	GENMASK(23, 22)	/* advanced: 0 is copper */
#define  CTRL_EXT_DRV_LOAD	BIT(28)
#define R_MDIC		0x0020
#define  MDIC_REG		16
#define  MDIC_PHY_1		(1 << 21)
#define  MDIC_WRITE		(1 << 26)
#define  MDIC_READ		(2 << 26)
#define  MDIC_READY		BIT(28)
#define  MDIC_ERROR		BIT(30)
#define R_ICR		0x00c0
#define R_IMC		0x00d8
#define R_RCTL		0x0100
#define  RCTL_EN		BIT(1)
#define  RCTL_UPE		BIT(3)
#define  RCTL_MPE		BIT(4)
#define  RCTL_BAM		BIT(15)
#define  RCTL_SECRC		BIT(26)
#define R_TCTL		0x0400
#define  TCTL_EN		BIT(1)
#define  TCTL_PSP		BIT(3)
#define  TCTL_COLLISIONS	(0x0f << 4 | 0x40 << 12)
#define R_TIPG		0x0410
#define  TIPG_COPPER		(8 | 8 << 10 | 6 << 20)
#define R_PHPM		0x0e14
#define  PHPM_GO_LINKD		BIT(5)
#define R_EEER		0x0e30
#define  EEER_ALL		GENMASK(18, 16)
#define R_IPCNFG	0x0e38
#define  IPCNFG_EEE		GENMASK(3, 2)
#define R_EXTCNF_CTRL	0x0f00
#define  EXTCNF_MDIO_OWNER	BIT(5)
#define R_EIMC		0x1528
#define R_TXDCTL	0x3828
#define R_TARC0		0x3840
#define R_CRCERRS	0x4000		/* counters: 0 after they are read */
#define R_RXERRC	0x400c
#define R_MPC		0x4010
#define R_RFCTL		0x5008
#define R_MTA		0x5200
#define R_RAL0		0x5400
#define R_RAH0		0x5404
#define  RAH_VALID		BIT(31)
#define R_MRQC		0x5818
#define R_GCR		0x5b00
#define R_SWSM		0x5b50
#define  SWSM_SMBI		BIT(0)		/* set by a read that finds it clear */
#define  SWSM_SWESMBI		BIT(1)
#define R_SW_FW_SYNC	0x5b5c
#define  SYNC_FIRMWARE		16		/* its bits, beside those of the software */
#define R_GCR2		0x5b64

/* of a queue, behind the offsets of struct intel_class */
#define Q_BAL		0x00
#define Q_BAH		0x04
#define Q_LEN		0x08
#define Q_SRRCTL	0x0c		/* advanced, receive */
#define  SRRCTL_ADVANCED	(1 << 25)
#define  SRRCTL_2K		2
#define Q_HEAD		0x10
#define Q_TAIL		0x18
#define Q_DCTL		0x28		/* threshold and enable */
#define  DCTL_ENABLE		BIT(25)
#define Q_DELAY		0x20		/* legacy: RDTR, TIDV */
#define Q_DELAY_ABS	0x2c		/* legacy: RADV, TADV */

/* PHY */
#define PHY_BMCR	0
#define  BMCR_POWER_DOWN	BIT(11)
#define  BMCR_AUTONEG		(BIT(12) | BIT(9))

#endif
