// SPDX-License-Identifier: LGPL-2.1-or-later
/* Slaves on the bus: what they describe, and their objects. */

#include <string.h>

#include "internal.h"

#define SM_CONTROL_OUTPUT	0x04	/* direction, register 0x0804 */
#define SM_CONTROL_WATCHDOG	0x40

/* The kernel says -ENOENT for what is not there, this interface -EINVAL. */
int ec_not_there(int err)
{
	return err == -ENOENT ? -EINVAL : err;
}

static void slave_from_uapi(ec_slave_info_t *info, const struct ec_ioc_slave *s)
{
	const struct ec_ioc_port *port;
	unsigned int i;

	memset(info, 0, sizeof(*info));
	info->position = s->position;
	info->vendor_id = s->vendor_id;
	info->product_code = s->product_code;
	info->revision_number = s->revision_number;
	info->serial_number = s->serial_number;
	info->alias = s->alias;
	info->current_on_ebus = s->current_ma;
	for (i = 0; i < EC_MAX_PORTS; i++) {
		port = &s->ports[i];
		info->ports[i].desc = (ec_slave_port_desc_t)(port->type & 3);
		info->ports[i].link.link_up = port->link_up;
		info->ports[i].link.loop_closed = port->loop_closed;
		info->ports[i].link.signal_detected = port->signal;
		info->ports[i].receive_time = port->receive_time;
		info->ports[i].next_slave = port->next_slave;
		info->ports[i].delay_to_next_dc = port->delay_to_next_dc;
	}
	info->al_state = s->al_status & 0xff;
	info->error_flag = s->error != EC_SLAVE_OK;
	info->sync_count = s->sm_count;
	info->sdo_count = s->sdo_count;
	memcpy(info->name, s->name, sizeof(info->name) - 1);
}

int ecrt_master_get_slave(ec_master_t *master, uint16_t slave_position,
			  ec_slave_info_t *slave_info)
{
	struct ec_ioc_slave s = { .position = slave_position };
	int ret;

	if (!master || !slave_info)
		return -EINVAL;
	ret = ec_ioctl(master, EC_IOC_SLAVE, &s);
	if (ret)
		return ec_fail_ioctl(master, ec_not_there(ret), "get slave %u",
				     slave_position);
	slave_from_uapi(slave_info, &s);
	return 0;
}

static int no_sm(uint8_t sync_index)
{
	return ec_fail(-ENOENT, "get SM%u of at most %u", sync_index,
		       EC_MAX_SYNC_MANAGERS);
}

int ecrt_master_get_sync_manager(ec_master_t *master, uint16_t slave_position,
				 uint8_t sync_index, ec_sync_info_t *sync)
{
	struct ec_ioc_sm sm = { .position = slave_position, .sm = sync_index };
	int ret;

	if (!master || !sync)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return no_sm(sync_index);
	ret = ec_ioctl(master, EC_IOC_SM, &sm);
	if (ret)
		return ec_fail_ioctl(master, ec_not_there(ret),
				     "get SM%u of slave %u", sync_index,
				     slave_position);
	sync->index = sync_index;
	sync->dir = sm.control & SM_CONTROL_OUTPUT ? EC_DIR_OUTPUT
						   : EC_DIR_INPUT;
	sync->n_pdos = sm.pdo_count;
	sync->pdos = NULL;
	sync->watchdog_mode = sm.control & SM_CONTROL_WATCHDOG
		? EC_WD_ENABLE : EC_WD_DISABLE;
	return 0;
}

int ecrt_master_get_pdo(ec_master_t *master, uint16_t slave_position,
			uint8_t sync_index, uint16_t pos, ec_pdo_info_t *pdo)
{
	struct ec_ioc_pdo p = {
		.position = slave_position,
		.sm = sync_index,
		.pdo_pos = pos,
	};
	int ret;

	if (!master || !pdo)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return no_sm(sync_index);
	ret = ec_ioctl(master, EC_IOC_PDO, &p);
	if (ret)
		return ec_fail_ioctl(master, ec_not_there(ret),
				     "get PDO %u of SM%u of slave %u", pos,
				     sync_index, slave_position);
	pdo->index = p.index;
	pdo->n_entries = p.entry_count;
	pdo->entries = NULL;
	return 0;
}

int ecrt_master_get_pdo_entry(ec_master_t *master, uint16_t slave_position,
			      uint8_t sync_index, uint16_t pdo_pos,
			      uint16_t entry_pos, ec_pdo_entry_info_t *entry)
{
	struct ec_ioc_pdo_entry e = {
		.position = slave_position,
		.sm = sync_index,
		.pdo_pos = pdo_pos,
		.entry_pos = entry_pos,
	};
	int ret;

	if (!master || !entry)
		return -EINVAL;
	if (sync_index >= EC_MAX_SYNC_MANAGERS)
		return no_sm(sync_index);
	ret = ec_ioctl(master, EC_IOC_PDO_ENTRY, &e);
	if (ret)
		return ec_fail_ioctl(master, ec_not_there(ret),
				     "get entry %u of PDO %u of SM%u of slave %u",
				     entry_pos, pdo_pos, sync_index,
				     slave_position);
	entry->index = e.index;
	entry->subindex = e.subindex;
	entry->bit_length = e.bits;
	return 0;
}

static int download(ec_master_t *master, uint16_t slave_position,
		    uint16_t index, uint8_t subindex, uint32_t flags,
		    const uint8_t *data, size_t data_size,
		    uint32_t *abort_code)
{
	struct ec_ioc_sdo sdo = {
		.flags = flags,
		.position = slave_position,
		.index = index,
		.subindex = subindex,
		.size = (uint32_t)data_size,
		.data = (uintptr_t)data,
	};
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (!master)
		return -EINVAL;
	if (!data || !data_size || data_size > UINT32_MAX)
		return ec_fail(-EINVAL,
			       "download %zu bytes to SDO 0x%04x:%02x of slave %u",
			       data_size, index, subindex, slave_position);
	ret = ec_ioctl(master, EC_IOC_SDO_DOWNLOAD, &sdo);
	if (!ret)
		return 0;
	if (ret == -EIO && abort_code)
		*abort_code = sdo.abort_code;
	return ec_fail_ioctl(master, ec_not_there(ret),
			     "download SDO 0x%04x:%02x to slave %u", index,
			     subindex, slave_position);
}

int ecrt_master_sdo_download(ec_master_t *master, uint16_t slave_position,
			     uint16_t index, uint8_t subindex,
			     const uint8_t *data, size_t data_size,
			     uint32_t *abort_code)
{
	return download(master, slave_position, index, subindex, 0, data,
			data_size, abort_code);
}

int ecrt_master_sdo_download_complete(ec_master_t *master,
				      uint16_t slave_position, uint16_t index,
				      const uint8_t *data, size_t data_size,
				      uint32_t *abort_code)
{
	return download(master, slave_position, index, 0, EC_SDO_FLAG_COMPLETE,
			data, data_size, abort_code);
}

static int upload(ec_master_t *master, uint16_t slave_position,
		  uint16_t index, uint8_t subindex, uint32_t flags,
		  uint8_t *target, size_t target_size, size_t *result_size,
		  uint32_t *abort_code)
{
	struct ec_ioc_sdo sdo = {
		.flags = flags,
		.position = slave_position,
		.index = index,
		.subindex = subindex,
		.size = target_size > UINT32_MAX ? UINT32_MAX
						 : (uint32_t)target_size,
		.data = (uintptr_t)target,
	};
	int ret;

	if (abort_code)
		*abort_code = 0;
	if (!master)
		return -EINVAL;
	if (!result_size || (!target && target_size))
		return ec_fail(-EINVAL,
			       "upload SDO 0x%04x:%02x from slave %u to nowhere",
			       index, subindex, slave_position);
	ret = ec_ioctl(master, EC_IOC_SDO_UPLOAD, &sdo);
	if (!ret) {
		*result_size = sdo.size;
		return 0;
	}
	if (ret == -EIO && abort_code)
		*abort_code = sdo.abort_code;
	return ec_fail_ioctl(master, ec_not_there(ret),
			     "upload SDO 0x%04x:%02x from slave %u", index,
			     subindex, slave_position);
}

int ecrt_master_sdo_upload(ec_master_t *master, uint16_t slave_position,
			   uint16_t index, uint8_t subindex, uint8_t *target,
			   size_t target_size, size_t *result_size,
			   uint32_t *abort_code)
{
	return upload(master, slave_position, index, subindex, 0, target,
		      target_size, result_size, abort_code);
}

int ecrt_master_sdo_upload_complete(ec_master_t *master,
				    uint16_t slave_position, uint16_t index,
				    uint8_t *target, size_t target_size,
				    size_t *result_size, uint32_t *abort_code)
{
	return upload(master, slave_position, index, 0, EC_SDO_FLAG_COMPLETE,
		      target, target_size, result_size, abort_code);
}
