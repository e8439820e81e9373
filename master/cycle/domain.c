// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "../config/config.h"
#include "domain.h"
#include "../base/grow.h"
#include "../base/limits.h"
#include "../session/session.h"

/**
 * ec_domain_create() - an empty domain
 * @s: session
 *
 * Context: Process, session_lock held. May sleep.
 * Return: domain, or ERR_PTR: -ENOSPC beyond EC_MAX_DOMAINS, -ENOMEM.
 */
struct ec_domain *ec_domain_create(struct ec_session *s)
{
	struct ec_domain *d;

	if (s->n_domains >= EC_MAX_DOMAINS)
		return ERR_PTR(-ENOSPC);
	d = kzalloc(sizeof(*d), GFP_KERNEL_ACCOUNT);
	if (!d)
		return ERR_PTR(-ENOMEM);
	d->session = s;
	d->index = s->n_domains;
	d->division = 1;
	d->max_age = EC_DOMAIN_MAX_AGE;
	s->domains[s->n_domains++] = d;
	return d;
}

void ec_domain_free(struct ec_domain *d)
{
	kvfree(d->fmmus);
	kfree(d);
}

/**
 * ec_domain_data() - where the process data of a domain lie
 * @d: domain of an active session
 *
 * Context: Any, while the session is active.
 * Return: its first byte.
 */
u8 *ec_domain_data(const struct ec_domain *d)
{
	return d->memory ?: d->session->shared->image + d->offset;
}

/**
 * ec_domain_add() - an FMMU of a configuration belongs to the domain
 * @d: domain
 * @c: configuration
 * @fmmu: index in it, @offset and @size set
 *
 * Context: Process, session_lock held. May sleep.
 * Return: 0, -ENOMEM, or -EOVERFLOW when the image would be larger than
 * EC_MAX_IMAGE.
 */
int ec_domain_add(struct ec_domain *d, struct ec_config *c, unsigned int fmmu)
{
	struct ec_domain_fmmu *p;

	if (d->size + c->fmmus[fmmu].size > EC_MAX_IMAGE)
		return -EOVERFLOW;
	p = ec_grow(d->fmmus, d->n_fmmus, sizeof(*p));
	if (!p)
		return -ENOMEM;
	d->fmmus = p;
	p[d->n_fmmus++] = (struct ec_domain_fmmu){ .config = c, .fmmu = fmmu };
	return 0;
}
