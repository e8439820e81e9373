// SPDX-License-Identifier: LGPL-2.1-or-later
/* Domains: size and data. */

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
