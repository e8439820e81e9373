// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/*
 * Distributed clocks. The cyclic calls only note clock datagrams for the next send, and
 * read the results of the last receive from the status page.
 */
#include "ecrt_int.h"

#define NO_DIFFERENCE	0xffffffffu

/* 0 and the status page, or why there is no reference clock */
static int check(const ec_master_t *master, const struct ec_status **st)
{
	*st = ec_active_status(master);
	if (!*st)
		return ec_inactive(master);
	return ec_status_read((*st)->dc_ref) ? 0 : -ENXIO;
}

int ecrt_master_sync_reference_clock_to(ec_master_t *master, uint64_t sync_time)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret)
		return ret;
	ec_app_cycle(master)->next.sync_time = sync_time;
	ec_app_cycle(master)->next.flags |= EC_SEND_FLAG_SYNC_REF;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_reference_clock_to);

int ecrt_master_sync_reference_clock(ec_master_t *master)
{
	return ecrt_master_sync_reference_clock_to(master, master ?
						   ec_app_cycle(master)->next.app_time : 0);
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_reference_clock);

int ecrt_master_sync_slave_clocks(ec_master_t *master)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (!ret)
		ec_app_cycle(master)->next.flags |= EC_SEND_FLAG_SYNC_SLAVES;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_slave_clocks);

/* 0; -EINVAL @result is NULL; -EIO no frame with the time is received yet; as check() */
static int reference_time(const ec_master_t *master, bool whole, const void *result,
			  uint64_t *time)
{
	const struct ec_status *st;
	int ret = check(master, &st);

	if (ret)
		return ret;
	if (!result)
		return -EINVAL;
	if (!(whole ? ec_status_read(st->dc_time64_valid) : ec_status_read(st->dc_time_valid)))
		return -EIO;
	*time = ec_status_read64(st, whole ? &st->dc_time64 : &st->dc_time);
	return 0;
}

int ecrt_master_reference_clock_time(const ec_master_t *master, uint32_t *time)
{
	uint64_t t;
	int ret = reference_time(master, false, time, &t);

	if (!ret)
		*time = (uint32_t)t;
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_reference_clock_time);

int ecrt_master_sync_monitor_queue(ec_master_t *master)
{
	if (!ec_active_status(master))
		return ec_inactive(master);
	ec_app_cycle(master)->next.flags |= EC_SEND_FLAG_MONITOR;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_monitor_queue);

uint32_t ecrt_master_sync_monitor_process(const ec_master_t *master)
{
	const struct ec_status *st = ec_active_status(master);

	return st ? ec_status_read(st->dc_monitor) : NO_DIFFERENCE;
}
EXPORT_SYMBOL_GPL(ecrt_master_sync_monitor_process);

void ecrt_master_64bit_reference_clock_time_queue(ec_master_t *master)
{
	const struct ec_status *st;

	if (!check(master, &st))
		ec_app_cycle(master)->next.flags |= EC_SEND_FLAG_REF_TIME;
}
EXPORT_SYMBOL_GPL(ecrt_master_64bit_reference_clock_time_queue);

int ecrt_master_64bit_reference_clock_time(ec_master_t *master, uint64_t *time)
{
	return reference_time(master, true, time, time);
}
EXPORT_SYMBOL_GPL(ecrt_master_64bit_reference_clock_time);
