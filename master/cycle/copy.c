// SPDX-License-Identifier: GPL-2.0-only
#include <linux/minmax.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../config/config.h"
#include "../config/domain.h"
#include "copy.h"

/** struct step - a copy, prepared */
struct step {
	/** @domain: of the inputs, its working counter says whether they are valid */
	u32 domain;
	/** @to_domain: of the outputs */
	u32 to_domain;
	/** @from: bit in the image */
	u32 from;
	/** @to: bit in the image */
	u32 to;
	/** @bits: how many */
	u32 bits;
	/** @last: byte in the memory of last values */
	u32 last;
};

/** struct ec_copying - the copies of an active cycle; of the cycle owner */
struct ec_copying {
	/** @n: entries in @steps */
	unsigned int n;
	/** @last: last valid values, behind @steps */
	u8 *last;
	/** @steps: copies */
	struct step steps[];
};

/* @bits from bit @from_bit of @from on to bit @to_bit of @to; least bit first. */
static void copy_bits(u8 *to, u32 to_bit, const u8 *from, u32 from_bit, u32 bits)
{
	to += to_bit / 8;
	to_bit %= 8;
	from += from_bit / 8;
	from_bit %= 8;
	if (!to_bit && !from_bit) {
		memcpy(to, from, bits / 8);
		to += bits / 8;
		from += bits / 8;
		bits %= 8;
	}
	while (bits) {
		u32 n = min3(bits, 8 - to_bit, 8 - from_bit);
		u8 mask = ((1u << n) - 1) << to_bit;

		*to = (*to & ~mask) | ((u8)(*from >> from_bit << to_bit) & mask);
		bits -= n;
		to_bit += n;
		from_bit += n;
		to += to_bit / 8;
		from += from_bit / 8;
		to_bit %= 8;
		from_bit %= 8;
	}
}

/* Do the bits belong to one slave's process data of that direction? */
static bool inside(const struct ec_wanted *w, u32 domain, u32 bit, u32 bits, u8 dir)
{
	const struct ec_domain *d = w->domains[domain];
	unsigned int i;

	for (i = 0; i < d->n_fmmus; i++) {
		const struct ec_config_fmmu *f = d->fmmus[i].fmmu;

		if (f->dir == dir && bit >= 8 * f->offset && bit - 8 * f->offset < 8 * f->size &&
		    bits <= 8 * f->size - (bit - 8 * f->offset))
			return true;
	}
	return false;
}

static bool overlap(const struct ec_ioc_copy *a, const struct ec_ioc_copy *b)
{
	return a->to_domain == b->to_domain && a->to_bit < b->to_bit + b->bits &&
	       b->to_bit < a->to_bit + a->bits;
}

/**
 * ec_copy_add() - one more copy
 * @c: copies of a cycle that is not active
 * @w: its domains
 * @copy: what to copy; nothing of it is checked yet
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENOENT no such domain; -EDOM the source is not input of one
 * slave; -ERANGE the target is not output of one slave; -EEXIST another copy has
 * that target; -ENOSPC; -ENOMEM.
 */
int ec_copy_add(struct ec_copies *c, const struct ec_wanted *w, const struct ec_ioc_copy *copy)
{
	unsigned int i;

	lockdep_assert_held(w->lock);
	if (copy->from_domain >= w->n_domains || copy->to_domain >= w->n_domains)
		return -ENOENT;
	if (!copy->bits || !inside(w, copy->from_domain, copy->from_bit, copy->bits,
				   EC_CFG_DIR_INPUT))
		return -EDOM;
	if (!inside(w, copy->to_domain, copy->to_bit, copy->bits, EC_CFG_DIR_OUTPUT))
		return -ERANGE;
	for (i = 0; i < c->n; i++)
		if (overlap(copy, &c->list[i]))
			return -EEXIST;
	if (c->n >= EC_MAX_COPIES)
		return -ENOSPC;
	if (!c->list)
		c->list = kvcalloc(EC_MAX_COPIES, sizeof(*c->list), GFP_KERNEL_ACCOUNT);
	if (!c->list)
		return -ENOMEM;
	c->list[c->n++] = *copy;
	return 0;
}

/**
 * ec_copy_begin() - prepare the copies of an activation
 * @c: copies
 * @w: domains, whose offsets are set
 * @copying: result for kvfree(); NULL: there are no copies
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_copy_begin(const struct ec_copies *c, const struct ec_wanted *w,
		  struct ec_copying **copying)
{
	size_t bytes = 0, steps = c->n * sizeof(struct step);
	struct ec_copying *k;
	unsigned int i;

	lockdep_assert_held(w->lock);
	*copying = NULL;
	if (!c->n)
		return 0;
	for (i = 0; i < c->n; i++)
		bytes += DIV_ROUND_UP(c->list[i].bits, 8);
	k = kvzalloc(sizeof(*k) + steps + bytes, GFP_KERNEL_ACCOUNT);
	if (!k)
		return -ENOMEM;
	k->n = c->n;
	k->last = (u8 *)k->steps + steps;
	for (bytes = 0, i = 0; i < k->n; i++) {
		const struct ec_ioc_copy *copy = &c->list[i];

		k->steps[i] = (struct step){
			.domain = copy->from_domain, .to_domain = copy->to_domain,
			.bits = copy->bits, .last = bytes,
			.from = 8 * w->domains[copy->from_domain]->offset + copy->from_bit,
			.to = 8 * w->domains[copy->to_domain]->offset + copy->to_bit,
		};
		bytes += DIV_ROUND_UP(copy->bits, 8);
	}
	*copying = k;
	return 0;
}

/**
 * ec_copy_run() - copy inputs to outputs in the image
 * @k: copies of an active cycle
 * @st: its status page
 * @domains: what it has received; their images may be the application's
 *
 * While the working counter of the source's domain is not complete the last
 * values stay; initially they are zero.
 *
 * Context: The cycle owner, between receive and send. RT-safe.
 */
void ec_copy_run(struct ec_copying *k, const struct ec_status *st,
		 const struct ec_cyc_domain *domains)
{
	unsigned int i;

	for (i = 0; i < k->n; i++) {
		const struct step *p = &k->steps[i];

		if (st->domains[p->domain].wc_state == EC_STATUS_WC_COMPLETE)
			copy_bits(k->last + p->last, 0, domains[p->domain].image, p->from,
				  p->bits);
		copy_bits(domains[p->to_domain].image, p->to, k->last + p->last, 0, p->bits);
	}
}
