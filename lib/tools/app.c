// SPDX-License-Identifier: LGPL-2.1-or-later
/* What an application has configured, and its process data. */
#include "internal.h"

#include <stdio.h>

#include "../../master/wire/replay.h"
#include "text.h"

#define COPY(member)	(to->member = from->member)

static void convert_config(struct ect_config *to, const struct ec_ioc_config *from)
{
	COPY(index);
	COPY(alias);
	COPY(position);
	COPY(vendor_id);
	COPY(product_code);
	COPY(slave_position);
	COPY(al_status);
	to->in_op = !!(from->state & EC_STATUS_SC_OP);
	COPY(watchdog_divider);
	COPY(watchdog_intervals);
	COPY(dc_assign_activate);
	memcpy(to->dc_cycle, from->dc_cycle, sizeof(to->dc_cycle));
	memcpy(to->dc_shift, from->dc_shift, sizeof(to->dc_shift));
	COPY(sdo_count);
	COPY(flag_count);
	COPY(device);
	COPY(group);
}

/* A group of which it is a member */
static int get_group(struct ect_handle *h, struct ect_config *to)
{
	struct ec_ioc_config_group from = { .index = to->index };
	int ret = to->group ? ect_command(h, EC_IOC_CONFIG_GROUP, &from) : 0;

	if (ret || !to->group)
		return ret;
	to->group_at = from.at;
	to->group_value = from.value;
	to->group_by = (uint8_t)from.by;
	to->group_port = from.port;
	to->group_mandatory = from.mandatory;
	memcpy(to->group_name, from.name, sizeof(to->group_name));
	string_clean(to->group_name, sizeof(to->group_name));
	return 0;
}

int ect_config_read(struct ect_handle *h, unsigned int index, struct ect_config *c)
{
	struct ec_ioc_config i = { .index = index };
	struct ect_config own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_CONFIG, &i);

	if (ret)
		return ret;
	convert_config(&own, &i);
	ret = get_group(h, &own);
	if (ret)
		return ret;
	return ect_give(h, c, &own, sizeof(own));
}

int ect_config_why(struct ect_handle *h, unsigned int index, struct ect_config_why *w)
{
	struct ec_ioc_config_why i = { .index = index };
	struct ect_config_why own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_CONFIG_WHY, &i);

	if (ret)
		return ret;
	ect_convert_cause(&own.cause, &i.cause);
	memcpy(own.text, i.text, sizeof(own.text));
	string_clean(own.text, sizeof(own.text));
	return ect_give(h, w, &own, sizeof(own));
}

int ect_config_sm(struct ect_handle *h, unsigned int index, unsigned int sm,
		  struct ect_config_sm *to)
{
	struct ec_ioc_config_sm i = { .index = index, .sm = (u8)sm };
	struct ect_config_sm own;
	int ret = ect_command(h, EC_IOC_CONFIG_SM, &i);

	own = (struct ect_config_sm){
		.sm = i.sm, .dir = i.dir, .watchdog = i.watchdog, .pdo_count = i.pdo_count,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_pdo(struct ect_handle *h, unsigned int index, unsigned int sm, unsigned int pdo,
		   struct ect_pdo *to)
{
	struct ec_ioc_config_pdo i = { .index = index, .sm = (u8)sm, .pdo_pos = pdo };
	struct ect_pdo own;
	int ret = ect_command(h, EC_IOC_CONFIG_PDO, &i);

	own = (struct ect_pdo){ .index = i.pdo_index, .entry_count = i.entry_count };
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_entry(struct ect_handle *h, unsigned int index, unsigned int sm, unsigned int pdo,
		     unsigned int entry, struct ect_pdo_entry *to)
{
	struct ec_ioc_config_entry i = {
		.index = index, .sm = (u8)sm, .pdo_pos = pdo, .entry_pos = entry,
	};
	struct ect_pdo_entry own;
	int ret = ect_command(h, EC_IOC_CONFIG_ENTRY, &i);

	own = (struct ect_pdo_entry){
		.index = i.entry_index, .subindex = i.subindex, .bits = i.bits,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_sdo(struct ect_handle *h, unsigned int index, unsigned int sdo,
		   struct ect_startup *to, void *data, size_t size)
{
	struct ec_ioc_config_sdo i = {
		.index = index, .sdo_pos = sdo, .size = (u32)min(size, (size_t)0xffffffff),
		.data = (uintptr_t)data,
	};
	struct ect_startup own;
	int ret = ect_command(h, EC_IOC_CONFIG_SDO, &i);

	own = (struct ect_startup){
		.index = i.sdo_index, .subindex = i.subindex,
		.complete = !!(i.flags & EC_SDO_FLAG_COMPLETE), .bytes = i.size,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_idn(struct ect_handle *h, unsigned int index, unsigned int idn,
		   struct ect_startup *to, void *data, size_t size)
{
	struct ec_ioc_config_idn i = {
		.index = index, .idn_pos = idn, .size = (u32)min(size, (size_t)0xffffffff),
		.data = (uintptr_t)data,
	};
	struct ect_startup own;
	int ret = ect_command(h, EC_IOC_CONFIG_IDN, &i);

	own = (struct ect_startup){
		.index = i.idn, .subindex = i.drive, .state = i.state, .bytes = i.size,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_write(struct ect_handle *h, unsigned int index, unsigned int pos,
		     struct ect_write *to, void *data, size_t size)
{
	struct ec_ioc_config_write i = {
		.index = index, .write_pos = pos, .size = (u32)min(size, (size_t)0xffffffff),
		.data = (uintptr_t)data,
	};
	struct ect_write own;
	int ret = ect_command(h, EC_IOC_CONFIG_WRITE, &i);

	own = (struct ect_write){
		.index = i.object, .subindex = i.subindex, .kind = i.kind,
		.complete = !!(i.flags & EC_SDO_FLAG_COMPLETE), .bytes = i.size,
		.forgotten = i.forgotten,
	};
	snprintf(own.why, sizeof(own.why), "%s", ec_replay_why_text((u8)min(i.why, 255u)));
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_command(struct ect_handle *h, unsigned int index, unsigned int pos,
		       struct ect_step_command *to, void *data, size_t size)
{
	struct ec_ioc_config_command i = {
		.index = index, .command_pos = pos, .size = (u32)min(size, (size_t)0xffffffff),
		.data = (uintptr_t)data,
	};
	struct ect_step_command own;
	int ret = ect_command(h, EC_IOC_CONFIG_COMMAND, &i);
	u32 parts = (i.flags & EC_COMMAND_FLAG_WRITE ? 1 : 0) +
		    (i.flags & EC_COMMAND_FLAG_CHECK ? 2 : 0);

	own = (struct ect_step_command){
		.index = i.object, .subindex = i.subindex, .kind = i.kind,
		.complete = !!(i.flags & EC_COMMAND_FLAG_COMPLETE), .from = i.from, .to = i.to,
		.writes = !!(i.flags & EC_COMMAND_FLAG_WRITE),
		.checks = !!(i.flags & EC_COMMAND_FLAG_CHECK), .timeout_ms = i.timeout_ms,
		.bytes = parts ? i.size / parts : 0,
	};
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_flag(struct ect_handle *h, unsigned int index, unsigned int flag,
		    struct ect_flag *to)
{
	struct ec_ioc_config_flag i = { .index = index, .flag_pos = flag };
	struct ect_flag own;
	int ret = ect_command(h, EC_IOC_CONFIG_FLAG, &i);

	own = (struct ect_flag){ .value = i.value };
	memcpy(own.key, i.key, sizeof(own.key));
	string_clean(own.key, sizeof(own.key));
	return ret ? ret : ect_give(h, to, &own, sizeof(own));
}

int ect_config_ip(struct ect_handle *h, unsigned int index, struct ect_ip *ip)
{
	struct ec_ioc_sc_ip i = { .config = index };
	struct ect_ip own;
	int ret = ect_command(h, EC_IOC_CONFIG_IP, &i);

	ect_convert_ip(&own, &i.params);
	return ret ? ret : ect_give(h, ip, &own, sizeof(own));
}

static void convert_domain(struct ect_domain *to, const struct ec_ioc_domain *from)
{
	COPY(index);
	COPY(size);
	COPY(logical);
	COPY(working_counter);
	COPY(expected);
	COPY(fmmu_count);
	COPY(max_age);
	COPY(options);
	COPY(datagram_count);
	COPY(datagram_bytes);
	COPY(age);
	COPY(wc_state);
	COPY(unsent);
}

int ect_domain_read(struct ect_handle *h, unsigned int index, struct ect_domain *d)
{
	struct ec_ioc_domain i = { .index = index };
	struct ect_domain own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_DOMAIN, &i);

	if (ret)
		return ret;
	convert_domain(&own, &i);
	return ect_give(h, d, &own, sizeof(own));
}

int ect_domain_fmmu(struct ect_handle *h, unsigned int index, unsigned int fmmu,
		    struct ect_fmmu *f)
{
	struct ec_ioc_domain_fmmu i = { .index = index, .fmmu = fmmu };
	struct ect_fmmu own;
	int ret = ect_command(h, EC_IOC_DOMAIN_FMMU, &i);

	own = (struct ect_fmmu){
		.alias = i.alias, .position = i.position, .sm = i.sm, .dir = i.dir,
		.logical = i.logical, .size = i.size, .offset = i.offset, .config = i.config,
	};
	return ret ? ret : ect_give(h, f, &own, sizeof(own));
}

long ect_domain_data(struct ect_handle *h, unsigned int index, void *data, size_t size)
{
	struct ec_ioc_domain_data i = {
		.index = index, .size = (u32)min(size, (size_t)0xffffffff),
		.data = (uintptr_t)data,
	};
	int ret = ect_command(h, EC_IOC_DOMAIN_DATA, &i);

	return ret ? ret : (long)min((size_t)i.size, size);
}

static void convert_unit(struct ect_unit *to, const struct ec_ioc_unit_info *from)
{
	u32 state = from->state;

	COPY(index);
	COPY(policy);
	COPY(flags);
	COPY(limit);
	COPY(lease_cycles);
	COPY(repeats);
	COPY(domains);
	to->active = !!from->active;
	to->faults = state >> 16;
	to->run = state & 0xf;
	to->outputs = state >> 4 & 0xf;
	to->authority = !!(state & EC_UNIT_HAS_AUTHORITY);
	to->lease_ended = !!(state & EC_UNIT_LEASE_ENDED);
	to->down = !!(state & EC_UNIT_DOWN);
	to->held = !!(state & EC_UNIT_HAS_HOLDER);
	memcpy(to->name, from->name, sizeof(to->name));
	string_clean(to->name, sizeof(to->name));
}

int ect_unit_read(struct ect_handle *h, unsigned int index, struct ect_unit *u)
{
	struct ec_ioc_unit_info i = { .index = index };
	struct ect_unit own = { .struct_size = sizeof(own) };
	int ret = ect_command(h, EC_IOC_UNIT_INFO, &i);

	if (ret)
		return ret;
	convert_unit(&own, &i);
	return ect_give(h, u, &own, sizeof(own));
}

int ect_unit_take(struct ect_handle *h, unsigned int index)
{
	struct ec_ioc_unit_authority i = { .unit = index };

	return ect_command(h, EC_IOC_UNIT_AUTHORITY, &i);
}
