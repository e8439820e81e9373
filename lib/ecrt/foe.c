// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Files of slaves (FoE), read and written at once. */
#include "ecrt_int.h"

/* at once --------------------------------------------------------------------*/

/* @error_code: the slave's when it refuses, and 0 otherwise; may be NULL */
static int transfer(ec_master_t *master, unsigned int cmd, const char *name,
		    struct ec_ioc_foe *i, uint32_t *error_code)
{
	bool read = cmd == EC_IOC_FOE_READ;
	const char *verb = read ? "read" : "write", *way = read ? "of" : "to";
	size_t len = name ? strlen(name) : 0;
	int ret;

	if (!len || len > sizeof(i->name))
		return ec_fail(master, -EINVAL,
			       "%s a file %s slave %u by a name of %zu characters, allowed 1 to %zu",
			       verb, way, i->position, len, sizeof(i->name));
	memcpy(i->name, name, len);
	ret = ec_do(master, cmd, i, "%s file '%s' %s slave %u", verb, name, way, i->position);
	if (ret == -EIO && error_code)
		*error_code = i->error_code;
	return ret;
}

int ecrt_master_foe_read(ec_master_t *master, uint16_t slave_position, const char *file_name,
			 uint32_t password, uint8_t *target, size_t target_size,
			 size_t *result_size, uint32_t *error_code, uint32_t timeout)
{
	struct ec_ioc_foe i = {
		.position = slave_position, .password = password, .size = ec_u32(target_size),
		.timeout_ms = timeout, .data = (uintptr_t)target,
	};
	int ret;

	if (result_size)
		ec_no_result(result_size);
	if (error_code)
		*error_code = 0;
	if (!master)
		return -EINVAL;
	if (!result_size || (!target && target_size))
		return ec_fail(master, -EINVAL, "read a file of slave %u to nowhere",
			       slave_position);
	ret = transfer(master, EC_IOC_FOE_READ, file_name, &i, error_code);
	if (!ret)
		*result_size = i.size;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_foe_read);

int ecrt_master_foe_write(ec_master_t *master, uint16_t slave_position, const char *file_name,
			  uint32_t password, const uint8_t *data, size_t data_size,
			  uint32_t *error_code, uint32_t timeout)
{
	struct ec_ioc_foe i = {
		.position = slave_position, .password = password, .size = ec_u32(data_size),
		.timeout_ms = timeout, .data = (uintptr_t)data,
	};

	if (error_code)
		*error_code = 0;
	if (!master)
		return -EINVAL;
	if ((!data && data_size) || data_size > EC_U32_MAX)
		return ec_fail(master, -EINVAL, "write %zu bytes to a file of slave %u", data_size,
			       slave_position);
	return transfer(master, EC_IOC_FOE_WRITE, file_name, &i, error_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_foe_write);
