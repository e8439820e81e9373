// SPDX-License-Identifier: LGPL-2.1-or-later
/* The slaves of a machine as ecrt.h gives them, in the form of a bus file. */
#include <errno.h>

#include "load.h"

static int read_pdo(struct load *l, struct ecb_slave *to, uint16_t position, uint8_t sm,
		    uint16_t pos)
{
	struct ecb_pdo *pdo = ecb_pdo_add(l->read, to);
	ec_pdo_info_t p;
	int ret;

	if (!pdo)
		return load_no_memory(l);
	ret = ecrt_master_get_pdo(l->m, position, sm, pos, &p);
	pdo->index = p.index;
	pdo->sm = sm;
	for (unsigned int i = 0; !ret && i < p.n_entries; i++) {
		ec_pdo_entry_info_t e;
		struct ecb_entry *entry;

		ret = ecrt_master_get_pdo_entry(l->m, position, sm, pos, (uint16_t)i, &e);
		if (ret || !e.bit_length)
			continue;
		entry = ecb_entry_add(l->read, pdo);
		if (!entry)
			return load_no_memory(l);
		entry->object = e.index ? (uint32_t)e.index << 8 | e.subindex : 0;
		entry->bits = e.bit_length;
	}
	return ret ? load_failed(l, 0, ret, "cannot read the PDOs of slave %u", position) : 0;
}

static int read_slave(struct load *l, struct ecb_master *m, const ec_slave_info_t *info)
{
	struct ecb_slave *to = ecb_slave_add(l->read, m);
	int ret = to ? 0 : load_no_memory(l);

	if (ret)
		return ret;
	to->vendor = info->vendor_id;
	to->product = info->product_code;
	to->revision = info->revision_number;
	to->serial = info->serial_number;
	to->alias = info->alias;
	to->type = ecb_bus_text(l->read, info->name);
	for (unsigned int sm = 0; sm < info->sync_count && !ret; sm++) {
		ec_sync_info_t s;

		ret = ecrt_master_get_sync_manager(l->m, info->position, (uint8_t)sm, &s);
		if (ret)
			return load_failed(l, 0, ret, "cannot read SM%u of slave %u", sm,
					   info->position);
		for (unsigned int i = 0; i < s.n_pdos && !ret; i++)
			ret = read_pdo(l, to, info->position, (uint8_t)sm, (uint16_t)i);
	}
	return ret;
}

/* of the slaves that the master reaches through this one */
static void read_ports(struct ecb_master *m, const ec_slave_info_t *info)
{
	for (unsigned int port = 0; port < EC_MAX_PORTS; port++) {
		unsigned int next = info->ports[port].next_slave;

		if (next <= info->position || next >= m->slave_count)
			continue;
		m->slaves[next]->parent = m->slaves[info->position]->name;
		m->slaves[next]->port = (uint8_t)port;
	}
}

int load_read_machine(struct load *l)
{
	struct ecb_master *m;
	ec_slave_info_t info;
	ec_master_info_t all;
	int ret;

	l->read = ecb_bus_new();
	m = l->read ? ecb_master_add(l->read) : NULL;
	if (!m)
		return load_no_memory(l);
	l->found = m;
	ret = ecrt_master(l->m, &all);
	if (ret)
		return load_failed(l, 0, ret, "cannot read the slaves of the master");
	for (unsigned int i = 0; i < all.slave_count && !ret; i++) {
		ret = ecrt_master_get_slave(l->m, (uint16_t)i, &info);
		ret = ret ? load_failed(l, 0, ret, "cannot read slave %u", i) :
			read_slave(l, m, &info);
	}
	/* names, to which ports refer */
	if (!ret)
		ret = ecb_bus_finish(l->read, "machine", l->e);
	for (unsigned int i = 0; i < all.slave_count && !ret; i++) {
		ret = ecrt_master_get_slave(l->m, (uint16_t)i, &info);
		if (ret)
			return load_failed(l, 0, ret, "cannot read slave %u", i);
		read_ports(m, &info);
	}
	return ret;
}
