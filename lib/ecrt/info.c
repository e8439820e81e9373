// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* Slaves on the bus, what they describe; reasons. */
#include "ecrt_int.h"

#define SM_CONTROL_OUTPUT	0x04	/* direction, register 0x0804 */
#define SM_CONTROL_WATCHDOG	0x40

unsigned int ecrt_version_magic(void)
{
	return ECRT_VERSION_MAGIC;
}
EXPORT_SYMBOL_GPL(ecrt_version_magic);

/* slaves -------------------------------------------------------------------*/

/* Each apart, as two of these arguments do not fit into one stack frame of the kernel. */
static noinline int fill_slave(const ec_master_t *m, uint16_t position,
			       struct ec_ioc_address *device, ec_slave_info_t *info)
{
	struct ec_ioc_slave s = { .slave.position = position };
	int ret = ec_give(m, EC_IOC_SLAVE, &s);

	if (ret)
		return ret;
	memset(info, 0, sizeof(*info));
	info->position = s.position;
	info->vendor_id = s.vendor_id;
	info->product_code = s.product_code;
	info->revision_number = s.revision_number;
	info->serial_number = s.serial_number;
	info->alias = s.alias;
	info->current_on_ebus = s.current_ma;
	info->al_state = s.al_status & 0xff;
	info->error_flag = s.error != EC_SLAVE_OK;
	info->sync_count = s.sm_count;
	device->kind = EC_ADDRESS_DEVICE;
	device->device = s.device;
	return 0;
}

static noinline int fill_name(const ec_master_t *m, const struct ec_ioc_address *device,
			      ec_slave_info_t *info)
{
	struct ec_ioc_slave_names n = { .slave = *device };
	int ret = ec_give(m, EC_IOC_SLAVE_NAMES, &n);

	memcpy(info->name, n.name, sizeof(info->name) - 1);
	return ret;
}

static noinline int fill_port(const ec_master_t *m, const struct ec_ioc_address *device,
			      ec_slave_info_t *info, unsigned int i)
{
	struct ec_ioc_port port = { .slave = *device, .port = i };
	int ret = ec_give(m, EC_IOC_PORT, &port);

	info->ports[i].desc = (ec_slave_port_desc_t)(port.type & 3);
	info->ports[i].link.link_up = port.link_up;
	info->ports[i].link.loop_closed = port.loop_closed;
	info->ports[i].link.signal_detected = port.signal;
	info->ports[i].receive_time = port.receive_time;
	info->ports[i].next_slave = port.next_slave;
	info->ports[i].delay_to_next_dc = port.delay_to_next_dc;
	return ret;
}

/* Information on one slave, which stays the same if another one has its position by now. */
static int get_slave(const ec_master_t *m, uint16_t position, ec_slave_info_t *info)
{
	struct ec_ioc_address device = { 0 };
	int ret = fill_slave(m, position, &device, info);
	unsigned int i;

	ret = ret ? ret : fill_name(m, &device, info);
	for (i = 0; i < EC_MAX_PORTS && !ret; i++)
		ret = fill_port(m, &device, info, i);
	return ret;
}

int ecrt_master_get_slave(ec_master_t *master, uint16_t slave_position,
			  ec_slave_info_t *slave_info)
{
	if (!slave_info)
		return -EINVAL;
	return ec_complain(master, NULL, get_slave(master, slave_position, slave_info), true,
			   "get slave %u", slave_position);
}
EXPORT_SYMBOL_GPL(ecrt_master_get_slave);

static int check(const ec_master_t *master, const void *result, uint8_t sync_index)
{
	if (!master || !result)
		return -EINVAL;
	if (sync_index < EC_MAX_SYNC_MANAGERS)
		return 0;
	return ec_fail(master, -ENOENT, "get SM%u of at most %u", sync_index,
		       EC_MAX_SYNC_MANAGERS);
}

int ecrt_master_get_sync_manager(ec_master_t *master, uint16_t slave_position,
				 uint8_t sync_index, ec_sync_info_t *sync)
{
	struct ec_ioc_sm sm = { .slave.position = slave_position, .sm = sync_index };
	int ret = check(master, sync, sync_index) ?:
		  ec_do(master, EC_IOC_SM, &sm, "get SM%u of slave %u", sync_index,
			slave_position);

	if (ret)
		return ret;
	sync->index = sync_index;
	sync->dir = sm.control & SM_CONTROL_OUTPUT ? EC_DIR_OUTPUT : EC_DIR_INPUT;
	sync->n_pdos = sm.pdo_count;
	sync->pdos = NULL;
	sync->watchdog_mode = sm.control & SM_CONTROL_WATCHDOG ? EC_WD_ENABLE : EC_WD_DISABLE;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_get_sync_manager);

int ecrt_master_get_pdo(ec_master_t *master, uint16_t slave_position, uint8_t sync_index,
			uint16_t pos, ec_pdo_info_t *pdo)
{
	struct ec_ioc_pdo p = {
		.slave.position = slave_position, .sm = sync_index, .pdo_pos = pos,
	};
	int ret = check(master, pdo, sync_index) ?:
		  ec_do(master, EC_IOC_PDO, &p, "get PDO %u of SM%u of slave %u", pos,
			sync_index, slave_position);

	if (ret)
		return ret;
	pdo->index = p.index;
	pdo->n_entries = p.entry_count;
	pdo->entries = NULL;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_get_pdo);

int ecrt_master_get_pdo_entry(ec_master_t *master, uint16_t slave_position, uint8_t sync_index,
			      uint16_t pdo_pos, uint16_t entry_pos, ec_pdo_entry_info_t *entry)
{
	struct ec_ioc_pdo_entry e = {
		.slave.position = slave_position, .sm = sync_index, .pdo_pos = pdo_pos,
		.entry_pos = entry_pos,
	};
	int ret = check(master, entry, sync_index) ?:
		  ec_do(master, EC_IOC_PDO_ENTRY, &e,
			"get entry %u of PDO %u of SM%u of slave %u", entry_pos, pdo_pos,
			sync_index, slave_position);

	if (ret)
		return ret;
	entry->index = e.index;
	entry->subindex = e.subindex;
	entry->bit_length = e.bits;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_master_get_pdo_entry);

/* states -------------------------------------------------------------------*/

/* While active from the status page: no command, no lock. */
int ecrt_slave_config_state(const ec_slave_config_t *sc, ec_slave_config_state_t *state)
{
	struct ec_ioc_config arg = { .index = ec_sc_index(sc) };
	const struct ec_status *st;
	int ret;

	if (!sc || !state)
		return -EINVAL;
	st = ec_active_status(ec_sc_master(sc));
	if (st && arg.index < ec_status_configs(ec_sc_master(sc))) {
		arg.state = ec_status_read(st->configs[arg.index]);
	} else {
		ret = ec_command(ec_sc_master(sc), EC_IOC_CONFIG, &arg);
		if (ret)
			return ret;
	}
	state->online = !!(arg.state & EC_STATUS_SC_ONLINE);
	state->operational = !!(arg.state & EC_STATUS_SC_OP);
	state->al_state = arg.state & EC_STATUS_SC_AL;
	return 0;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_state);

/* clocks -------------------------------------------------------------------*/

/* Apart, as two of these arguments do not fit into one stack frame of the kernel. */
static noinline int ref_clock(const ec_master_t *m, int *position)
{
	struct ec_ioc_master info = { 0 };
	int ret = ec_command(m, EC_IOC_MASTER, &info);

	*position = info.ref_clock;
	return ret;
}

static noinline int dc_of_slave(const ec_master_t *m, __u64 device, int reference,
				ec_slave_config_dc_state_t *state)
{
	static const unsigned int bits[] = { 0, 32, 64 };
	struct ec_ioc_slave s = {
		.slave = { .kind = EC_ADDRESS_DEVICE, .device = device },
	};
	int ret = ec_command(m, EC_IOC_SLAVE, &s);
	__s64 diff = s.dc_diff;

	if (ret)
		return ret;
	memset(state, 0, sizeof(*state));
	if (s.dc_delay_only || !s.dc_supported || s.dc_supported > 2)
		return 0;
	state->bits = bits[s.dc_supported];
	state->reference = s.position == reference;
	state->set = !!s.dc_set;
	state->in_window = s.dc_set && !s.dc_odd && diff <= EC_UAPI_DC_WINDOW_NS &&
			   diff >= -EC_UAPI_DC_WINDOW_NS;
	state->delay_ns = s.transmission_delay;
	state->offset_ns = s.dc_offset;
	state->difference_ns = s.dc_diff;
	return 0;
}

int ecrt_slave_config_dc_state(const ec_slave_config_t *sc, ec_slave_config_dc_state_t *state)
{
	struct ec_ioc_config config = { .index = ec_sc_index(sc) };
	int reference, ret;

	if (!sc || !state)
		return -EINVAL;
	ret = ec_command(ec_sc_master(sc), EC_IOC_CONFIG, &config);
	if (ret)
		return ret;
	if (!config.device)
		return -ENODEV;
	ret = ref_clock(ec_sc_master(sc), &reference);
	if (ret)
		return ret;
	return dc_of_slave(ec_sc_master(sc), config.device, reference, state);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_dc_state);

/* reasons ------------------------------------------------------------------*/

/* One line without its end; returns its full length. */
static int copy_line(char *buf, size_t size, const char *text, size_t room)
{
	size_t len = strnlen(text, room), n;
	const char *end = memchr(text, '\n', len);

	if (end)
		len = (size_t)(end - text);
	if (size) {
		n = len < size ? len : size - 1;
		memcpy(buf, text, n);
		buf[n] = '\0';
	}
	return (int)len;
}

int ecrt_master_reason(const ec_master_t *master, char *buf, size_t size)
{
	struct ec_ioc_reason reason = { 0 };
	int ret;

	if (!master || (!buf && size))
		return -EINVAL;
	ret = ec_command(master, EC_IOC_REASON, &reason);
	return ret ? ret : copy_line(buf, size, reason.text, sizeof(reason.text));
}
EXPORT_SYMBOL_GPL(ecrt_master_reason);

int ecrt_slave_config_reason(const ec_slave_config_t *sc, char *buf, size_t size)
{
	struct ec_ioc_config_why why = { .index = ec_sc_index(sc) };
	int ret;

	if (!sc || (!buf && size))
		return -EINVAL;
	ret = ec_command(ec_sc_master(sc), EC_IOC_CONFIG_WHY, &why);
	return ret ? ret : copy_line(buf, size, why.text, sizeof(why.text));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_reason);
