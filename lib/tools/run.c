// SPDX-License-Identifier: LGPL-2.1-or-later
/* A bus that runs without an application: what an application would do, and its outputs. */
#include <errno.h>
#include <stdlib.h>
#include <strings.h>

#include "internal.h"

#define PROFILE_DRIVE	402
#define PROFILE_MODULAR	5001
#define MODULES_MAX	64	/* of which the profile is read; with more the kind is unknown */
#define MBOX_COE	4
#define MBOX_SOE	16

/* SDO abort codes that say that there is no such object */
#define ABORT_NO_OBJECT		0x06020000
#define ABORT_NO_SUBINDEX	0x06090011

int ect_run_reserve(struct ect_handle *h)
{
	struct ec_ioc_create_domain d = { 0 };
	int ret = ect_command(h, EC_IOC_RESERVE, NULL);

	return ret ? ret : ect_command(h, EC_IOC_CREATE_DOMAIN, &d);
}

/* All of a SyncManager is in the domain when one of its entries is. */
static int add_sm(struct ect_handle *h, unsigned int config, unsigned int sm, unsigned int pdos)
{
	for (unsigned int i = 0; i < pdos; i++) {
		struct ect_pdo p = { .struct_size = sizeof(p) };
		struct ec_ioc_reg_entry r = {
			.flags = EC_REG_ENTRY_BY_POS, .config = config, .sm = (u8)sm, .pdo_pos = i,
		};
		int ret = ect_config_pdo(h, config, sm, i, &p);

		if (ret)
			return ret;
		if (p.entry_count)
			return ect_command(h, EC_IOC_REG_ENTRY, &r);
	}
	return 0;
}

int ect_run_add(struct ect_handle *h, const struct ect_slave *s)
{
	struct ec_ioc_slave_config c = {
		.position = (u16)(s->position + s->missing_before), .vendor_id = s->vendor_id,
		.product_code = s->product_code,
	};
	int ret = ect_command(h, EC_IOC_SLAVE_CONFIG, &c);

	for (unsigned int sm = 0; sm < 16 && !ret; sm++) {
		struct ect_config_sm x = { .struct_size = sizeof(x) };

		ret = ect_config_sm(h, c.index, sm, &x);
		if (!ret && x.dir)
			ret = add_sm(h, c.index, sm, x.pdo_count);
	}
	return ret;
}

int ect_run_start(struct ect_handle *h, const struct ect_run *how)
{
	struct ec_ioc_cycle c = {
		.period_ns = how->period_ns, .cpu = how->cpu, .priority = how->priority,
		.stall = EC_STALL_HOLD,
	};
	struct ec_ioc_activate a = { 0 };
	int ret = ect_command(h, EC_IOC_CYCLE, &c);

	return ret ? ret : ect_command(h, EC_IOC_ACTIVATE, &a);
}

int ect_run_leave(struct ect_handle *h)
{
	struct ec_ioc_detach d = { 0 };

	return ect_command(h, EC_IOC_DETACH, &d);
}

int ect_session_names(struct ect_handle *h, char **text, size_t *size)
{
	struct ec_ioc_names i = { 0 };
	int ret;

	*text = NULL;
	*size = 0;
	/* the text may have grown between two commands */
	do {
		free(*text);
		*text = NULL;
		*size = i.size;
		if (i.size) {
			*text = calloc(1, (size_t)i.size + 1);
			if (!*text)
				return ect_no_memory(h);
		}
		i.data = (uintptr_t)*text;
		ret = ect_command(h, EC_IOC_NAMES, &i);
	} while (!ret && i.size > *size);
	*size = i.size;
	if (!ret && i.size)
		return 0;
	free(*text);
	*text = NULL;
	return ret;
}

int ect_output_set(struct ect_handle *h, const struct ect_output *o)
{
	struct ec_ioc_output i = {
		.flags = o->lease_ms ? 0 : EC_OUTPUT_FLAG_HOLD, .domain = o->domain, .bit = o->bit,
		.bits = o->bits, .value = o->value, .device = o->device, .lease_ms = o->lease_ms,
	};

	return ect_command(h, EC_IOC_OUTPUT, &i);
}

/*
 * Return: 1 it has the object; 0 it says that it has none; -EIO it refuses for another cause, or
 * another negative errno.
 */
static int read_u32(struct ect_handle *h, u64 device, u16 index, u8 sub, u32 *value)
{
	u8 data[4] = { 0 };
	long n = ect_sdo_upload(h, device, index, sub, 0, 0, data, sizeof(data));

	*value = (u32)data[0] | (u32)data[1] << 8 | (u32)data[2] << 16 | (u32)data[3] << 24;
	if (n == -EIO && (ect_error_code(h) == ABORT_NO_OBJECT ||
			  ect_error_code(h) == ABORT_NO_SUBINDEX))
		return 0;
	return n < 0 ? (int)n : 1;
}

static bool says_safety(const char *text)
{
	return strcasestr(text, "fsoe") || strcasestr(text, "safety");
}

/* FSoE messages are PDO entries as others; their names say it. */
static int named_safety(struct ect_handle *h, const struct ect_slave *s, bool *safety)
{
	*safety = says_safety(s->name) || says_safety(s->group);
	for (unsigned int sm = 0; sm < s->sm_count && !*safety; sm++) {
		struct ect_sm x = { .struct_size = sizeof(x) };
		int ret = ect_sm_read(h, s->device, sm, &x);

		for (unsigned int i = 0; i < x.pdo_count && !ret && !*safety; i++) {
			struct ect_pdo p = { .struct_size = sizeof(p) };

			ret = ect_pdo_read(h, s->device, sm, i, &p);
			*safety = !ret && says_safety(p.name);
		}
		if (ret)
			return ret;
	}
	return 0;
}

/* A modular device: of one module at least. Return: 1, 0, or a negative errno. */
static int has_drive(struct ect_handle *h, u64 device)
{
	u32 n, profile;
	int ret = read_u32(h, device, 0xf010, 0, &n);

	if (ret > 0 && n > MODULES_MAX)
		return -E2BIG;
	for (unsigned int i = 1; ret > 0 && i <= n; i++) {
		int has = read_u32(h, device, 0xf010, (u8)i, &profile);

		if (has < 0)
			return has;
		if (has && (profile & 0xffff) == PROFILE_DRIVE)
			return 1;
	}
	return ret < 0 ? ret : 0;
}

/* What its objects say; @kind stays without them. Return: 0, or a negative errno: no answer. */
static int read_kind(struct ect_handle *h, u64 device, unsigned int *kind)
{
	u32 type, address;
	int ret = read_u32(h, device, 0x1000, 0, &type), drive;

	if (ret <= 0)
		return ret;
	type &= 0xffff;
	drive = type == PROFILE_MODULAR ? has_drive(h, device) : type == PROFILE_DRIVE;
	if (drive < 0)
		return drive;
	if (drive) {
		*kind = ECT_KIND_DRIVE;
		return 0;
	}
	ret = read_u32(h, device, 0xf980, 1, &address);
	if (ret > 0)
		*kind = ECT_KIND_SAFETY;
	return ret < 0 ? ret : 0;
}

int ect_kind_read(struct ect_handle *h, const struct ect_slave *s, unsigned int *kind)
{
	bool safety;
	int ret = named_safety(h, s, &safety);

	*kind = safety ? ECT_KIND_SAFETY :
		s->mbox_protocols & MBOX_SOE ? ECT_KIND_DRIVE : ECT_KIND_IO;
	if (ret || *kind != ECT_KIND_IO || !(s->mbox_protocols & MBOX_COE))
		return ret;
	ret = read_kind(h, s->device, kind);
	if (!ret)
		return 0;
	*kind = ECT_KIND_UNKNOWN;
	return ret == -ENODEV || ret == -EINTR ? ret : 0;
}
