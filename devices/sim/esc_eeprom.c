// SPDX-License-Identifier: GPL-2.0-only
/* EEPROM and its register interface (ETG.1000.4 clause 6.4). */
#include "esc_int.h"

#define CONFIG_BYTES	16	/* words 0-7 */

/**
 * ec_esc_eeprom_crc() - checksum of the configuration area
 * @data: words 0-6, 14 bytes
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what the low byte of word 7 must be.
 */
u8 ec_esc_eeprom_crc(const u8 *data)
{
	u8 crc = 0xff;
	int i, bit;

	for (i = 0; i < 14; i++) {
		crc ^= data[i];
		for (bit = 0; bit < 8; bit++)
			crc = (u8)(crc << 1 ^ (crc & 0x80 ? 0x07 : 0));
	}
	return crc;
}

/* configuration area to registers, at power-on or by the reload command */
void ec_esc_eeprom_load(struct ec_esc *esc, bool power_on)
{
	struct ec_esc_eeprom *e = &esc->eep;
	const u8 *d = e->data;
	u8 *m = esc->mem;

	if (power_on) {
		e->busy_until = EC_ESC_NEVER;
		e->cmd = 0;
		e->control = 0;
		e->alias_loaded = false;
	}
	/* with an emulated EEPROM the configuration is built in */
	e->loaded = e->len >= CONFIG_BYTES &&
		    (esc->cfg.eeprom_emulated || ec_esc_eeprom_crc(d) == d[14]);
	e->control &= (u16)~(EC_EEP_ERR_CHECKSUM | EC_EEP_ERR_LOADING);
	if (!e->loaded) {
		e->control |= EC_EEP_ERR_CHECKSUM;
		return;
	}
	m[EC_REG_PDI_CONTROL] = d[0];
	m[EC_REG_ESC_CONFIG] = d[1];
	memcpy(m + EC_REG_PDI_CONFIG, d + 2, 2);
	memcpy(m + EC_REG_DC_PULSE, d + 4, 2);
	memcpy(m + EC_REG_PDI_CONFIG + 2, d + 6, 2);
	/* many controllers do not take it by a reload */
	if (!e->alias_loaded || esc->cfg.alias_reload) {
		memcpy(m + EC_REG_ALIAS, d + 8, 2);
		e->alias_loaded = true;
		ec_sim_rehash(esc);
	}
	esc->emulation = d[1] & EC_ESC_CONFIG_EMULATION;
}

/* an emulated EEPROM has a command for the PDI */
bool ec_esc_eeprom_asks(const struct ec_esc *esc)
{
	return esc->cfg.eeprom_emulated && esc->eep.cmd;
}

/*
 * The PDI writes 0x0503: the command itself when it is done, with bit 5 when
 * it failed. A word to write the PDI has taken from 0x0508 before.
 */
void ec_esc_eeprom_answer(struct ec_esc *esc, u8 control)
{
	struct ec_esc_eeprom *e = &esc->eep;
	u16 v = (u16)(control << 8);

	if (!ec_esc_eeprom_asks(esc) || (v & EC_EEP_CMD_MASK) != e->cmd)
		return;
	e->control |= v & EC_EEP_ERR_ACK;
	if (esc->fault.eeprom_noack) {
		if (esc->fault.eeprom_noack != ~0u)
			esc->fault.eeprom_noack--;
		e->control |= EC_EEP_ERR_ACK;
	}
	e->cmd = 0;
	e->busy_until = EC_ESC_NEVER;
	esc->al_event &= (u32)~EC_AL_EVENT_EEPROM;
}

static void finish(struct ec_esc *esc, u64 now)
{
	struct ec_esc_eeprom *e = &esc->eep;
	size_t at = (size_t)(e->addr & 0x3ffff) * 2, n, i;

	if (esc->fault.eeprom_noack) {
		if (esc->fault.eeprom_noack != ~0u)
			esc->fault.eeprom_noack--;
		e->control |= EC_EEP_ERR_ACK;
		return;
	}
	switch (e->cmd) {
	case EC_EEP_CMD_READ:
		if (ec_esc_bug(esc, EC_SIM_BUG_EEP_ADDRESS))
			at = 0;
		n = esc->cfg.eeprom_8byte ? 8 : 4;
		for (i = 0; i < n; i++)
			esc->mem[EC_REG_EEP_DATA + i] =
				at + i < e->len ? e->data[at + i] : 0xff;
		break;
	case EC_EEP_CMD_WRITE:
		if (ec_esc_bug(esc, EC_SIM_BUG_EEP_WRITE_LOST))
			break;
		if (at + 2 <= e->len)
			put_unaligned_le16(e->wdata, e->data + at);
		else
			e->control |= EC_EEP_ERR_ACK;
		break;
	case EC_EEP_CMD_RELOAD:
		ec_esc_eeprom_load(esc, false);
		/* an application that starts now reads what was asked for before */
		if (e->loaded && esc->al_unread) {
			esc->pend.al_control = true;
			ec_esc_pend(esc, now);
		}
		break;
	}
}

/* finish what is done by now, bring 0x0502 up to date */
void ec_esc_eeprom_refresh(struct ec_esc *esc, u64 now)
{
	struct ec_esc_eeprom *e = &esc->eep;
	u16 v;

	if (e->cmd && now >= e->busy_until && !esc->fault.eeprom_busy) {
		finish(esc, now);
		e->cmd = 0;
		e->busy_until = EC_ESC_NEVER;
	}
	v = e->control | EC_EEP_TWO_ADDR;
	if (e->len <= 2048)
		v &= (u16)~EC_EEP_TWO_ADDR;
	if (esc->cfg.eeprom_8byte != ec_esc_bug(esc, EC_SIM_BUG_EEP_READ8))
		v |= EC_EEP_READ8;
	if (esc->cfg.eeprom_emulated &&
	    !ec_esc_bug(esc, EC_SIM_BUG_EEP_PDI_HIDDEN))
		v |= EC_EEP_EMULATED;
	if ((e->cmd || esc->fault.eeprom_busy) &&
	    !(esc->cfg.eeprom_emulated &&
	      ec_esc_bug(esc, EC_SIM_BUG_EEP_PDI_LATE)) &&
	    !ec_esc_bug(esc, EC_SIM_BUG_EEP_NEVER_BUSY))
		v |= (u16)(EC_EEP_BUSY | e->cmd);
	put_unaligned_le16(v, esc->mem + EC_REG_EEP_CONTROL);
}

/*
 * Power is lost: of a word that is being written, the chip has erased some bits and has not set all
 * of them. Which, depends on when it happens.
 */
void ec_esc_eeprom_power_off(struct ec_esc *esc, u64 now)
{
	struct ec_esc_eeprom *e = &esc->eep;
	size_t at = (size_t)(e->addr & 0x3ffff) * 2;
	u16 bits;

	ec_esc_eeprom_refresh(esc, now);
	if (e->cmd != EC_EEP_CMD_WRITE || esc->cfg.eeprom_emulated || at + 2 > e->len)
		return;
	bits = (u16)((e->busy_until - now) * 0x9e3779b1u >> 16);
	if (bits & 3)		/* else it has not begun */
		put_unaligned_le16(e->wdata | (bits & 4 ? 0xffff : bits), e->data + at);
}

static u64 duration(const struct ec_esc *esc, u16 cmd)
{
	switch (cmd) {
	case EC_EEP_CMD_WRITE:
		return esc->cfg.eeprom_write_ns;
	case EC_EEP_CMD_RELOAD:
		return 2ull * esc->cfg.eeprom_busy_ns;
	default:
		return esc->cfg.eeprom_8byte ? esc->cfg.eeprom_busy_ns :
					       esc->cfg.eeprom_busy_ns / 2;
	}
}

static void command(struct ec_esc *esc, u16 control,
		    const struct ec_frame_ctx *ctx)
{
	struct ec_esc_eeprom *e = &esc->eep;
	u16 cmd = control & EC_EEP_CMD_MASK;

	e->control &= (u16)~(EC_EEP_ERR_ACK | EC_EEP_ERR_WRITE_EN);
	switch (cmd) {
	case 0:
		return;
	case EC_EEP_CMD_WRITE:
		if (!(control & EC_EEP_WRITE_ENABLE) &&
		    !ec_esc_bug(esc, EC_SIM_BUG_EEP_ENABLE)) {
			e->control |= EC_EEP_ERR_WRITE_EN;
			return;
		}
		break;
	case EC_EEP_CMD_READ:
	case EC_EEP_CMD_RELOAD:
		break;
	default:
		e->control |= EC_EEP_ERR_ACK;
		return;
	}
	e->cmd = cmd;
	e->addr = get_unaligned_le32(esc->mem + EC_REG_EEP_ADDRESS);
	e->wdata = ec_esc_get16(esc, EC_REG_EEP_DATA);
	if (!esc->cfg.eeprom_emulated) {
		e->busy_until = ctx->now + duration(esc, cmd);
		esc->own.reads += cmd == EC_EEP_CMD_READ;
		esc->own.eeprom_ns += duration(esc, cmd);
		return;
	}
	e->busy_until = EC_ESC_NEVER;	/* until the PDI answers */
	esc->al_event |= EC_AL_EVENT_EEPROM;
	esc->pend.eeprom = true;
	ec_esc_pend(esc, ctx->end);
}

/*
 * The master writes to 0x0500-0x050F. Everything but the owner is ignored
 * while the PDI has the interface or a command runs.
 */
void ec_esc_eeprom_write(struct ec_esc *esc, u16 ado, const u8 *buf,
			 size_t len, const struct ec_frame_ctx *ctx)
{
	u8 *m = esc->mem;
	bool hit_lo, hit_hi, busy;
	u16 control = 0;
	size_t i;

	ec_esc_eeprom_refresh(esc, ctx->now);
	if (ec_range_hit(ado, (u32)len, EC_REG_EEP_OWNER, 1)) {
		u8 v = buf[EC_REG_EEP_OWNER - ado];

		m[EC_REG_EEP_OWNER] = v & (EC_EEP_OWNER_PDI | EC_EEP_OWNER_FORCE);
		if (v & EC_EEP_OWNER_FORCE)
			m[EC_REG_EEP_PDI] &= (u8)~1;
	}
	busy = esc->eep.cmd || esc->fault.eeprom_busy;
	if (m[EC_REG_EEP_OWNER] & EC_EEP_OWNER_PDI || m[EC_REG_EEP_PDI] & 1 ||
	    busy)
		return;

	hit_lo = ec_range_hit(ado, (u32)len, EC_REG_EEP_CONTROL, 1);
	hit_hi = ec_range_hit(ado, (u32)len, EC_REG_EEP_CONTROL + 1, 1);
	for (i = 0; i < len; i++) {
		u32 a = ado + (u32)i;

		if (a >= EC_REG_EEP_ADDRESS && a < EC_REG_EEP_DATA + 8)
			m[a] = buf[i];
	}
	if (hit_lo)
		control |= buf[EC_REG_EEP_CONTROL - ado] & EC_EEP_WRITE_ENABLE;
	if (hit_hi)
		control |= (u16)(buf[EC_REG_EEP_CONTROL + 1 - ado] << 8);
	if (hit_hi)
		command(esc, control, ctx);
}
