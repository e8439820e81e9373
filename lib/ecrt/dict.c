// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Object dictionary of slaves (SDO information), at once, and by requests beside a cycle. */
#include "ecrt_int.h"

#define LIST_MOST	32768U	/* indexes; the kernel passes on 64 KiB */
#define ANSWER_BYTES	4096U	/* of a description */
#define LISTS		6

/* fields of an answer, little-endian (ETG.1000.6 5.6.3) */
#define OBJECT_BYTES	6U
#define ENTRY_BYTES	10U

/* A name fills the rest of an answer; zeros at its end do not belong to it. */
static void copy_name(char to[EC_MAX_STRING_LENGTH], const uint8_t *name, size_t len)
{
	while (len && !name[len - 1])
		len--;
	if (len > EC_MAX_STRING_LENGTH - 1)
		len = EC_MAX_STRING_LENGTH - 1;
	memset(to, 0, EC_MAX_STRING_LENGTH);
	memcpy(to, name, len);
}

static int decode_object(const uint8_t *b, size_t len, ec_sdo_object_info_t *info)
{
	if (len < OBJECT_BYTES)
		return -EBADMSG;
	info->index = EC_READ_U16(b);
	info->data_type = EC_READ_U16(b + 2);
	info->max_subindex = b[4];
	info->object_code = b[5];
	copy_name(info->name, b + OBJECT_BYTES, len - OBJECT_BYTES);
	return 0;
}

/* Unit, default, minimum and maximum precede the name of a slave that sends them unasked. */
static size_t values_size(uint8_t value_info, uint16_t bits)
{
	size_t value = ((size_t)bits + 7) / 8, n = value_info & 0x08 ? 2 : 0;

	for (unsigned int bit = 4; bit < 7; bit++)
		n += value_info & 1 << bit ? value : 0;
	return n;
}

static int decode_entry(const uint8_t *b, size_t len, ec_sdo_entry_info_t *info)
{
	size_t at;

	if (len < ENTRY_BYTES)
		return -EBADMSG;
	info->index = EC_READ_U16(b);
	info->subindex = b[2];
	info->data_type = EC_READ_U16(b + 4);
	info->bit_length = EC_READ_U16(b + 6);
	info->access = EC_READ_U16(b + 8);
	at = ENTRY_BYTES + values_size(b[3], info->bit_length);
	copy_name(info->name, b + (at < len ? at : len), at < len ? len - at : 0);
	return 0;
}

/* at once --------------------------------------------------------------------*/

/* @abort_code: that of a slave that refuses, otherwise 0; may be NULL */
static int ask(ec_master_t *master, struct ec_ioc_sdo_info *i, uint32_t *abort_code)
{
	int ret;

	if (i->what == EC_SDO_INFO_LIST)
		ret = ec_do(master, EC_IOC_SDO_INFO, i, "read list %u of objects of slave %u",
			    i->index, i->slave.position);
	else
		ret = ec_do(master, EC_IOC_SDO_INFO, i, "read the description of 0x%04x:%02x of slave %u",
			    i->index, i->subindex, i->slave.position);
	if (ret == -EIO && abort_code)
		*abort_code = i->abort_code;
	return ret;
}

int ecrt_master_sdo_info_list(ec_master_t *master, uint16_t slave_position, uint8_t list_type,
			      uint16_t *target, size_t target_count, size_t *result_count,
			      uint32_t *abort_code)
{
	struct ec_ioc_sdo_info i = {
		.slave.position = slave_position, .what = EC_SDO_INFO_LIST, .index = list_type,
		.size = 2 * (target_count < LIST_MOST ? (__u32)target_count : LIST_MOST),
		.data = (uintptr_t)target,
	};
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (result_count)
		ec_no_result(result_count);
	if (!master)
		return -EINVAL;
	if (!result_count || (!target && target_count) || list_type >= LISTS)
		return ec_fail(master, -EINVAL, "read list %u, of 0 to 5, of objects of slave %u",
			       list_type, slave_position);
	ret = ask(master, &i, abort_code);
	if (ret)
		return ret;
	*result_count = i.size / 2;
	for (size_t n = 0; n < *result_count; n++)
		target[n] = EC_READ_U16(&target[n]);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_info_list);

/* Decode an answer by the kind of its question. */
static int describe(ec_master_t *master, struct ec_ioc_sdo_info *i, void *info,
		    uint32_t *abort_code)
{
	uint8_t *b;
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (!master)
		return -EINVAL;
	if (!info)
		return ec_fail(master, -EINVAL,
			       "read the description of 0x%04x:%02x of slave %u to nowhere",
			       i->index, i->subindex, i->slave.position);
	b = ec_zalloc(ANSWER_BYTES);
	if (!b)
		return -ENOMEM;
	i->size = ANSWER_BYTES;
	i->data = (uintptr_t)b;
	ret = ask(master, i, abort_code);
	if (!ret && i->what == EC_SDO_INFO_OBJECT)
		ret = decode_object(b, i->size, info);
	else if (!ret)
		ret = decode_entry(b, i->size, info);
	ec_free(b);
	return ret;
}

int ecrt_master_sdo_info_object(ec_master_t *master, uint16_t slave_position, uint16_t index,
				ec_sdo_object_info_t *info, uint32_t *abort_code)
{
	struct ec_ioc_sdo_info i = {
		.slave.position = slave_position, .what = EC_SDO_INFO_OBJECT, .index = index,
	};

	return describe(master, &i, info, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_info_object);

int ecrt_master_sdo_info_entry(ec_master_t *master, uint16_t slave_position, uint16_t index,
			       uint8_t subindex, ec_sdo_entry_info_t *info, uint32_t *abort_code)
{
	struct ec_ioc_sdo_info i = {
		.slave.position = slave_position, .what = EC_SDO_INFO_ENTRY, .index = index,
		.subindex = subindex,
	};

	return describe(master, &i, info, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_info_entry);

int ecrt_master_sdo_info_forget(ec_master_t *master, uint16_t slave_position)
{
	struct ec_ioc_sdo_info i = { .slave.position = slave_position, .what = EC_SDO_INFO_FORGET };

	return ec_do(master, EC_IOC_SDO_INFO, &i, "forget the object dictionary of slave %u",
		     slave_position);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_info_forget);

/* requests -----------------------------------------------------------------*/

ec_sdo_info_request_t *ecrt_slave_config_create_sdo_info_request(ec_slave_config_t *sc,
								 size_t size)
{
	return ec_app_request_create(sc, EC_REQUEST_SDO_INFO, sizeof(ec_sdo_info_request_t),
				     size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_create_sdo_info_request);

static int start(ec_sdo_info_request_t *req, __u32 what, uint16_t index, uint8_t subindex)
{
	if (!req)
		return -EINVAL;
	if (ec_app_request_state(&req->r) == EC_REQUEST_BUSY)
		return -EBUSY;
	req->r.flags = what;
	req->r.index16 = index;
	req->r.subindex = subindex;
	return ec_app_request_start(&req->r, EC_REQUEST_OP_READ, 0);
}

int ecrt_sdo_info_request_list(ec_sdo_info_request_t *req, uint8_t list_type)
{
	return list_type < LISTS ? start(req, EC_SDO_INFO_LIST, list_type, 0) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_list);

int ecrt_sdo_info_request_object(ec_sdo_info_request_t *req, uint16_t index)
{
	return start(req, EC_SDO_INFO_OBJECT, index, 0);
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_object);

int ecrt_sdo_info_request_entry(ec_sdo_info_request_t *req, uint16_t index, uint8_t subindex)
{
	return start(req, EC_SDO_INFO_ENTRY, index, subindex);
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_entry);

static bool has(const ec_sdo_info_request_t *req, __u32 what)
{
	return req && req->r.state == EC_REQUEST_SUCCESS && req->r.flags == what;
}

int ecrt_sdo_info_request_get_object(const ec_sdo_info_request_t *req,
				     ec_sdo_object_info_t *info)
{
	return info && has(req, EC_SDO_INFO_OBJECT) ?
	       decode_object(req->r.data, req->r.size, info) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_get_object);

int ecrt_sdo_info_request_get_entry(const ec_sdo_info_request_t *req, ec_sdo_entry_info_t *info)
{
	return info && has(req, EC_SDO_INFO_ENTRY) ?
	       decode_entry(req->r.data, req->r.size, info) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_get_entry);

uint32_t ecrt_sdo_info_request_abort_code(const ec_sdo_info_request_t *req)
{
	const struct ec_request_record *rec = req ? req->r.rec : NULL;

	return rec && req->r.state == EC_REQUEST_ERROR ? ec_status_read(rec->abort_code) : 0;
}
EXPORT_SYMBOL_GPL(ecrt_sdo_info_request_abort_code);
