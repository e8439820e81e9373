// SPDX-License-Identifier: LGPL-2.1-or-later
/* Slave configurations. */

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "internal.h"

#define MARK_END	0xff	/* EC_END in the 8 bit of an index */

/* Message of a failed call: "Failed to set SM2 of slave 0:3: ..." */
#define fail_sc(sc, err, fmt, ...) \
	ec_fail(err, fmt " of slave %u:%u", ##__VA_ARGS__, \
		(sc)->alias, (sc)->position)
#define fail_sc_ioctl(sc, err, fmt, ...) \
	ec_fail_ioctl((sc)->master, err, fmt " of slave %u:%u", \
		      ##__VA_ARGS__, (sc)->alias, (sc)->position)

int ecrt_slave_config_sync_manager(ec_slave_config_t *sc, uint8_t sync_index,
				   ec_direction_t direction,
				   ec_watchdog_mode_t watchdog_mode)
{
	struct ec_ioc_sc_sync arg = { 0 };
	int ret;

	if (!sc)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return fail_sc(sc, -ENOENT, "set SM%u", sync_index);
	if (direction != EC_DIR_OUTPUT && direction != EC_DIR_INPUT)
		return fail_sc(sc, -EINVAL, "set direction %d for SM%u",
			       (int)direction, sync_index);
	if ((unsigned int)watchdog_mode > EC_WD_DISABLE)
		return fail_sc(sc, -EINVAL, "set watchdog mode %d for SM%u",
			       (int)watchdog_mode, sync_index);
	arg.config = sc->index;
	arg.sm = sync_index;
	arg.dir = (__u8)direction;
	arg.watchdog = (__u8)watchdog_mode;
	ret = ec_ioctl(sc->master, EC_IOC_SC_SYNC, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "set SM%u", sync_index) : 0;
}

int ecrt_slave_config_watchdog(ec_slave_config_t *sc,
			       uint16_t watchdog_divider,
			       uint16_t watchdog_intervals)
{
	struct ec_ioc_sc_watchdog arg = {
		.divider = watchdog_divider,
		.intervals = watchdog_intervals,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_WATCHDOG, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "set watchdog") : 0;
}

static int sc_pdo(ec_slave_config_t *sc, struct ec_ioc_sc_pdo *arg)
{
	arg->config = sc->index;
	return ec_ioctl(sc->master, EC_IOC_SC_PDO, arg);
}

int ecrt_slave_config_pdo_assign_add(ec_slave_config_t *sc, uint8_t sync_index,
				     uint16_t index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_ASSIGN_ADD,
		.sm = sync_index,
		.pdo = index,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return fail_sc(sc, -EINVAL, "assign PDO 0x%04x to SM%u", index,
			       sync_index);
	ret = sc_pdo(sc, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "assign PDO 0x%04x to SM%u", index,
				   sync_index) : 0;
}

int ecrt_slave_config_pdo_assign_clear(ec_slave_config_t *sc,
				       uint8_t sync_index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_ASSIGN_CLEAR,
		.sm = sync_index,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return fail_sc(sc, -EINVAL, "clear SM%u", sync_index);
	ret = sc_pdo(sc, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "clear SM%u", sync_index) : 0;
}

int ecrt_slave_config_pdo_mapping_add(ec_slave_config_t *sc,
				      uint16_t pdo_index, uint16_t entry_index,
				      uint8_t entry_subindex,
				      uint8_t entry_bit_length)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_MAP_ADD,
		.pdo = pdo_index,
		.entry_index = entry_index,
		.subindex = entry_subindex,
		.bits = entry_bit_length,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "map 0x%04x:%02x to PDO 0x%04x",
				   entry_index, entry_subindex, pdo_index) : 0;
}

int ecrt_slave_config_pdo_mapping_clear(ec_slave_config_t *sc,
					uint16_t pdo_index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_MAP_CLEAR,
		.pdo = pdo_index,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "clear PDO 0x%04x", pdo_index) : 0;
}

/* A PDO that lists no entries keeps what the slave maps by default. */
static int set_pdo(ec_slave_config_t *sc, uint8_t sm, const ec_pdo_info_t *pdo)
{
	const ec_pdo_entry_info_t *e;
	unsigned int i;
	int ret;

	ret = ecrt_slave_config_pdo_assign_add(sc, sm, pdo->index);
	if (ret || !pdo->n_entries || !pdo->entries)
		return ret;
	ret = ecrt_slave_config_pdo_mapping_clear(sc, pdo->index);
	for (i = 0; !ret && i < pdo->n_entries; i++) {
		e = &pdo->entries[i];
		ret = ecrt_slave_config_pdo_mapping_add(sc, pdo->index,
							e->index, e->subindex,
							e->bit_length);
	}
	return ret;
}

static int set_sync(ec_slave_config_t *sc, const ec_sync_info_t *sync)
{
	unsigned int i;
	int ret;

	ret = ecrt_slave_config_sync_manager(sc, sync->index, sync->dir,
					     sync->watchdog_mode);
	if (!ret)
		ret = ecrt_slave_config_pdo_assign_clear(sc, sync->index);
	if (!sync->pdos)
		return ret;
	for (i = 0; !ret && i < sync->n_pdos; i++)
		ret = set_pdo(sc, sync->index, &sync->pdos[i]);
	return ret;
}

int ecrt_slave_config_pdos(ec_slave_config_t *sc, unsigned int n_syncs,
			   const ec_sync_info_t syncs[])
{
	unsigned int i;
	int ret = 0;

	if (!sc)
		return -EINVAL;
	if (!syncs)
		return 0;
	for (i = 0; !ret && i < n_syncs && syncs[i].index != MARK_END; i++)
		ret = set_sync(sc, &syncs[i]);
	return ret;
}

/* Common end of both ways to register; @name is for messages. */
static int reg_entry(ec_slave_config_t *sc, struct ec_ioc_reg_entry *arg,
		     ec_domain_t *domain, unsigned int *bit_position,
		     const char *name)
{
	int ret;

	if (ec_memory_frozen(sc->master, "register an entry"))
		return -EBUSY;
	if (!domain)
		return fail_sc(sc, -EINVAL, "register %s without domain", name);
	if (domain->master != sc->master)
		return fail_sc(sc, -EINVAL,
			       "register %s in another master's domain", name);
	arg->config = sc->index;
	arg->domain = domain->index;
	if (!bit_position)
		arg->flags |= EC_REG_ENTRY_ALIGNED;
	ret = ec_ioctl(sc->master, EC_IOC_REG_ENTRY, arg);
	if (ret)
		return fail_sc_ioctl(sc, ret, "register %s", name);
	if (arg->offset > INT_MAX)
		return fail_sc(sc, -EOVERFLOW, "register %s", name);
	if (bit_position)
		*bit_position = arg->bit;
	return (int)arg->offset;
}

int ecrt_slave_config_reg_pdo_entry(ec_slave_config_t *sc,
				    uint16_t entry_index,
				    uint8_t entry_subindex,
				    ec_domain_t *domain,
				    unsigned int *bit_position)
{
	struct ec_ioc_reg_entry arg = {
		.entry_index = entry_index,
		.subindex = entry_subindex,
	};
	char name[32];

	if (!sc)
		return -EINVAL;
	snprintf(name, sizeof(name), "0x%04x:%02x", entry_index,
		 entry_subindex);
	return reg_entry(sc, &arg, domain, bit_position, name);
}

int ecrt_slave_config_reg_pdo_entry_pos(ec_slave_config_t *sc,
					uint8_t sync_index,
					unsigned int pdo_pos,
					unsigned int entry_pos,
					ec_domain_t *domain,
					unsigned int *bit_position)
{
	struct ec_ioc_reg_entry arg = {
		.flags = EC_REG_ENTRY_BY_POS,
		.sm = sync_index,
		.pdo_pos = pdo_pos,
		.entry_pos = entry_pos,
	};
	char name[64];

	if (!sc)
		return -EINVAL;
	snprintf(name, sizeof(name), "SM%u PDO %u entry %u", sync_index,
		 pdo_pos, entry_pos);
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return fail_sc(sc, -EINVAL, "register %s", name);
	return reg_entry(sc, &arg, domain, bit_position, name);
}

static int add_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex,
		   uint32_t flags, const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_sdo arg = {
		.flags = flags,
		.index = index,
		.subindex = subindex,
		.size = (__u32)size,
		.data = (uintptr_t)data,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	if (!data || !size || size > UINT32_MAX)
		return fail_sc(sc, -EINVAL, "store SDO 0x%04x:%02x", index,
			       subindex);
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_SDO, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "store SDO 0x%04x:%02x", index,
				   subindex) : 0;
}

int ecrt_slave_config_sdo(ec_slave_config_t *sc, uint16_t index,
			  uint8_t subindex, const uint8_t *data, size_t size)
{
	return add_sdo(sc, index, subindex, 0, data, size);
}

int ecrt_slave_config_complete_sdo(ec_slave_config_t *sc, uint16_t index,
				   const uint8_t *data, size_t size)
{
	return add_sdo(sc, index, 0, EC_SDO_FLAG_COMPLETE, data, size);
}

int ecrt_slave_config_sdo8(ec_slave_config_t *sc, uint16_t sdo_index,
			   uint8_t sdo_subindex, uint8_t value)
{
	return add_sdo(sc, sdo_index, sdo_subindex, 0, &value, sizeof(value));
}

int ecrt_slave_config_sdo16(ec_slave_config_t *sc, uint16_t sdo_index,
			    uint8_t sdo_subindex, uint16_t value)
{
	uint8_t data[2];

	EC_WRITE_U16(data, value);
	return add_sdo(sc, sdo_index, sdo_subindex, 0, data, sizeof(data));
}

int ecrt_slave_config_sdo32(ec_slave_config_t *sc, uint16_t sdo_index,
			    uint8_t sdo_subindex, uint32_t value)
{
	uint8_t data[4];

	EC_WRITE_U32(data, value);
	return add_sdo(sc, sdo_index, sdo_subindex, 0, data, sizeof(data));
}

static void state_from_page(ec_slave_config_state_t *state, __u8 byte)
{
	state->online = !!(byte & EC_STATUS_SC_ONLINE);
	state->operational = !!(byte & EC_STATUS_SC_OP);
	state->al_state = byte & EC_STATUS_SC_AL;
}

int ecrt_slave_config_state(const ec_slave_config_t *sc,
			    ec_slave_config_state_t *state)
{
	struct ec_ioc_config arg = { 0 };
	const struct ec_master *m;
	int ret;

	if (!sc || !state)
		return -EINVAL;
	m = sc->master;
	if (m->active && sc->index < EC_STATUS_CONFIGS &&
	    offsetof(struct ec_status, configs) + sc->index < m->status_size) {
		state_from_page(state,
				ec_status_read(m->status->configs[sc->index]));
		return 0;
	}
	arg.index = sc->index;
	ret = ec_ioctl(m, EC_IOC_CONFIG, &arg);
	if (ret)
		return ret;
	state_from_page(state, (__u8)arg.state);
	return 0;
}

int ecrt_slave_config_flag(ec_slave_config_t *sc, const char *key,
			   int32_t value)
{
	struct ec_ioc_sc_flag arg = { .value = value };
	int ret;

	if (!sc)
		return -EINVAL;
	if (!key)
		return fail_sc(sc, -EINVAL, "set a flag without name");
	if (!*key || strlen(key) >= sizeof(arg.key))
		return fail_sc(sc, -EINVAL, "set flag '%.64s'", key);
	memcpy(arg.key, key, strlen(key));
	arg.config = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_SC_FLAG, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "set flag '%s'", key) : 0;
}

static bool is_al_state(ec_al_state_t state)
{
	return state == EC_AL_STATE_INIT || state == EC_AL_STATE_PREOP ||
	       state == EC_AL_STATE_SAFEOP || state == EC_AL_STATE_OP;
}

int ecrt_slave_config_state_timeout(ec_slave_config_t *sc,
				    ec_al_state_t from_state,
				    ec_al_state_t to_state,
				    unsigned int timeout_ms)
{
	struct ec_ioc_sc_timeout arg = { .timeout_ms = timeout_ms };
	int ret = -EINVAL;

	if (!sc)
		return -EINVAL;
	if (!is_al_state(from_state) || !is_al_state(to_state))
		return fail_sc(sc, ret, "set timeout from state %d to %d",
			       (int)from_state, (int)to_state);
	arg.config = sc->index;
	arg.from = (__u8)from_state;
	arg.to = (__u8)to_state;
	ret = ec_ioctl(sc->master, EC_IOC_SC_TIMEOUT, &arg);
	return ret ? fail_sc_ioctl(sc, ret, "set timeout from state %d to %d",
				   (int)from_state, (int)to_state) : 0;
}
