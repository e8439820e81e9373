// SPDX-License-Identifier: LGPL-2.1-or-later
/* How process data are sent: extensions. */

#include "internal.h"

/* the numbers of the options are the kernel's */
_Static_assert((int)EC_DOMAIN_OVERLAP == EC_DOMAIN_OPT_OVERLAP, "options");
_Static_assert((int)EC_DOMAIN_SEPARATE == EC_DOMAIN_OPT_SEPARATE, "options");
_Static_assert((int)EC_DOMAIN_OWN_FRAME == EC_DOMAIN_OPT_OWN_FRAME, "options");

int ecrt_domain_set_options(ec_domain_t *domain, uint32_t options)
{
	struct ec_ioc_domain_options arg = { .options = options };
	int ret;

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	ret = ec_ioctl(domain->master, EC_IOC_DOMAIN_OPTIONS, &arg);
	return ret ? ec_fail_ioctl(domain->master, ret, "set options 0x%x of domain %u",
				   options, domain->index) : 0;
}

int ecrt_domain_set_max_age(ec_domain_t *domain, unsigned int sends)
{
	struct ec_ioc_domain_age arg = { .max_age = sends };
	int ret;

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	ret = ec_ioctl(domain->master, EC_IOC_DOMAIN_AGE, &arg);
	if (ret)
		return ec_fail_ioctl(domain->master, ret, "set the maximum age of domain %u",
				     domain->index);
	domain->max_age = sends;
	return 0;
}

int ecrt_slave_config_overlapping_pdos(ec_slave_config_t *sc, uint8_t allow_overlapping_pdos)
{
	struct ec_ioc_sc_overlap arg = { .overlap = !!allow_overlapping_pdos };
	int ret;

	if (!sc)
		return -EINVAL;
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_OVERLAP, &arg);
	return ret ? ec_fail_ioctl(sc->master, ret, "let process data of slave %u:%u overlap",
				   sc->alias, sc->position) : 0;
}

int ecrt_master_set_late_cycles(ec_master_t *master, uint32_t per_second)
{
	struct ec_ioc_late arg = { .per_s = per_second };
	int ret;

	if (!master)
		return -EINVAL;
	ret = ec_ioctl(master, EC_IOC_LATE, &arg);
	return ret ? ec_fail_ioctl(master, ret, "allow %u delayed cycles per second", per_second) : 0;
}
