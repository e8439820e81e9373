// SPDX-License-Identifier: GPL-2.0-only
/* Domains, for applications in the kernel. */
#include "api.h"

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
	/* not the session of the handle, which after a takeover never becomes active */
	if (!READ_ONCE(m->api->active))
		domain->memory = domain->data = memory;
	else
		ec_err(m,
		       "kernel API: memory for domain %u comes after activation; it is not used\n",
		       domain->index);
	mutex_unlock(&m->sessions.lock);
}
EXPORT_SYMBOL_GPL(ecrt_domain_external_memory);

uint8_t *ecrt_domain_data(const ec_domain_t *domain)
{
	return domain && domain->size ? domain->data : NULL;
}
EXPORT_SYMBOL_GPL(ecrt_domain_data);
