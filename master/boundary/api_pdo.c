// SPDX-License-Identifier: GPL-2.0-only
/* SyncManagers, PDOs and their entries in domains, for the kernel. */
#include "api.h"

#define MARK_END	0xff	/* EC_END in the 8 bit of an index */

int ecrt_slave_config_sync_manager(ec_slave_config_t *sc, uint8_t sync_index,
				   ec_direction_t direction, ec_watchdog_mode_t watchdog_mode)
{
	struct ec_ioc_sc_sync i = { .sm = sync_index };
	int ret;

	if (!sc)
		return -EINVAL;
	i.config = ec_api_config(sc)->index;
	i.dir = min_t(unsigned int, direction, U8_MAX);
	i.watchdog = min_t(unsigned int, watchdog_mode, U8_MAX);
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_SYNC, &i);
	return ret ? ec_api_fail_sc(sc, ret, "set SM%u", sync_index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sync_manager);

static int sc_pdo(ec_slave_config_t *sc, struct ec_ioc_sc_pdo *i)
{
	i->config = ec_api_config(sc)->index;
	return ec_command(ec_api_master(sc), EC_IOC_SC_PDO, i);
}

int ecrt_slave_config_pdo_assign_add(ec_slave_config_t *sc, uint8_t sync_index, uint16_t index)
{
	struct ec_ioc_sc_pdo i = { .op = EC_SC_PDO_ASSIGN_ADD, .sm = sync_index, .pdo = index };
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &i);
	return ret ? ec_api_fail_sc(sc, ret, "assign PDO 0x%04x to SM%u", index, sync_index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_assign_add);

int ecrt_slave_config_pdo_assign_clear(ec_slave_config_t *sc, uint8_t sync_index)
{
	struct ec_ioc_sc_pdo i = { .op = EC_SC_PDO_ASSIGN_CLEAR, .sm = sync_index };
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &i);
	return ret ? ec_api_fail_sc(sc, ret, "clear SM%u", sync_index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_assign_clear);

int ecrt_slave_config_pdo_mapping_add(ec_slave_config_t *sc, uint16_t pdo_index,
				      uint16_t entry_index, uint8_t entry_subindex,
				      uint8_t entry_bit_length)
{
	struct ec_ioc_sc_pdo i = {
		.op = EC_SC_PDO_MAP_ADD, .pdo = pdo_index, .entry_index = entry_index,
		.subindex = entry_subindex, .bits = entry_bit_length,
	};
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &i);
	return ret ? ec_api_fail_sc(sc, ret, "map 0x%04x:%02x to PDO 0x%04x", entry_index,
				    entry_subindex, pdo_index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_mapping_add);

int ecrt_slave_config_pdo_mapping_clear(ec_slave_config_t *sc, uint16_t pdo_index)
{
	struct ec_ioc_sc_pdo i = { .op = EC_SC_PDO_MAP_CLEAR, .pdo = pdo_index };
	int ret;

	if (!sc)
		return -EINVAL;
	ret = sc_pdo(sc, &i);
	return ret ? ec_api_fail_sc(sc, ret, "clear PDO 0x%04x", pdo_index) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_mapping_clear);

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
		ret = ecrt_slave_config_pdo_mapping_add(sc, pdo->index, e->index, e->subindex,
							e->bit_length);
	}
	return ret;
}

static int set_sync(ec_slave_config_t *sc, const ec_sync_info_t *sync)
{
	unsigned int i;
	int ret;

	ret = ecrt_slave_config_sync_manager(sc, sync->index, sync->dir, sync->watchdog_mode);
	if (!ret)
		ret = ecrt_slave_config_pdo_assign_clear(sc, sync->index);
	for (i = 0; !ret && sync->pdos && i < sync->n_pdos; i++)
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
	for (i = 0; !ret && syncs && i < n_syncs && syncs[i].index != MARK_END; i++)
		ret = set_sync(sc, &syncs[i]);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdos);

/* Common end of both ways to register. */
static int reg_entry(ec_slave_config_t *sc, struct ec_ioc_reg_entry *i, ec_domain_t *domain,
		     unsigned int *bit_position)
{
	int ret;

	ec_api_begin(ec_api_master(sc));
	if (domain->session != ec_api_config(sc)->session)
		return ec_api_fail_sc(sc, -EINVAL, "register an entry in another master's domain:");
	i->config = ec_api_config(sc)->index;
	i->domain = domain->index;
	if (!bit_position)
		i->flags |= EC_REG_ENTRY_ALIGNED;
	ret = ec_command(ec_api_master(sc), EC_IOC_REG_ENTRY, i);
	if (ret)
		return ec_api_fail_sc(sc, ret, "register an entry");
	if (bit_position)
		*bit_position = i->bit;
	return i->offset;
}

int ecrt_slave_config_reg_pdo_entry(ec_slave_config_t *sc, uint16_t entry_index,
				    uint8_t entry_subindex, ec_domain_t *domain,
				    unsigned int *bit_position)
{
	struct ec_ioc_reg_entry i = { .entry_index = entry_index, .subindex = entry_subindex };

	return sc && domain ? reg_entry(sc, &i, domain, bit_position) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reg_pdo_entry);

int ecrt_slave_config_reg_pdo_entry_pos(ec_slave_config_t *sc, uint8_t sync_index,
					unsigned int pdo_pos, unsigned int entry_pos,
					ec_domain_t *domain, unsigned int *bit_position)
{
	struct ec_ioc_reg_entry i = {
		.flags = EC_REG_ENTRY_BY_POS, .sm = sync_index, .pdo_pos = pdo_pos,
		.entry_pos = entry_pos,
	};

	return sc && domain ? reg_entry(sc, &i, domain, bit_position) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reg_pdo_entry_pos);
