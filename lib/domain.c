// SPDX-License-Identifier: LGPL-2.1-or-later
/* Domains: registration by list, data, exchange. */

#include "internal.h"

static int reg_entry(struct ec_domain *d, const ec_pdo_entry_reg_t *reg)
{
	ec_slave_config_t *sc;
	int ret;

	if (!reg->offset)
		return ec_fail(-EINVAL,
			       "register 0x%04x:%02x: no place for its offset",
			       reg->index, reg->subindex);
	sc = ecrt_master_slave_config(d->master, reg->alias, reg->position,
				      reg->vendor_id, reg->product_code);
	if (!sc)
		return -ENOENT;
	ret = ecrt_slave_config_reg_pdo_entry(sc, reg->index, reg->subindex, d,
					      reg->bit_position);
	if (ret < 0)
		return ret;
	*reg->offset = (unsigned int)ret;
	return 0;
}

int ecrt_domain_reg_pdo_entry_list(ec_domain_t *domain,
				   const ec_pdo_entry_reg_t *pdo_entry_regs)
{
	const ec_pdo_entry_reg_t *reg;
	int ret;

	if (!domain || !pdo_entry_regs)
		return -EINVAL;
	for (reg = pdo_entry_regs; reg->index; reg++) {
		ret = reg_entry(domain, reg);
		if (ret)
			return ret;
	}
	return 0;
}

size_t ecrt_domain_size(const ec_domain_t *domain)
{
	struct ec_ioc_domain arg = { 0 };
	int ret;

	if (!domain)
		return (size_t)-EINVAL;
	if (domain->master->active)
		return domain->size;
	arg.index = domain->index;
	ret = ec_ioctl(domain->master, EC_IOC_DOMAIN, &arg);
	if (ret)
		return (size_t)ec_fail_ioctl(domain->master, ret,
					     "get size of domain %u",
					     domain->index);
	return arg.size;
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
	if (!(m->received & bit))
		return 0;
	m->received &= ~bit;
	if (m->exchange) {
		ec_cycle_process(domain);
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
	if (domain->master->exchange)
		ec_cycle_queue(domain);
	domain->master->queued |= 1ULL << domain->index;
	return 0;
}

int ecrt_domain_state(const ec_domain_t *domain, ec_domain_state_t *state)
{
	if (!domain || !state)
		return -EINVAL;
	state->working_counter = domain->snap.working_counter;
	state->wc_state = (ec_wc_state_t)domain->snap.wc_state;
	state->redundancy_active = domain->snap.redundancy_active;
	return 0;
}

int ecrt_domain_age(const ec_domain_t *domain, ec_domain_age_t *age)
{
	if (!domain || !age)
		return -EINVAL;
	age->age = domain->snap.age;
	age->limit = domain->max_age;
	age->stale = domain->max_age && domain->snap.age > domain->max_age;
	return 0;
}
