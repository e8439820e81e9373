// SPDX-License-Identifier: GPL-2.0-only
/* States and what the master knows without a lock, for applications in the kernel. */
#include "api.h"
#include "../base/once64.h"

int ecrt_master(ec_master_t *master, ec_master_info_t *master_info)
{
	if (!master || !master_info)
		return -EINVAL;
	master_info->slave_count = READ_ONCE(master->bus.n_slaves);
	master_info->link_up = ec_links_seen_up(&master->links);
	master_info->scan_busy = ec_bus_scan_busy(&master->bus);
	master_info->app_time = ec_read64(&master->dc.app_time);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master);

int ecrt_master_scan_progress(ec_master_t *master, ec_master_scan_progress_t *progress)
{
	if (!master || !progress)
		return -EINVAL;
	ec_bus_scan_progress(&master->bus, &progress->scan_index, &progress->slave_count);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_scan_progress);

int ecrt_master_state(const ec_master_t *master, ec_master_state_t *state)
{
	if (!master || !state)
		return -EINVAL;
	state->slaves_responding = READ_ONCE(master->bus.responding);
	state->al_states = READ_ONCE(master->bus.al_states) & 0xf;
	state->link_up = ec_links_any_up(&master->links);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_state);

int ecrt_master_link_state(const ec_master_t *master, unsigned int dev_idx,
			   ec_master_link_state_t *state)
{
	const struct ec_link *link;

	if (!master || !state || dev_idx >= ec_links_n(&master->links))
		return -EINVAL;
	link = ec_links_at(&master->links, dev_idx);
	state->slaves_responding = READ_ONCE(link->slaves);
	state->al_states = READ_ONCE(link->al_states) & 0xf;
	state->link_up = READ_ONCE(link->up);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_link_state);
