// SPDX-License-Identifier: GPL-2.0-only
/*
 * Write protection of the registers (0x0020, 0x0021) and of the whole slave
 * controller (0x0030, 0x0031). It holds the master back, not the PDI. A write
 * of 0 to the enable register opens the way for the rest of the same frame,
 * this datagram included. What is protected behaves as a register that the
 * master may only read: the write counts and changes nothing.
 */
#include "esc_int.h"

/* frames are counted from 1, so 0 never was one */
static bool locked(const struct ec_esc *esc, u16 protect, u64 open)
{
	if (!(esc->mem[protect] & 1) || ec_esc_bug(esc, EC_SIM_BUG_PROTECT))
		return false;
	return ec_esc_bug(esc, EC_SIM_BUG_PROTECT_OPEN) ?
		!open : open != esc->sim->frame;
}

/* may this frame not write to the RAM */
bool ec_esc_ram_locked(const struct ec_esc *esc)
{
	return locked(esc, EC_REG_ESC_WRITE_PROTECT, esc->open_all);
}

static void take_enable(struct ec_esc *esc, u16 reg, u64 *open, u16 ado,
			const u8 *buf, u32 len)
{
	if (ec_range_hit(ado, len, reg, 1) && !(buf[reg - ado] & 1))
		*open = esc->sim->frame;
}

/*
 * A write to registers: notes the enable in it. Returns how many bytes at its
 * beginning are protected.
 */
u32 ec_esc_protect(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len)
{
	take_enable(esc, EC_REG_WRITE_ENABLE, &esc->open_regs, ado, buf, len);
	take_enable(esc, EC_REG_ESC_WRITE_ENABLE, &esc->open_all, ado, buf, len);
	if (ec_esc_ram_locked(esc))
		return len;
	if (ado < EC_REG_USER_RAM &&
	    locked(esc, EC_REG_WRITE_PROTECT, esc->open_regs))
		return min_t(u32, len, EC_REG_USER_RAM - ado);
	return 0;
}
