// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Sync units: domains that fail together, alone. */
#include "ecrt_int.h"

/* the numbers are the kernel's */
_Static_assert((int)EC_UNIT_STOP == EC_UNIT_POLICY_STOP, "policy");
_Static_assert(EC_UNIT_AUTHORITY == EC_UNIT_FLAG_AUTHORITY, "flags");
_Static_assert(EC_UNIT_LEASE_HOLD == EC_UNIT_FLAG_LEASE_HOLD, "flags");
_Static_assert(EC_UNIT_OFFERED == EC_UNIT_FLAG_OFFERED, "flags");
_Static_assert((int)EC_UNIT_FAILED == EC_UNIT_RUN_FAILED, "state");
_Static_assert((int)EC_UNIT_SENDS_HELD_VALUES == EC_UNIT_SENDS_HELD, "state");

int ecrt_master_unit(ec_master_t *master, const ec_unit_config_t *config)
{
	struct ec_ioc_unit arg = { 0 };
	int ret;

	if (!master || !config)
		return -EINVAL;
	if (!config->name || strlen(config->name) >= sizeof(arg.name))
		return ec_fail(master, -EINVAL, "create a unit without name, or with a long one");
	strcpy(arg.name, config->name);
	arg.flags = config->flags;
	arg.policy = (__u32)config->policy;
	arg.limit = config->limit;
	arg.lease_cycles = config->lease_cycles;
	arg.repeats = config->repeats;
	ret = ec_do(master, EC_IOC_UNIT, &arg, "create unit %s", config->name);
	return ret ?: (int)arg.index;
}
EXPORT_SYMBOL_GPL(ecrt_master_unit);

int ecrt_domain_set_unit(ec_domain_t *domain, int unit)
{
	struct ec_ioc_domain_unit arg = { .unit = (__u32)unit };

	if (!domain || unit < -1)
		return -EINVAL;
	arg.domain = domain->index;
	return ec_do(ec_domain_master(domain), EC_IOC_DOMAIN_UNIT, &arg,
		     "put domain %u into unit %d", domain->index, unit);
}
EXPORT_SYMBOL_GPL(ecrt_domain_set_unit);

int ecrt_master_unit_authority(ec_master_t *master, unsigned int unit, int give)
{
	struct ec_ioc_unit_authority arg = { .unit = unit, .authority = !!give };
	int ret = ec_give(master, EC_IOC_UNIT_AUTHORITY, &arg);

	/* it is called until it succeeds */
	if (ret == -EINPROGRESS)
		return ret;
	return ec_complain(master, NULL, ret, true, "%s authority %s unit %u",
			   give ? "give" : "take", give ? "to" : "from", unit);
}
EXPORT_SYMBOL_GPL(ecrt_master_unit_authority);

static void convert(__u32 word, ec_unit_state_t *state)
{
	*state = (ec_unit_state_t){
		.run = (ec_unit_run_t)(word & 0xf),
		.outputs = (ec_unit_outputs_t)(word >> 4 & 0xf),
		.authority = !!(word & EC_UNIT_HAS_AUTHORITY),
		.lease_ended = !!(word & EC_UNIT_LEASE_ENDED),
		.down = !!(word & EC_UNIT_DOWN),
		.held = !!(word & EC_UNIT_HAS_HOLDER),
		.faults = word >> 16,
	};
}

int ecrt_master_unit_state(const ec_master_t *master, unsigned int unit, ec_unit_state_t *state)
{
	const struct ec_status *page = ec_active_status(master);
	__u32 word;

	if (!page || !state || unit >= EC_STATUS_DOMAINS || !ec_status_has_units(master))
		return -EINVAL;
	word = ec_status_read(page->units[unit]);
	if (!word)
		return -EINVAL;
	convert(word, state);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_unit_state);

int ecrt_master_unit_hold(ec_master_t *master, const char *name, size_t *size)
{
	struct ec_ioc_unit_hold arg = { 0 };
	int ret;

	if (!master)
		return -EINVAL;
	if (!name || strlen(name) >= sizeof(arg.name))
		return ec_fail(master, -EINVAL, "hold a unit without name, or with a long one");
	strcpy(arg.name, name);
	ret = ec_do(master, EC_IOC_UNIT_HOLD, &arg, "hold unit %s", name);
	if (!ret && size)
		*size = arg.size;
	return ret ?: (int)arg.index;
}
EXPORT_SYMBOL_GPL(ecrt_master_unit_hold);

static int exchange(ec_master_t *master, unsigned int cmd, unsigned int unit, const uint8_t *data,
		    size_t size, ec_unit_state_t *state)
{
	struct ec_ioc_unit_data arg = {
		.unit = unit, .size = ec_u32(size), .data = (uintptr_t)data,
	};
	int ret;

	if (!master || !data)
		return -EINVAL;
	ret = ec_do(master, cmd, &arg, "exchange data of unit %u", unit);
	if (!ret && state)
		convert(arg.state, state);
	return ret;
}

int ecrt_master_unit_write(ec_master_t *master, unsigned int unit, const uint8_t *data,
			   size_t size, ec_unit_state_t *state)
{
	return exchange(master, EC_IOC_UNIT_WRITE, unit, data, size, state);
}
EXPORT_SYMBOL_GPL(ecrt_master_unit_write);

int ecrt_master_unit_read(ec_master_t *master, unsigned int unit, uint8_t *data, size_t size,
			  ec_unit_state_t *state)
{
	return exchange(master, EC_IOC_UNIT_READ, unit, data, size, state);
}
EXPORT_SYMBOL_GPL(ecrt_master_unit_read);
