// SPDX-License-Identifier: GPL-2.0-only
/* The slave controller as its own CPU sees it. */
#include "esc_int.h"

/**
 * ec_esc_pdi_read() - the slave's CPU reads
 * @esc: slave controller
 * @ado: address
 * @buf: result
 * @len: bytes
 * @now: simulation time, ns
 *
 * Reading an output window takes the latest complete buffer, if it begins at
 * the window's start; a mailbox becomes empty with its last byte. Reading
 * registers acknowledges AL events as hardware does: 0x0120 AL control,
 * 0x0806 + 8n SM activation, 0x0440 watchdog, 0x098e and 0x098f SYNC.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EACCES where the PDI may not read or nothing was written yet.
 */
int ec_esc_pdi_read(struct ec_esc *esc, u16 ado, void *buf, size_t len,
		    u64 now)
{
	struct ec_frame_ctx ctx = { .now = now, .end = now };
	const u8 *p;
	int sm, n;

	ec_esc_settle(esc);
	ec_esc_wd_pdi_trigger(esc, now);
	if (ado >= EC_REG_RAM) {
		p = ec_esc_sm_begin(esc, ado, len, true, false, &sm);
		if (!p)
			return -EACCES;
		memcpy(buf, p, len);
		ec_esc_sm_end(esc, sm, ado, len, true, &ctx);
		return 0;
	}
	if (ado + len > EC_REG_RAM)
		return -EACCES;
	ec_esc_refresh(esc, ado, (u32)len, now);
	memcpy(buf, esc->mem + ado, len);
	if (ec_range_hit(ado, (u32)len, EC_REG_AL_CONTROL, 2)) {
		esc->al_event &= (u32)~EC_AL_EVENT_CONTROL;
		esc->al_unread = false;
	}
	if (ec_range_hit(ado, (u32)len, EC_REG_WD_STATUS, 2))
		esc->al_event &= (u32)~EC_AL_EVENT_WD;
	for (n = 0; n < esc->cfg.sms; n++)
		if (ec_range_hit(ado, (u32)len,
				 EC_REG_SM(n) + EC_SM_OFS_ACTIVATE, 1))
			esc->al_event &= (u32)~EC_AL_EVENT_SM_ACT;
	if (ec_range_hit(ado, (u32)len, EC_REG_DC_SYNC0_STATUS, 2))
		ec_esc_dc_sync_ack(esc, ado, (u32)len, now);
	if (ec_range_hit(ado, (u32)len, EC_DC_FIRST, EC_DC_SIZE))
		ec_esc_dc_read(esc, ado, len, true);
	return 0;
}

static bool pdi_may_write(const struct ec_esc *esc, u32 a)
{
	if (a >= EC_REG_EEP_DATA && a < EC_REG_EEP_DATA + 8 &&
	    ec_esc_eeprom_asks(esc))
		return true;
	if (a >= EC_REG_EEP_CONTROL && a < EC_REG_EEP_DATA + 8)
		return esc->mem[EC_REG_EEP_PDI] & 1;
	return (a >= EC_REG_ALIAS && a < EC_REG_ALIAS + 2) ||
	       (a >= EC_REG_AL_STATUS && a < EC_REG_AL_STATUS + 2) ||
	       (a >= EC_REG_AL_CODE && a < EC_REG_AL_CODE + 2) ||
	       a == 0x0138 || a == 0x0139 ||
	       (a >= EC_REG_AL_MASK && a < EC_REG_AL_MASK + 4) ||
	       (a == EC_REG_EEP_PDI &&
		esc->mem[EC_REG_EEP_OWNER] & EC_EEP_OWNER_PDI) ||
	       (a >= EC_REG_SM(0) && a < EC_REG_SM(0u + esc->cfg.sms) &&
		(a & 7) == EC_SM_OFS_PDI) ||
	       a >= 0x0e00;
}

/**
 * ec_esc_pdi_write() - the slave's CPU writes
 * @esc: slave controller
 * @ado: address
 * @buf: data
 * @len: bytes
 * @now: simulation time, ns
 *
 * Writing an input window fills the PDI's own buffer and hands it over with
 * the last byte; a mailbox must be empty. Bytes of registers that the PDI may
 * not write keep their value.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0, -EACCES where the PDI may not write or a mailbox is full.
 */
int ec_esc_pdi_write(struct ec_esc *esc, u16 ado, const void *buf, size_t len,
		     u64 now)
{
	struct ec_frame_ctx ctx = { .now = now, .end = now };
	const u8 *src = buf;
	u8 *p;
	u32 i;
	int sm, n;

	ec_esc_settle(esc);
	ec_esc_wd_pdi_trigger(esc, now);
	if (ado >= EC_REG_RAM) {
		p = ec_esc_sm_begin(esc, ado, len, true, true, &sm);
		if (!p)
			return -EACCES;
		memcpy(p, buf, len);
		ec_esc_sm_end(esc, sm, ado, len, true, &ctx);
		return 0;
	}
	if (ado + len > EC_REG_RAM)
		return -EACCES;
	for (i = 0; i < len; i++)
		if (pdi_may_write(esc, ado + i))
			esc->mem[ado + i] = src[i];
	if (ec_range_hit(ado, (u32)len, EC_REG_EEP_CONTROL + 1, 1))
		ec_esc_eeprom_answer(esc, src[EC_REG_EEP_CONTROL + 1 - ado]);
	if (ec_range_hit(ado, (u32)len, EC_REG_MII_PDI, 1) &&
	    !(esc->mem[EC_REG_MII_ECAT] & 1) &&
	    !(esc->mem[EC_REG_MII_PDI] & 2))
		esc->mem[EC_REG_MII_PDI] = src[EC_REG_MII_PDI - ado] & 1;
	if (ec_range_hit(ado, (u32)len, EC_DC_FIRST, EC_DC_SIZE))
		ec_esc_dc_pdi_write(esc, ado, src, (u32)len, now);
	if (ec_range_hit(ado, (u32)len, EC_REG_ALIAS, 2))
		ec_sim_rehash(esc);
	if (ec_range_hit(ado, (u32)len, EC_REG_AL_STATUS, 2))
		ec_esc_event(esc, EC_ECAT_EVENT_AL, 0);
	for (n = 0; n < esc->cfg.sms; n++) {
		u32 a = EC_REG_SM(n) + EC_SM_OFS_PDI;

		if (!ec_range_hit(ado, (u32)len, a, 1))
			continue;
		esc->sm[n].page.pdi = src[a - ado];
		ec_esc_sm_pdi_disable(esc, n, src[a - ado] & EC_SM_PDI_DISABLE);
	}
	return 0;
}

/**
 * ec_esc_set_al_status() - the slave's CPU reports its state
 * @esc: slave controller
 * @status: 0x0130
 * @code: 0x0134
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_set_al_status(struct ec_esc *esc, u16 status, u16 code, u64 now)
{
	u8 b[2];

	put_unaligned_le16(code, b);
	ec_esc_pdi_write(esc, EC_REG_AL_CODE, b, 2, now);
	put_unaligned_le16(status, b);
	ec_esc_pdi_write(esc, EC_REG_AL_STATUS, b, 2, now);
}

/**
 * ec_esc_wake_at() - the application wants @poll
 * @esc: slave controller
 * @at_ns: simulation time, ns; EC_ESC_NEVER: not at all
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_wake_at(struct ec_esc *esc, u64 at_ns)
{
	esc->app_wake_ns = at_ns;
	ec_sim_touch(esc);
}
