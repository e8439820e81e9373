// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "../base/grow.h"
#include "../base/limits.h"
#include "config.h"
#include "domain.h"

/**
 * ec_domain_create() - an empty domain
 * @w: what an application configures
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: domain, or ERR_PTR: -ENOSPC beyond EC_MAX_DOMAINS, -ENOMEM.
 */
struct ec_domain *ec_domain_create(struct ec_wanted *w)
{
	struct ec_domain *d;

	lockdep_assert_held(w->lock);
	if (w->n_domains >= EC_MAX_DOMAINS)
		return ERR_PTR(-ENOSPC);
	d = kzalloc(sizeof(*d), GFP_KERNEL_ACCOUNT);
	if (!d)
		return ERR_PTR(-ENOMEM);
	d->wanted = w;
	d->index = w->n_domains;
	d->division = 1;
	d->max_age = EC_DOMAIN_MAX_AGE;
	w->domains[w->n_domains++] = d;
	return d;
}

/**
 * ec_domain_free() - free a domain
 * @d: domain that no layout uses
 *
 * Context: Process.
 */
void ec_domain_free(struct ec_domain *d)
{
	kvfree(d->fmmus);
	kvfree(d->inputs);
	kfree(d);
}

/**
 * ec_domain_add() - an FMMU of a configuration belongs to the domain
 * @d: domain
 * @c: configuration
 * @fmmu: index in it, @offset and @size set
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0, -ENOMEM, or -EOVERFLOW when the image would be larger than
 * EC_MAX_IMAGE.
 */
int ec_domain_add(struct ec_domain *d, struct ec_config *c, unsigned int fmmu)
{
	struct ec_domain_fmmu *p;

	lockdep_assert_held(d->wanted->lock);
	if (d->size + c->fmmus[fmmu].size > EC_MAX_IMAGE)
		return -EOVERFLOW;
	p = ec_grow(d->fmmus, d->n_fmmus, sizeof(*p));
	if (!p)
		return -ENOMEM;
	d->fmmus = p;
	p[d->n_fmmus++] = (struct ec_domain_fmmu){ .config = c, .fmmu = &c->fmmus[fmmu] };
	return 0;
}

/**
 * ec_domain_areas() - where the process data of a domain lie in the image
 * @d: domain with an offset
 * @dir: EC_CFG_DIR_*
 * @list: result: as many entries more as the domain has FMMUs, at most
 * @n: entries of earlier domains in @list
 *
 * Context: Process, lock of the configuration held.
 * Return: entries now; data behind those of the last entry are one with it.
 */
unsigned int ec_domain_areas(const struct ec_domain *d, u8 dir, struct ec_domain_area *list,
			     unsigned int n)
{
	unsigned int i;

	lockdep_assert_held(d->wanted->lock);
	for (i = 0; i < d->n_fmmus; i++) {
		const struct ec_config_fmmu *f = d->fmmus[i].fmmu;
		u32 offset = d->offset + f->offset;

		if (f->dir != dir || !f->size)
			continue;
		if (n && list[n - 1].offset + list[n - 1].len == offset)
			list[n - 1].len += f->size;
		else
			list[n++] = (struct ec_domain_area){ offset, f->size };
	}
	return n;
}
