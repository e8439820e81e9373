// SPDX-License-Identifier: GPL-2.0-only
/* Objects of slaves read and written at once, for applications in the kernel. */
#include <linux/mm.h>
#include <linux/string.h>
#include "api.h"

/* The end of a transfer; a slave that is not there has a word of its own here. */
static int ended(struct ec_master *m, const struct ec_ioc_sdo *i, int ret, u32 *abort_code,
		 const char *what)
{
	if (abort_code)
		*abort_code = ret == -EIO ? i->abort_code : 0;
	if (!ret)
		return 0;
	return ec_api_fail(m, ret == -ENOENT ? -EINVAL : ret, "%s SDO 0x%04x:%02x of slave %u",
			   what, i->index, i->subindex, i->position);
}

static int download(struct ec_master *m, struct ec_ioc_sdo *i, const u8 *data, size_t size,
		    u32 *abort_code)
{
	if (abort_code)
		*abort_code = 0;
	if (!m || !data || !size)
		return -EINVAL;
	i->size = min_t(size_t, size, U32_MAX);
	i->data = (uintptr_t)data;
	return ended(m, i, ec_command(m, EC_IOC_SDO_DOWNLOAD, i), abort_code, "write");
}

int ecrt_master_sdo_download(ec_master_t *master, uint16_t slave_position, uint16_t index,
			     uint8_t subindex, const uint8_t *data, size_t data_size,
			     uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.position = slave_position, .index = index, .subindex = subindex,
	};

	return download(master, &i, data, data_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_download);

int ecrt_master_sdo_download_complete(ec_master_t *master, uint16_t slave_position,
				      uint16_t index, const uint8_t *data, size_t data_size,
				      uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.flags = EC_SDO_FLAG_COMPLETE, .position = slave_position, .index = index,
	};

	return download(master, &i, data, data_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_download_complete);

static int upload(struct ec_master *m, struct ec_ioc_sdo *i, u8 *target, size_t target_size,
		  size_t *result_size, u32 *abort_code)
{
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (result_size)
		*result_size = 0;
	if (!m || (!target && target_size) || !result_size)
		return -EINVAL;
	i->size = min_t(size_t, target_size, U32_MAX);
	i->data = (uintptr_t)target;
	ret = ec_command(m, EC_IOC_SDO_UPLOAD, i);
	if (!ret)
		*result_size = i->size;
	return ended(m, i, ret, abort_code, "read");
}

int ecrt_master_sdo_upload(ec_master_t *master, uint16_t slave_position, uint16_t index,
			   uint8_t subindex, uint8_t *target, size_t target_size,
			   size_t *result_size, uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.position = slave_position, .index = index, .subindex = subindex,
	};

	return upload(master, &i, target, target_size, result_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_upload);

int ecrt_master_sdo_upload_complete(ec_master_t *master, uint16_t slave_position,
				    uint16_t index, uint8_t *target, size_t target_size,
				    size_t *result_size, uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.flags = EC_SDO_FLAG_COMPLETE, .position = slave_position, .index = index,
	};

	return upload(master, &i, target, target_size, result_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_upload_complete);
