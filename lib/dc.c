// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Distributed clocks. The cyclic calls only note what the next send shall do
 * and read what the last receive has left in the mapped status.
 */
#include "internal.h"

#define NO_DIFFERENCE	0xffffffffu

int ecrt_master_select_reference_clock(ec_master_t *master,
				       ec_slave_config_t *sc)
{
	struct ec_ioc_ref_clock arg = { 0 };
	int ret;

	if (!master)
		return -EINVAL;
	arg.config = sc ? sc->index : EC_UAPI_NONE32;
	ret = ec_ioctl(master, EC_IOC_REF_CLOCK, &arg);
	return ret ? ec_fail_ioctl(master, ret, "select the reference clock") :
		     0;
}

int ecrt_slave_config_dc(ec_slave_config_t *sc, uint16_t assign_activate,
			 uint32_t sync0_cycle, int32_t sync0_shift,
			 uint32_t sync1_cycle, int32_t sync1_shift)
{
	struct ec_ioc_sc_dc arg = {
		.assign_activate = assign_activate,
		.cycle0 = sync0_cycle, .shift0 = sync0_shift,
		.cycle1 = sync1_cycle, .shift1 = sync1_shift,
	};

	if (!sc)
		return -EINVAL;
	arg.config = sc->index;
	return ec_ioctl(sc->master, EC_IOC_SC_DC, &arg);
}

/* 0, or why there is no clock to talk to */
static int check(const ec_master_t *master)
{
	if (!master || !master->active)
		return -EINVAL;
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
	*time = (uint32_t)ec_status_read(master->status->dc_time);
	return 0;
}

int ecrt_master_sync_monitor_queue(ec_master_t *master)
{
	if (!master || !master->active)
		return -EINVAL;
	master->send_flags |= EC_SEND_FLAG_MONITOR;
	return 0;
}

uint32_t ecrt_master_sync_monitor_process(const ec_master_t *master)
{
	if (!master || !master->active)
		return NO_DIFFERENCE;
	return ec_status_read(master->status->dc_monitor);
}
