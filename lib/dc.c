// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Distributed clocks. The cyclic calls only note what the next send shall do
 * and read what the last receive has left in the mapped status.
 */
#include <string.h>

#include "ecrt/ecrt_int.h"

#define NO_DIFFERENCE	0xffffffffu

/* 0, or why there is no clock to talk to */
static int check(const ec_master_t *master)
{
	if (!master || !master->active)
		return ec_inactive(master);
	return ec_status_read(master->status->dc_ref) ? 0 : -ENXIO;
}

int ecrt_master_sync_reference_clock_to(ec_master_t *master,
					uint64_t sync_time)
{
	int ret = check(master);

	if (ret)
		return ret;
	master->sync_time = sync_time;
	master->send_flags |= EC_SEND_FLAG_SYNC_REF;
	return 0;
}

int ecrt_master_sync_reference_clock(ec_master_t *master)
{
	return ecrt_master_sync_reference_clock_to(master, master ?
						   master->app_time : 0);
}

int ecrt_master_sync_slave_clocks(ec_master_t *master)
{
	int ret = check(master);

	if (!ret)
		master->send_flags |= EC_SEND_FLAG_SYNC_SLAVES;
	return ret;
}

int ecrt_master_reference_clock_time(const ec_master_t *master,
				     uint32_t *time)
{
	int ret = check(master);

	if (ret)
		return ret;
	if (!time)
		return -EINVAL;
	if (!ec_status_read(master->status->dc_time_valid))
		return -EIO;
	*time = (uint32_t)ec_status_read64(master->status, &master->status->dc_time);
	return 0;
}

int ecrt_master_sync_monitor_queue(ec_master_t *master)
{
	if (!master || !master->active)
		return ec_inactive(master);
	master->send_flags |= EC_SEND_FLAG_MONITOR;
	return 0;
}

uint32_t ecrt_master_sync_monitor_process(const ec_master_t *master)
{
	if (!master || !master->active)
		return NO_DIFFERENCE;
	return ec_status_read(master->status->dc_monitor);
}

void ecrt_master_64bit_reference_clock_time_queue(ec_master_t *master)
{
	if (!check(master))
		master->send_flags |= EC_SEND_FLAG_REF_TIME;
}

int ecrt_master_64bit_reference_clock_time(ec_master_t *master, uint64_t *time)
{
	int ret = check(master);

	if (ret)
		return ret;
	if (!time)
		return -EINVAL;
	if (!ec_status_read(master->status->dc_time64_valid))
		return -EIO;
	*time = ec_status_read64(master->status, &master->status->dc_time64);
	return 0;
}
