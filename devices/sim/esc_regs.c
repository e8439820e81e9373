// SPDX-License-Identifier: GPL-2.0-only
/* Which registers there are, and which of them the master may write. */
#include "esc_int.h"

/* whole registers; FMMU and SyncManager pages depend on the configuration */
static const struct {
	u16 first;
	u16 last;
} used[] = {
	{ 0x0000, 0x0009 }, { 0x0010, 0x0013 }, { 0x0020, 0x0021 },
	{ 0x0030, 0x0031 }, { 0x0040, 0x0041 }, { 0x0100, 0x0103 },
	{ 0x0108, 0x0109 }, { 0x0110, 0x0111 }, { 0x0120, 0x0121 },
	{ 0x0130, 0x0131 }, { 0x0134, 0x0135 }, { 0x0138, 0x0139 },
	{ 0x0140, 0x0141 }, { 0x014e, 0x0153 }, { 0x0200, 0x0201 },
	{ 0x0204, 0x0207 }, { 0x0210, 0x0211 }, { 0x0220, 0x0223 },
	{ 0x0300, 0x030f }, { 0x0310, 0x0313 }, { 0x0400, 0x0401 },
	{ 0x0410, 0x0411 }, { 0x0420, 0x0421 }, { 0x0440, 0x0443 },
	{ 0x0500, 0x051b }, { 0x0900, 0x0936 }, { 0x0980, 0x0984 },
	{ 0x098e, 0x09a9 }, { 0x09ae, 0x09cf }, { 0x09f0, 0x09f3 },
	{ 0x09f8, 0x09ff }, { 0x0e00, 0x0eff }, { 0x0f00, 0x0f03 },
	{ 0x0f10, 0x0f1f }, { 0x0f80, 0x0fff },
};

static bool is_used(const struct ec_esc *esc, u32 a)
{
	size_t i;

	if (a >= EC_REG_FMMU(0) && a < EC_REG_FMMU(0u + esc->cfg.fmmus))
		return true;
	if (a >= EC_REG_SM(0) && a < EC_REG_SM(0u + esc->cfg.sms))
		return true;
	for (i = 0; i < ARRAY_SIZE(used); i++)
		if (a >= used[i].first && a <= used[i].last)
			return true;
	return false;
}

static bool within(u32 a, u32 len, u32 first, u32 end)
{
	return a >= first && a + len <= end;
}

/* behind the last register of the clock: of a delay-only one the receive times */
static u32 clock_end(const struct ec_esc *esc)
{
	if (!(esc->cfg.features & EC_FEAT_DC))
		return EC_DC_FIRST;
	return ec_esc_has_clock(esc) ? EC_DC_FIRST + EC_DC_SIZE : EC_REG_DC_RECV(EC_MAX_PORT);
}

/*
 * False for a place that this slave controller does not answer at: a datagram
 * counts with one byte of it in a register that exists. One that supports no access
 * to unused registers (feature bit 1) wants it to begin and to end in one that is
 * there; gaps between are passed over.
 */
bool ec_esc_reg_exists(const struct ec_esc *esc, u32 ado, u32 len)
{
	if (ado + len > EC_REG_RAM)
		return false;
	if (esc->cfg.features & EC_FEAT_NO_UNUSED && len &&
	    !(is_used(esc, ado) && is_used(esc, ado + len - 1)))
		return false;
	return !within(ado, len, EC_REG_FMMU(0u + esc->cfg.fmmus), EC_REG_FMMU(EC_MAX_FMMU)) &&
	       !within(ado, len, EC_REG_SM(0u + esc->cfg.sms), EC_REG_SM(EC_MAX_SM)) &&
	       !within(ado, len, clock_end(esc), EC_DC_FIRST + EC_DC_SIZE);
}

static bool in(u32 a, u32 reg, u32 n)
{
	return a - reg < n;
}

/* registers without a behaviour of their own that the master may write */
bool ec_esc_reg_plain(const struct ec_esc *esc, u32 a)
{
	if (in(a, EC_REG_FMMU(0), 16u * esc->cfg.fmmus))
		return true;
	if (in(a, EC_REG_SM(0), 8u * esc->cfg.sms)) {
		u32 n = (a - EC_REG_SM(0)) / EC_SM_PAGE, ofs = a & 7;

		/* the page can be changed while the SM is switched off */
		return ofs == EC_SM_OFS_ACTIVATE ||
		       (ofs <= EC_SM_OFS_CONTROL &&
			!(esc->sm[n].page.activate & EC_SM_ACT_ENABLE));
	}
	return in(a, EC_REG_STATION, 2) || in(a, EC_REG_DL_CONTROL, 4) ||
	       a == EC_REG_WRITE_PROTECT || a == EC_REG_ESC_WRITE_PROTECT ||
	       in(a, 0x0108, 2) || in(a, EC_REG_ECAT_MASK, 2) ||
	       in(a, EC_REG_WD_DIVIDER, 2) || in(a, EC_REG_WD_PDI, 2) ||
	       in(a, EC_REG_WD_SM, 2) || in(a, EC_REG_MII_PHY, 5) ||
	       in(a, 0x0f00, 4) || in(a, 0x0f10, 8) || a >= EC_REG_USER_RAM;
}

/* what a controller has built in: loops, and pages with fixed use of them (bit 11) */
void ec_esc_regs_fixed(struct ec_esc *esc)
{
	static const u8 fmmu[3] = { EC_FMMU_WRITE, EC_FMMU_READ, EC_FMMU_READ };
	static const u8 sm[4] = {
		EC_SM_MODE_MAILBOX | EC_SM_DIR_WRITE, EC_SM_MODE_MAILBOX,
		EC_SM_MODE_BUFFERED | EC_SM_DIR_WRITE, EC_SM_MODE_BUFFERED,
	};
	u8 *m = esc->mem;
	u32 i;

	if (esc->cfg.loops_fixed)
		m[EC_REG_DL_LOOPS] = 0;
	if (!(esc->cfg.features & EC_FEAT_FIXED_FMMU_SM))
		return;
	for (i = 0; i < ARRAY_SIZE(fmmu) && i < esc->cfg.fmmus; i++)
		m[EC_REG_FMMU(i) + 11] = fmmu[i];
	for (i = 0; i < ARRAY_SIZE(sm) && i < esc->cfg.sms; i++) {
		u8 *c = m + EC_REG_SM(i) + EC_SM_OFS_CONTROL;

		*c = (u8)((*c & ~(EC_SM_MODE_MASK | EC_SM_DIR_MASK)) | sm[i]);
	}
}
