// SPDX-License-Identifier: GPL-2.0-only
/* PDOs: assignment, mapping, registration, offsets. */
#include "api.h"

static struct bench b;
static ec_domain_t *d;
static ec_slave_config_t *sc;

static bool begin(void)
{
	ec_slave_info_t info;

	if (!bench_request(&b))
		return false;
	d = CALL(ecrt_master_create_domain)(b.m);
	if (!YES(d != NULL) || CALL(ecrt_master_get_slave)(b.m, MOTOR, &info))
		return false;
	sc = CALL(ecrt_master_slave_config)(b.m, 0, MOTOR, info.vendor_id, info.product_code);
	return YES(sc != NULL);
}

/* offset of an object in the domain, or what came instead */
static int offset(uint16_t index, unsigned int *bit)
{
	return CALL(ecrt_slave_config_reg_pdo_entry)(sc, index, 0, d, bit);
}

static void single_steps(void)
{
	unsigned int bit = 9;

	NEED(begin());
	IS(CALL(ecrt_slave_config_pdo_assign_clear)(sc, 2), 0);
	SAYS(offset(0x6040, &bit), -ENOENT);
	IS(CALL(ecrt_slave_config_pdo_assign_add)(sc, 2, 0x1600), 0);
	/* with the mapping the drive has */
	IS(offset(0x6040, &bit), 0);
	IS(bit, 0);
	bench_down(&b);

	NEED(begin());
	IS(CALL(ecrt_slave_config_pdo_mapping_clear)(sc, 0x1600), 0);
	SAYS(offset(0x6040, &bit), -ENOENT);
	IS(CALL(ecrt_slave_config_pdo_mapping_add)(sc, 0x1600, 0, 0, 3), 0);
	IS(CALL(ecrt_slave_config_pdo_mapping_add)(sc, 0x1600, 0x6060, 0, 8), 0);
	IS(CALL(ecrt_slave_config_pdo_mapping_add)(sc, 0x1600, 0x6040, 0, 16), 0);
	SAYS(CALL(ecrt_slave_config_pdo_mapping_add)(sc, 0x16ff, 0x6040, 0, 16), -ENOENT);
	/* no such PDO to clear: no error */
	IS(CALL(ecrt_slave_config_pdo_mapping_clear)(sc, 0x16ff), 0);
	SAYS(CALL(ecrt_slave_config_pdo_assign_add)(sc, 16, 0x1600), -EINVAL);
	SAYS(CALL(ecrt_slave_config_pdo_assign_clear)(sc, 16), -EINVAL);
	/* 3 + 8 bits before it */
	SAYS(offset(0x6040, NULL), -EFAULT);
	IS(CALL(ecrt_domain_size)(d), 0);
	IS(offset(0x6040, &bit), 1);
	IS(bit, 3);
	/* what was registered does not change any more */
	IS(CALL(ecrt_slave_config_pdo_mapping_add)(sc, 0x1600, 0x60ff, 0, 32), 0);
	SAYS(offset(0x6040, &bit), -EBUSY);
	SAYS(CALL(ecrt_master_activate)(b.m), -EBUSY);
	bench_down(&b);
}

static void bulk(void)
{
	static const ec_pdo_entry_info_t entries[] = { { 0x6040, 0, 16 }, { 0, 0, 16 }, { 0x60ff, 0, 32 } };
	static const ec_pdo_info_t rx = { 0x1600, 3, entries }, empty = { 0x1600, 0, NULL };
	const ec_sync_info_t syncs[] = {
		{ 0, EC_DIR_OUTPUT, 0, NULL, EC_WD_DISABLE },
		{ 1, EC_DIR_INPUT, 0, NULL, EC_WD_DISABLE },
		{ 2, EC_DIR_OUTPUT, 1, &rx, EC_WD_ENABLE },
		{ 3, EC_DIR_INPUT, 0, NULL, EC_WD_DISABLE },
		{ 0xff, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
		{ 99, EC_DIR_INVALID, 0, NULL, EC_WD_DEFAULT },
	};
	const ec_sync_info_t bad[] = {
		{ 3, EC_DIR_INPUT, 0, NULL, EC_WD_DEFAULT }, { 16, EC_DIR_INPUT, 0, NULL, EC_WD_DEFAULT },
	};
	const ec_sync_info_t keep = { 2, EC_DIR_OUTPUT, 1, &empty, EC_WD_DEFAULT };

	NEED(begin());
	SILENT(CALL(ecrt_slave_config_pdos)(sc, EC_END, NULL), 0);
	/* stops at the mark, with the number given or not */
	IS(CALL(ecrt_slave_config_pdos)(sc, EC_END, syncs), 0);
	IS(CALL(ecrt_slave_config_pdos)(sc, 5, syncs), 0);
	IS(CALL(ecrt_slave_config_pdos)(sc, 6, syncs), 0);
	IS(offset(0x60ff, NULL), 4);
	IS(CALL(ecrt_domain_size)(d), 8);
	IS(CALL(ecrt_slave_config_reg_pdo_entry)(sc, 0x6041, 0, d, NULL), -ENOENT);
	bench_down(&b);

	NEED(begin());
	SAYS(CALL(ecrt_slave_config_pdos)(sc, 2, bad), -ENOENT);
	/* the step before has been done */
	IS(offset(0x6041, NULL), -ENOENT);
	/* a PDO that lists no entries keeps the mapping it has */
	IS(CALL(ecrt_slave_config_pdos)(sc, 1, &keep), 0);
	IS(offset(0x6040, NULL), 0);
	bench_down(&b);
}

static void registration(void)
{
	static const ec_pdo_entry_info_t out_map[] = { { 0x6040, 0, 16 }, { 0x60ff, 0, 32 } };
	static const ec_pdo_entry_info_t in_map = { 0x6041, 0, 16 };
	static const ec_pdo_info_t rx = { 0x1600, 2, out_map }, tx = { 0x1a00, 1, &in_map };
	static const ec_sync_info_t syncs[] = {
		{ 2, EC_DIR_OUTPUT, 1, &rx, EC_WD_DEFAULT },
		{ 3, EC_DIR_INPUT, 1, &tx, EC_WD_DEFAULT },
	};
	unsigned int bit = 9, size;
	ec_domain_t *other;
	int out;

	NEED(begin());
	IS(CALL(ecrt_slave_config_pdos)(sc, 2, syncs), 0);
	out = offset(0x6040, NULL);
	IS(out, 0);
	size = (unsigned int)CALL(ecrt_domain_size)(d);
	IS(size, 6);
	/* once more: the same place, nothing grows */
	IS(offset(0x6040, &bit), out);
	IS(bit, 0);
	IS(offset(0x60ff, NULL), 2);
	IS(CALL(ecrt_domain_size)(d), size);
	SAYS(offset(0x5555, &bit), -ENOENT);

	/* the same by position */
	IS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(sc, 2, 0, 1, d, &bit), 2);
	IS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(sc, 2, 0, 1, d, NULL), 2);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(sc, 16, 0, 0, d, &bit), -EINVAL);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(sc, 2, 7, 0, d, &bit), -ENOENT);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry_pos)(sc, 2, 0, 200, d, &bit), -ENOENT);

	/* in another domain, offsets begin again */
	other = CALL(ecrt_master_create_domain)(b.m);
	NEED(other);
	IS(CALL(ecrt_domain_size)(other), 0);
	IS(CALL(ecrt_slave_config_reg_pdo_entry)(sc, 0x6041, 0, other, NULL), 0);
	IS(CALL(ecrt_domain_size)(other), 2);
	YES(!CALL(ecrt_domain_data)(d));
	bench_down(&b);
}

/* no FMMU for a seventeenth domain, or for the ninth of a slave that has eight */
static void fmmus(void)
{
	ec_domain_t *many[17];
	int ret = 0;
	unsigned int i;

	NEED(begin());
	for (i = 0; i < 17 && ret >= 0; i++) {
		many[i] = CALL(ecrt_master_create_domain)(b.m);
		ret = many[i] ? CALL(ecrt_slave_config_reg_pdo_entry)(sc, 0x6040, 0, many[i], NULL) : -1;
	}
	IS(ret, -EOVERFLOW);
	YES(i > 8);
	bench_down(&b);
}

static void list(void)
{
	unsigned int o[4] = { 99, 99, 99, 99 }, bits[4] = { 99, 99, 99, 99 };
	const ec_pdo_entry_reg_t good[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7000, 1, &o[0], &bits[0] },
		{ 0, OUT, BECKHOFF, EL2008, 0x7070, 1, &o[1], &bits[1] },
		{ 0, IN, BECKHOFF, EL1008, 0x6020, 1, &o[2], &bits[2] },
		{ 0, OUT, BECKHOFF, EL2008, 0x7000, 1, &o[3], NULL },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const ec_pdo_entry_reg_t stops[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7010, 1, &o[0], &bits[0] },
		{ 0, NOWHERE, BECKHOFF, EL2008, 0x7000, 1, &o[1], &bits[1] },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const ec_pdo_entry_reg_t wrong[] = {
		{ 0, OUT, BECKHOFF, EL1008, 0x7010, 1, &o[0], &bits[0] },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const ec_pdo_entry_reg_t unaligned[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7010, 1, &o[0], NULL },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};
	const ec_pdo_entry_reg_t nowhere[] = {
		{ 0, OUT, BECKHOFF, EL2008, 0x7000, 1, NULL, NULL },
		{ 0, 0, 0, 0, 0, 0, NULL, NULL },
	};

	NEED(begin());
	IS(CALL(ecrt_domain_reg_pdo_entry_list)(d, good), 0);
	YES(o[0] == 0 && bits[0] == 0 && o[1] == 0 && bits[1] == 7);
	YES(o[2] == 1 && bits[2] == 2 && o[3] == 0);
	/* an absent slave without PDOs: not mapped; what came before stays */
	IS(CALL(ecrt_domain_reg_pdo_entry_list)(d, stops), -ENOENT);
	IS(bits[0], 1);
	IS(CALL(ecrt_domain_size)(d), 2);
	IS(CALL(ecrt_domain_reg_pdo_entry_list)(d, wrong), -ENOENT);
	IS(CALL(ecrt_domain_reg_pdo_entry_list)(d, unaligned), -EFAULT);
	IS(CALL(ecrt_domain_reg_pdo_entry_list)(d, nowhere), -EINVAL);
	/* an empty list */
	SILENT(CALL(ecrt_domain_reg_pdo_entry_list)(d, &good[4]), 0);
	bench_down(&b);
}

/* A slave that is not there: registration needs an explicit mapping, and has it. */
static void absent(void)
{
	static const ec_pdo_entry_info_t entry = { 0x7000, 1, 8 };
	static const ec_pdo_info_t pdo = { 0x1600, 1, &entry };
	static const ec_sync_info_t sync = { 0, EC_DIR_OUTPUT, 1, &pdo, EC_WD_DEFAULT };
	ec_slave_config_state_t s;
	unsigned int bit;

	NEED(begin());
	sc = CALL(ecrt_master_slave_config)(b.m, 0, NOWHERE, BECKHOFF, EL2008);
	NEED(sc);
	SAYS(CALL(ecrt_slave_config_reg_pdo_entry)(sc, 0x7000, 1, d, &bit), -ENOENT);
	IS(CALL(ecrt_slave_config_pdos)(sc, 1, &sync), 0);
	IS(CALL(ecrt_slave_config_reg_pdo_entry)(sc, 0x7000, 1, d, &bit), 0);
	IS(CALL(ecrt_slave_config_state)(sc, &s), 0);
	YES(!s.online && !s.operational && !s.al_state);
	bench_down(&b);
}

const struct api_case pdo_cases[] = {
	{ "assignment and mapping, step by step", single_steps },
	{ "assignment and mapping at once", bulk },
	{ "registration", registration },
	{ "as many domains as FMMUs", fmmus },
	{ "registration of a list", list },
	{ "an absent slave", absent },
	{ NULL, NULL },
};
