// SPDX-License-Identifier: GPL-2.0-only OR LGPL-2.1-or-later
/* The configuration of a slave without its PDOs. */
#include "ecrt_int.h"

#define DRIVES	8

int ecrt_slave_config_watchdog(ec_slave_config_t *sc, uint16_t watchdog_divider,
			       uint16_t watchdog_intervals)
{
	struct ec_ioc_sc_watchdog arg = {
		.config = ec_sc_index(sc), .divider = watchdog_divider,
		.intervals = watchdog_intervals,
	};

	return ec_do_sc(sc, EC_IOC_SC_WATCHDOG, &arg, "set watchdog");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_watchdog);

/* Silent on failure: applications call it for slaves without a clock as well. */
int ecrt_slave_config_dc(ec_slave_config_t *sc, uint16_t assign_activate, uint32_t sync0_cycle,
			 int32_t sync0_shift, uint32_t sync1_cycle, int32_t sync1_shift)
{
	struct ec_ioc_sc_dc arg = {
		.config = ec_sc_index(sc), .assign_activate = assign_activate,
		.cycle0 = sync0_cycle, .shift0 = sync0_shift,
		.cycle1 = sync1_cycle, .shift1 = sync1_shift,
	};

	return sc ? ec_command(ec_sc_master(sc), EC_IOC_SC_DC, &arg) : -EINVAL;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_dc);

int ecrt_slave_config_overlapping_pdos(ec_slave_config_t *sc, uint8_t allow_overlapping_pdos)
{
	struct ec_ioc_sc_overlap arg = {
		.config = ec_sc_index(sc), .overlap = !!allow_overlapping_pdos,
	};

	return ec_do_sc(sc, EC_IOC_SC_OVERLAP, &arg, "overlap process data");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_overlapping_pdos);

int ecrt_slave_config_emerg_size(ec_slave_config_t *sc, size_t elements)
{
	struct ec_ioc_sc_emerg arg = {
		.config = ec_sc_index(sc), .count = ec_u32(elements),
	};

	return ec_do_sc(sc, EC_IOC_SC_EMERG, &arg, "keep %zu emergencies", elements);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_emerg_size);

int ecrt_slave_config_flag(ec_slave_config_t *sc, const char *key, int32_t value)
{
	struct ec_ioc_sc_flag arg = { .config = ec_sc_index(sc), .value = value };
	size_t len;

	if (!sc)
		return -EINVAL;
	if (!key)
		return ec_fail_sc(sc, -EINVAL, "set a flag without name");
	len = strnlen(key, sizeof(arg.key));
	if (!len || len == sizeof(arg.key))
		return ec_fail_sc(sc, -EINVAL, "set flag '%.64s'", key);
	memcpy(arg.key, key, len);
	return ec_do_sc(sc, EC_IOC_SC_FLAG, &arg, "set flag '%s'", key);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_flag);

static bool is_al_state(ec_al_state_t state)
{
	return state == EC_AL_STATE_INIT || state == EC_AL_STATE_PREOP ||
	       state == EC_AL_STATE_SAFEOP || state == EC_AL_STATE_OP;
}

int ecrt_slave_config_state_timeout(ec_slave_config_t *sc, ec_al_state_t from_state,
				    ec_al_state_t to_state, unsigned int timeout_ms)
{
	struct ec_ioc_sc_timeout arg = {
		.config = ec_sc_index(sc), .from = (__u8)from_state, .to = (__u8)to_state,
		.timeout_ms = timeout_ms,
	};

	return ec_do_valid(sc, is_al_state(from_state) && is_al_state(to_state),
			   EC_IOC_SC_TIMEOUT, &arg, "set timeout from state %d to %d",
			   (int)from_state, (int)to_state);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_state_timeout);

int ecrt_slave_config_sdo_timeout(ec_slave_config_t *sc, unsigned int timeout_ms)
{
	struct ec_ioc_sc_timeout arg = {
		.flags = EC_SC_TIMEOUT_REPLY, .config = ec_sc_index(sc), .timeout_ms = timeout_ms,
	};

	return ec_do_sc(sc, EC_IOC_SC_TIMEOUT, &arg, "set timeout of replies");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo_timeout);

/* a slave that returns --------------------------------------------------------*/

int ecrt_slave_config_replay(ec_slave_config_t *sc, ec_replay_t what)
{
	struct ec_ioc_sc_replay arg = { .config = ec_sc_index(sc), .mode = what };

	return ec_do_sc(sc, EC_IOC_SC_REPLAY, &arg, "set replay to %d", (int)what);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_replay);

int ecrt_slave_config_replay_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex)
{
	struct ec_ioc_sc_replay arg = {
		.flags = EC_SC_REPLAY_SDO, .config = ec_sc_index(sc), .object = index,
		.subindex = subindex,
	};

	return ec_do_sc(sc, EC_IOC_SC_REPLAY, &arg, "replay SDO 0x%04x:%02x", index, subindex);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_replay_sdo);

int ecrt_slave_config_replay_idn(ec_slave_config_t *sc, uint8_t drive_no, uint16_t idn)
{
	struct ec_ioc_sc_replay arg = {
		.flags = EC_SC_REPLAY_IDN, .config = ec_sc_index(sc), .object = idn,
		.subindex = drive_no,
	};

	return ec_do_valid(sc, drive_no < DRIVES, EC_IOC_SC_REPLAY, &arg,
			   "replay IDN 0x%04x of drive %u", idn, drive_no);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_replay_idn);

int ecrt_slave_config_held(ec_slave_config_t *sc)
{
	struct ec_ioc_hold arg = { .config = ec_sc_index(sc) };
	int ret = ec_do_sc(sc, EC_IOC_HOLD, &arg, "see whether the slave is held");

	return ret ? ret : (int)arg.hold;
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_held);

int ecrt_slave_config_resume(ec_slave_config_t *sc, int hold)
{
	struct ec_ioc_hold arg = {
		.flags = EC_HOLD_FLAG_RESUME, .config = ec_sc_index(sc), .hold = (__u32)hold,
	};

	return ec_do_valid(sc, hold > 0, EC_IOC_HOLD, &arg, "resume hold %d", hold);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_resume);

/* startup SDOs and IDNs ------------------------------------------------------*/

static int add_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex, uint32_t flags,
		   const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_sdo arg = {
		.flags = flags, .config = ec_sc_index(sc), .index = index, .subindex = subindex,
		.size = ec_u32(size), .data = (uintptr_t)data,
	};

	return ec_do_valid(sc, data && size, EC_IOC_SC_SDO, &arg, "store SDO 0x%04x:%02x", index,
			   subindex);
}

int ecrt_slave_config_sdo(ec_slave_config_t *sc, uint16_t index, uint8_t subindex,
			  const uint8_t *data, size_t size)
{
	return add_sdo(sc, index, subindex, 0, data, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo);

int ecrt_slave_config_complete_sdo(ec_slave_config_t *sc, uint16_t index, const uint8_t *data,
				   size_t size)
{
	return add_sdo(sc, index, 0, EC_SDO_FLAG_COMPLETE, data, size);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_complete_sdo);

int ecrt_slave_config_sdo8(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			   uint8_t value)
{
	return add_sdo(sc, sdo_index, sdo_subindex, 0, &value, sizeof(value));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo8);

int ecrt_slave_config_sdo16(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			    uint16_t value)
{
	uint8_t data[2];

	EC_WRITE_U16(data, value);
	return add_sdo(sc, sdo_index, sdo_subindex, 0, data, sizeof(data));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo16);

int ecrt_slave_config_sdo32(ec_slave_config_t *sc, uint16_t sdo_index, uint8_t sdo_subindex,
			    uint32_t value)
{
	uint8_t data[4];

	EC_WRITE_U32(data, value);
	return add_sdo(sc, sdo_index, sdo_subindex, 0, data, sizeof(data));
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_sdo32);

int ecrt_slave_config_idn(ec_slave_config_t *sc, uint8_t drive_no, uint16_t idn,
			  ec_al_state_t state, const uint8_t *data, size_t size)
{
	struct ec_ioc_sc_idn arg = {
		.config = ec_sc_index(sc), .idn = idn, .drive = drive_no, .state = (__u8)state,
		.size = ec_u32(size), .data = (uintptr_t)data,
	};
	bool valid = data && size && drive_no < DRIVES &&
		     (state == EC_AL_STATE_PREOP || state == EC_AL_STATE_SAFEOP);

	return ec_do_valid(sc, valid, EC_IOC_SC_IDN, &arg, "store IDN 0x%04x of drive %u", idn,
			   drive_no);
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_idn);

/* IP parameters of slaves with EoE -------------------------------------------*/

/* A parameter of @size bytes, @at in struct ec_ip_params; the kernel keeps those set before. */
static int set_ip(ec_slave_config_t *sc, __u32 which, size_t at, const void *value, size_t size,
		  const char *what)
{
	struct ec_ioc_sc_ip arg = { .config = ec_sc_index(sc), .params.which = which };

	if (sc && !value)
		return ec_fail_sc(sc, -EINVAL, "set the EoE %s to NULL", what);
	if (sc)
		memcpy((__u8 *)&arg.params + at, value, size);
	return ec_do_sc(sc, EC_IOC_SC_IP, &arg, "set EoE %s", what);
}

int ecrt_slave_config_eoe_mac_address(ec_slave_config_t *sc, const unsigned char *mac_address)
{
	return set_ip(sc, EC_IP_MAC, offsetof(struct ec_ip_params, mac), mac_address, 6,
		      "MAC address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_mac_address);

int ecrt_slave_config_eoe_ip_address(ec_slave_config_t *sc, struct in_addr ip_address)
{
	return set_ip(sc, EC_IP_ADDRESS, offsetof(struct ec_ip_params, ip), &ip_address,
		      sizeof(ip_address), "IP address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_ip_address);

int ecrt_slave_config_eoe_subnet_mask(ec_slave_config_t *sc, struct in_addr subnet_mask)
{
	return set_ip(sc, EC_IP_MASK, offsetof(struct ec_ip_params, mask), &subnet_mask,
		      sizeof(subnet_mask), "subnet mask");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_subnet_mask);

int ecrt_slave_config_eoe_default_gateway(ec_slave_config_t *sc, struct in_addr gateway_address)
{
	return set_ip(sc, EC_IP_GATEWAY, offsetof(struct ec_ip_params, gateway), &gateway_address,
		      sizeof(gateway_address), "default gateway");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_default_gateway);

int ecrt_slave_config_eoe_dns_address(ec_slave_config_t *sc, struct in_addr dns_address)
{
	return set_ip(sc, EC_IP_DNS, offsetof(struct ec_ip_params, dns), &dns_address,
		      sizeof(dns_address), "DNS address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_dns_address);

/* A longer name is cut. */
int ecrt_slave_config_eoe_hostname(ec_slave_config_t *sc, const char *name)
{
	return set_ip(sc, EC_IP_HOSTNAME, offsetof(struct ec_ip_params, name), name,
		      name ? strnlen(name, EC_IP_NAME - 1) : 0, "host name");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_hostname);
