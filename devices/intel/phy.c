// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bitfield.h>
#include <linux/delay.h>
#include <linux/errno.h>
#include <linux/iopoll.h>
#include "phy.h"
#include "regs.h"

#define MDIC_US		2000
#define TRIES		10	/* to get the PHY, 1 to 2 ms each */
#define SWSM_US		10000

static int mdic(const struct intel_nic *nic, u32 command)
{
	u32 v;

	ec_nic_write(nic, R_MDIC, command | MDIC_PHY_1);
	if (readl_poll_timeout(nic->regs + R_MDIC, v, v & MDIC_READY, 50, MDIC_US))
		return -ETIMEDOUT;
	return v & MDIC_ERROR ? -EIO : v & 0xffff;
}

/* data sheet of the 82574, 10.2.2.9; the bit stays clear while the hardware owns it */
static bool own(const struct intel_nic *nic)
{
	ec_nic_write(nic, R_EXTCNF_CTRL, ec_nic_read(nic, R_EXTCNF_CTRL) | EXTCNF_MDIO_OWNER);
	return ec_nic_read(nic, R_EXTCNF_CTRL) & EXTCNF_MDIO_OWNER;
}

static void end_swsm(const struct intel_nic *nic)
{
	ec_nic_write(nic, R_SWSM, ec_nic_read(nic, R_SWSM) & ~(SWSM_SMBI | SWSM_SWESMBI));
}

/* first against other software, then against firmware (data sheet of the I210, 4.6) */
static bool begin_swsm(const struct intel_nic *nic)
{
	u32 v;

	/* software that ended without giving it back keeps it no longer than this */
	if (readl_poll_timeout(nic->regs + R_SWSM, v, !(v & SWSM_SMBI), 50, SWSM_US)) {
		end_swsm(nic);
		return false;
	}
	ec_nic_write(nic, R_SWSM, ec_nic_read(nic, R_SWSM) | SWSM_SWESMBI);
	if (ec_nic_read(nic, R_SWSM) & SWSM_SWESMBI)
		return true;
	end_swsm(nic);
	return false;
}

/* of this function's PHY in SW_FW_SYNC */
static u32 sync_bit(const struct intel_nic *nic)
{
	static const u32 bits[] = { BIT(1), BIT(2), BIT(5), BIT(6) };

	return bits[FIELD_GET(STATUS_FUNCTION, ec_nic_read(nic, R_STATUS))];
}

static bool sync_begin(const struct intel_nic *nic)
{
	u32 bit = sync_bit(nic), v;
	bool ok;

	if (!begin_swsm(nic))
		return false;
	v = ec_nic_read(nic, R_SW_FW_SYNC);
	ok = !(v & (bit | bit << SYNC_FIRMWARE));
	if (ok)
		ec_nic_write(nic, R_SW_FW_SYNC, v | bit);
	end_swsm(nic);
	return ok;
}

static bool take_phy(const struct intel_nic *nic)
{
	unsigned int i;

	if (!nic->class->phy_owner && !nic->class->phy_sync)
		return true;
	for (i = 0; i < TRIES; i++) {
		if (nic->class->phy_owner ? own(nic) : sync_begin(nic))
			return true;
		usleep_range(1000, 2000);
	}
	return false;
}

static void leave_phy(const struct intel_nic *nic)
{
	unsigned int i;

	if (nic->class->phy_owner)
		ec_nic_write(nic, R_EXTCNF_CTRL,
			     ec_nic_read(nic, R_EXTCNF_CTRL) & ~EXTCNF_MDIO_OWNER);
	if (!nic->class->phy_sync)
		return;
	for (i = 0; i < TRIES && !begin_swsm(nic); i++)
		usleep_range(1000, 2000);
	/* also without the semaphore: it is our bit, and nothing else clears it */
	ec_nic_write(nic, R_SW_FW_SYNC, ec_nic_read(nic, R_SW_FW_SYNC) & ~sync_bit(nic));
	end_swsm(nic);
}

/**
 * ec_phy_wake() - switch the PHY on
 * @nic: controller
 * @anew: without a link it negotiates anew, which takes seconds
 *
 * The stock driver switches the PHY off with its interface, and some chips do not negotiate by
 * themselves after a reset. A link that is up stays.
 *
 * Context: Process. May sleep.
 * Return: 0, -EBUSY while firmware has the PHY, -ETIMEDOUT or -EIO when it does not answer.
 */
int ec_phy_wake(const struct intel_nic *nic, bool anew)
{
	int bmcr;

	if (!take_phy(nic))
		return -EBUSY;
	bmcr = mdic(nic, MDIC_READ | PHY_BMCR << MDIC_REG);
	if (bmcr >= 0 && (bmcr & BMCR_POWER_DOWN ||
			  (anew && !(ec_nic_read(nic, R_STATUS) & STATUS_LU)))) {
		bmcr &= ~BMCR_POWER_DOWN;
		bmcr = mdic(nic, MDIC_WRITE | PHY_BMCR << MDIC_REG | bmcr | BMCR_AUTONEG);
	}
	leave_phy(nic);
	return min(bmcr, 0);
}
