// SPDX-License-Identifier: LGPL-2.1-or-later
/* States of master, links and slaves: from the mapped status while active. */
#include "ecrt/ecrt_int.h"

int ecrt_master(ec_master_t *master, ec_master_info_t *master_info)
{
	struct ec_ioc_master info = { 0 };
	int ret;

	if (!master || !master_info)
		return -EINVAL;
	ret = ec_do(master, EC_IOC_MASTER, &info, "get master %u", master->index);
	if (ret)
		return ret;
	master_info->slave_count = info.slave_count;
	master_info->link_up = info.links_up & 1;
	master_info->scan_busy = info.scan_busy;
	master_info->app_time = info.app_time;
	return 0;
}

int ecrt_master_scan_progress(ec_master_t *master, ec_master_scan_progress_t *progress)
{
	struct ec_ioc_master info = { 0 };
	int ret;

	if (!master || !progress)
		return -EINVAL;
	ret = ec_do(master, EC_IOC_MASTER, &info, "get scan progress of master %u", master->index);
	if (ret)
		return ret;
	progress->slave_count = info.scan_slaves;
	progress->scan_index = info.scan_index;
	return 0;
}

int ecrt_master_state(const ec_master_t *master, ec_master_state_t *state)
{
	struct ec_ioc_master info = { 0 };
	const struct ec_status *st;
	int ret;

	if (!master || !state)
		return -EINVAL;
	if (master->active) {
		st = master->status;
		state->slaves_responding = ec_status_read(st->slaves_responding);
		state->al_states = ec_status_read(st->al_states) & 0xf;
		state->link_up = !!ec_status_read(st->link_up);
		return 0;
	}
	ret = ec_command(master, EC_IOC_MASTER, &info);
	if (ret)
		return ret;
	state->slaves_responding = info.slaves_responding;
	state->al_states = info.al_states & 0xf;
	state->link_up = !!info.links_up;
	return 0;
}

int ecrt_master_link_state(const ec_master_t *master, unsigned int dev_idx,
			   ec_master_link_state_t *state)
{
	struct ec_ioc_device dev = { .index = dev_idx };
	int ret;

	if (!master || !state)
		return -EINVAL;
	/* for another number the kernel reports the cause */
	if (master->active && dev_idx < ec_status_read(master->status->link_count)) {
		const struct ec_status_link *link = &master->status->links[dev_idx];

		state->slaves_responding = ec_status_read(link->slaves_responding);
		state->al_states = ec_status_read(link->al_states) & 0xf;
		state->link_up = !!ec_status_read(link->link_up);
		return 0;
	}
	ret = ec_do(master, EC_IOC_DEVICE, &dev, "get state of link %u", dev_idx);
	if (ret)
		return ret;
	state->slaves_responding = dev.slaves;
	state->al_states = dev.al_states & 0xf;
	state->link_up = !!dev.link_up;
	return 0;
}
