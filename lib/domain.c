// SPDX-License-Identifier: LGPL-2.1-or-later
/* Domains: data and exchange. */

#include "ecrt/ecrt_int.h"

size_t ecrt_domain_size(const ec_domain_t *domain)
{
	struct ec_ioc_domain arg = { 0 };
	int ret;

	if (!domain)
		return (size_t)-EINVAL;
	if (domain->master->active)
		return domain->size;
	arg.index = domain->index;
	ret = ec_do(domain->master, EC_IOC_DOMAIN, &arg, "get size of domain %u", domain->index);
	return ret ? (size_t)ret : arg.size;
}

uint8_t *ecrt_domain_data(const ec_domain_t *domain)
{
	return domain ? domain->data : NULL;
}

int ecrt_domain_process(ec_domain_t *domain)
{
	const struct ec_status_domain *st;
	struct ec_master *m;
	__u64 bit;

	if (!domain || !domain->master->active)
		return -EINVAL;
	m = domain->master;
	bit = 1ULL << domain->index;
	if (!(m->cycle.received & bit))
		return 0;
	m->cycle.received &= ~bit;
	if (m->cycle.exchange) {
		ec_exchange_process(domain);
		return 0;
	}
	st = &m->status->domains[domain->index];
	domain->snap.working_counter = ec_status_read(st->working_counter);
	domain->snap.wc_state = ec_status_read(st->wc_state);
	domain->snap.redundancy_active = ec_status_read(st->redundancy_active);
	domain->snap.age = ec_status_read(st->age);
	return 0;
}

int ecrt_domain_queue(ec_domain_t *domain)
{
	if (!domain || !domain->master->active)
		return -EINVAL;
	if (domain->master->cycle.exchange)
		ec_exchange_queue(domain);
	domain->master->cycle.next.queued |= 1ULL << domain->index;
	return 0;
}
