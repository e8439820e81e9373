// SPDX-License-Identifier: GPL-2.0-only
/* What else is configured of a slave, for applications in the kernel. */
#include "api.h"

int ecrt_slave_config_watchdog(ec_slave_config_t *sc, uint16_t watchdog_divider,
			       uint16_t watchdog_intervals)
{
	struct ec_ioc_sc_watchdog i = {
		.divider = watchdog_divider, .intervals = watchdog_intervals,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_WATCHDOG, &i);
	return ret ? ec_api_fail_sc(sc, ret, "set the watchdog") : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_watchdog);

int ecrt_slave_config_dc(ec_slave_config_t *sc, uint16_t assign_activate, uint32_t sync0_cycle,
			 int32_t sync0_shift, uint32_t sync1_cycle, int32_t sync1_shift)
{
	struct ec_ioc_sc_dc i = {
		.assign_activate = assign_activate,
		.cycle0 = sync0_cycle, .shift0 = sync0_shift,
		.cycle1 = sync1_cycle, .shift1 = sync1_shift,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_DC, &i);
	return ret ? ec_api_fail_sc(sc, ret, "set the SYNC signals") : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_dc);

static int store_sdo(ec_slave_config_t *sc, struct ec_ioc_sc_sdo *i, const u8 *data, size_t size)
{
	int ret;

	if (!sc || !data)
		return -EINVAL;
	i->config = ec_api_config(sc)->index;
	i->size = min_t(size_t, size, U32_MAX);
	i->data = (uintptr_t)data;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_SDO, i);
	return ret ? ec_api_fail_sc(sc, ret, "store SDO 0x%04x:%02x", i->index, i->subindex) : 0;
}

int ecrt_slave_config_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex,
			  const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_sdo i = { .index = index, .subindex = subindex };

	return store_sdo(sc, &i, data, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo);

int ecrt_slave_config_complete_sdo(ec_slave_config_t *sc, uint16_t index, const uint8_t *data,
				   size_t size)
{
	struct ec_ioc_sc_sdo i = { .flags = EC_SDO_FLAG_COMPLETE, .index = index };

	return store_sdo(sc, &i, data, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_complete_sdo);

int ecrt_slave_config_sdo8(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			   uint8_t value)
{
	return ecrt_slave_config_sdo(sc, sdo_index, sdo_subindex, &value, sizeof(value));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo8);

int ecrt_slave_config_sdo16(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			    uint16_t value)
{
	u8 data[2];

	EC_WRITE_U16(data, value);
	return ecrt_slave_config_sdo(sc, sdo_index, sdo_subindex, data, sizeof(data));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo16);

int ecrt_slave_config_sdo32(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			    uint32_t value)
{
	u8 data[4];

	EC_WRITE_U32(data, value);
	return ecrt_slave_config_sdo(sc, sdo_index, sdo_subindex, data, sizeof(data));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo32);

int ecrt_slave_config_flag(ec_slave_config_t *sc, const char *key, int32_t value)
{
	struct ec_ioc_sc_flag i = { .value = value };
	int ret;

	if (!sc || !key)
		return -EINVAL;
	if (strscpy(i.key, key, sizeof(i.key)) < 0)
		return ec_api_fail_sc(sc, -EINVAL, "set a flag whose name is too long");
	i.config = ec_api_config(sc)->index;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_FLAG, &i);
	return ret ? ec_api_fail_sc(sc, ret, "set flag '%s'", key) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_flag);

int ecrt_slave_config_state_timeout(ec_slave_config_t *sc, ec_al_state_t from_state,
				    ec_al_state_t to_state, unsigned int timeout_ms)
{
	struct ec_ioc_sc_timeout i = { .timeout_ms = timeout_ms };
	int ret;

	if (!sc)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	i.from = min_t(unsigned int, from_state, U8_MAX);
	i.to = min_t(unsigned int, to_state, U8_MAX);
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_TIMEOUT, &i);
	return ret ? ec_api_fail_sc(sc, ret, "set the timeout from state %u to %u", from_state,
				    to_state) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_state_timeout);

/* While active from the status page, which costs no lock. */
int ecrt_slave_config_state(const ec_slave_config_t *sc, ec_slave_config_state_t *state)
{
	struct ec_session *s;
	struct ec_master *m;
	u8 v;

	if (!sc || !state)
		return -EINVAL;
	m = ec_api_master(sc);
	s = smp_load_acquire(&m->api->active);
	if (s) {
		v = READ_ONCE(s->shared->status->configs[ec_api_config(sc)->index]);
	} else {
		mutex_lock(&m->session_lock);
		v = ec_session_config_status(ec_api_config(sc));
		mutex_unlock(&m->session_lock);
	}
	state->online = !!(v & EC_STATUS_SC_ONLINE);
	state->operational = !!(v & EC_STATUS_SC_OP);
	state->al_state = v & EC_STATUS_SC_AL;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_state);
