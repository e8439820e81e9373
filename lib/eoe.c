// SPDX-License-Identifier: LGPL-2.1-or-later
/* IP parameters of slaves with EoE; the kernel adds them up. */
#include <string.h>

#include "internal.h"

static int set(ec_slave_config_t *sc, struct ec_ioc_sc_ip *arg, __u32 which,
	       const char *what)
{
	int ret;

	if (!sc)
		return -EINVAL;
	arg->config = sc->index;
	arg->params.which = which;
	ret = ec_ioctl(sc->master, EC_IOC_SC_IP, arg);
	return ret ? ec_fail_ioctl(sc->master, ret,
				   "set EoE %s of slave %u:%u", what,
				   sc->alias, sc->position) : 0;
}

static int nothing(const ec_slave_config_t *sc, const char *what)
{
	return ec_fail(-EINVAL, "set the EoE %s of slave %u:%u: NULL argument", what, sc->alias,
		       sc->position);
}

int ecrt_slave_config_eoe_mac_address(ec_slave_config_t *sc,
				      const unsigned char *mac_address)
{
	struct ec_ioc_sc_ip arg = { 0 };

	if (!sc)
		return -EINVAL;
	if (!mac_address)
		return nothing(sc, "MAC address");
	memcpy(arg.params.mac, mac_address, sizeof(arg.params.mac));
	return set(sc, &arg, EC_IP_MAC, "MAC address");
}

int ecrt_slave_config_eoe_ip_address(ec_slave_config_t *sc,
				     struct in_addr ip_address)
{
	struct ec_ioc_sc_ip arg = { 0 };

	memcpy(arg.params.ip, &ip_address, sizeof(arg.params.ip));
	return set(sc, &arg, EC_IP_ADDRESS, "IP address");
}

int ecrt_slave_config_eoe_subnet_mask(ec_slave_config_t *sc,
				      struct in_addr subnet_mask)
{
	struct ec_ioc_sc_ip arg = { 0 };

	memcpy(arg.params.mask, &subnet_mask, sizeof(arg.params.mask));
	return set(sc, &arg, EC_IP_MASK, "subnet mask");
}

int ecrt_slave_config_eoe_default_gateway(ec_slave_config_t *sc,
					  struct in_addr gateway_address)
{
	struct ec_ioc_sc_ip arg = { 0 };

	memcpy(arg.params.gateway, &gateway_address,
	       sizeof(arg.params.gateway));
	return set(sc, &arg, EC_IP_GATEWAY, "default gateway");
}

int ecrt_slave_config_eoe_dns_address(ec_slave_config_t *sc,
				      struct in_addr dns_address)
{
	struct ec_ioc_sc_ip arg = { 0 };

	memcpy(arg.params.dns, &dns_address, sizeof(arg.params.dns));
	return set(sc, &arg, EC_IP_DNS, "DNS address");
}

int ecrt_slave_config_eoe_hostname(ec_slave_config_t *sc, const char *name)
{
	struct ec_ioc_sc_ip arg = { 0 };

	if (!sc)
		return -EINVAL;
	if (!name)
		return nothing(sc, "host name");
	memcpy(arg.params.name, name,
	       strnlen(name, sizeof(arg.params.name) - 1));
	return set(sc, &arg, EC_IP_HOSTNAME, "host name");
}
