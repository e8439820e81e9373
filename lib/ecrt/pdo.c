// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* SyncManagers, PDOs and their entries in domains. */
#include "ecrt_int.h"

#define MARK_END	0xff	/* EC_END in the 8 bit of an index */

int ecrt_slave_config_sync_manager(ec_slave_config_t *sc, uint8_t sync_index,
				   ec_direction_t direction, ec_watchdog_mode_t watchdog_mode)
{
	struct ec_ioc_sc_sync arg = {
		.config = ec_sc_index(sc), .sm = sync_index, .dir = (__u8)direction,
		.watchdog = (__u8)watchdog_mode,
	};

	if (!sc)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return ec_fail_sc(sc, -ENOENT, "set SM%u", sync_index);
	if (direction != EC_DIR_OUTPUT && direction != EC_DIR_INPUT)
		return ec_fail_sc(sc, -EINVAL, "set direction %d for SM%u", (int)direction,
				  sync_index);
	if ((unsigned int)watchdog_mode > EC_WD_DISABLE)
		return ec_fail_sc(sc, -EINVAL, "set watchdog mode %d for SM%u",
				  (int)watchdog_mode, sync_index);
	return ec_do_sc(sc, EC_IOC_SC_SYNC, &arg, "set SM%u", sync_index);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sync_manager);

int ecrt_slave_config_pdo_assign_add(ec_slave_config_t *sc, uint8_t sync_index, uint16_t index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_ASSIGN_ADD, .config = ec_sc_index(sc), .sm = sync_index,
		.pdo = index,
	};

	return ec_do_valid(sc, sync_index < EC_MAX_SYNC_MANAGERS, EC_IOC_SC_PDO, &arg,
			   "assign PDO 0x%04x to SM%u", index, sync_index);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_assign_add);

int ecrt_slave_config_pdo_assign_clear(ec_slave_config_t *sc, uint8_t sync_index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_ASSIGN_CLEAR, .config = ec_sc_index(sc), .sm = sync_index,
	};

	return ec_do_valid(sc, sync_index < EC_MAX_SYNC_MANAGERS, EC_IOC_SC_PDO, &arg,
			   "clear SM%u", sync_index);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_assign_clear);

int ecrt_slave_config_pdo_mapping_add(ec_slave_config_t *sc, uint16_t pdo_index,
				      uint16_t entry_index, uint8_t entry_subindex,
				      uint8_t entry_bit_length)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_MAP_ADD, .config = ec_sc_index(sc), .pdo = pdo_index,
		.entry_index = entry_index, .subindex = entry_subindex, .bits = entry_bit_length,
	};

	return ec_do_sc(sc, EC_IOC_SC_PDO, &arg, "map 0x%04x:%02x to PDO 0x%04x", entry_index,
			entry_subindex, pdo_index);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_pdo_mapping_add);

int ecrt_slave_config_pdo_mapping_clear(ec_slave_config_t *sc, uint16_t pdo_index)
{
	struct ec_ioc_sc_pdo arg = {
		.op = EC_SC_PDO_MAP_CLEAR, .config = ec_sc_index(sc), .pdo = pdo_index,
	};

	return ec_do_sc(sc, EC_IOC_SC_PDO, &arg, "clear PDO 0x%04x", pdo_index);
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

/* Common end of both ways to register; @name is for messages. */
static int reg_entry(ec_slave_config_t *sc, struct ec_ioc_reg_entry *arg, ec_domain_t *domain,
		     unsigned int *bit_position, const char *name)
{
	int ret = ec_memory_frozen(ec_sc_master(sc), "register an entry");

	if (ret)
		return ret;
	if (!domain)
		return ec_fail_sc(sc, -EINVAL, "register %s without domain", name);
	if (ec_domain_master(domain) != ec_sc_master(sc))
		return ec_fail_sc(sc, -EINVAL, "register %s in another master's domain", name);
	arg->config = ec_sc_index(sc);
	arg->domain = domain->index;
	if (!bit_position)
		arg->flags |= EC_REG_ENTRY_ALIGNED;
	ret = ec_do_sc(sc, EC_IOC_REG_ENTRY, arg, "register %s", name);
	if (ret)
		return ret;
	if (bit_position)
		*bit_position = arg->bit;
	return (int)arg->offset;
}

int ecrt_slave_config_reg_pdo_entry(ec_slave_config_t *sc, uint16_t entry_index,
				    uint8_t entry_subindex, ec_domain_t *domain,
				    unsigned int *bit_position)
{
	struct ec_ioc_reg_entry arg = { .entry_index = entry_index, .subindex = entry_subindex };
	char name[32];

	if (!sc)
		return -EINVAL;
	snprintf(name, sizeof(name), "0x%04x:%02x", entry_index, entry_subindex);
	return reg_entry(sc, &arg, domain, bit_position, name);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reg_pdo_entry);

int ecrt_slave_config_reg_pdo_entry_pos(ec_slave_config_t *sc, uint8_t sync_index,
					unsigned int pdo_pos, unsigned int entry_pos,
					ec_domain_t *domain, unsigned int *bit_position)
{
	struct ec_ioc_reg_entry arg = {
		.flags = EC_REG_ENTRY_BY_POS, .sm = sync_index, .pdo_pos = pdo_pos,
		.entry_pos = entry_pos,
	};
	char name[64];

	if (!sc)
		return -EINVAL;
	snprintf(name, sizeof(name), "SM%u PDO %u entry %u", sync_index, pdo_pos, entry_pos);
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return ec_fail_sc(sc, -EINVAL, "register %s", name);
	return reg_entry(sc, &arg, domain, bit_position, name);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reg_pdo_entry_pos);

static int reg_list_entry(ec_domain_t *d, const ec_pdo_entry_reg_t *reg)
{
	ec_slave_config_t *sc;
	int ret;

	if (!reg->offset)
		return ec_fail(ec_domain_master(d), -EINVAL,
			       "register 0x%04x:%02x: no place for its offset", reg->index,
			       reg->subindex);
	sc = ecrt_master_slave_config(ec_domain_master(d), reg->alias, reg->position,
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
	int ret = 0;

	if (!domain || !pdo_entry_regs)
		return -EINVAL;
	for (reg = pdo_entry_regs; !ret && reg->index; reg++)
		ret = reg_list_entry(domain, reg);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_domain_reg_pdo_entry_list);
