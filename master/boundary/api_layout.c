// SPDX-License-Identifier: GPL-2.0-only
/* How process data are sent, for applications in the kernel. */
#include "api.h"
#include "../cycle/domain.h"

int ecrt_slave_config_overlapping_pdos(ec_slave_config_t *sc, uint8_t allow_overlapping_pdos)
{
	struct ec_ioc_sc_overlap i = { .overlap = !!allow_overlapping_pdos };
	int ret;

	if (!sc)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_OVERLAP, &i);
	return ret ? ec_api_fail_sc(sc, ret, "let process data overlap") : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_overlapping_pdos);

int ecrt_domain_set_options(ec_domain_t *domain, uint32_t options)
{
	struct ec_ioc_domain_options i = { .options = options };
	struct ec_master *m;
	int ret;

	if (!domain)
		return -EINVAL;
	m = domain->session->master;
	i.domain = domain->index;
	ret = ec_command(m, EC_IOC_DOMAIN_OPTIONS, &i);
	return ret ? ec_api_fail(m, ret, "set options 0x%x of domain %u", options,
				 domain->index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_options);

int ecrt_domain_set_max_age(ec_domain_t *domain, unsigned int sends)
{
	struct ec_ioc_domain_age i = { .max_age = sends };
	struct ec_master *m;
	int ret;

	if (!domain)
		return -EINVAL;
	m = domain->session->master;
	i.domain = domain->index;
	ret = ec_command(m, EC_IOC_DOMAIN_AGE, &i);
	return ret ? ec_api_fail(m, ret, "set the maximum age of domain %u",
				 domain->index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_max_age);

int ecrt_master_set_late_cycles(ec_master_t *master, uint32_t per_second)
{
	struct ec_ioc_late i = { .per_s = per_second };
	int ret;

	if (!master)
		return -EINVAL;
	ret = ec_command(master, EC_IOC_LATE, &i);
	return ret ? ec_api_fail(master, ret, "allow %u delayed cycles per second", per_second) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_set_late_cycles);
