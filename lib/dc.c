// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Distributed clocks. The cyclic calls only note what the next send shall do
 * and read what the last receive has left in the mapped status.
 */
#include <string.h>

#include "internal.h"

#define NO_DIFFERENCE	0xffffffffu

int ecrt_master_select_reference_clock(ec_master_t *master,
				       ec_slave_config_t *sc)
{
	struct ec_ioc_ref_clock arg = { 0 };
	int ret;

	if (!master)
		return -EINVAL;
	if (sc && sc->master != master)
		return ec_fail(-EINVAL, "select another master's slave as the reference clock");
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

static void fill_dc_state(ec_slave_config_dc_state_t *state,
			  const struct ec_ioc_slave *s, int reference)
{
	static const unsigned int bits[] = { 0, 32, 64 };
	__s64 diff = s->dc_diff;

	memset(state, 0, sizeof(*state));
	if (s->dc_delay_only || !s->dc_supported || s->dc_supported > 2)
		return;
	state->bits = bits[s->dc_supported];
	state->reference = s->position == reference;
	state->set = !!s->dc_set;
	state->in_window = s->dc_set && !s->dc_odd && diff <= EC_UAPI_DC_WINDOW_NS &&
			   diff >= -EC_UAPI_DC_WINDOW_NS;
	state->delay_ns = s->transmission_delay;
	state->offset_ns = s->dc_offset;
	state->difference_ns = s->dc_diff;
}

int ecrt_slave_config_dc_state(const ec_slave_config_t *sc,
			       ec_slave_config_dc_state_t *state)
{
	struct ec_ioc_config config = { 0 };
	struct ec_ioc_master info = { 0 };
	struct ec_ioc_slave slave = { 0 };
	int ret;

	if (!sc || !state)
		return -EINVAL;
	config.index = sc->index;
	ret = ec_ioctl(sc->master, EC_IOC_CONFIG, &config);
	if (ret)
		return ret;
	if (config.slave_position < 0)
		return -ENODEV;
	slave.position = (__u16)config.slave_position;
	ret = ec_ioctl(sc->master, EC_IOC_SLAVE, &slave);
	if (!ret)
		ret = ec_ioctl(sc->master, EC_IOC_MASTER, &info);
	if (!ret)
		fill_dc_state(state, &slave, info.ref_clock);
	return ret;
}
