// SPDX-License-Identifier: GPL-2.0-only
/*
 * Distributed clocks for applications in the kernel: the calls note what the next
 * send shall do and read what the last receive has left.
 */
#include "api.h"
#include "../base/once64.h"

#define NO_DIFFERENCE	0xffffffffu

/* 0, or why there is no clock to talk to */
static int check(const struct ec_master *m, const struct ec_status **st)
{
	const struct ec_session *s = m ? ec_api_session(m->api) : NULL;

	if (!s)
		return -EINVAL;
	*st = s->cycle.shared->status;
	return READ_ONCE((*st)->dc_ref) ? 0 : -ENXIO;
}

int ecrt_master_sync_reference_clock_to(ec_master_t *master, uint64_t sync_time)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret)
		return ret;
	master->api->next.sync_time = sync_time;
	master->api->next.flags |= EC_SEND_FLAG_SYNC_REF;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_reference_clock_to);

int ecrt_master_sync_reference_clock(ec_master_t *master)
{
	return ecrt_master_sync_reference_clock_to(master, master ? master->api->app_time : 0);
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_reference_clock);

int ecrt_master_sync_slave_clocks(ec_master_t *master)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (!ret)
		master->api->next.flags |= EC_SEND_FLAG_SYNC_SLAVES;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_slave_clocks);

int ecrt_master_reference_clock_time(const ec_master_t *master, uint32_t *time)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret)
		return ret;
	if (!time)
		return -EINVAL;
	if (!READ_ONCE(st->dc_time_valid))
		return -EIO;
	*time = (u32)READ_ONCE(st->dc_time);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_reference_clock_time);

int ecrt_master_sync_monitor_queue(ec_master_t *master)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret == -EINVAL)
		return ret;
	master->api->next.flags |= EC_SEND_FLAG_MONITOR;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_monitor_queue);

uint32_t ecrt_master_sync_monitor_process(const ec_master_t *master)
{
	const struct ec_status *st;

	return check(master, &st) == -EINVAL ? NO_DIFFERENCE : READ_ONCE(st->dc_monitor);
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_monitor_process);

void ecrt_master_64bit_reference_clock_time_queue(ec_master_t *master)
{
	const struct ec_status *st;

	if (!check(master, &st))
		master->api->next.flags |= EC_SEND_FLAG_REF_TIME;
}
EXPORT_SYMBOL_GPL(ecrt_master_64bit_reference_clock_time_queue);

int ecrt_master_64bit_reference_clock_time(ec_master_t *master, uint64_t *time)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret)
		return ret;
	if (!time)
		return -EINVAL;
	if (!READ_ONCE(st->dc_time64_valid))
		return -EIO;
	ec_status_copy(st, time, &st->dc_time64, sizeof(*time));
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_64bit_reference_clock_time);
