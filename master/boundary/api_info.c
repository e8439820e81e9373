// SPDX-License-Identifier: GPL-2.0-only
/* What the master knows, for applications in the kernel. */
#include <linux/slab.h>
#include "api.h"
#include "../base/once64.h"

int ecrt_master(ec_master_t *master, ec_master_info_t *master_info)
{
	if (!master || !master_info)
		return -EINVAL;
	master_info->slave_count = READ_ONCE(master->bus.n_slaves);
	master_info->link_up = READ_ONCE(master->links.link[0].up);
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

static void fill_ports(ec_slave_info_t *info, const struct ec_ioc_slave *s)
{
	unsigned int p;

	for (p = 0; p < EC_MAX_PORTS; p++) {
		const struct ec_ioc_port *port = &s->ports[p];

		info->ports[p].desc = (ec_slave_port_desc_t)(port->type & 3);
		info->ports[p].link.link_up = port->link_up;
		info->ports[p].link.loop_closed = port->loop_closed;
		info->ports[p].link.signal_detected = port->signal;
		info->ports[p].receive_time = port->receive_time;
		info->ports[p].next_slave = port->next_slave;
		info->ports[p].delay_to_next_dc = port->delay_to_next_dc;
	}
}

int ecrt_master_get_slave(ec_master_t *master, uint16_t slave_position,
			  ec_slave_info_t *slave_info)
{
	struct ec_ioc_slave *s;
	int ret;

	if (!master || !slave_info)
		return -EINVAL;
	s = kzalloc(sizeof(*s), GFP_KERNEL);
	if (!s)
		return -ENOMEM;
	s->position = slave_position;
	ret = ec_command(master, EC_IOC_SLAVE, s);
	if (ret) {
		ec_api_fail(master, ret, "get slave %u", slave_position);
	} else {
		memset(slave_info, 0, sizeof(*slave_info));
		slave_info->position = slave_position;
		slave_info->vendor_id = s->vendor_id;
		slave_info->product_code = s->product_code;
		slave_info->revision_number = s->revision_number;
		slave_info->serial_number = s->serial_number;
		slave_info->alias = s->alias;
		slave_info->current_on_ebus = s->current_ma;
		slave_info->al_state = s->al_status & 0xff;
		slave_info->error_flag = s->error != EC_SLAVE_OK;
		slave_info->sync_count = s->sm_count;
		slave_info->sdo_count = s->sdo_count;
		strscpy(slave_info->name, s->name, sizeof(slave_info->name));
		fill_ports(slave_info, s);
	}
	kfree(s);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_get_slave);

int ecrt_master_state(const ec_master_t *master, ec_master_state_t *state)
{
	if (!master || !state)
		return -EINVAL;
	state->slaves_responding = READ_ONCE(master->bus.responding);
	state->al_states = READ_ONCE(master->bus.al_states) & 0xf;
	state->link_up = READ_ONCE(master->links.link[0].up) || READ_ONCE(master->links.link[1].up);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_state);

int ecrt_master_link_state(const ec_master_t *master, unsigned int dev_idx,
			   ec_master_link_state_t *state)
{
	const struct ec_link *link;

	if (!master || !state || dev_idx >= EC_MAX_LINKS || (dev_idx && !master->links.spec[dev_idx]))
		return -EINVAL;
	link = &master->links.link[dev_idx];
	state->slaves_responding = READ_ONCE(link->slaves);
	state->al_states = READ_ONCE(link->al_states) & 0xf;
	state->link_up = READ_ONCE(link->up);
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_link_state);
