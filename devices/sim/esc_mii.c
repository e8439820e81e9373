// SPDX-License-Identifier: GPL-2.0-only
/* MII management: port status, and PHYs with the registers everyone reads. */
#include "esc_int.h"

#define CMD_READ	0x01	/* in the high byte */
#define CMD_WRITE	0x02
#define ERR_READ	0x2000
#define ERR_COMMAND	0x4000
#define PDI_ACCESS	0x01
#define PDI_FORCE	0x02

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

/*
 * The master writes to 0x0510-0x051b. The PHY numbers and data lie in memory
 * already. A command takes no time. The PDI takes part by 0x0517 only.
 */
void ec_esc_mii_write(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len)
{
	u8 *m = esc->mem, phy = m[EC_REG_MII_PHY] & 0x1f;
	u16 v = ec_esc_get16(esc, EC_REG_MII_CONTROL);
	bool enable, known;
	u8 cmd;

	if (ec_range_hit(ado, len, EC_REG_MII_PDI, 1)) {
		u8 force = buf[EC_REG_MII_PDI - ado] & PDI_FORCE;

		m[EC_REG_MII_PDI] = force ? PDI_FORCE :
					    m[EC_REG_MII_PDI] & PDI_ACCESS;
	}
	if (!ec_range_hit(ado, len, EC_REG_MII_CONTROL + 1, 1) ||
	    m[EC_REG_MII_PDI] & PDI_ACCESS)
		return;
	enable = ec_range_hit(ado, len, EC_REG_MII_CONTROL, 1) &&
		 buf[EC_REG_MII_CONTROL - ado] & 1;
	cmd = buf[EC_REG_MII_CONTROL + 1 - ado];
	known = phy < EC_MAX_PORT && esc->cfg.ports[phy] == EC_PORT_TYPE_MII;
	v &= (u16)~(ERR_READ | ERR_COMMAND);
	if (cmd & CMD_READ && cmd & CMD_WRITE)
		v |= ERR_COMMAND;
	else if (cmd & CMD_READ && known)
		put_unaligned_le16(phy_read(esc, phy, m[EC_REG_MII_REG] & 0x1f),
				   m + EC_REG_MII_DATA);
	else if (cmd & CMD_READ)
		v |= ERR_READ;
	else if (cmd & CMD_WRITE && (!enable || !known))
		v |= ERR_COMMAND;	/* else the PHY keeps its settings */
	put_unaligned_le16(v, m + EC_REG_MII_CONTROL);
}
