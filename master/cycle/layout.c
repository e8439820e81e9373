// SPDX-License-Identifier: GPL-2.0-only
/* The datagrams of a cycle, laid out once at activation. */
#include <linux/slab.h>
#include "../base/grow.h"
#include "../base/limits.h"
#include "../config/config.h"
#include "../config/domain.h"
#include "../config/unit.h"
#include "../config/group.h"
#include "layout.h"
#include "logical.h"

#define DC_BYTES	(4 + 8 + 4)	/* of the three clock datagrams */
#define DC_DGRAMS	3

/* a domain that is being added to the layout */
struct adding {
	struct ec_layout *to;
	struct ec_domain *d;
	struct ec_logical l;
};

/* Has one of the FMMUs before number @i in the stretch the same slave and direction? */
static bool is_counted(const struct adding *o, const struct ec_stretch *st, unsigned int i)
{
	const struct ec_domain_fmmu *r = o->l.refs;
	unsigned int j;

	for (j = st->first; j < i; j++)
		if (r[j].config == r[i].config && r[j].fmmu->dir == r[i].fmmu->dir &&
		    r[j].fmmu->size)
			return true;
	return false;
}

/* Slaves with data of @dir in the stretch; each counts once. */
static u16 layout_count_slaves(const struct adding *o, const struct ec_stretch *st, u8 dir)
{
	const struct ec_domain_fmmu *r = o->l.refs;
	unsigned int i;
	u16 n = 0;

	for (i = st->first; i < st->last; i++)
		n += r[i].fmmu->dir == dir && r[i].fmmu->size && !is_counted(o, st, i);
	return n;
}

static struct ec_cyc_dgram *add_dgram(struct adding *o, const struct ec_stretch *st, u8 cmd,
				      u16 expected)
{
	struct ec_layout *l = o->to;
	struct ec_cyc_dgram *g;

	if (l->n_dgrams >= EC_MAX_CYCLE_DGRAMS)
		return ERR_PTR(-EOVERFLOW);
	g = ec_grow(l->dgrams, l->n_dgrams, sizeof(*g));
	if (!g)
		return ERR_PTR(-ENOMEM);
	l->dgrams = g;
	g += l->n_dgrams++;
	*g = (struct ec_cyc_dgram){
		.domain = o->d->index, .cmd = cmd, .logical = o->d->offset + st->start,
		.expected = expected, .full = expected, .first_copy = l->n_areas,
	};
	return g;
}

/* One more area of the datagram added last; whole ones side by side are one copy. */
static int add_area(struct ec_layout *l, u16 *count, u32 offset, u16 pos, u16 len, bool cut)
{
	struct ec_cyc_area *a = l->areas + l->n_areas - 1;

	if (*count && !cut && a->pos + a->len == pos && a->offset + a->len == offset) {
		a->len += len;
		return 0;
	}
	a = ec_grow(l->areas, l->n_areas, sizeof(*a));
	if (!a)
		return -ENOMEM;
	l->areas = a;
	a[l->n_areas++] = (struct ec_cyc_area){ .offset = offset, .pos = pos, .len = len,
						.count = 1 };
	++*count;
	return 0;
}

/* which part of the stretch's process data */
enum part {
	SENT,	/* outputs, and inputs with their last value */
	PLAIN,	/* inputs that share their addresses with no outputs */
	SHARED,	/* inputs that have replaced outputs */
	CUT,	/* inputs of which this datagram has only a part */
};

static bool belongs(const struct ec_cyc_dgram *g, const struct ec_config_fmmu *f, bool whole,
		    enum part part)
{
	if (f->dir == EC_CFG_DIR_OUTPUT)
		return part == SENT && g->cmd != EC_CMD_LRD;
	if (g->cmd == EC_CMD_LWR)
		return false;
	if (part == SENT)
		return !f->shared;
	return part == (!whole ? CUT : f->shared ? SHARED : PLAIN);
}

/* An input area of several datagrams: it is taken when all of them are received. */
static int add_cut(struct ec_layout *l, u32 offset, u32 len)
{
	struct ec_cyc_cut *k = l->cuts;

	if (l->n_cuts && k[l->n_cuts - 1].offset == offset) {
		k[l->n_cuts - 1].parts++;
		return 0;
	}
	k = ec_grow(l->cuts, l->n_cuts, sizeof(*k));
	if (!k)
		return -ENOMEM;
	l->cuts = k;
	k[l->n_cuts++] = (struct ec_cyc_cut){ .offset = offset, .len = len, .parts = 1 };
	return 0;
}

/* Is @b the next value of @a? */
static bool follows(const struct ec_cyc_area *a, const struct ec_cyc_area *b)
{
	u32 offset = b->offset - a->offset, pos = b->pos - a->pos;

	if (b->len != a->len || b->offset < a->offset || b->pos < a->pos || offset > U16_MAX)
		return false;
	return a->count == 1 || (offset == (u32)a->count * a->offset_stride &&
				 pos == (u32)a->count * a->pos_stride);
}

/* Merge the last @count areas where values have equal distances. */
static void fold_areas(struct ec_layout *l, u16 *count)
{
	struct ec_cyc_area *a = l->areas + l->n_areas - *count, *last = a;
	unsigned int i;

	for (i = 1; i < *count; i++) {
		if (!follows(last, &a[i])) {
			*++last = a[i];
			continue;
		}
		if (last->count++ == 1) {
			last->offset_stride = a[i].offset - last->offset;
			last->pos_stride = a[i].pos - last->pos;
		}
	}
	if (*count) {
		*count = last - a + 1;
		l->n_areas = last - l->areas + 1;
	}
}

/* Areas of the datagram added last, of one part. */
static int add_areas(struct adding *o, const struct ec_stretch *st, enum part part, u16 *count)
{
	struct ec_layout *l = o->to;
	struct ec_cyc_dgram *g = &l->dgrams[l->n_dgrams - 1];
	unsigned int i;
	int ret = 0;

	for (i = st->first; i < st->last && !ret; i++) {
		const struct ec_config_fmmu *f = o->l.refs[i].fmmu;
		u32 from = max(f->logical, st->start), to = min(f->logical + f->size, st->end);
		u32 offset = o->d->offset + f->offset;

		if (from >= to || !belongs(g, f, to - from == f->size, part))
			continue;
		if (part == CUT) {
			ret = add_cut(l, offset, f->size);
			if (ret)
				break;
		}
		ret = add_area(l, count, offset + from - f->logical, from - st->start, to - from,
			       part == CUT);
		if (part == CUT && !ret)
			l->areas[l->n_areas - 1].cut = l->n_cuts - 1;
		g->len = max_t(u16, g->len, to - st->start);
	}
	if (!ret && part != CUT)
		fold_areas(l, count);
	return ret;
}

static u32 area_bytes(const struct ec_layout *l, const struct ec_cyc_dgram *g)
{
	u32 i, n = 0;

	for (i = 0; i < g->n_copies; i++)
		n += l->areas[g->first_copy + i].len * l->areas[g->first_copy + i].count;
	return n;
}

/* Does a single area of the image cover the datagram, with inputs? */
static bool is_solid(const struct ec_layout *l, const struct ec_cyc_dgram *g)
{
	return !g->holes && g->n_copies == 1 && l->areas[g->first_copy].count == 1 &&
	       g->n_plain && g->n_inputs == g->n_plain;
}

static int layout_fill_dgram(struct adding *o, const struct ec_stretch *st, u8 cmd, u16 expected)
{
	struct ec_cyc_dgram *g = add_dgram(o, st, cmd, expected);
	int ret;

	if (IS_ERR(g))
		return PTR_ERR(g);
	ret = add_areas(o, st, SENT, &g->n_copies) ?: add_areas(o, st, PLAIN, &g->n_plain) ?:
	      add_areas(o, st, SHARED, &g->n_whole) ?: add_areas(o, st, CUT, &g->n_inputs);
	g->first_input = g->first_copy + g->n_copies;
	g->n_whole += g->n_plain;
	g->n_inputs += g->n_whole;
	g->holes = area_bytes(o->to, g) != g->len;
	g->solid = is_solid(o->to, g);
	return ret;
}

/* What each slave of an optional group adds to the counter of the datagram added last. */
static int add_shares(struct adding *o, const struct ec_stretch *st, u16 out, u16 in)
{
	struct ec_layout *l = o->to;
	unsigned int i;

	for (i = st->first; i < st->last; i++) {
		const struct ec_config *c = o->l.refs[i].config;
		const struct ec_stretch alone = { .first = i, .last = i + 1 };
		u16 wkc = out * layout_count_slaves(o, &alone, EC_CFG_DIR_OUTPUT) +
			  in * layout_count_slaves(o, &alone, EC_CFG_DIR_INPUT);
		struct ec_cyc_share *p;

		if (!ec_group_is_optional(c->group) || !wkc || is_counted(o, st, i))
			continue;
		p = ec_grow(l->shares, l->n_shares, sizeof(*p));
		if (!p)
			return -ENOMEM;
		l->shares = p;
		p[l->n_shares++] = (struct ec_cyc_share){ c, l->n_dgrams - 1, wkc };
	}
	return 0;
}

static int add_stretch(struct adding *o, const struct ec_stretch *st)
{
	u16 out = layout_count_slaves(o, st, EC_CFG_DIR_OUTPUT);
	u16 in = layout_count_slaves(o, st, EC_CFG_DIR_INPUT);
	unsigned int i;
	int ret = 0;

	if (out && in && !o->l.separate) {
		for (i = st->first; i < st->last; i++)
			o->l.refs[i].config->lrw = true;
		o->d->expected += 2 * out + in;
		return layout_fill_dgram(o, st, EC_CMD_LRW, 2 * out + in) ?:
		       add_shares(o, st, 2, 1);
	}
	o->d->expected += out + in;
	if (out)
		ret = layout_fill_dgram(o, st, EC_CMD_LWR, out) ?: add_shares(o, st, 1, 0);
	if (in && !ret)
		ret = layout_fill_dgram(o, st, EC_CMD_LRD, in) ?: add_shares(o, st, 0, 1);
	return ret;
}

static int layout_domain(struct ec_layout *l, const struct ec_wanted *w, struct ec_domain *d)
{
	struct adding o = { .to = l, .d = d };
	unsigned int i, first = l->n_dgrams;
	u8 repeats = ec_unit_repeats(w, d);
	int ret = ec_logical_place(d, &o.l);

	d->expected = 0;
	for (i = 0; i < o.l.n_stretches && !ret; i++)
		ret = add_stretch(&o, &o.l.stretches[i]);
	ec_logical_free(&o.l);
	d->n_dgrams = l->n_dgrams - first;
	d->dgram_bytes = 0;
	for (i = first; i < l->n_dgrams; i++) {
		d->dgram_bytes += EC_DGRAM_OVERHEAD + l->dgrams[i].len;
		l->dgrams[i].repeats = repeats;
		l->dgrams[i].own_frame = d->options & EC_DOMAIN_OPT_OWN_FRAME || repeats > 1;
	}
	return ret;
}

/*
 * Frames of a cycle that sends all domains, packed as the send packs them, and
 * how long they occupy the wire.
 */
static struct ec_cyc_wire layout_plan(const struct ec_layout *l, unsigned int max_datagrams,
				      bool clocks)
{
	unsigned int count = clocks ? DC_DGRAMS : 0, i;
	const struct ec_cyc_dgram *last = NULL;
	size_t body = clocks ? DC_BYTES + DC_DGRAMS * EC_DGRAM_OVERHEAD : 0;
	struct ec_cyc_wire w = { 0 };

	for (i = 0; i <= l->n_dgrams; i++) {
		const struct ec_cyc_dgram *g = l->dgrams + i;
		bool end = i == l->n_dgrams;

		if (count && (end || count >= max_datagrams || (!end && ec_cyc_is_apart(g, last)) ||
			      body + EC_DGRAM_OVERHEAD + g->len > EC_FRAME_BODY_MAX)) {
			u8 frames = last ? last->repeats : 1;

			/* the clock datagrams are only in the first of them */
			w.frames += frames;
			w.ns += frames * ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + body);
			body = count = 0;
			last = NULL;
		}
		if (end)
			break;
		body += EC_DGRAM_OVERHEAD + g->len;
		count++;
		last = g;
	}
	return w;
}

/**
 * ec_layout_make() - lay out the datagrams of a cycle, once
 * @l: zeroed; ec_layout_free() frees it, also after an error
 * @w: slave configurations and domains, whose offsets are set
 * @max_datagrams: most datagrams of a frame
 * @image_size: bytes of the image of all domains
 *
 * Sets the expected working counters of the domains.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -EOVERFLOW beyond EC_MAX_CYCLE_DGRAMS or EC_MAX_CYCLE_FRAMES;
 * -ENOMEM.
 */
int ec_layout_make(struct ec_layout *l, struct ec_wanted *w, unsigned int max_datagrams,
		   size_t image_size)
{
	int ret;

	lockdep_assert_held(w->lock);
	ec_for_each_config(s, w) {
		s->lrw = false;
		s->in_ring = false;
	}
	ec_for_each_domain(d, w) {
		ret = layout_domain(l, w, d);
		if (ret)
			return ret;
	}
	if (l->n_cuts) {
		l->stage = kvzalloc(image_size, GFP_KERNEL_ACCOUNT);
		if (!l->stage)
			return -ENOMEM;
	}
	l->plain = layout_plan(l, max_datagrams, false);
	l->clocked = layout_plan(l, max_datagrams, true);
	return l->clocked.frames > EC_MAX_CYCLE_FRAMES ? -EOVERFLOW : 0;
}

/**
 * ec_layout_free() - free what a layout has allocated
 * @l: of a cycle that does not run any more
 *
 * Context: Process. May sleep.
 */
void ec_layout_free(struct ec_layout *l)
{
	kvfree(l->dgrams);
	kvfree(l->shares);
	kvfree(l->areas);
	kvfree(l->cuts);
	kvfree(l->stage);
}
