// SPDX-License-Identifier: GPL-2.0-only
/* The datagrams of a cycle, laid out once at activation. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/slab.h>
#include "config.h"
#include "cycle.h"
#include "domain.h"
#include "master.h"
#include "session.h"
#include "slave.h"

/* one stretch of a domain that becomes one datagram, or LRD plus LWR */
struct stretch {
	u32 start;
	u32 end;
	unsigned int first;	/* FMMU reference in the domain */
	unsigned int last;	/* behind the last one */
};

static const struct ec_config_fmmu *fmmu(const struct ec_domain *d, unsigned int i)
{
	return &d->fmmus[i].config->fmmus[d->fmmus[i].fmmu];
}

/* Slaves with data of @dir in the stretch; each counts once. */
static u16 count_slaves(const struct ec_domain *d, const struct stretch *st, u8 dir)
{
	unsigned int i, j;
	u16 n = 0;

	for (i = st->first; i < st->last; i++) {
		if (fmmu(d, i)->dir != dir || !fmmu(d, i)->size)
			continue;
		for (j = st->first; j < i; j++)
			if (d->fmmus[j].config == d->fmmus[i].config && fmmu(d, j)->dir == dir &&
			    fmmu(d, j)->size)
				break;
		n += j == i;
	}
	return n;
}

static int add_dgram(struct ec_cycle *c, const struct ec_domain *d, const struct stretch *st,
		     u8 cmd, u16 expected)
{
	struct ec_cyc_dgram *g;

	if (c->n_dgrams >= EC_MAX_CYCLE_DGRAMS)
		return -EOVERFLOW;
	g = krealloc_array(c->dgrams, c->n_dgrams + 1, sizeof(*g), GFP_KERNEL);
	if (!g)
		return -ENOMEM;
	c->dgrams = g;
	g += c->n_dgrams++;
	*g = (struct ec_cyc_dgram){
		.domain = d->index, .cmd = cmd, .logical = d->logical + st->start,
		.offset = d->offset + st->start, .len = st->end - st->start,
		.expected = expected, .first_input = c->n_inputs,
	};
	return 0;
}

/* Inputs side by side are one copy. */
static int add_input(struct ec_cycle *c, u32 offset, u16 pos, u16 len)
{
	struct ec_cyc_dgram *g = &c->dgrams[c->n_dgrams - 1];
	struct ec_cyc_input *in = c->inputs;

	if (g->n_inputs) {
		in += c->n_inputs - 1;
		if (in->pos + in->len == pos) {
			in->len += len;
			return 0;
		}
	}
	in = krealloc_array(c->inputs, c->n_inputs + 1, sizeof(*in), GFP_KERNEL);
	if (!in)
		return -ENOMEM;
	c->inputs = in;
	in[c->n_inputs++] = (struct ec_cyc_input){ .offset = offset, .pos = pos, .len = len };
	g->n_inputs++;
	return 0;
}

/* The inputs of the datagram added last; FMMUs are in order of their offset. */
static int add_inputs(struct ec_cycle *c, const struct ec_domain *d, const struct stretch *st)
{
	unsigned int i;
	int ret = 0;

	for (i = st->first; i < st->last && !ret; i++) {
		const struct ec_config_fmmu *f = fmmu(d, i);
		u32 from = max(f->offset, st->start), to = min(f->offset + f->size, st->end);

		if (f->dir == EC_CFG_DIR_INPUT && from < to)
			ret = add_input(c, d->offset + from, from - st->start, to - from);
	}
	return ret;
}

static int add_stretch(struct ec_cycle *c, struct ec_domain *d, const struct stretch *st)
{
	u16 out = count_slaves(d, st, EC_CFG_DIR_OUTPUT);
	u16 in = count_slaves(d, st, EC_CFG_DIR_INPUT);
	bool split = false;
	unsigned int i;
	int ret = 0;

	for (i = st->first; i < st->last; i++)
		split |= d->fmmus[i].config->slave && ec_slave_no_lrw(d->fmmus[i].config->slave);
	if (out && in && !split) {
		for (i = st->first; i < st->last; i++)
			d->fmmus[i].config->lrw = true;
		d->expected += 2 * out + in;
		return add_dgram(c, d, st, EC_CMD_LRW, 2 * out + in) ?: add_inputs(c, d, st);
	}
	d->expected += out + in;
	if (out)
		ret = add_dgram(c, d, st, EC_CMD_LWR, out);
	if (in && !ret)
		ret = add_dgram(c, d, st, EC_CMD_LRD, in) ?: add_inputs(c, d, st);
	return ret;
}

/* Cut a domain into stretches that fit a datagram, between FMMUs where possible. */
static int layout_domain(struct ec_cycle *c, struct ec_domain *d)
{
	struct stretch st = { 0 };
	unsigned int i;
	int ret = 0;

	d->expected = 0;
	for (i = 0; i < d->n_fmmus && !ret; i++) {
		u32 end = fmmu(d, i)->offset + fmmu(d, i)->size;

		if (end - st.start > EC_DGRAM_DATA_MAX && st.end > st.start) {
			ret = add_stretch(c, d, &st);
			st.start = st.end;
			st.first = i;
		}
		st.last = i + 1;
		while (!ret && end - st.start > EC_DGRAM_DATA_MAX) {
			st.end = st.start + EC_DGRAM_DATA_MAX;
			ret = add_stretch(c, d, &st);
			st.start = st.end;
		}
		st.end = end;
	}
	if (!ret && st.end > st.start)
		ret = add_stretch(c, d, &st);
	return ret;
}

/**
 * ec_cycle_layout() - lay out the datagrams of a cycle, once
 * @s: session whose domains have offsets
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, -EOVERFLOW beyond EC_MAX_CYCLE_DGRAMS, -ENOMEM.
 */
int ec_cycle_layout(struct ec_session *s)
{
	unsigned int i;
	int ret = 0;

	memset(&s->cycle, 0, sizeof(s->cycle));
	for (i = 0; i < s->n_domains && !ret; i++)
		ret = layout_domain(&s->cycle, s->domains[i]);
	for (i = 0; i < s->n_domains; i++)
		s->cycle.domains[i].expected = s->domains[i]->expected;
	if (ret)
		ec_cycle_free(s->master, &s->cycle);
	return ret;
}

/* Nobody will receive what is still on its way. */
static void forget_flights(struct ec_master *m, struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->n_flight; i++) {
		struct ec_slot *slot = c->flight[i].slot;

		while (!ec_slot_cancel(slot, ktime_get_ns())) {
			if (atomic_read_acquire(&slot->state) == EC_SLOT_DONE) {
				ec_slot_put(&m->slots, slot, true);
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
 * @m: master
 * @c: layout nobody uses any more
 *
 * Context: Process. May sleep.
 */
void ec_cycle_free(struct ec_master *m, struct ec_cycle *c)
{
	forget_flights(m, c);
	kfree(c->dgrams);
	kfree(c->inputs);
	memset(c, 0, sizeof(*c));
}
