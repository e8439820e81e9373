// SPDX-License-Identifier: GPL-2.0-only
/* MII management: port status, and PHYs with the registers everyone reads. */
#include "esc_int.h"

#define CMD_READ	0x0100
#define CMD_WRITE	0x0200
#define ERR_READ	0x2000

void ec_esc_mii_reset(struct ec_esc *esc)
{
	put_unaligned_le16(0x0004, esc->mem + EC_REG_MII_CONTROL);
}

void ec_esc_mii_refresh(struct ec_esc *esc)
{
	int p;

	for (p = 0; p < EC_MAX_PORT; p++)
		esc->mem[EC_REG_MII_PORT(p)] =
			esc->cfg.ports[p] == EC_PORT_TYPE_MII &&
			esc->port[p].link ? 0x03 : 0x00;
}

static u16 phy_read(const struct ec_esc *esc, u8 phy, u8 reg)
{
	bool link = esc->port[phy].link;

	switch (reg) {
	case 0:
		return 0x3100;			/* 100 Mbit, auto, full duplex */
	case 1:
		return link ? 0x782d : 0x7809;
	case 2:
		return 0x0022;
	case 3:
		return 0x1619;
	case 4:
		return 0x0101;
	case 5:
		return link ? 0x4101 : 0x0000;
	default:
		return 0;
	}
}

void ec_esc_mii_write(struct ec_esc *esc, u16 ado, size_t len)
{
	u16 v = ec_esc_get16(esc, EC_REG_MII_CONTROL);
	u8 phy = esc->mem[EC_REG_MII_PHY] & 0x1f;
	u8 reg = esc->mem[EC_REG_MII_REG] & 0x1f;

	if (!ec_range_hit(ado, (u32)len, EC_REG_MII_CONTROL + 1, 1))
		return;
	if (v & CMD_READ) {
		v &= (u16)~ERR_READ;
		if (phy < EC_MAX_PORT &&
		    esc->cfg.ports[phy] == EC_PORT_TYPE_MII)
			put_unaligned_le16(phy_read(esc, phy, reg),
					   esc->mem + EC_REG_MII_DATA);
		else
			v |= ERR_READ;
	}
	v &= (u16)~(CMD_READ | CMD_WRITE | 1);
	put_unaligned_le16(v, esc->mem + EC_REG_MII_CONTROL);
}
