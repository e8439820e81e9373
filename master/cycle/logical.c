// SPDX-License-Identifier: GPL-2.0-only
/*
 * Where the FMMUs of a domain lie in its logical addresses.
 *
 * Without options they follow each other as in the image. Where inputs and outputs
 * share addresses, a slave overwrites outputs in the datagram by its inputs. So each
 * slave whose outputs are at these addresses must be upstream, or be the same slave.
 * LRD and LWR do not change each other's data: there all FMMUs may share addresses.
 */
#include <linux/slab.h>
#include <linux/sort.h>
#include "../config/config.h"
#include "../config/why.h"
#include "../base/grow.h"
#include "logical.h"
#include "../bus/slave.h"
#include "../wire/frame.h"

/* how the FMMUs of one slave are put */
enum way {
	APART,	/* one after the other */
	OWN,	/* inputs share with outputs of the same slave only */
	RING,	/* inputs share with outputs of slaves upstream as well */
	FREE,	/* inputs share with outputs of any slave: LRD and LWR */
};

/* @out, @in: behind the last output, input; @at: the stretch in work */
struct place {
	const struct ec_domain *d;
	struct ec_logical *l;
	u32 out;
	u32 in;
	struct ec_stretch at;
};

static bool is_out(const struct ec_config_fmmu *f)
{
	return f->dir == EC_CFG_DIR_OUTPUT;
}

/* The place of a slave in the ring does not change, or is known now. */
static bool ring_place(const struct ec_config *c, unsigned int *place)
{
	return ec_config_place(c, place) && (!c->alias || c->slave);
}

static enum way way_of(const struct place *p, const struct ec_config *c)
{
	unsigned int place;

	if (p->l->separate)
		return FREE;
	if (p->d->options & EC_DOMAIN_OPT_OVERLAP)
		return ring_place(c, &place) ? RING : OWN;
	return c->overlap ? OWN : APART;
}

/* Configurations without a known place come last: they share with no other. */
static int by_ring(const void *a, const void *b)
{
	const struct ec_domain_fmmu *x = a, *y = b;
	unsigned int px, py;

	if (!ring_place(x->config, &px))
		px = U32_MAX;
	if (!ring_place(y->config, &py))
		py = U32_MAX;
	if (px != py)
		return px < py ? -1 : 1;
	if (x->config != y->config)
		return x->config->index < y->config->index ? -1 : 1;
	/* outputs first: inputs can share with them */
	if (x->fmmu->dir != y->fmmu->dir)
		return is_out(x->fmmu) ? -1 : 1;
	return x->fmmu < y->fmmu ? -1 : x->fmmu > y->fmmu;
}

/* All FMMUs of @c in the domain, outputs first. */
static void take_config(struct place *p, struct ec_config *c)
{
	static const u8 dirs[] = { EC_CFG_DIR_OUTPUT, EC_CFG_DIR_INPUT };
	unsigned int i, k;

	for (k = 0; k < ARRAY_SIZE(dirs); k++)
		for (i = 0; i < c->n_fmmus; i++)
			if (c->fmmus[i].domain == p->d && c->fmmus[i].dir == dirs[k])
				p->l->refs[p->l->n++] = (struct ec_domain_fmmu){
					.config = c, .fmmu = &c->fmmus[i] };
}

/* Is it the first FMMU of its configuration in the domain? */
static bool logical_is_first(const struct place *p, const struct ec_domain_fmmu *ref)
{
	const struct ec_config_fmmu *f = ref->config->fmmus;

	while (f->domain != p->d)
		f++;
	return f == ref->fmmu;
}

/* In the order of registration, but FMMUs of a slave that share addresses are adjacent. */
static void arrange(struct place *p)
{
	unsigned int i;

	for (i = 0; i < p->d->n_fmmus; i++) {
		const struct ec_domain_fmmu *ref = &p->d->fmmus[i];

		if (way_of(p, ref->config) == APART || way_of(p, ref->config) == FREE)
			p->l->refs[p->l->n++] = *ref;
		else if (logical_is_first(p, ref))
			take_config(p, ref->config);
	}
	if (p->d->options & EC_DOMAIN_OPT_OVERLAP && !p->l->separate)
		sort(p->l->refs, p->l->n, sizeof(p->l->refs[0]), by_ring, NULL);
}

static void logical_put(struct place *p, struct ec_config_fmmu *f)
{
	u32 *end = is_out(f) ? &p->out : &p->in;

	f->logical = *end;
	*end += f->size;
}

/* FMMUs @i to @k - 1 of one configuration, behind those put before. */
static void put_unit(struct place *p, unsigned int i, unsigned int k, enum way way)
{
	if (way == OWN || way == APART)
		p->out = p->in = max(p->out, p->in);
	for (; i < k; i++) {
		struct ec_config_fmmu *f = p->l->refs[i].fmmu;
		u32 outputs = p->out;

		logical_put(p, f);
		f->shared = (way == OWN || way == RING) && !is_out(f) && f->logical < outputs;
		p->l->refs[i].config->in_ring |= way == RING;
		/* outputs of later slaves must not lie at these inputs */
		if (way == RING)
			p->out = max(p->out, p->in);
		else if (way == APART)
			p->out = p->in = max(p->out, p->in);
	}
	if (way == OWN)
		p->out = p->in = max(p->out, p->in);
}

static int close_stretch(struct place *p, u32 next, unsigned int first)
{
	struct ec_logical *l = p->l;
	struct ec_stretch *st;

	st = ec_grow(l->stretches, l->n_stretches, sizeof(*st));
	if (!st)
		return -ENOMEM;
	l->stretches = st;
	st[l->n_stretches++] = p->at;
	p->at = (struct ec_stretch){ .start = next, .end = next, .first = first, .last = first };
	return 0;
}

/* An FMMU that is larger than a datagram: several datagrams, all full but the last. */
static int put_large(struct place *p, unsigned int i)
{
	u32 end;
	int ret = 0;

	put_unit(p, i, i + 1, APART);
	end = max(p->out, p->in);
	p->at.last = i + 1;
	while (!ret && end - p->at.start > EC_DGRAM_DATA_MAX) {
		p->at.end = p->at.start + EC_DGRAM_DATA_MAX;
		ret = close_stretch(p, p->at.end, i);
		p->at.last = i + 1;
	}
	p->at.end = end;
	return ret;
}

/* A unit in the stretch in work, or in a new one when it does not fit there. */
static int add_unit(struct place *p, unsigned int i, unsigned int k, enum way way)
{
	u32 out = p->out, in = p->in;
	int ret = 0;

	put_unit(p, i, k, way);
	if (max(p->out, p->in) - p->at.start > EC_DGRAM_DATA_MAX && p->at.end > p->at.start) {
		p->out = p->in = max(out, in);
		ret = close_stretch(p, p->out, i);
		if (ret)
			return ret;
		out = in = p->out;
		put_unit(p, i, k, way);
	}
	if (max(p->out, p->in) - p->at.start <= EC_DGRAM_DATA_MAX) {
		p->at.end = max(p->out, p->in);
		p->at.last = k;
		return 0;
	}
	if (k - i > 1) {
		p->out = p->in = max(out, in);
		for (; i < k && !ret; i++)
			ret = add_unit(p, i, i + 1, APART);
		return ret;
	}
	p->out = p->in = max(out, in);
	return put_large(p, i);
}

/* Where the unit that begins at @i ends: a slave that shares stays together. */
static unsigned int unit_end(const struct place *p, unsigned int i, enum way way)
{
	const struct ec_domain_fmmu *r = p->l->refs;
	unsigned int k = i + 1;

	if (way == OWN || way == RING)
		while (k < p->l->n && r[k].config == r[i].config)
			k++;
	return k;
}

static bool wants_separate(const struct ec_domain *d)
{
	unsigned int i;

	if (d->options & EC_DOMAIN_OPT_SEPARATE)
		return true;
	for (i = 0; i < d->n_fmmus; i++)
		if (d->fmmus[i].config->slave && ec_slave_no_lrw(d->fmmus[i].config->slave))
			return true;
	return false;
}

/**
 * ec_logical_place() - give the FMMUs of a domain their logical addresses
 * @d: domain whose FMMUs have offsets
 * @l: result; ec_logical_free() frees it, also after an error
 *
 * A stretch is at most EC_DGRAM_DATA_MAX bytes, cut between FMMUs; only an FMMU
 * that is larger itself is cut.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0, -ENOMEM.
 */
int ec_logical_place(struct ec_domain *d, struct ec_logical *l)
{
	struct place p = { .d = d, .l = l };
	unsigned int i, k;
	int ret = 0;

	lockdep_assert_held(d->wanted->lock);
	*l = (struct ec_logical){ .separate = wants_separate(d) };
	l->refs = kvcalloc(d->n_fmmus + 1, sizeof(*l->refs), GFP_KERNEL_ACCOUNT);
	if (!l->refs)
		return -ENOMEM;
	/* the places in the ring */
	down_read(&d->wanted->bus->topo);
	arrange(&p);
	for (i = 0; i < l->n && !ret; i = k) {
		struct ec_config *c = l->refs[i].config;
		enum way way = way_of(&p, c);

		k = unit_end(&p, i, way);
		if (way == RING)
			ring_place(c, &c->ring_position);
		ret = add_unit(&p, i, k, way);
	}
	up_read(&d->wanted->bus->topo);
	if (!ret && p.at.end > p.at.start)
		ret = close_stretch(&p, p.at.end, l->n);
	return ret;
}

void ec_logical_free(struct ec_logical *l)
{
	kvfree(l->refs);
	kvfree(l->stretches);
}
