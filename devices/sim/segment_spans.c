// SPDX-License-Identifier: GPL-2.0-only
/*
 * What the FMMUs of a segment map, sorted by logical address: a logical datagram
 * finds the slaves it concerns and costs nothing for the others.
 */
#include "esc_int.h"

static u64 key(u32 first, int slave)
{
	return (u64)first << 32 | (u32)slave;
}

/* first span that does not stand before @k */
static u32 find(const struct ec_sim *sim, u64 k)
{
	u32 lo = 0, hi = sim->spans;

	while (lo < hi) {
		u32 mid = lo + (hi - lo) / 2;

		if (sim->span[mid].key < k)
			lo = mid + 1;
		else
			hi = mid;
	}
	return lo;
}

static u32 last_byte(const struct ec_fmmu *f)
{
	return (u32)min_t(u64, (u64)f->logical + f->len - 1, ~0u);
}

/* room for @n more spans; 0 or -ENOMEM */
int ec_sim_spans_room(struct ec_sim *sim, u32 n)
{
	u32 room = max(sim->span_want + n, 2 * sim->span_room);
	struct ec_sim_span *span;

	if (sim->span_want + n > sim->span_room) {
		span = sim->ops.alloc(room * sizeof(*span));
		if (!span)
			return -ENOMEM;
		if (sim->spans)
			memcpy(span, sim->span, sim->spans * sizeof(*span));
		sim->ops.free(sim->span);
		sim->span = span;
		sim->span_room = room;
	}
	sim->span_want += n;
	return 0;
}

/* FMMU @f of a slave, which maps something, is switched on */
void ec_sim_span_add(const struct ec_esc *esc, const struct ec_fmmu *f)
{
	struct ec_sim *sim = esc->sim;
	u32 i = find(sim, key(f->logical, esc->index));

	memmove(sim->span + i + 1, sim->span + i, (sim->spans - i) * sizeof(*sim->span));
	sim->span[i].key = key(f->logical, esc->index);
	sim->span[i].last = last_byte(f);
	sim->spans++;
	sim->change++;
	sim->span_longest = max_t(u32, sim->span_longest, f->len);
}

/* and this one, as it was added, off */
void ec_sim_span_del(const struct ec_esc *esc, const struct ec_fmmu *f)
{
	struct ec_sim *sim = esc->sim;
	u32 i = find(sim, key(f->logical, esc->index));

	while (sim->span[i].last != last_byte(f))	/* two that begin there */
		i++;
	sim->spans--;
	sim->change++;
	memmove(sim->span + i, sim->span + i + 1, (sim->spans - i) * sizeof(*sim->span));
	if (!sim->spans)
		sim->span_longest = 0;
}

/* marks the steps concerned in the words *@lo to *@hi of sim->mark; none: false */
static bool mark(struct ec_sim *sim, const struct ec_sim_hits *h, u32 *lo, u32 *hi)
{
	u32 from = h->first > sim->span_longest ? h->first - sim->span_longest : 0, i;
	u64 end = (u64)h->first + h->len;

	*lo = ~0u;
	*hi = 0;
	for (i = find(sim, key(from, 0)); i < sim->spans; i++) {
		const struct ec_sim_span *s = &sim->span[i];
		u32 pos;

		if (s->key >> 32 >= end)
			break;
		pos = (u32)sim->esc[(u32)s->key]->route_pos[h->mport];
		if (s->last < h->first || pos >= h->steps)	/* -1: no step */
			continue;
		sim->mark[pos / 32] |= (u32)BIT(pos % 32);
		*lo = min(*lo, pos / 32);
		*hi = max(*hi, pos / 32);
	}
	return *lo != ~0u;
}

static void look_up(struct ec_sim *sim, struct ec_sim_hits *h)
{
	u32 w, hi;

	h->n = 0;
	if (!h->len || !mark(sim, h, &w, &hi))
		return;
	for (; w <= hi; w++) {
		u32 bits = sim->mark[w];

		sim->mark[w] = 0;
		for (; bits; bits &= bits - 1)
			h->step[h->n++] = (u16)(32 * w + (u32)ffs((int)bits) - 1);
	}
}

static bool same(const struct ec_sim *sim, const struct ec_sim_hits *h, int mport, u32 steps,
		 u32 first, u32 len)
{
	return h->first == first && h->len == len && h->change == sim->change &&
	       h->steps == steps && h->mport == mport;
}

/*
 * The steps of a way from master port @mport, of @steps steps, whose slaves map one of @len
 * logical bytes from @first on. A cycle asks the same again and again.
 */
const struct ec_sim_hits *ec_sim_spans_hit(struct ec_sim *sim, int mport, u32 steps, u32 first,
					   u32 len)
{
	struct ec_sim_hits *h;
	u32 i;

	for (i = 1; i <= EC_SIM_HITS; i++) {
		h = &sim->hits[(sim->hit + i) % EC_SIM_HITS];
		if (!same(sim, h, mport, steps, first, len))
			continue;
		sim->hit = (sim->hit + i) % EC_SIM_HITS;
		return h;
	}
	sim->hit = (sim->hit + 1) % EC_SIM_HITS;
	h = &sim->hits[sim->hit];
	h->first = first;
	h->len = len;
	h->change = sim->change;
	h->steps = steps;
	h->mport = mport;
	look_up(sim, h);
	return h;
}

/* memory for a segment of sim->max slaves; 0 or -ENOMEM */
int ec_sim_spans_init(struct ec_sim *sim)
{
	u32 i;

	sim->change = 1;
	sim->mark = sim->ops.alloc(DIV_ROUND_UP(sim->max, 32) * sizeof(u32));
	sim->hit_steps = sim->ops.alloc(EC_SIM_HITS * sim->max * sizeof(u16));
	if (!sim->mark || !sim->hit_steps)
		return -ENOMEM;
	for (i = 0; i < EC_SIM_HITS; i++)
		sim->hits[i].step = sim->hit_steps + i * sim->max;
	return 0;
}

void ec_sim_spans_exit(struct ec_sim *sim)
{
	sim->ops.free(sim->span);
	sim->ops.free(sim->hit_steps);
	sim->ops.free(sim->mark);
}
