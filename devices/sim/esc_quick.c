// SPDX-License-Identifier: GPL-2.0-only
/*
 * Short ways for what a master sends in every cycle. They do what the long way
 * through FMMU, registers and SyncManager does, for slaves in which nothing is
 * out of the ordinary; whatever could make a difference sends a slave the long
 * way (ec_esc_quick_update()). ec_sim_set_slow() switches them off, to compare.
 */
#include "esc_int.h"

#define DIRECT		0x0F00	/* four bytes of digital outputs */
#define PACE_NS		2000000	/* inputs older than that are computed when read */

/* FMMU @f maps whole bytes to all of one buffered SyncManager: fills @w */
static bool window(struct ec_esc *esc, const struct ec_fmmu *f,
		   struct ec_esc_window *w)
{
	const u8 special = EC_SM_ACT_DC_ECAT | EC_SM_ACT_DC_PDI;
	bool out = f->type == EC_FMMU_WRITE;
	const struct ec_sm *p;
	int n;

	if (out && !w->len && f->phys >= DIRECT && f->phys + f->len <= DIRECT + 4 &&
	    !f->lbit_start && f->lbit_stop == 7 && !f->pbit &&
	    (u64)f->logical + f->len <= 1ULL << 32 &&
	    !(esc->mem[EC_REG_WRITE_PROTECT] & 1) &&
	    !(esc->cfg.features & EC_FEAT_NO_UNUSED)) {
		*w = (struct ec_esc_window){
			.logical = f->logical, .len = f->len, .phys = f->phys,
			.sm = EC_ESC_NO_SM, .mem = esc->mem + f->phys,
		};
		return true;
	}
	if (w->len || f->lbit_start || f->lbit_stop != 7 || f->pbit || !f->len ||
	    f->phys < EC_REG_RAM || (u64)f->logical + f->len > 1ULL << 32)
		return false;
	n = ec_esc_sm_find(esc, f->phys, f->len);
	if (n < 0 || n >= 8)
		return false;
	p = &esc->sm[n].page;
	if (p->start != f->phys || p->len != f->len || p->activate & special ||
	    (p->control & EC_SM_MODE_MASK) == EC_SM_MODE_MAILBOX ||
	    ((p->control & EC_SM_DIR_MASK) == EC_SM_DIR_WRITE) != out)
		return false;
	*w = (struct ec_esc_window){
		.logical = f->logical, .len = f->len, .phys = f->phys, .sm = (u8)n,
		.watchdog = p->control & EC_SM_WATCHDOG, .bit = (u16)BIT(n),
		.event = (u16)EC_ECAT_EVENT_SM(n), .clear = (u32)EC_AL_EVENT_SM(n),
		.irq = p->control & EC_SM_PDI_IRQ ? (u32)EC_AL_EVENT_SM(n) : 0,
		.s = &esc->sm[n], .mem = esc->mem + f->phys,
	};
	return true;
}

/* which short ways may be gone */
void ec_esc_quick_update(struct ec_esc *esc)
{
	struct ec_esc_quick *q = &esc->quick;
	bool normal = !esc->fault.dead && !esc->fault.wkc_add &&
		      esc->sim->bug == EC_SIM_BUG_NONE;
	bool open = !(esc->mem[EC_REG_ESC_WRITE_PROTECT] & 1);
	int n;

	memset(q, 0, sizeof(*q));
	q->known = true;
	q->wd_ns = ec_esc_wd_ns(esc);
	q->bcast = normal && !esc->fault.miss_broadcast &&
		   !(esc->cfg.features & EC_FEAT_NO_UNUSED);
	q->time = normal && open && !esc->cfg.no_frmw && !(esc->mem[EC_REG_WRITE_PROTECT] & 1) &&
		  ec_esc_has_clock(esc) &&
		  !(esc->cfg.features & EC_FEAT_NO_UNUSED);
	q->data = normal && open && !esc->cfg.refuse_unwritten &&
		  !(esc->cfg.features & EC_FEAT_NO_LRW);
	q->other_first = ~0u;
	for (n = 0; n < esc->cfg.fmmus; n++) {
		const struct ec_fmmu *f = &esc->fmmu[n];
		u64 last = (u64)f->logical + f->len - 1;

		if (!(esc->fmmus_active & BIT(n)) ||
		    (f->type == EC_FMMU_READ && window(esc, f, &q->in)) ||
		    (f->type == EC_FMMU_WRITE && window(esc, f, &q->out)))
			continue;
		q->others = true;
		q->other_first = min(q->other_first, f->logical);
		q->other_last = max(q->other_last, (u32)min_t(u64, last, ~0u));
	}
}

/* process data have mostly a few bytes: no call then */
static inline void copy(u8 *dst, const u8 *src, u32 n)
{
	if (n == 1) {
		*dst = *src;
	} else if (n == 8) {
		put_unaligned_le64(get_unaligned_le64(src), dst);
	} else if (n > 16) {
		memcpy(dst, src, n);
	} else {
		while (n--)
			*dst++ = *src++;
	}
}

static inline void swap_free(u8 *buf, struct ec_esc_sm *sm)
{
	u8 t = *buf;

	*buf = sm->free_buf;
	sm->free_buf = t;
}

static inline void note(struct ec_esc_sm *sm, u8 set, u8 clear)
{
	sm->page.status = (u8)((sm->page.status & ~clear) | set);
}

static inline void accessed(struct ec_esc *esc, const struct ec_esc_window *w)
{
	w->s->ecat_lock = false;
	if (esc->ecat_event & w->event)
		ec_esc_event(esc, 0, w->event);
	esc->al_event |= w->irq;
}

static inline void write_window(struct ec_esc *esc, const struct ec_esc_window *w,
				const u8 *src, u64 now)
{
	struct ec_esc_sm *sm = w->s;
	u8 buf = sm->ecat_buf;

	accessed(esc, w);
	copy(w->mem + buf * w->len, src, w->len);
	note(sm, EC_SM_ST_WRITE_EVENT, EC_SM_ST_READ_EVENT);
	sm->last_buf = buf;
	swap_free(&sm->ecat_buf, sm);
	sm->fresh = true;
	esc->pend.sm_written |= w->bit;
	if (w->watchdog)
		ec_esc_wd_start(esc, now, esc->quick.wd_ns);
}

static inline void read_window(struct ec_esc *esc, const struct ec_esc_window *w, u8 *dst)
{
	struct ec_esc_sm *sm = w->s;

	accessed(esc, w);
	if (sm->fresh)
		swap_free(&sm->ecat_buf, sm);
	sm->fresh = false;
	note(sm, EC_SM_ST_READ_EVENT, EC_SM_ST_WRITE_EVENT);
	copy(dst, w->mem + sm->ecat_buf * w->len, w->len);
	esc->pend.sm_read |= w->bit;
}

/* the PDI has read all of an output SyncManager */
static inline void taken(struct ec_esc *esc, const struct ec_esc_window *w)
{
	struct ec_esc_sm *sm = w->s;

	if (sm->fresh)
		swap_free(&sm->pdi_buf, sm);
	sm->fresh = false;
	note(sm, EC_SM_ST_READ_EVENT, EC_SM_ST_WRITE_EVENT);
	esc->al_event &= ~w->clear;
}

/* the PDI has written all of an input SyncManager; where the data go */
static inline u8 *given(struct ec_esc *esc, const struct ec_esc_window *w)
{
	struct ec_esc_sm *sm = w->s;
	u8 buf = sm->pdi_buf;

	sm->last_buf = buf;
	swap_free(&sm->pdi_buf, sm);
	sm->fresh = true;
	note(sm, EC_SM_ST_WRITE_EVENT, EC_SM_ST_READ_EVENT);
	esc->al_event &= ~w->clear;
	return w->mem + buf * w->len;
}

/* what was taken last */
static const u8 *pdi_data(const struct ec_esc_window *w)
{
	return w->mem + w->s->pdi_buf * w->len;
}

/* The PDI has a short way to SyncManager @sm, too */
static bool pdi_quick(struct ec_esc *esc, const struct ec_esc_window *w, int sm, u16 len,
		      u64 now)
{
	struct ec_esc_sm *s = &esc->sm[sm];

	if (!esc->quick.known || !esc->quick.data || w->sm != sm || w->len != len || !len)
		return false;
	s->pdi_lock = false;
	ec_esc_wd_pdi_trigger(esc, now);
	if (s->page.control & EC_SM_ECAT_IRQ)
		ec_esc_event(esc, (u16)EC_ECAT_EVENT_SM(sm), 0);
	return true;
}

/**
 * ec_esc_pdi_take() - the slave's CPU reads all of an output SyncManager
 * @esc: slave controller
 * @sm: SyncManager
 * @len: its bytes
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the data, valid until the next access; NULL: use ec_esc_pdi_read().
 */
const u8 *ec_esc_pdi_take(struct ec_esc *esc, int sm, u16 len, u64 now)
{
	const struct ec_esc_window *w = &esc->quick.out;

	if (esc->sm[sm].last_buf == 3 || !pdi_quick(esc, w, sm, len, now))
		return NULL;
	taken(esc, w);
	return pdi_data(w);
}

/**
 * ec_esc_pdi_give() - the slave's CPU writes all of an input SyncManager
 * @esc: slave controller
 * @sm: SyncManager
 * @len: its bytes
 * @now: simulation time, ns
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: where to put the data before anything else is done; NULL: use
 * ec_esc_pdi_write().
 */
u8 *ec_esc_pdi_give(struct ec_esc *esc, int sm, u16 len, u64 now)
{
	const struct ec_esc_window *w = &esc->quick.in;

	return pdi_quick(esc, w, sm, len, now) ? given(esc, w) : NULL;
}

static bool late_ok(const struct ec_esc *esc, const struct ec_esc_window *w, int sm, u16 len)
{
	return w->len == len &&
	       (!len || (w->sm == sm && !(esc->sm[sm].page.control & EC_SM_ECAT_IRQ)));
}

/**
 * ec_esc_pdi_may_wait() - process data may be reported to the application later
 * @esc: slave controller
 * @out_sm: SyncManager of the outputs
 * @out_len: its bytes, 0: no outputs
 * @in_sm: SyncManager of the inputs
 * @in_len: its bytes, 0: no inputs
 * @image: the inputs, which stay the same
 *
 * To be called at the end of @sm_written or @sm_read. It holds until anything
 * but a frame with all of these process data concerns the slave.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is so.
 */
bool ec_esc_pdi_may_wait(struct ec_esc *esc, int out_sm, u16 out_len, int in_sm,
			 u16 in_len, const u8 *image)
{
	const struct ec_esc_quick *q = &esc->quick;

	if (!q->known || !q->data || esc->fault.app_mute || esc->wd_pdi_expired ||
	    esc->sim->slow || !late_ok(esc, &q->out, out_sm, out_len) ||
	    !late_ok(esc, &q->in, in_sm, in_len))
		return false;
	esc->late.on = true;
	esc->late.stale = false;
	esc->late.out = out_len;
	esc->late.in_len = in_len;
	esc->late.image = image;
	return true;
}

/**
 * ec_esc_settle() - report to an application what is still pending
 * @esc: slave controller
 *
 * Before anything is done that the application or its SyncManagers could show in.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_esc_settle(struct ec_esc *esc)
{
	const struct ec_esc_window *w = &esc->quick.out;

	if (!esc->late.on)
		return;
	esc->late.on = false;
	if (esc->late.stale)
		esc->app_ops->sm_taken(esc, pdi_data(w));
	esc->late.stale = false;
	if (!(esc->pend.sm_written | esc->pend.sm_read))
		return;
	if (esc->sim->passing && esc->late.frame == esc->sim->frame)
		ec_esc_pend(esc, esc->pend_ns);	/* its turn is after the frame */
	else
		ec_esc_deliver(esc);
	esc->late.on = false;			/* whatever it said: a caller looks */
}

/* what the application would have done after the last frame; it was not called */
static void catch_up(struct ec_esc *esc)
{
	struct ec_esc_late *l = &esc->late;
	bool run = esc->pend.sm_written;

	l->stale |= run;
	if (run)
		taken(esc, &esc->quick.out);
	else if (esc->pend.sm_read)
		run = !l->out || esc->pend_ns - l->ran_ns > PACE_NS;
	esc->pend.sm_written = 0;
	esc->pend.sm_read = 0;
	if (!run)
		return;
	l->ran_ns = esc->pend_ns;
	if (l->in_len)
		copy(given(esc, &esc->quick.in), l->image, l->in_len);
}

/* 1: the datagram has all of the window, 0: nothing of it, -1: a part */
static inline int covers(const struct ec_quick *k, const struct ec_esc_window *w)
{
	u32 ofs = w->logical - k->first;

	if (!w->len)
		return 0;
	if (ofs < k->len && k->len - ofs >= w->len)
		return 1;
	return ofs < k->len || k->first - w->logical < w->len ? -1 : 0;
}

/*
 * A logical datagram in one slave, which some FMMU of it concerns; its first bit
 * is there at @now. False: it has to go the long way, and nothing was done.
 */
bool ec_esc_quick_data(struct ec_esc *esc, const struct ec_quick *k, u64 now, u16 *wkc)
{
	struct ec_esc_quick *q = &esc->quick;
	struct ec_esc_late *l = &esc->late;
	int in = 0, out = 0;

	if (!q->known)
		ec_esc_quick_update(esc);
	if (!q->data || (q->others && k->first <= q->other_last &&
			 (u64)k->first + k->len > q->other_first))
		return false;
	if (k->cmd != EC_CMD_LWR)
		in = covers(k, &q->in);
	if (k->cmd != EC_CMD_LRD)
		out = covers(k, &q->out);
	if (in < 0 || out < 0)
		return false;
	if (l->on && l->frame != k->frame && (in | out)) {
		catch_up(esc);
		l->frame = k->frame;
	}
	if (out) {	/* what came in, before inputs take its place */
		const u8 *src = k->data + (q->out.logical - k->first);

		*wkc = (u16)(*wkc + k->count);
		if (q->out.s) {
			write_window(esc, &q->out, src, now);
		} else {
			copy(q->out.mem, src, q->out.len);
			out = 0;
		}
	}
	if (in) {
		read_window(esc, &q->in, k->data + (q->in.logical - k->first));
		++*wkc;
	}
	if (l->on)
		esc->pend_ns = now + k->wire_ns;
	else if (in | out)
		ec_esc_pend(esc, now + k->wire_ns);
	return true;
}
