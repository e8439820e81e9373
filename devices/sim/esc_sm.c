// SPDX-License-Identifier: GPL-2.0-only
/*
 * SyncManagers: which side may access a window of the RAM, in which direction, and
 * when a buffer goes to the other side (ETG.1000.4 clause 6.7).
 *
 * An access begins with the first byte of the window, which opens the buffer,
 * and ends with the last byte, which hands it over; in between it may come in
 * several pieces. An access that lies only partly in a window is refused, and
 * so is one to the second and third buffer of a 3-buffer window.
 */
#include "esc_int.h"

static bool is_mailbox(const struct ec_esc_sm *sm)
{
	return (sm->page.control & EC_SM_MODE_MASK) == EC_SM_MODE_MAILBOX;
}

static bool is_output(const struct ec_esc_sm *sm)
{
	return (sm->page.control & EC_SM_DIR_MASK) == EC_SM_DIR_WRITE;
}

static void clear_state(struct ec_esc_sm *sm)
{
	sm->full = false;
	sm->ecat_lock = false;
	sm->pdi_lock = false;
	sm->ecat_buf = 0;
	sm->pdi_buf = 1;
	sm->free_buf = 2;
	sm->last_buf = 3;
	sm->fresh = false;
	sm->page.status = 0;
}

/* a 3-buffer SM whose buffers do not fit into the RAM stays inactive */
static bool is_valid(const struct ec_esc *esc, const struct ec_esc_sm *sm)
{
	u32 end = sm->page.start + sm->page.len * (is_mailbox(sm) ? 1u : 3u);

	return sm->page.activate & EC_SM_ACT_ENABLE &&
	       !(sm->page.pdi & EC_SM_PDI_DISABLE) && sm->page.len &&
	       sm->page.start >= EC_REG_RAM && end <= esc->mem_len;
}

static void update_active(struct ec_esc *esc, int n)
{
	struct ec_esc_sm *sm = &esc->sm[n];
	bool active = is_valid(esc, sm);

	if (active == sm->active)
		return;
	clear_state(sm);
	ec_esc_quick_forget(esc);
	sm->active = active;
	if (active)
		esc->sms_active |= (u16)BIT(n);
	else
		esc->sms_active &= (u16)~BIT(n);
}

void ec_esc_sm_reset(struct ec_esc *esc)
{
	int n;

	esc->sms_active = 0;
	for (n = 0; n < EC_MAX_SM; n++) {
		memset(&esc->sm[n], 0, sizeof(esc->sm[n]));
		clear_state(&esc->sm[n]);
	}
}

/* register pages were written: @ado, @len; @old_activate before the write */
void ec_esc_sm_config(struct ec_esc *esc, u16 ado, size_t len,
		      const u8 *old_activate, const struct ec_frame_ctx *ctx)
{
	int n;

	for (n = 0; n < esc->cfg.sms; n++) {
		struct ec_esc_sm *sm = &esc->sm[n];
		u8 status = sm->page.status;

		if (!ec_range_hit(ado, (u32)len, EC_REG_SM(n), EC_SM_PAGE))
			continue;
		ec_sm_decode(&sm->page, esc->mem + EC_REG_SM(n));
		sm->page.status = status;
		update_active(esc, n);
		if (sm->page.activate == old_activate[n])
			continue;
		esc->al_event |= EC_AL_EVENT_SM_ACT;
		esc->pend.sm_activate |= (u16)BIT(n);
		ec_esc_pend(esc, ctx->end);
	}
	ec_esc_wd_config(esc, ctx->now);
}

/* bring the status bytes of the register pages up to date */
void ec_esc_sm_refresh(struct ec_esc *esc)
{
	int n;

	for (n = 0; n < esc->cfg.sms; n++) {
		const struct ec_esc_sm *sm = &esc->sm[n];
		u8 st = sm->page.status &
			(EC_SM_ST_WRITE_EVENT | EC_SM_ST_READ_EVENT);

		if (sm->active) {
			if (is_mailbox(sm))
				st |= sm->full && !ec_esc_bug(esc, EC_SIM_BUG_SM_STATUS) ?
				      EC_SM_ST_FULL : 0;
			else
				st |= (u8)(sm->last_buf << 4);
		}
		esc->mem[EC_REG_SM(n) + EC_SM_OFS_STATUS] = st;
		esc->mem[EC_REG_SM(n) + EC_SM_OFS_PDI] = sm->page.pdi;
	}
}

/* the SM whose area the access touches; -1: none, -2: refused */
int ec_esc_sm_find(const struct ec_esc *esc, u32 ado, size_t len)
{
	u32 end = ado + (u32)len, left = esc->sms_active;
	int n;

	for (n = 0; left; n++, left >>= 1) {
		const struct ec_sm *p = &esc->sm[n].page;
		u32 stop = p->start + p->len;
		u32 area = is_mailbox(&esc->sm[n]) ? stop : stop + 2u * p->len;

		if (!(left & 1) || ado >= area || end <= p->start)
			continue;
		return ado < p->start || end > stop ? -2 : n;
	}
	return -1;
}

static void swap_free(u8 *buf, struct ec_esc_sm *sm)
{
	u8 t = *buf;

	*buf = sm->free_buf;
	sm->free_buf = t;
}

/*
 * Begins an access to RAM. Returns the memory behind it, NULL when it is
 * refused; @smp gets the SM to end it with, -1 when none guards the place.
 */
u8 *ec_esc_sm_begin(struct ec_esc *esc, u32 ado, size_t len, bool pdi,
		    bool write, int *smp)
{
	bool bug_dir = ec_esc_bug(esc, EC_SIM_BUG_SM_DIRECTION);
	bool bug_full = ec_esc_bug(esc, EC_SIM_BUG_MBOX_FULL);
	bool bug_empty = ec_esc_bug(esc, EC_SIM_BUG_MBOX_EMPTY);
	struct ec_esc_sm *sm;
	bool *lock, first;
	u8 *buf;
	int n;

	*smp = -1;
	if (ado + len > esc->mem_len)
		return NULL;
	n = len ? ec_esc_sm_find(esc, ado, len) : -1;
	if (n == -1)
		return esc->mem + ado;
	if (n < 0)
		return NULL;

	sm = &esc->sm[n];
	if (write == (pdi == is_output(sm)))
		return bug_dir && !pdi ? esc->mem + ado : NULL;
	lock = pdi ? &sm->pdi_lock : &sm->ecat_lock;
	first = ado == sm->page.start;
	if (!*lock && !first)
		return NULL;

	if (is_mailbox(sm)) {
		if (write && sm->full && (pdi || !bug_full))
			return NULL;
		if (!write && !sm->full)
			return bug_empty && !pdi ? esc->mem + ado : NULL;
	} else if (!write && first) {
		if (sm->last_buf == 3 &&
		    (pdi || esc->cfg.refuse_unwritten))
			return NULL;
		if (sm->fresh) {
			swap_free(pdi ? &sm->pdi_buf : &sm->ecat_buf, sm);
			sm->fresh = false;
		}
	}

	if (first) {
		*lock = true;
		sm->page.status &= write ? (u8)~EC_SM_ST_READ_EVENT :
					   (u8)~EC_SM_ST_WRITE_EVENT;
	}
	if (pdi)
		esc->al_event &= (u32)~EC_AL_EVENT_SM(n);
	else if (n < 8)
		ec_esc_event(esc, 0, (u16)EC_ECAT_EVENT_SM(n));

	*smp = n;
	if (is_mailbox(sm))
		return esc->mem + ado;
	buf = esc->mem + sm->page.start;
	if (!ec_esc_bug(esc, EC_SIM_BUG_SM_ONE_BUFFER))
		buf += (pdi ? sm->pdi_buf : sm->ecat_buf) * sm->page.len;
	return buf + (ado - sm->page.start);
}

/* 0x09f0, 0x09f8, 0x09fc: local time of buffer events, if the SM asks for it */
static void latch_time(struct ec_esc *esc, const struct ec_esc_sm *sm, u8 wish,
		       u16 reg, u64 now)
{
	if (sm->page.activate & wish && ec_esc_has_clock(esc))
		put_unaligned_le32((u32)ec_esc_local_time(esc, now),
				   esc->mem + reg);
}

/* the access is done; hands the buffer over after its last byte */
void ec_esc_sm_end(struct ec_esc *esc, int n, u32 ado, size_t len, bool pdi,
		   const struct ec_frame_ctx *ctx)
{
	struct ec_esc_sm *sm;
	u16 bit = (u16)BIT(n < 0 ? 0 : n);
	bool write;

	if (n < 0)
		return;
	sm = &esc->sm[n];
	if (pdi && ado == sm->page.start)
		latch_time(esc, sm, EC_SM_ACT_DC_PDI, EC_REG_DC_PDI_START,
			   ctx->now);
	if (ado + len != (u32)sm->page.start + sm->page.len)
		return;

	if (pdi)
		latch_time(esc, sm, EC_SM_ACT_DC_PDI, EC_REG_DC_PDI_CHANGE,
			   ctx->now);
	else
		latch_time(esc, sm, EC_SM_ACT_DC_ECAT, EC_REG_DC_ECAT_EVENT,
			   ctx->now);
	write = pdi != is_output(sm);
	if (pdi)
		sm->pdi_lock = false;
	else
		sm->ecat_lock = false;
	sm->page.status |= write ? EC_SM_ST_WRITE_EVENT : EC_SM_ST_READ_EVENT;
	if (is_mailbox(sm)) {
		sm->full = write;
	} else if (write) {
		u8 *buf = pdi ? &sm->pdi_buf : &sm->ecat_buf;

		sm->last_buf = *buf;
		swap_free(buf, sm);
		sm->fresh = true;
	}

	if (pdi) {
		if (n < 8 && sm->page.control & EC_SM_ECAT_IRQ)
			ec_esc_event(esc, (u16)EC_ECAT_EVENT_SM(n), 0);
		return;
	}
	if (sm->page.control & EC_SM_PDI_IRQ)
		esc->al_event |= (u32)EC_AL_EVENT_SM(n);
	if (write)
		esc->pend.sm_written |= bit;
	else
		esc->pend.sm_read |= bit;
	ec_esc_pend(esc, ctx->end);
	if (write && sm->page.control & EC_SM_WATCHDOG)
		ec_esc_wd_trigger(esc, ctx->now);
}

/**
 * ec_esc_sm_readable() - does the PDI find something to read
 * @esc: slave controller
 * @n: SyncManager, an output or mailbox-out one
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: a full mailbox, or a buffer not read yet.
 */
bool ec_esc_sm_readable(const struct ec_esc *esc, int n)
{
	const struct ec_esc_sm *sm = &esc->sm[n];

	return sm->active && is_output(sm) &&
	       (is_mailbox(sm) ? sm->full : sm->fresh);
}

/**
 * ec_esc_sm_writable() - may the PDI write
 * @esc: slave controller
 * @n: SyncManager, an input or mailbox-in one
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: an empty mailbox, or any active input SM.
 */
bool ec_esc_sm_writable(const struct ec_esc *esc, int n)
{
	const struct ec_esc_sm *sm = &esc->sm[n];

	return sm->active && !is_output(sm) && !(is_mailbox(sm) && sm->full);
}

/**
 * ec_esc_sm_pdi_disable() - the PDI switches an SM off, or on again
 * @esc: slave controller
 * @n: SyncManager
 * @disable: off
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_sm_pdi_disable(struct ec_esc *esc, int n, bool disable)
{
	struct ec_esc_sm *sm = &esc->sm[n];

	if (disable)
		sm->page.pdi |= EC_SM_PDI_DISABLE;
	else
		sm->page.pdi &= (u8)~EC_SM_PDI_DISABLE;
	esc->mem[EC_REG_SM(n) + EC_SM_OFS_PDI] = sm->page.pdi;
	update_active(esc, n);
}
