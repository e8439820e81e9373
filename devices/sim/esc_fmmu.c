// SPDX-License-Identifier: GPL-2.0-only
/* FMMUs: logical commands to physical accesses, bit by bit where needed. */
#include "esc_int.h"

/* a datagram's logical addresses do not wrap at 4 GiB */
static bool overlap(const struct ec_esc *esc, const struct ec_fmmu *f,
		    u32 logical, u16 len, u64 *first, u64 *end, u32 *phys_bit)
{
	u64 f0 = (u64)f->logical * 8 + f->lbit_start;
	u32 bits = ec_fmmu_bits(f);
	u64 d0 = (u64)logical * 8, d1 = d0 + (u64)len * 8, f1;

	if (ec_esc_bug(esc, EC_SIM_BUG_FMMU_LENGTH))
		bits = bits > 8 ? bits - 8 : 0;
	f1 = f0 + bits;
	*first = max(f0, d0);
	*end = min(f1, d1);
	if (*first >= *end)
		return false;
	*phys_bit = f->phys * 8u + f->pbit + (u32)(*first - f0);
	if (ec_esc_bug(esc, EC_SIM_BUG_FMMU_SHIFT))
		++*phys_bit;
	return true;
}

/* FMMU pages were written */
void ec_esc_fmmu_config(struct ec_esc *esc)
{
	u16 active = esc->fmmus_active;
	int n;

	esc->fmmus_active = 0;
	esc->log_first = ~0u;
	esc->log_last = 0;
	for (n = 0; n < esc->cfg.fmmus; n++) {
		struct ec_fmmu *f = &esc->fmmu[n], was = *f;
		bool mapped = active & BIT(n), moved;
		u64 last;

		ec_fmmu_decode(f, esc->mem + EC_REG_FMMU(n));
		if (esc->cfg.features & EC_FEAT_NO_BIT_FMMU) {
			f->lbit_start = 0;
			f->lbit_stop = 7;
			f->pbit = 0;
		}
		moved = f->logical != was.logical || f->len != was.len ||
			!f->enable || !f->type || !ec_fmmu_bits(f);
		if (mapped && moved)
			ec_sim_span_del(esc, &was);
		if (!f->enable || !f->type || !ec_fmmu_bits(f))
			continue;
		if (!mapped || moved)
			ec_sim_span_add(esc, f);
		esc->fmmus_active |= (u16)BIT(n);
		last = (u64)f->logical + f->len - 1;
		esc->log_first = min(esc->log_first, f->logical);
		esc->log_last = max(esc->log_last,
				    (u32)min_t(u64, last, ~0u));
	}
}

/* may a logical datagram concern the slave; a quick test */
bool ec_esc_fmmu_hit(const struct ec_esc *esc, u32 logical, u16 len)
{
	return esc->fmmus_active && len && logical <= esc->log_last &&
	       (u64)logical + len > esc->log_first;
}

static bool read_bits(struct ec_esc *esc, u32 phys_bit, u8 *dst, u32 dst_bit,
		      u32 bits, const struct ec_frame_ctx *ctx)
{
	u32 ado = phys_bit / 8, n = (phys_bit % 8 + bits + 7) / 8;
	u8 *tmp = esc->sim->scratch2;

	if (ado + n > 0x10000 || n > EC_SIM_SCRATCH ||
	    !ec_esc_phys_read(esc, (u16)ado, tmp, n, ctx))
		return false;
	ec_bits_copy(dst, dst_bit, tmp, phys_bit % 8, bits);
	return true;
}

static bool write_bits(struct ec_esc *esc, u32 phys_bit, const u8 *src,
		       u32 src_bit, u32 bits, const struct ec_frame_ctx *ctx)
{
	u32 ado = phys_bit / 8, n = (phys_bit % 8 + bits + 7) / 8;
	u8 *tmp = esc->sim->scratch2, *mem;
	int sm;

	if (ado + n > 0x10000 || n > EC_SIM_SCRATCH)
		return false;
	if (ado < EC_REG_RAM) {
		memcpy(tmp, esc->mem + ado, min_t(u32, n, EC_REG_RAM - ado));
		ec_bits_copy(tmp, phys_bit % 8, src, src_bit, bits);
		return ec_esc_phys_write(esc, (u16)ado, tmp, n, ctx);
	}
	if (ec_esc_ram_locked(esc))
		return ado + n <= esc->mem_len;
	mem = ec_esc_sm_begin(esc, ado, n, false, true, &sm);
	if (!mem)
		return false;
	ec_bits_copy(mem, phys_bit % 8, src, src_bit, bits);
	ec_esc_sm_end(esc, sm, ado, n, false, ctx);
	return true;
}

/*
 * One logical datagram in one slave. What is written is what came in, even
 * where the slave puts its inputs into the same bits. Returns the increment.
 */
int ec_esc_fmmu_access(struct ec_esc *esc, struct ec_dgram *d,
		       const struct ec_frame_ctx *ctx)
{
	u32 logical = ec_dgram_logical(d), phys;
	bool rd = d->cmd != EC_CMD_LWR, wr = d->cmd != EC_CMD_LRD;
	int n, reads = 0, writes = 0, write_count;
	u64 base = (u64)logical * 8, first, end;
	const u8 *in = d->data;
	u32 at, n_in;

	if (!ec_esc_fmmu_hit(esc, logical, d->len))
		return 0;
	if (d->cmd == EC_CMD_LRW && esc->cfg.features & EC_FEAT_NO_LRW)
		return 0;
	if (rd && wr) {		/* what came in, as far as it is mapped */
		at = max(esc->log_first, logical) - logical;
		n_in = (esc->log_last == ~0u ? d->len :	/* may be mapped beyond 4 GiB */
			min_t(u32, d->len, esc->log_last - logical + 1)) - at;
		memcpy(esc->sim->scratch + at, d->data + at, n_in);
		in = esc->sim->scratch;
	}

	/* backwards: the lower number wins where two overlap */
	for (n = esc->cfg.fmmus - 1; rd && n >= 0; n--) {
		const struct ec_fmmu *f = &esc->fmmu[n];

		if (!(esc->fmmus_active & BIT(n)) || !(f->type & EC_FMMU_READ) ||
		    !overlap(esc, f, logical, d->len, &first, &end, &phys))
			continue;
		reads += read_bits(esc, phys, d->data, (u32)(first - base),
				   (u32)(end - first), ctx);
	}
	for (n = 0; wr && n < esc->cfg.fmmus; n++) {
		const struct ec_fmmu *f = &esc->fmmu[n];

		if (!(esc->fmmus_active & BIT(n)) ||
		    !(f->type & EC_FMMU_WRITE ||
		      ec_esc_bug(esc, EC_SIM_BUG_LWR_INPUTS)) ||
		    !overlap(esc, f, logical, d->len, &first, &end, &phys))
			continue;
		if (!(f->type & EC_FMMU_WRITE)) {	/* the bug */
			u32 bits = (u32)(end - first);

			if (phys / 8 >= EC_REG_RAM &&
			    (phys + bits + 7) / 8 <= esc->mem_len)
				ec_bits_copy(esc->mem, phys, in,
					     (u32)(first - base), bits);
			writes++;
			continue;
		}
		writes += write_bits(esc, phys, in, (u32)(first - base),
				     (u32)(end - first), ctx);
	}

	if (!ec_esc_bug(esc, EC_SIM_BUG_WKC_PER_FMMU)) {
		reads = !!reads;
		writes = !!writes;
	}
	write_count = d->cmd == EC_CMD_LRW &&
		      !ec_esc_bug(esc, EC_SIM_BUG_LRW_WKC) ? 2 : 1;
	return reads + write_count * writes;
}
