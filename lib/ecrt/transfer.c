// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Values in slaves, read and written at once: SDOs and IDNs. */
#include "ecrt_int.h"

#define DRIVES	8

/* SDOs ---------------------------------------------------------------------*/

/* @abort_code: that of a slave that aborts, otherwise 0; may be NULL */
static int sdo(ec_master_t *master, unsigned int cmd, struct ec_ioc_sdo *i,
	       uint32_t *abort_code)
{
	bool read = cmd == EC_IOC_SDO_UPLOAD;
	int ret = ec_do(master, cmd, i, "%s SDO 0x%04x:%02x %s slave %u",
			read ? "upload" : "download", i->index, i->subindex,
			read ? "from" : "to", i->slave.position);

	if (ret == -EIO && abort_code)
		*abort_code = i->abort_code;
	return ret;
}

static int download(ec_master_t *master, uint16_t position, uint16_t index, uint8_t subindex,
		    __u32 flags, const uint8_t *data, size_t size, uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.flags = flags, .slave.position = position, .index = index, .subindex = subindex,
		.size = ec_u32(size), .data = (uintptr_t)data,
	};

	if (abort_code)
		*abort_code = 0;
	if (!master)
		return -EINVAL;
	if (!data || !size || size > EC_U32_MAX)
		return ec_fail(master, -EINVAL, "download %zu bytes to SDO 0x%04x:%02x of slave %u",
			       size, index, subindex, position);
	return sdo(master, EC_IOC_SDO_DOWNLOAD, &i, abort_code);
}

int ecrt_master_sdo_download(ec_master_t *master, uint16_t slave_position, uint16_t index,
			     uint8_t subindex, const uint8_t *data, size_t data_size,
			     uint32_t *abort_code)
{
	return download(master, slave_position, index, subindex, 0, data, data_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_download);

int ecrt_master_sdo_download_complete(ec_master_t *master, uint16_t slave_position,
				      uint16_t index, const uint8_t *data, size_t data_size,
				      uint32_t *abort_code)
{
	return download(master, slave_position, index, 0, EC_SDO_FLAG_COMPLETE, data, data_size,
			abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_download_complete);

static int upload(ec_master_t *master, uint16_t position, uint16_t index, uint8_t subindex,
		  __u32 flags, uint8_t *target, size_t size, size_t *result_size,
		  uint32_t *abort_code)
{
	struct ec_ioc_sdo i = {
		.flags = flags, .slave.position = position, .index = index, .subindex = subindex,
		.size = ec_u32(size), .data = (uintptr_t)target,
	};
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (result_size)
		ec_no_result(result_size);
	if (!master)
		return -EINVAL;
	if (!result_size || (!target && size))
		return ec_fail(master, -EINVAL, "upload SDO 0x%04x:%02x from slave %u to nowhere",
			       index, subindex, position);
	ret = sdo(master, EC_IOC_SDO_UPLOAD, &i, abort_code);
	if (!ret)
		*result_size = i.size;
	return ret;
}

int ecrt_master_sdo_upload(ec_master_t *master, uint16_t slave_position, uint16_t index,
			   uint8_t subindex, uint8_t *target, size_t target_size,
			   size_t *result_size, uint32_t *abort_code)
{
	return upload(master, slave_position, index, subindex, 0, target, target_size, result_size,
		      abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_upload);

int ecrt_master_sdo_upload_complete(ec_master_t *master, uint16_t slave_position,
				    uint16_t index, uint8_t *target, size_t target_size,
				    size_t *result_size, uint32_t *abort_code)
{
	return upload(master, slave_position, index, 0, EC_SDO_FLAG_COMPLETE, target, target_size,
		      result_size, abort_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_sdo_upload_complete);

/* IDNs ---------------------------------------------------------------------*/

static int idn_transfer(ec_master_t *master, unsigned int cmd, struct ec_ioc_soe *i,
			uint16_t *error_code)
{
	int ret;

	if (error_code)
		*error_code = 0;
	if (!master || (!i->data && i->size))
		return -EINVAL;
	if (i->drive >= DRIVES)
		return ec_fail(master, -EINVAL, "use drive %u; there are 0 to 7", i->drive);
	ret = ec_do(master, cmd, i, "%s IDN 0x%04x of drive %u of slave %u",
		    cmd == EC_IOC_SOE_READ ? "read" : "write", i->idn, i->drive, i->slave.position);
	if (ret == -EIO && error_code)
		*error_code = (uint16_t)i->error_code;
	return ret;
}

int ecrt_master_read_idn(ec_master_t *master, uint16_t slave_position, uint8_t drive_no,
			 uint16_t idn, uint8_t *target, size_t target_size, size_t *result_size,
			 uint16_t *error_code)
{
	struct ec_ioc_soe i = {
		.slave.position = slave_position, .idn = idn, .drive = drive_no,
		.size = ec_u32(target_size), .data = (uintptr_t)target,
	};
	int ret;

	if (!result_size)
		return -EINVAL;
	ec_no_result(result_size);
	ret = idn_transfer(master, EC_IOC_SOE_READ, &i, error_code);
	if (!ret)
		*result_size = i.size;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_read_idn);

int ecrt_master_write_idn(ec_master_t *master, uint16_t slave_position, uint8_t drive_no,
			  uint16_t idn, const uint8_t *data, size_t data_size,
			  uint16_t *error_code)
{
	struct ec_ioc_soe i = {
		.slave.position = slave_position, .idn = idn, .drive = drive_no,
		.size = ec_u32(data_size), .data = (uintptr_t)data,
	};

	return idn_transfer(master, EC_IOC_SOE_WRITE, &i, error_code);
}
EXPORT_SYMBOL_GPL(ecrt_master_write_idn);
