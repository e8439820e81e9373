// SPDX-License-Identifier: GPL-2.0-only
/* Fake master: what an application has configured, and its cycle. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fake.h"

static const struct ec_ioc_config configs[] = {
	{ .alias = 1001, .vendor_id = 2, .product_code = 0x07d83052, .slave_position = 1,
	  .al_status = 2 },
	{ .position = 2, .vendor_id = 2, .product_code = 0x1c213052, .slave_position = -1,
	  .sdo_count = 2, .flag_count = 2, .dc_assign_activate = 0x0300, .dc_cycle = { 1000000, 0 },
	  .dc_shift = { -500, 0 }, .watchdog_divider = 2498 },
};

static const struct ec_ioc_domain domains[] = {
	{ .index = 0, .size = 1, .logical = 0, .working_counter = 1, .expected = 1,
	  .wc_state = EC_STATUS_WC_COMPLETE,
	  .fmmu_count = 1, .datagram_count = 1, .datagram_bytes = 13, .age = 1, .max_age = 2 },
	{ .index = 1, .size = 6, .logical = 1, .working_counter = 3, .expected = 3,
	  .wc_state = EC_STATUS_WC_COMPLETE,
	  .fmmu_count = 1, .options = EC_DOMAIN_OPT_OVERLAP | EC_DOMAIN_OPT_OWN_FRAME,
	  .datagram_count = 2, .datagram_bytes = 30, .age = 3, .max_age = 2 },
};

static const struct ec_ioc_unit_info units[] = {
	{ .index = 0, .policy = EC_UNIT_POLICY_ZERO, .limit = 3, .repeats = 1, .domains = 1,
	  .active = 1, .state = EC_UNIT_RUN_COMPLETE | EC_UNIT_HAS_AUTHORITY, .name = "tool" },
	{ .index = 1, .flags = EC_UNIT_FLAG_AUTHORITY | EC_UNIT_FLAG_LEASE_HOLD, .limit = 10,
	  .policy = EC_UNIT_POLICY_SAFEOP, .lease_cycles = 50, .repeats = 2, .domains = 2,
	  .active = 1, .state = EC_UNIT_RUN_FAILED | EC_UNIT_SENDS_ZERO << 4 | EC_UNIT_DOWN |
	  EC_UNIT_LEASE_ENDED | 2 << 16, .name = "axes" },
};

const unsigned int fake_configs = LEN(configs), fake_domains = LEN(domains);

static const __u8 images[2][6] = { { 0xa5 }, { 1, 2, 3, 4, 5, 0xff } };

static int config_sdo(struct ec_ioc_config_sdo *x)
{
	__u8 *data = (__u8 *)(uintptr_t)x->data;
	bool big = x->sdo_pos;

	x->flags = big ? EC_SDO_FLAG_COMPLETE : 0;
	x->sdo_index = 0x8010;
	x->subindex = big ? 0 : 3;
	for (__u32 i = 0; i < (big ? 20u : 2u) && i < x->size; i++)
		data[i] = (__u8)(i + 1);
	x->size = big ? 20 : 2;
	return 0;
}

/* configuration 1 has two, the first one longer than what is shown of others */
static int config_idn(struct ec_ioc_config_idn *x)
{
	__u8 *data = (__u8 *)(uintptr_t)x->data;

	if (getenv("FAKE_NO_IDN"))
		return fake_fail(ENOTTY, "");
	if (x->index != 1 || x->idn_pos > 1)
		return fake_fail(ENOENT, "configuration has 2 startup IDNs");
	x->idn = x->idn_pos ? 0x8096 : 15;
	x->drive = (__u8)x->idn_pos;
	x->state = x->idn_pos ? 4 : 2;
	x->size = 2;
	data[0] = 7;
	data[1] = (__u8)x->idn_pos;
	return 0;
}

/* configuration 1: an SDO, one that is not replayed, an IDN, a register */
static int config_write(struct ec_ioc_config_write *x)
{
	static const struct ec_ioc_config_write writes[] = {
		{ .object = 0x8000, .subindex = 2, .size = 2, .forgotten = 3 },
		{ .object = 0x6040, .size = 2, .why = 4, .forgotten = 3 },
		{ .object = 0x2000, .flags = EC_SDO_FLAG_COMPLETE, .why = 200, .forgotten = 3 },
		{ .object = 91, .subindex = 1, .kind = EC_WRITE_KIND_IDN, .size = 4,
		  .forgotten = 3 },
		{ .object = 0x0420, .kind = EC_WRITE_KIND_REG, .size = 2, .forgotten = 3 },
	};
	__u8 *data = (__u8 *)(uintptr_t)x->data;
	__u64 address = x->data;
	__u32 room = x->size;

	if (getenv("FAKE_NO_WRITE"))
		return fake_fail(ENOTTY, "");
	if (x->index != 1 || x->write_pos >= LEN(writes))
		return fake_fail(ENOENT, "configuration has 5 recorded writes");
	*x = writes[x->write_pos];
	x->data = address;
	for (__u32 i = 0; i < x->size && i < room; i++)
		data[i] = (__u8)(i + 1);
	return 0;
}

/* configuration 1: what writes, what checks, what does both, and one longer than is shown */
static int config_command(struct ec_ioc_config_command *x)
{
	static const struct ec_ioc_config_command commands[] = {
		{ .object = 0x0f80, .kind = EC_WRITE_KIND_REG, .from = 1, .to = 2,
		  .flags = EC_COMMAND_FLAG_WRITE, .size = 2 },
		{ .object = 0x8000, .subindex = 3, .kind = EC_WRITE_KIND_SDO, .from = 2, .to = 4,
		  .flags = EC_COMMAND_FLAG_WRITE | EC_COMMAND_FLAG_CHECK, .size = 12,
		  .timeout_ms = 250 },
		{ .object = 91, .subindex = 1, .kind = EC_WRITE_KIND_IDN, .from = 4, .to = 8,
		  .flags = EC_COMMAND_FLAG_CHECK, .size = 8 },
		{ .object = 0x2000, .kind = EC_WRITE_KIND_SDO, .from = 8, .to = 4,
		  .flags = EC_COMMAND_FLAG_WRITE | EC_COMMAND_FLAG_COMPLETE, .size = 1040 },
		{ .object = 0x0f81, .kind = 9, .from = 3, .to = 1,
		  .flags = EC_COMMAND_FLAG_WRITE, .size = 1 },
	};
	__u8 *data = (__u8 *)(uintptr_t)x->data;
	__u64 address = x->data;
	__u32 room = x->size;

	if (getenv("FAKE_NO_COMMAND"))
		return fake_fail(ENOTTY, "");
	if (x->index != 1 || x->command_pos >= LEN(commands))
		return fake_fail(ENOENT, "configuration has 5 commands");
	*x = commands[x->command_pos];
	x->data = address;
	for (__u32 i = 0; i < x->size && i < room; i++)
		data[i] = (__u8)(i + 1);
	return 0;
}

static int config_flag(struct ec_ioc_config_flag *x)
{
	static const char *const key[] = { "AssignToPdi", "WaitBeforeSAFEOPms" };

	if (x->flag_pos >= LEN(key))
		return fake_fail(ENOENT, "there is no such flag");
	snprintf(x->key, sizeof(x->key), "%s", key[x->flag_pos]);
	x->value = x->flag_pos ? -1 : 1;
	return 0;
}

/* FAKE_PDOS: of SM2 of the second configuration */
static int config_sm(struct ec_ioc_config_sm *x)
{
	const char *pdos = getenv("FAKE_PDOS");

	if (x->sm == 2 && x->index == 1) {
		x->dir = getenv("FAKE_SM_DIR") ? 2 : 1;
		x->pdo_count = pdos ? (__u8)atoi(pdos) : 1;
	}
	return 0;
}

static int domain_data(struct ec_ioc_domain_data *x)
{
	if (x->index >= LEN(domains))
		return fake_fail(EINVAL, "there is no such domain");
	if (x->size > domains[x->index].size)
		x->size = domains[x->index].size;
	memcpy((void *)(uintptr_t)x->data, images[x->index], x->size);
	return 0;
}

static int domain_fmmu(struct ec_ioc_domain_fmmu *x)
{
	bool second = x->index == 1;

	x->alias = second ? 0 : 1001;
	x->position = second ? 2 : 0;
	x->sm = second ? 3 : 0;
	x->dir = second ? 2 : 1;
	x->logical = domains[x->index].logical;
	x->size = domains[x->index].size;
	return 0;
}

/* 10000 sends: 9900 about 1 us, 95 about 5 us, 5 about 100 us from schedule */
static int cycle_stats(struct ec_ioc_cycle_stats *x)
{
	struct ec_status_cycle st = {
		.late_sum = 10875000, .late_count = 10000, .late_min = 960, .late_max = 101234,
	};

	if (!fake_bus("app") && !fake_bus("kcycle")) {
		x->size = 0;
		return 0;
	}
	x->kind = fake_bus("app") ? EC_CYCLE_BY_APP : EC_CYCLE_BY_KERNEL;
	x->active = 1;
	x->interval_set = fake_bus("kcycle");
	x->interval_ns = fake_bus("app") ? 1000123 : 250000;
	x->cpu = -1;
	st.late[63] = 4900;
	st.late[64] = 5000;
	st.late[81] = 95;
	st.late[116] = 5;
	if (fake_bus("kcycle")) {
		st.state = EC_CYCLE_STATE_STALLED;
		st.overruns = 2;
		st.work_sum = 42000000;
		st.work_count = 10000;
		st.work_max = 9876;
		st.missed = 3;
		x->cpu = 2;
		x->cpu_losses = 1;
		x->place = EC_CYCLE_PLACE_RIGHT;
		x->priority = 40;
		x->priority_wanted = 80;
	}
	memcpy((void *)(uintptr_t)x->data, &st, sizeof(st));
	return 0;
}

static int config(struct ec_ioc_config *c)
{
	__u32 i = c->index;

	*c = configs[i];
	c->index = i;
	return 0;
}

static int config_entry(struct ec_ioc_config_entry *x)
{
	x->entry_index = 0x7010;
	x->subindex = 1;
	x->bits = 16;
	return 0;
}

static int config_pdo(struct ec_ioc_config_pdo *x)
{
	x->pdo_index = (__u16)(0x1600 + x->pdo_pos);
	x->entry_count = 1;
	return 0;
}

static int config_why(struct ec_ioc_config_why *x)
{
	if (x->index == 1)
		strcpy(x->text, fake_bus("evil") ? "\033[2J" :
		       "no slave at ring position 2: 2 slave(s) connected");
	return 0;
}

int fake_app(unsigned long request, void *arg)
{
	switch (request) {
	case EC_IOC_CONFIG:
		return config(arg);
	case EC_IOC_CONFIG_SM:
		return config_sm(arg);
	case EC_IOC_CONFIG_PDO:
		return config_pdo(arg);
	case EC_IOC_CONFIG_ENTRY:
		return config_entry(arg);
	case EC_IOC_CONFIG_SDO:
		return config_sdo(arg);
	case EC_IOC_CONFIG_IDN:
		return config_idn(arg);
	case EC_IOC_CONFIG_FLAG:
		return config_flag(arg);
	case EC_IOC_CONFIG_WRITE:
		return config_write(arg);
	case EC_IOC_CONFIG_COMMAND:
		return config_command(arg);
	case EC_IOC_CONFIG_WHY:
		return config_why(arg);
	case EC_IOC_CONFIG_IP:
		if (((struct ec_ioc_sc_ip *)arg)->config == 1)
			((struct ec_ioc_sc_ip *)arg)->params = fake_net;
		return 0;
	case EC_IOC_CYCLE_STATS:
		return cycle_stats(arg);
	case EC_IOC_CYCLE_RESET:
		fake_record("cycle reset\n");
		return 0;
	case EC_IOC_DOMAIN:
		*(struct ec_ioc_domain *)arg = domains[((struct ec_ioc_domain *)arg)->index];
		return 0;
	case EC_IOC_UNIT_INFO:
		if (fake_why_unit(arg))
			return 0;
		if (!getenv("FAKE_UNITS") || ((struct ec_ioc_unit_info *)arg)->index >= LEN(units))
			return fake_fail(ENOENT, "there is no such unit");
		*(struct ec_ioc_unit_info *)arg = units[((struct ec_ioc_unit_info *)arg)->index];
		return 0;
	case EC_IOC_UNIT_AUTHORITY:
		fake_record("unit %u authority %u\n", ((struct ec_ioc_unit_authority *)arg)->unit,
			    ((struct ec_ioc_unit_authority *)arg)->authority);
		return 0;
	case EC_IOC_DOMAIN_FMMU:
		return domain_fmmu(arg);
	case EC_IOC_DOMAIN_DATA:
		return domain_data(arg);
	default:
		return FAKE_OTHER;
	}
}
