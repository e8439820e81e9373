// SPDX-License-Identifier: GPL-2.0-only
/* Domains, for applications in the kernel. */
#include "../../lib/ecrt/ecrt_int.h"

size_t ecrt_domain_size(const ec_domain_t *domain)
{
	return domain ? READ_ONCE(domain->size) : (size_t)-EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_domain_size);

void ecrt_domain_external_memory(ec_domain_t *domain, uint8_t *memory)
{
	struct ec_master *m;

	if (!domain)
		return;
	m = ec_master_of(ec_domain_session(domain));
	mutex_lock(&m->sessions.lock);
	if (!ec_domain_session(domain)->wanted.active)
		domain->memory = domain->data = memory;
	else
		ec_err(m,
		       "kernel API: memory for domain %u comes after activation; it is not used\n",
		       domain->index);
	mutex_unlock(&m->sessions.lock);
}
EXPORT_SYMBOL_GPL(ecrt_domain_external_memory);

static struct ec_api *active(const struct ec_domain *d)
{
	struct ec_api *api = d ? ec_master_of(ec_domain_session(d))->api : NULL;

	return api && ec_api_session(api) ? api : NULL;
}

uint8_t *ecrt_domain_data(const ec_domain_t *domain)
{
	return domain && domain->size ? domain->data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_domain_data);

int ecrt_domain_process(ec_domain_t *domain)
{
	struct ec_api *api = active(domain);
	const struct ec_status_domain *st;

	if (!api)
		return -EINVAL;
	if (!(api->cycle.received & BIT_ULL(domain->index)))
		return 0;
	api->cycle.received &= ~BIT_ULL(domain->index);
	if (api->cycle.exchange) {
		ec_exchange_process(domain);
		return 0;
	}
	st = &ec_domain_session(domain)->cycle.shared->status->domains[domain->index];
	domain->snap.working_counter = READ_ONCE(st->working_counter);
	domain->snap.wc_state = READ_ONCE(st->wc_state);
	domain->snap.redundancy_active = READ_ONCE(st->redundancy_active);
	domain->snap.age = READ_ONCE(st->age);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_process);

int ecrt_domain_queue(ec_domain_t *domain)
{
	struct ec_api *api = active(domain);

	if (!api)
		return -EINVAL;
	if (api->cycle.exchange)
		ec_exchange_queue(domain);
	api->cycle.next.queued |= BIT_ULL(domain->index);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_queue);
