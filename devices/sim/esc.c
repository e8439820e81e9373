// SPDX-License-Identifier: GPL-2.0-only
/*
 * Slave controller: registers and datagrams.
 *
 * A write to a register that the master may only read is accepted, counts
 * and changes nothing. Not counted are: accesses beyond the RAM, accesses
 * across the border of registers and RAM, what a SyncManager refuses, DC
 * registers of a slave without DC, and the AL control write before the PDI
 * has read the last one.
 */
#include "esc_int.h"

/**
 * ec_esc_config_init() - settings of an ordinary slave controller
 * @cfg: result; 4 MII ports, 8 FMMUs, 8 SyncManagers, 8 KiB, 64-bit DC, no
 *       EEPROM content, exact crystal
 *
 * Both delays are 500 ns: 1 us per slave there and back. Different figures
 * give the systematic error that unsymmetric slaves show.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_config_init(struct ec_esc_config *cfg)
{
	memset(cfg, 0, sizeof(*cfg));
	cfg->type = 0x11;
	cfg->build = 2;
	cfg->fmmus = 8;
	cfg->sms = 8;
	cfg->ram_kib = 8;
	memset(cfg->ports, EC_PORT_TYPE_MII, sizeof(cfg->ports));
	cfg->features = EC_FEAT_DC | EC_FEAT_DC64 | EC_FEAT_FCS_SEPARATE |
			EC_FEAT_DC_ENHANCED;
	cfg->eeprom_8byte = true;
	cfg->eeprom_busy_ns = 740000;
	cfg->eeprom_write_ns = 5000000;
	cfg->process_ns = 500;
	cfg->forward_ns = 500;
	cfg->dc_noise_ns = 10;
}

bool ec_esc_config_valid(const struct ec_esc_config *c)
{
	return c->fmmus && c->fmmus <= EC_MAX_FMMU && c->sms &&
	       c->sms <= EC_MAX_SM && c->ram_kib && c->ram_kib <= 60;
}

void ec_esc_power_on(struct ec_esc *esc, u64 now)
{
	const struct ec_esc_config *c = &esc->cfg;
	u8 *m = esc->mem;
	int p;

	memset(m, 0, esc->mem_len);
	m[EC_REG_TYPE] = c->type;
	m[EC_REG_REVISION] = c->revision;
	put_unaligned_le16(c->build, m + EC_REG_BUILD);
	m[EC_REG_FMMUS] = c->fmmus;
	m[EC_REG_SMS] = c->sms;
	m[EC_REG_RAM_KIB] = c->ram_kib;
	for (p = 0; p < EC_MAX_PORT; p++)
		m[EC_REG_PORTS] |= (u8)(c->ports[p] << 2 * p);
	put_unaligned_le16(c->features, m + EC_REG_FEATURES);
	put_unaligned_le32(0x00070001, m + EC_REG_DL_CONTROL);
	m[EC_REG_AL_CONTROL] = 1;
	m[EC_REG_AL_STATUS] = 1;
	put_unaligned_le16(0x09c2, m + EC_REG_WD_DIVIDER);
	put_unaligned_le16(1000, m + EC_REG_WD_PDI);
	put_unaligned_le16(1000, m + EC_REG_WD_SM);

	esc->ecat_event = 0;
	esc->al_event = 0;
	ec_esc_event(esc, 0, 0);
	esc->al_unread = false;
	esc->emulation = false;
	esc->wd_due = EC_ESC_NEVER;
	esc->wd_pdi_expired = false;
	ec_esc_wd_pdi_trigger(esc, now);
	esc->loop_restore = EC_ESC_NEVER;
	esc->app_wake_ns = EC_ESC_NEVER;
	esc->reset_step = 0;
	memset(&esc->pend, 0, sizeof(esc->pend));
	esc->late.on = false;
	esc->open_regs = 0;
	esc->open_all = 0;
	ec_esc_regs_fixed(esc);
	ec_esc_sm_reset(esc);
	ec_esc_fmmu_config(esc);
	ec_esc_mii_reset(esc);
	ec_esc_dc_reset(esc, now);
	ec_esc_eeprom_load(esc, true);
	ec_esc_quick_forget(esc);
	ec_sim_rehash(esc);
	ec_sim_touch(esc);
}

/* change the ECAT event register, keep count of slaves that signal one */
void ec_esc_event(struct ec_esc *esc, u16 set, u16 clear)
{
	bool irq;

	if (!ec_esc_bug(esc, EC_SIM_BUG_EVENT_STUCK))
		esc->ecat_event &= (u16)~clear;
	esc->ecat_event |= set;
	irq = ec_esc_irq(esc);
	if (irq != esc->irq) {
		esc->irq = irq;
		esc->sim->irqs += irq ? 1 : -1u;
	}
}

u16 ec_esc_dl_status(const struct ec_esc *esc)
{
	u16 v = (esc->wd_pdi_expired ? 0 : EC_DLS_PDI_WD_OK) |
		(esc->eep.loaded ? EC_DLS_PDI_OK : 0);
	int p;

	for (p = 0; p < EC_MAX_PORT; p++) {
		const struct ec_esc_port *port = &esc->port[p];

		if (port->link)
			v |= (u16)(EC_DLS_LINK(p) | EC_DLS_COMM(p));
		if (!port->open != ec_esc_bug(esc, EC_SIM_BUG_LOOPS_INVERTED))
			v |= (u16)EC_DLS_LOOP(p);
	}
	return v;
}

/* put computed registers in the touched range into memory */
void ec_esc_refresh(struct ec_esc *esc, u16 ado, u32 len, u64 now)
{
	u8 *m = esc->mem;

	if (ec_range_hit(ado, len, EC_REG_DL_STATUS, 2))
		put_unaligned_le16(ec_esc_dl_status(esc), m + EC_REG_DL_STATUS);
	if (ec_range_hit(ado, len, EC_REG_ECAT_EVENT, 0x14)) {
		put_unaligned_le16(esc->ecat_event, m + EC_REG_ECAT_EVENT);
		put_unaligned_le32(esc->al_event, m + EC_REG_AL_EVENT);
	}
	if (ec_range_hit(ado, len, EC_REG_WD_STATUS, 2))
		m[EC_REG_WD_STATUS] = ec_esc_wd_ok(esc);
	if (ec_range_hit(ado, len, EC_REG_EEP_OWNER, 16))
		ec_esc_eeprom_refresh(esc, now);
	if (ec_range_hit(ado, len, EC_REG_MII_CONTROL, 12))
		ec_esc_mii_refresh(esc);
	if (ec_range_hit(ado, len, EC_REG_SM(0), EC_MAX_SM * EC_SM_PAGE))
		ec_esc_sm_refresh(esc);
	if (ec_range_hit(ado, len, EC_DC_FIRST, EC_DC_SIZE))
		ec_esc_dc_refresh(esc, now);
}

/* what reading acknowledges */
static void after_read(struct ec_esc *esc, u16 ado, u32 len)
{
	u16 clear = 0;

	if (ec_range_hit(ado, len, EC_REG_DL_STATUS, 2))
		clear |= EC_ECAT_EVENT_DL;
	if (ec_range_hit(ado, len, EC_REG_AL_STATUS, 2))
		clear |= EC_ECAT_EVENT_AL;
	if (clear)
		ec_esc_event(esc, 0, clear);
	if (ec_range_hit(ado, len, EC_DC_FIRST, EC_DC_SIZE))
		ec_esc_dc_read(esc, ado, len, false);
}

/* the master reads physical memory; false: refused, not counted */
bool ec_esc_phys_read(struct ec_esc *esc, u16 ado, void *buf, size_t len,
		      const struct ec_frame_ctx *ctx)
{
	const u8 *p;
	int sm;

	if (ado >= EC_REG_RAM) {
		p = ec_esc_sm_begin(esc, ado, len, false, false, &sm);
		if (!p)
			return false;
		memcpy(buf, p, len);
		ec_esc_sm_end(esc, sm, ado, len, false, ctx);
		return true;
	}
	if (!ec_esc_reg_exists(esc, ado, (u32)len))
		return false;
	ec_esc_refresh(esc, ado, (u32)len, ctx->now);
	memcpy(buf, esc->mem + ado, len);
	after_read(esc, ado, (u32)len);
	return true;
}

static void clear_errors(struct ec_esc *esc, u16 ado, u32 len)
{
	u8 *m = esc->mem;

	if (ec_esc_bug(esc, EC_SIM_BUG_ERRORS_KEPT))
		return;
	if (ec_range_hit(ado, len, EC_REG_ERR_RX(0), 12))
		memset(m + EC_REG_ERR_RX(0), 0, 12);
	if (ec_range_hit(ado, len, EC_REG_ERR_PU, 1))
		m[EC_REG_ERR_PU] = 0;
	if (ec_range_hit(ado, len, EC_REG_ERR_PDI, 1))
		m[EC_REG_ERR_PDI] = 0;
	if (ec_range_hit(ado, len, EC_REG_ERR_LOST(0), 4))
		memset(m + EC_REG_ERR_LOST(0), 0, 4);
	if (ec_range_hit(ado, len, EC_REG_WD_SM_COUNT, 2))
		memset(m + EC_REG_WD_SM_COUNT, 0, 2);
}

static void al_control(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len,
		       const struct ec_frame_ctx *ctx)
{
	u8 *m = esc->mem;
	u32 i;

	for (i = 0; i < len; i++)
		if (ado + i >= EC_REG_AL_CONTROL &&
		    ado + i < EC_REG_AL_CONTROL + 2)
			m[ado + i] = buf[i];
	if (esc->emulation) {
		memcpy(m + EC_REG_AL_STATUS, m + EC_REG_AL_CONTROL, 2);
		ec_esc_event(esc, EC_ECAT_EVENT_AL, 0);
		return;
	}
	esc->al_event |= EC_AL_EVENT_CONTROL;
	esc->al_unread = esc->app_ops && esc->app_ops->al_control;
	esc->pend.al_control = true;
	ec_esc_pend(esc, ctx->end);
}

static void dl_control(struct ec_esc *esc, u16 ado, u32 len, u8 old_loops,
		       u64 now)
{
	u8 *m = esc->mem;

	if (ec_range_hit(ado, len, EC_REG_DL_ALIAS, 1))
		ec_sim_rehash(esc);
	if (!ec_range_hit(ado, len, EC_REG_DL_LOOPS, 1))
		return;
	if (m[EC_REG_DL_CONTROL] & 0x02 && !ec_esc_bug(esc, EC_SIM_BUG_LOOPS_STAY)) {
		/* for one second */
		if (esc->loop_restore == EC_ESC_NEVER)
			esc->loop_saved = old_loops;
		esc->loop_restore = now + 1000000000;
		ec_sim_port_due(esc->sim, esc->loop_restore);
		ec_sim_touch(esc);
	} else {
		esc->loop_restore = EC_ESC_NEVER;
	}
	ec_sim_loops(esc, true, now);
}

/* 'R', 'E', 'S' in three accesses */
static void reset_letter(struct ec_esc *esc, u8 v, u64 now)
{
	static const u8 letters[3] = { 'R', 'E', 'S' };

	if (v != letters[esc->reset_step]) {
		esc->reset_step = v == 'R';
	} else if (++esc->reset_step == 3) {
		ec_sim_power(esc, false, now);
		ec_sim_power(esc, true, now);
	}
	esc->mem[EC_REG_RESET] = esc->reset_step;
}

static bool reg_write(struct ec_esc *esc, u16 ado, const u8 *buf, u32 len,
		      const struct ec_frame_ctx *ctx)
{
	bool al = ec_range_hit(ado, len, EC_REG_AL_CONTROL, 2);
	bool sms = ec_range_hit(ado, len, EC_REG_SM(0),
				EC_MAX_SM * EC_SM_PAGE);
	u8 old_loops = esc->mem[EC_REG_DL_LOOPS], act[EC_MAX_SM] = {};
	u8 *m = esc->mem;
	u32 i;

	if (al && esc->al_unread && !ec_esc_bug(esc, EC_SIM_BUG_AL_OVERWRITE))
		return false;
	for (i = 0; sms && i < esc->cfg.sms; i++)
		act[i] = esc->sm[i].page.activate;

	for (i = 0; i < len; i++)
		if (ec_esc_reg_plain(esc, ado + i) ||
		    ec_esc_bug(esc, EC_SIM_BUG_READ_ONLY))
			m[ado + i] = buf[i];

	ec_esc_regs_fixed(esc);

	if (ado < 0x0200) {
		m[EC_REG_WRITE_PROTECT] &= 1;
		m[EC_REG_ESC_WRITE_PROTECT] &= 1;
		if (ec_range_hit(ado, len, EC_REG_STATION, 2))
			ec_sim_rehash(esc);
		if (ec_range_hit(ado, len, EC_REG_DL_CONTROL, 4))
			dl_control(esc, ado, len, old_loops, ctx->now);
		if (al)
			al_control(esc, ado, buf, len, ctx);
		if (ec_range_hit(ado, len, EC_REG_RESET, 1))
			reset_letter(esc, buf[EC_REG_RESET - ado], ctx->now);
	}
	if (ec_range_hit(ado, len, EC_REG_ECAT_MASK, 2))
		ec_esc_event(esc, 0, 0);
	if (ec_range_hit(ado, len, EC_REG_ERRORS, 0x200))
		clear_errors(esc, ado, len);
	if (ec_range_hit(ado, len, EC_REG_WD_DIVIDER, 0x22))
		ec_esc_wd_config(esc, ctx->now);
	if (ec_range_hit(ado, len, EC_REG_WD_DIVIDER, 0x12) &&
	    !esc->wd_pdi_expired)
		ec_esc_wd_pdi_trigger(esc, ctx->now);
	if (ec_range_hit(ado, len, EC_REG_EEP_OWNER, 16))
		ec_esc_eeprom_write(esc, ado, buf, len, ctx);
	if (ec_range_hit(ado, len, EC_REG_MII_CONTROL, 12))
		ec_esc_mii_write(esc, ado, buf, len);
	if (ec_range_hit(ado, len, EC_REG_FMMU(0), EC_MAX_FMMU * EC_FMMU_PAGE))
		ec_esc_fmmu_config(esc);
	if (sms)
		ec_esc_sm_config(esc, ado, len, act, ctx);
	if (ec_range_hit(ado, len, EC_DC_FIRST, EC_DC_SIZE))
		ec_esc_dc_write(esc, ado, buf, len, ctx);
	ec_esc_quick_forget(esc);
	return true;
}

/* the master writes physical memory; false: refused, not counted */
bool ec_esc_phys_write(struct ec_esc *esc, u16 ado, const void *buf,
		       size_t len, const struct ec_frame_ctx *ctx)
{
	u32 skip;
	u8 *p;
	int sm;

	if (ado >= EC_REG_RAM) {
		if (ec_esc_ram_locked(esc))
			return ado + len <= esc->mem_len;
		p = ec_esc_sm_begin(esc, ado, len, false, true, &sm);
		if (!p)
			return false;
		memcpy(p, buf, len);
		ec_esc_sm_end(esc, sm, ado, len, false, ctx);
		return true;
	}
	if (!ec_esc_reg_exists(esc, ado, (u32)len))
		return false;
	skip = ec_esc_protect(esc, ado, buf, (u32)len);
	return skip == len ||
	       reg_write(esc, (u16)(ado + skip), (const u8 *)buf + skip,
			 (u32)len - skip, ctx);
}

/* does a physical command address this slave */
bool ec_esc_addressed(const struct ec_esc *esc, const struct ec_dgram *d)
{
	switch (d->cmd) {
	case EC_CMD_FPRD:
	case EC_CMD_FPWR:
	case EC_CMD_FPRW:
	case EC_CMD_FRMW:
		if (d->adp == ec_esc_get16(esc, EC_REG_STATION))
			return true;
		return esc->mem[EC_REG_DL_ALIAS] & 1 &&
		       d->adp == ec_esc_get16(esc, EC_REG_ALIAS) &&
		       !ec_esc_bug(esc, EC_SIM_BUG_NO_ALIAS);
	case EC_CMD_APRD:
	case EC_CMD_APWR:
	case EC_CMD_APRW:
	case EC_CMD_ARMW:
		return !d->adp;
	case EC_CMD_BRD:
	case EC_CMD_BWR:
	case EC_CMD_BRW:
		return !esc->fault.miss_broadcast;
	default:
		return false;
	}
}

static bool read_data(struct ec_esc *esc, struct ec_dgram *d, bool merge,
		      const struct ec_frame_ctx *ctx)
{
	u8 *tmp = esc->sim->scratch2;
	u32 i;

	if (!merge || ec_esc_bug(esc, EC_SIM_BUG_BRD_NO_OR) ||
	    (d->ado == EC_REG_AL_STATUS &&
	     ec_esc_bug(esc, EC_SIM_BUG_AL_NO_OR)))
		return ec_esc_phys_read(esc, d->ado, d->data, d->len, ctx);
	if (!ec_esc_phys_read(esc, d->ado, tmp, d->len, ctx))
		return false;
	for (i = 0; i < d->len; i++)
		d->data[i] |= tmp[i];
	return true;
}

/* a physical command that concerns this slave; returns the increment */
static int physical(struct ec_esc *esc, struct ec_dgram *d,
		    const struct ec_frame_ctx *ctx)
{
	bool match = ec_esc_addressed(esc, d), rd = false, wr = false;
	bool bcast = false;
	const u8 *in = d->data;
	int add = 0;

	switch (d->cmd) {
	case EC_CMD_ARMW:
	case EC_CMD_FRMW:
		if (d->cmd == EC_CMD_FRMW && esc->cfg.no_frmw)
			return 0;
		rd = match;
		wr = !match;
		break;
	case EC_CMD_APRW:
	case EC_CMD_FPRW:
	case EC_CMD_BRW:
		if (esc->cfg.features & EC_FEAT_NO_RW)
			return 0;
		fallthrough;
	default:
		rd = match && ec_cmd_reads(d->cmd);
		wr = match && ec_cmd_writes(d->cmd);
		bcast = d->cmd == EC_CMD_BRD || d->cmd == EC_CMD_BRW;
		break;
	}

	if (rd && wr) {
		memcpy(esc->sim->scratch, d->data, d->len);
		in = esc->sim->scratch;
	}
	if (rd && read_data(esc, d, bcast, ctx)) {
		add++;
		esc->armw_reads += d->cmd == EC_CMD_ARMW;
	}
	if (wr && ec_esc_phys_write(esc, d->ado, in, d->len, ctx)) {
		if (match)
			add += ec_cmd_reads(d->cmd) &&
			       !ec_esc_bug(esc, EC_SIM_BUG_BRW_WKC) ? 2 : 1;
		else
			add += !ec_esc_bug(esc, EC_SIM_BUG_FRMW_WKC);
	}
	return add;
}

/**
 * ec_esc_dgram() - a datagram passes the processing unit
 * @esc: slave controller
 * @d: datagram; address, IRQ field, data and working counter are changed in
 *     the frame as silicon does, @d's own copies follow
 * @ctx: when
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_dgram(struct ec_esc *esc, struct ec_dgram *d,
		  struct ec_frame_ctx *ctx)
{
	int add = 0;

	if (!esc->fault.dead) {
		if (esc->irq) {
			d->irq |= ec_esc_irq(esc);
			put_unaligned_le16(d->irq, d->hdr + 8);
		}
		switch (d->cmd) {
		case EC_CMD_NOP:
			break;
		case EC_CMD_LRD:
		case EC_CMD_LWR:
		case EC_CMD_LRW:
			add = ec_esc_fmmu_access(esc, d, ctx);
			break;
		default:
			if (d->cmd <= EC_CMD_FRMW)
				add = physical(esc, d, ctx);
		}
		if (add)
			ec_dgram_set_wkc(d, (u16)(ec_dgram_wkc(d) + add +
						  esc->fault.wkc_add));
	}

	switch (d->cmd) {
	case EC_CMD_APRD:
	case EC_CMD_APWR:
	case EC_CMD_APRW:
	case EC_CMD_BRD:
	case EC_CMD_BWR:
	case EC_CMD_BRW:
	case EC_CMD_ARMW:
		if (ec_esc_bug(esc, EC_SIM_BUG_AP_NO_INC))
			break;
		d->adp++;
		put_unaligned_le16(d->adp, d->hdr + 2);
	}
}

/* do what is due at @now */
void ec_esc_run(struct ec_esc *esc, u64 now)
{
	ec_esc_settle(esc);
	if (esc->loop_restore <= now) {
		esc->loop_restore = EC_ESC_NEVER;
		esc->mem[EC_REG_DL_LOOPS] = esc->loop_saved;
		esc->mem[EC_REG_DL_CONTROL] &= (u8)~0x02;
		ec_sim_loops(esc, false, now);		/* the master wrote nothing */
	}
	if (esc->link_wake <= now)
		ec_sim_ports(esc, now);
	if (esc->wd_due <= now)
		ec_esc_wd_expire(esc, now);
	if (esc->wd_pdi_due <= now)
		ec_esc_wd_pdi_expire(esc);
	if (esc->dc.sync_wake <= now)
		ec_esc_dc_sync(esc, now);
	if (esc->app_wake_ns <= now) {
		esc->app_wake_ns = EC_ESC_NEVER;
		if (esc->app_ops && esc->app_ops->poll && esc->eep.loaded)
			esc->app_ops->poll(esc, now);
		if (esc->app_wake_ns <= now)
			esc->app_wake_ns = now + 1;
	}
}

/* report to the application what the frame did */
void ec_esc_deliver(struct ec_esc *esc)
{
	const struct ec_esc_app_ops *ops = esc->app_ops;
	u64 now = esc->pend_ns;
	u32 sms = esc->pend.sm_written | esc->pend.sm_read;
	u32 active = esc->pend.sm_activate;
	int n;

	if (ops && esc->eep.loaded && esc->powered) {
		for (; active && ops->sm_activate; active &= active - 1)
			ops->sm_activate(esc, ffs((int)active) - 1, now);
		if (esc->pend.al_control && ops->al_control)
			ops->al_control(esc, now);
		if (esc->pend.eeprom && ops->eeprom)
			ops->eeprom(esc, now);
		for (; sms; sms &= sms - 1) {
			n = ffs((int)sms) - 1;
			if (esc->pend.sm_written & BIT(n) && ops->sm_written)
				ops->sm_written(esc, n, now);
			if (esc->pend.sm_read & BIT(n) && ops->sm_read)
				ops->sm_read(esc, n, now);
		}
	}
	memset(&esc->pend, 0, sizeof(esc->pend));
}
