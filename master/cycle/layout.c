// SPDX-License-Identifier: GPL-2.0-only
/* The datagrams of a cycle, laid out once at activation. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "cycle.h"
#include "../base/grow.h"
#include "logical.h"
#include "../base/once64.h"
#include "../bus/slave.h"

#define DC_BYTES	(4 + 8 + 4)	/* of the three clock datagrams */
#define DC_DGRAMS	3
#define MEASURED	1000	/* sends after which the measured interval is right */

/* a domain on its way into the layout */
struct layout {
	struct ec_cycle *c;
	struct ec_domain *d;
	struct ec_logical l;
};

/* Slaves with data of @dir in the stretch; each counts once. */
static u16 layout_count_slaves(const struct layout *o, const struct ec_stretch *st, u8 dir)
{
	const struct ec_domain_fmmu *r = o->l.refs;
	unsigned int i, j;
	u16 n = 0;

	for (i = st->first; i < st->last; i++) {
		if (r[i].fmmu->dir != dir || !r[i].fmmu->size)
			continue;
		for (j = st->first; j < i; j++)
			if (r[j].config == r[i].config && r[j].fmmu->dir == dir && r[j].fmmu->size)
				break;
		n += j == i;
	}
	return n;
}

static struct ec_cyc_dgram *add_dgram(struct layout *o, const struct ec_stretch *st, u8 cmd,
				      u16 expected)
{
	struct ec_cycle *c = o->c;
	struct ec_cyc_dgram *g;

	if (c->n_dgrams >= EC_MAX_CYCLE_DGRAMS)
		return ERR_PTR(-EOVERFLOW);
	g = ec_grow(c->dgrams, c->n_dgrams, sizeof(*g));
	if (!g)
		return ERR_PTR(-ENOMEM);
	c->dgrams = g;
	g += c->n_dgrams++;
	*g = (struct ec_cyc_dgram){
		.domain = o->d->index, .cmd = cmd, .logical = o->d->offset + st->start,
		.expected = expected, .first_copy = c->n_areas,
	};
	return g;
}

/* One more area of the datagram added last; whole ones side by side are one copy. */
static int add_area(struct ec_cycle *c, u16 *count, u32 offset, u16 pos, u16 len, bool cut)
{
	struct ec_cyc_area *a = c->areas + c->n_areas - 1;

	if (*count && !cut && a->pos + a->len == pos && a->offset + a->len == offset) {
		a->len += len;
		return 0;
	}
	a = ec_grow(c->areas, c->n_areas, sizeof(*a));
	if (!a)
		return -ENOMEM;
	c->areas = a;
	a[c->n_areas++] = (struct ec_cyc_area){ .offset = offset, .pos = pos, .len = len,
						.count = 1 };
	++*count;
	return 0;
}

/* which part of the stretch's process data */
enum part {
	SENT,	/* outputs, and inputs that keep their last value on the way */
	PLAIN,	/* inputs that share their addresses with no outputs */
	SHARED,	/* inputs that came in the place of outputs */
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

/* An input area of several datagrams: it is taken when all of them are back. */
static int add_cut(struct ec_cycle *c, u32 offset, u32 len)
{
	struct ec_cyc_cut *k = c->cuts;

	if (c->n_cuts && k[c->n_cuts - 1].offset == offset) {
		k[c->n_cuts - 1].parts++;
		return 0;
	}
	k = ec_grow(c->cuts, c->n_cuts, sizeof(*k));
	if (!k)
		return -ENOMEM;
	c->cuts = k;
	k[c->n_cuts++] = (struct ec_cyc_cut){ .offset = offset, .len = len, .parts = 1 };
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

/* The last @count areas, as few as it takes. */
static void fold_areas(struct ec_cycle *c, u16 *count)
{
	struct ec_cyc_area *a = c->areas + c->n_areas - *count, *last = a;
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
		c->n_areas = last - c->areas + 1;
	}
}

/* Areas of the datagram added last, of one part. */
static int add_areas(struct layout *o, const struct ec_stretch *st, enum part part, u16 *count)
{
	struct ec_cycle *c = o->c;
	struct ec_cyc_dgram *g = &c->dgrams[c->n_dgrams - 1];
	unsigned int i;
	int ret = 0;

	for (i = st->first; i < st->last && !ret; i++) {
		const struct ec_config_fmmu *f = o->l.refs[i].fmmu;
		u32 from = max(f->logical, st->start), to = min(f->logical + f->size, st->end);
		u32 offset = o->d->offset + f->offset;

		if (from >= to || !belongs(g, f, to - from == f->size, part))
			continue;
		if (part == CUT) {
			ret = add_cut(c, offset, f->size);
			if (ret)
				break;
		}
		ret = add_area(c, count, offset + from - f->logical, from - st->start, to - from,
			       part == CUT);
		if (part == CUT && !ret)
			c->areas[c->n_areas - 1].cut = c->n_cuts - 1;
		g->len = max_t(u16, g->len, to - st->start);
	}
	if (!ret && part != CUT)
		fold_areas(c, count);
	return ret;
}

static u32 area_bytes(const struct ec_cycle *c, const struct ec_cyc_dgram *g)
{
	u32 i, n = 0;

	for (i = 0; i < g->n_copies; i++)
		n += c->areas[g->first_copy + i].len * c->areas[g->first_copy + i].count;
	return n;
}

/* A single area covers it, so nothing of it lies elsewhere, and it brings inputs. */
static bool is_solid(const struct ec_cycle *c, const struct ec_cyc_dgram *g)
{
	return !g->holes && g->n_copies == 1 && c->areas[g->first_copy].count == 1 &&
	       g->n_plain && g->n_inputs == g->n_plain;
}

static int layout_fill_dgram(struct layout *o, const struct ec_stretch *st, u8 cmd, u16 expected)
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
	g->holes = area_bytes(o->c, g) != g->len;
	g->solid = is_solid(o->c, g);
	return ret;
}

static int add_stretch(struct layout *o, const struct ec_stretch *st)
{
	u16 out = layout_count_slaves(o, st, EC_CFG_DIR_OUTPUT);
	u16 in = layout_count_slaves(o, st, EC_CFG_DIR_INPUT);
	unsigned int i;
	int ret = 0;

	if (out && in && !o->l.separate) {
		for (i = st->first; i < st->last; i++)
			o->l.refs[i].config->lrw = true;
		o->d->expected += 2 * out + in;
		return layout_fill_dgram(o, st, EC_CMD_LRW, 2 * out + in);
	}
	o->d->expected += out + in;
	if (out)
		ret = layout_fill_dgram(o, st, EC_CMD_LWR, out);
	if (in && !ret)
		ret = layout_fill_dgram(o, st, EC_CMD_LRD, in);
	return ret;
}

/* The first datagram of a domain that wants frames of its own, or comes behind one. */
static void begin_frame(struct ec_cycle *c, const struct ec_domain *d, unsigned int first)
{
	struct ec_cyc_dgram *g = c->dgrams + first;
	u32 options = d->options;

	if (first)
		options |= c->wanted->domains[g[-1].domain]->options;
	g->new_frame = options & EC_DOMAIN_OPT_OWN_FRAME;
}

static int layout_domain(struct ec_cycle *c, struct ec_domain *d)
{
	struct layout o = { .c = c, .d = d };
	unsigned int i, first = c->n_dgrams;
	int ret = ec_logical_place(d, &o.l);

	d->expected = 0;
	for (i = 0; i < o.l.n_stretches && !ret; i++)
		ret = add_stretch(&o, &o.l.stretches[i]);
	ec_logical_free(&o.l);
	d->n_dgrams = c->n_dgrams - first;
	d->dgram_bytes = 0;
	for (i = first; i < c->n_dgrams; i++)
		d->dgram_bytes += EC_DGRAM_OVERHEAD + c->dgrams[i].len;
	if (!ret && d->n_dgrams)
		begin_frame(c, d, first);
	return ret;
}

/*
 * Frames of a cycle that sends all domains, packed as the send packs them, and
 * how long they occupy the wire.
 */
static struct ec_cyc_wire layout_plan(const struct ec_cycle *c, unsigned int max_datagrams,
				      bool clocks)
{
	unsigned int count = clocks ? DC_DGRAMS : 0, own = 0, i;
	size_t body = clocks ? DC_BYTES + DC_DGRAMS * EC_DGRAM_OVERHEAD : 0;
	struct ec_cyc_wire w = { 0 };

	for (i = 0; i <= c->n_dgrams; i++) {
		const struct ec_cyc_dgram *g = c->dgrams + i;
		bool end = i == c->n_dgrams;

		if (count && (end || count >= max_datagrams || (own && g->new_frame) ||
			      body + EC_DGRAM_OVERHEAD + g->len > EC_FRAME_BODY_MAX)) {
			w.frames++;
			w.ns += ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + body);
			body = count = own = 0;
		}
		if (end)
			break;
		body += EC_DGRAM_OVERHEAD + g->len;
		count++;
		own++;
	}
	return w;
}

/**
 * ec_cycle_layout() - lay out the datagrams of a cycle, once
 * @c: cycle whose domains have offsets; ec_cycle_free() frees the layout, also after an error
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -EOVERFLOW beyond EC_MAX_CYCLE_DGRAMS or EC_MAX_CYCLE_FRAMES;
 * -ENOMEM.
 */
int ec_cycle_layout(struct ec_cycle *c)
{
	int ret;

	lockdep_assert_held(c->wanted->lock);
	ec_for_each_config(s, c->wanted) {
		s->lrw = false;
		s->in_ring = false;
	}
	ec_for_each_domain(d, c->wanted) {
		ret = layout_domain(c, d);
		if (ret)
			return ret;
		c->domains[d->index] = (struct ec_cyc_domain){
			.expected = d->expected, .max_age = d->max_age,
			/* offsets are those of the image of all domains; a thread exchanges those */
			.image = d->memory && !c->kernel.period_ns ? d->memory - d->offset :
								     c->shared->image,
		};
	}
	if (c->n_cuts) {
		c->stage = kvzalloc(c->shared->image_size, GFP_KERNEL_ACCOUNT);
		if (!c->stage)
			return -ENOMEM;
	}
	c->plain = layout_plan(c, c->links->max_datagrams, false);
	c->clocked = layout_plan(c, c->links->max_datagrams, true);
	return c->clocked.frames > EC_MAX_CYCLE_FRAMES ? -EOVERFLOW : 0;
}

/* Wire time of a minimum Ethernet frame: less does no acyclic frame need. */
u32 ec_cycle_need_ns(void)
{
	return ec_frame_wire_ns(EC_ETH_MIN);
}

/* Does an acyclic frame fit beside a cycle of @interval_ns? If not the log says so. */
static bool has_room(struct ec_cycle *c, u64 interval_ns, u32 wire_ns)
{
	u64 budget = div_u64(interval_ns * 9, 10);
	u32 slack = budget > wire_ns ? min_t(u64, budget - wire_ns, ~0u) : 0;

	if (slack >= ec_cycle_need_ns())
		return true;
	c->room_logged = true;
	ec_warn(c,
		"cyclic frames use %u ns of %llu ns; %u ns free for acyclic frames, minimum %u ns: lengthen the cycle or overlap PDOs\n",
		wire_ns, interval_ns, slack, ec_cycle_need_ns());
	ec_event(c->base, EC_EVENT_WIRE_TIME, wire_ns, min_t(u64, interval_ns, ~0u), slack,
		 ec_cycle_need_ns());
	return false;
}

/**
 * ec_cycle_check_room() - do acyclic frames fit beside the cycle?
 * @c: cycle with a layout
 * @clocks: the application uses distributed clocks
 *
 * Without them no slave gets to OP. As long as the interval is not set it is not
 * known yet; ec_cycle_tell_room() looks later.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENOSPC: they do not, and may make no cycle late.
 */
int ec_cycle_check_room(struct ec_cycle *c, bool clocks)
{
	u64 interval = c->kernel.period_ns ?:
		       ec_access_interval_us(&c->links->access) * (u64)NSEC_PER_USEC;
	const struct ec_cyc_wire *w = clocks ? &c->clocked : &c->plain;

	lockdep_assert_held(c->wanted->lock);
	c->room_logged = false;
	c->links->access.wire_ns = w->ns;
	WRITE_ONCE(c->carry->share.late_per_s, c->late_per_s);
	c->carry->share.late_cycles = 0;
	if (!c->kernel.period_ns && !c->links->access.interval_set)
		return 0;
	return has_room(c, interval, w->ns) || c->late_per_s ? 0 : -ENOSPC;
}

/**
 * ec_cycle_tell_room() - the same in the log, once the interval is measured
 * @c: active cycle
 *
 * Context: The monitor thread, lock of the configuration held. May sleep.
 */
void ec_cycle_tell_room(struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	if (!c->room_logged && !c->links->access.interval_set &&
	    ec_read64(&c->sends) > MEASURED)
		has_room(c, ec_access_interval_us(&c->links->access) * (u64)NSEC_PER_USEC,
			 READ_ONCE(c->links->access.wire_ns));
}

/* What is still on its way will not be received. */
static void forget_flights(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->n_flight; i++) {
		struct ec_slot *slot = c->flight[i].slot;

		while (!ec_slot_cancel(slot, ktime_get_ns())) {
			if (atomic_read_acquire(&slot->state) == EC_SLOT_DONE) {
				ec_slot_put(slot);
				break;
			}
			/* being copied at this moment */
			usleep_range(20, 50);
		}
	}
	c->n_flight = 0;
}

/**
 * ec_cycle_free() - give back what a layout and its frames occupy
 * @c: cycle that does not run any more
 *
 * Context: Process. May sleep.
 */
void ec_cycle_free(struct ec_cycle *c)
{
	forget_flights(c);
	kvfree(c->dgrams);
	kvfree(c->areas);
	kvfree(c->cuts);
	kvfree(c->stage);
	kvfree(c->copying);
	memset_startat(c, 0, dgrams);
}
