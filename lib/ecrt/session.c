// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* The configuration of a session and its domains. */
#include "ecrt_int.h"

/* the numbers of the options are those of the command */
_Static_assert((int)EC_DOMAIN_OVERLAP == EC_DOMAIN_OPT_OVERLAP, "options");
_Static_assert((int)EC_DOMAIN_SEPARATE == EC_DOMAIN_OPT_SEPARATE, "options");
_Static_assert((int)EC_DOMAIN_OWN_FRAME == EC_DOMAIN_OPT_OWN_FRAME, "options");

int ecrt_master_select_reference_clock(ec_master_t *master, ec_slave_config_t *sc)
{
	struct ec_ioc_ref_clock arg = { .config = sc ? ec_sc_index(sc) : EC_UAPI_NONE32 };

	if (master && sc && ec_sc_master(sc) != master)
		return ec_fail(master, -EINVAL,
			       "select another master's slave as the reference clock");
	return ec_do(master, EC_IOC_REF_CLOCK, &arg, "select the reference clock");
}
EXPORT_SYMBOL_GPL(ecrt_master_select_reference_clock);

/* Silent on failure. */
int ecrt_master_set_send_interval(ec_master_t *master, size_t send_interval)
{
	struct ec_ioc_interval arg = { .interval_us = ec_u32(send_interval) };

	if (!master || !send_interval)
		return -EINVAL;
	return ec_command(master, EC_IOC_INTERVAL, &arg);
}
EXPORT_SYMBOL_GPL(ecrt_master_set_send_interval);

int ecrt_master_set_late_cycles(ec_master_t *master, uint32_t per_second)
{
	struct ec_ioc_late arg = { .per_s = per_second };

	return ec_do(master, EC_IOC_LATE, &arg, "allow %u delayed cycles per second", per_second);
}
EXPORT_SYMBOL_GPL(ecrt_master_set_late_cycles);

void ecrt_master_deactivate_slaves(ec_master_t *master)
{
	if (ec_active_status(master))
		ec_command(master, EC_IOC_SLAVES_DOWN, NULL);
}
EXPORT_SYMBOL_GPL(ecrt_master_deactivate_slaves);

/* Requests advance without calls of the application, with this setting and without it. */
int ecrt_master_rt_slave_requests(ec_master_t *master, unsigned int rt_slave_requests)
{
	(void)rt_slave_requests;
	return master ? 0 : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_master_rt_slave_requests);

void ecrt_master_exec_slave_requests(ec_master_t *master)
{
	(void)master;
}
EXPORT_SYMBOL_GPL(ecrt_master_exec_slave_requests);

/* hot connect groups --------------------------------------------------------*/

_Static_assert((int)EC_GROUP_ALIAS == EC_GROUP_BY_ALIAS, "groups");
_Static_assert((int)EC_GROUP_ID == EC_GROUP_BY_ID, "groups");
_Static_assert((int)EC_GROUP_PORT == EC_GROUP_BY_PORT, "groups");
_Static_assert(EC_GROUP_MANDATORY == EC_GROUP_FLAG_MANDATORY, "groups");
_Static_assert(EC_GROUP_FAST == EC_GROUP_FLAG_FAST, "groups");

int ecrt_master_group(ec_master_t *master, const ec_group_info_t *info)
{
	struct ec_ioc_group arg = { .at = EC_UAPI_NONE32 };
	int ret;

	if (!master || !info)
		return -EINVAL;
	if (!info->name || strlen(info->name) >= sizeof(arg.name))
		return ec_fail(master, -EINVAL, "create a group without name, or with a long one");
	if (info->at && ec_sc_master(info->at) != master)
		return ec_fail(master, -EINVAL, "create group %s at another master's slave",
			       info->name);
	strcpy(arg.name, info->name);
	arg.flags = info->flags;
	arg.by = info->by;
	arg.value = info->value;
	arg.port = info->port;
	if (info->at)
		arg.at = ec_sc_index(info->at);
	ret = ec_do(master, EC_IOC_GROUP, &arg, "create group %s", info->name);
	return ret ?: (int)arg.index;
}
EXPORT_SYMBOL_GPL(ecrt_master_group);

/* domains ------------------------------------------------------------------*/

int ecrt_domain_set_options(ec_domain_t *domain, uint32_t options)
{
	struct ec_ioc_domain_options arg = { .options = options };

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	return ec_do(ec_domain_master(domain), EC_IOC_DOMAIN_OPTIONS, &arg,
		     "set options 0x%x of domain %u", options, domain->index);
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_options);

int ecrt_domain_set_max_age(ec_domain_t *domain, unsigned int sends)
{
	struct ec_ioc_domain_age arg = { .max_age = sends };
	int ret;

	if (!domain)
		return -EINVAL;
	arg.domain = domain->index;
	ret = ec_do(ec_domain_master(domain), EC_IOC_DOMAIN_AGE, &arg,
		    "set the maximum age of domain %u", domain->index);
	if (!ret)
		domain->max_age = sends;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_max_age);

/* Apart, so that a cycle of the application saves no registers for it. */
static noinline int take_exchanged(ec_domain_t *domain, struct ec_app_cycle *a)
{
	if (a->received >> domain->index & 1)
		ec_exchange_process(domain);
	a->received &= ~(1ULL << domain->index);
	return 0;
}

int ecrt_domain_process(ec_domain_t *domain)
{
	const ec_master_t *m = domain ? ec_domain_master(domain) : NULL;
	const struct ec_status *page = ec_active_status(m);
	const struct ec_status_domain *st;
	struct ec_app_cycle *a;

	if (!page)
		return -EINVAL;
	a = ec_app_cycle(m);
	if (a->exchange)
		return take_exchanged(domain, a);
	/* read now: a frame may be received later than by the first receive after its send */
	st = &page->domains[domain->index];
	domain->snap.working_counter = ec_status_read(st->working_counter);
	domain->snap.wc_state = ec_status_read(st->wc_state);
	domain->snap.redundancy_active = ec_status_read(st->redundancy_active);
	domain->snap.age = ec_status_read(st->age);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_process);

/* Apart, as take_exchanged(). */
static noinline int queue_exchanged(ec_domain_t *domain, struct ec_app_cycle *a)
{
	ec_exchange_queue(domain);
	a->next.queued |= 1ULL << domain->index;
	return 0;
}

int ecrt_domain_queue(ec_domain_t *domain)
{
	const ec_master_t *m = domain ? ec_domain_master(domain) : NULL;
	struct ec_app_cycle *a;

	if (!ec_active_status(m))
		return -EINVAL;
	a = ec_app_cycle(m);
	if (a->exchange)
		return queue_exchanged(domain, a);
	a->next.queued |= 1ULL << domain->index;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_queue);

int ecrt_domain_state(const ec_domain_t *domain, ec_domain_state_t *state)
{
	if (!domain || !state)
		return -EINVAL;
	state->working_counter = domain->snap.working_counter;
	state->wc_state = (ec_wc_state_t)domain->snap.wc_state;
	state->redundancy_active = domain->snap.redundancy_active;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_state);

int ecrt_domain_age(const ec_domain_t *domain, ec_domain_age_t *age)
{
	if (!domain || !age)
		return -EINVAL;
	age->age = domain->snap.age;
	age->limit = domain->max_age;
	age->stale = domain->max_age && domain->snap.age > domain->max_age;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_domain_age);
