// SPDX-License-Identifier: GPL-2.0-only
/*
 * Short ways for what a master sends in every cycle. They do what the long way
 * through FMMU, registers and SyncManager does, for slaves in which nothing is
 * out of the ordinary; whatever could make a difference sends a slave the long
 * way (ec_esc_quick_update()). ec_sim_set_slow() switches them off, to compare.
 */
#include "esc_int.h"

/* FMMU @f maps whole bytes to all of one buffered SyncManager: fills @w */
static bool window(const struct ec_esc *esc, const struct ec_fmmu *f,
		   struct ec_esc_window *w)
{
	const u8 special = EC_SM_ACT_DC_ECAT | EC_SM_ACT_DC_PDI;
	bool out = f->type == EC_FMMU_WRITE;
	const struct ec_sm *p;
	int n;

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
	q->time = normal && open && !(esc->mem[EC_REG_WRITE_PROTECT] & 1) &&
		  esc->cfg.features & EC_FEAT_DC &&
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
		q->other_first = min(q->other_first, f->logical);
		q->other_last = max(q->other_last, (u32)min_t(u64, last, ~0u));
	}
}

/* process data have mostly a few bytes: no call then */
static void copy(u8 *dst, const u8 *src, u32 n)
{
	if (n > 16)
		memcpy(dst, src, n);
	else
		while (n--)
			*dst++ = *src++;
}

/* SyncManager @n was accessed as a whole, its buffer @buf goes to the other side */
static void accessed(struct ec_esc *esc, struct ec_esc_sm *sm, u8 n)
{
	sm->ecat_lock = false;
	if (esc->ecat_event & EC_ECAT_EVENT_SM(n))
		ec_esc_event(esc, 0, (u16)EC_ECAT_EVENT_SM(n));
	if (sm->page.control & EC_SM_PDI_IRQ)
		esc->al_event |= (u32)EC_AL_EVENT_SM(n);
}

static void write_window(struct ec_esc *esc, const struct ec_esc_window *w,
			 const u8 *src, u64 now)
{
	struct ec_esc_sm *sm = &esc->sm[w->sm];
	u8 buf = sm->ecat_buf;

	accessed(esc, sm, w->sm);
	copy(esc->mem + w->phys + buf * w->len, src, w->len);
	sm->page.status = (u8)((sm->page.status & ~EC_SM_ST_READ_EVENT) |
			       EC_SM_ST_WRITE_EVENT);
	sm->last_buf = buf;
	sm->ecat_buf = sm->free_buf;
	sm->free_buf = buf;
	sm->fresh = true;
	esc->pend.sm_written |= (u16)BIT(w->sm);
	if (sm->page.control & EC_SM_WATCHDOG)
		ec_esc_wd_start(esc, now, esc->quick.wd_ns);
}

static void read_window(struct ec_esc *esc, const struct ec_esc_window *w, u8 *dst)
{
	struct ec_esc_sm *sm = &esc->sm[w->sm];
	u8 buf = sm->ecat_buf;

	accessed(esc, sm, w->sm);
	if (sm->fresh) {
		sm->ecat_buf = sm->free_buf;
		sm->free_buf = buf;
		sm->fresh = false;
	}
	sm->page.status = (u8)((sm->page.status & ~EC_SM_ST_WRITE_EVENT) |
			       EC_SM_ST_READ_EVENT);
	copy(dst, esc->mem + w->phys + sm->ecat_buf * w->len, w->len);
	esc->pend.sm_read |= (u16)BIT(w->sm);
}

/* 1: the datagram has all of the window, 0: nothing of it, -1: a part */
static int covers(const struct ec_dgram *d, u32 first, const struct ec_esc_window *w)
{
	u32 ofs = w->logical - first;

	if (!w->len)
		return 0;
	if (ofs < d->len && d->len - ofs >= w->len)
		return 1;
	return ofs < d->len || first - w->logical < w->len ? -1 : 0;
}

/*
 * A logical datagram in one slave, which some FMMU of it concerns. False: it has
 * to go the long way, and nothing was done. A datagram must not wrap at 4 GiB.
 */
bool ec_esc_quick_data(struct ec_esc *esc, struct ec_dgram *d, u64 now, u64 end,
		       u16 *wkc)
{
	struct ec_esc_quick *q = &esc->quick;
	u32 first = ec_dgram_logical(d);
	int in = 0, out = 0;

	if (!q->known)
		ec_esc_quick_update(esc);
	if (!q->data || (first <= q->other_last &&
			 (u64)first + d->len > q->other_first))
		return false;
	if (d->cmd != EC_CMD_LWR)
		in = covers(d, first, &q->in);
	if (d->cmd != EC_CMD_LRD)
		out = covers(d, first, &q->out);
	if (in < 0 || out < 0)
		return false;
	if (!(in | out))
		return true;
	if (out) {	/* what came in, before inputs take its place */
		write_window(esc, &q->out, d->data + (q->out.logical - first), now);
		*wkc = (u16)(*wkc + (d->cmd == EC_CMD_LRW ? 2 : 1));
	}
	if (in) {
		read_window(esc, &q->in, d->data + (q->in.logical - first));
		++*wkc;
	}
	ec_esc_pend(esc, end);
	return true;
}
