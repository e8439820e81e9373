// SPDX-License-Identifier: LGPL-2.1-or-later
/* The object dictionary of a slave, as it describes itself. */
#include <stdio.h>
#include <stdlib.h>

#include "../../master/wire/sdoinfo.h"
#include "internal.h"
#include "text.h"

_Static_assert(ECT_VALUE_ALL == EC_OD_INFO_VALUES, "bits of values");

/* an answer of the slave into @buf of ECT_SDO_MAX bytes */
static int ask(struct ect_handle *h, struct ec_ioc_sdo_info *i, u8 *buf)
{
	int ret;

	i->size = ECT_SDO_MAX;
	i->data = (uintptr_t)buf;
	ret = ect_command(h, EC_IOC_SDO_INFO, i);
	i->size = min(i->size, ECT_SDO_MAX);
	return ect_coded(h, ret, i->abort_code);
}

static int fill_list(struct ect_handle *h, struct ect_list *l, const u8 *indexes, size_t n)
{
	for (size_t i = 0; i < n; i++) {
		struct ect_object *o = ect_list_add(l);

		if (!o)
			return ect_no_memory(h);
		o->index = get_unaligned_le16(indexes + 2 * i);
	}
	return 0;
}

int ect_objects_read(struct ect_handle *h, uint64_t device, uint32_t timeout_ms,
		     struct ect_list **list)
{
	struct ec_ioc_sdo_info i = {
		.slave = ect_address(device), .what = EC_SDO_INFO_LIST, .index = 1,
		.timeout_ms = timeout_ms,
	};
	struct ect_list *l = ect_list_new(sizeof(struct ect_object));
	u8 *buf = malloc(ECT_SDO_MAX);
	int ret = l && buf ? ask(h, &i, buf) : ect_no_memory(h);

	if (!ret)
		ret = fill_list(h, l, buf, i.size / 2);
	free(buf);
	if (ret)
		ect_list_free(l);
	else
		*list = l;
	return ret;
}

static void convert_name(char to[ECT_TEXT], const char *name, size_t len)
{
	snprintf(to, ECT_TEXT, "%.*s", (int)min(len, (size_t)ECT_TEXT - 1), name);
	string_clean(to, ECT_TEXT);
}

static int no_description(struct ect_handle *h, const char *what)
{
	return ect_fail(h, -EBADMSG, "the answer of the slave is no description of an %s", what);
}

int ect_object_read(struct ect_handle *h, uint64_t device, uint16_t index, uint32_t timeout_ms,
		    struct ect_object *o)
{
	struct ec_ioc_sdo_info i = {
		.slave = ect_address(device), .what = EC_SDO_INFO_OBJECT, .index = index,
		.timeout_ms = timeout_ms,
	};
	struct ect_object own = { .index = index };
	u8 *buf = malloc(ECT_SDO_MAX);
	int ret = buf ? ask(h, &i, buf) : ect_no_memory(h);
	struct ec_od_object d;

	if (!ret && ec_od_object_decode(buf, i.size, &d))
		ret = no_description(h, "object");
	if (!ret) {
		own.type = d.type;
		own.max_subindex = d.max_sub;
		own.code = d.code;
		convert_name(own.name, d.name, d.name_len);
		ret = ect_give(h, o, &own, sizeof(own));
	}
	free(buf);
	return ret;
}

static void convert_value(struct ect_entry *e, u8 bit, u8 *to, const u8 *from, size_t size)
{
	if (!from || size > ECT_VALUE_BYTES)
		return;
	e->values |= bit;
	memcpy(to, from, size);
}

/*
 * Values that the slave does not have are no failure; nor is an older module, which reads none.
 * @plain: bytes of the description without optional fields
 */
static void ask_values(struct ect_handle *h, struct ec_ioc_sdo_info i, size_t plain, u8 *buf,
		       unsigned int values, struct ect_entry *e)
{
	struct ec_od_values v;

	i.value_info = (u8)(values & EC_OD_INFO_VALUES);
	if (ask(h, &i, buf) || ec_od_values_decode(buf, i.size, plain, &v))
		return;
	e->value_size = (u16)v.size;
	convert_value(e, EC_OD_INFO_DEFAULT, e->initial, v.def, v.size);
	convert_value(e, EC_OD_INFO_MIN, e->minimum, v.min, v.size);
	convert_value(e, EC_OD_INFO_MAX, e->maximum, v.max, v.size);
	if (!(v.info & EC_OD_INFO_UNIT))
		return;
	e->values |= EC_OD_INFO_UNIT;
	e->unit = v.unit;
	e->unit_size = v.unit_size;
}

int ect_entry_read(struct ect_handle *h, uint64_t device, uint16_t index, uint8_t subindex,
		   unsigned int values, uint32_t timeout_ms, struct ect_entry *e)
{
	struct ec_ioc_sdo_info i = {
		.slave = ect_address(device), .what = EC_SDO_INFO_ENTRY, .index = index,
		.subindex = subindex, .timeout_ms = timeout_ms,
	};
	struct ect_entry own = { .index = index, .subindex = subindex };
	u8 *buf = malloc(ECT_SDO_MAX);
	int ret = buf ? ask(h, &i, buf) : ect_no_memory(h);
	struct ec_od_entry d;

	if (!ret && ec_od_entry_decode(buf, i.size, &d))
		ret = no_description(h, "entry");
	if (!ret) {
		own.index = d.index;
		own.subindex = d.sub;
		own.type = d.type;
		own.bits = d.bits;
		own.access = d.access;
		convert_name(own.name, d.name, d.name_len);
		/* values that were not requested leave the size of the rest unknown */
		if (values && !(d.info & EC_OD_INFO_VALUES))
			ask_values(h, i, i.size, buf, values, &own);
		ret = ect_give(h, e, &own, sizeof(own));
	}
	free(buf);
	return ret;
}
