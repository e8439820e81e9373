// SPDX-License-Identifier: GPL-2.0-only
/* IP parameters of slaves with EoE, for applications in the kernel. */
#include "api.h"

static int set(ec_slave_config_t *sc, struct ec_ioc_sc_ip *i, u32 which, const char *what)
{
	int ret;

	if (!sc)
		return -EINVAL;
	i->config = ec_api_config(sc)->index;
	i->params.which = which;
	ret = ec_command(ec_api_master(sc), EC_IOC_SC_IP, i);
	return ret ? ec_api_fail_sc(sc, ret, "set the %s", what) : 0;
}

int ecrt_slave_config_eoe_mac_address(ec_slave_config_t *sc, const unsigned char *mac_address)
{
	struct ec_ioc_sc_ip i = { 0 };

	if (!mac_address)
		return -EINVAL;
	memcpy(i.params.mac, mac_address, sizeof(i.params.mac));
	return set(sc, &i, EC_IP_MAC, "MAC address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_mac_address);

int ecrt_slave_config_eoe_ip_address(ec_slave_config_t *sc, struct in_addr ip_address)
{
	struct ec_ioc_sc_ip i = { 0 };

	memcpy(i.params.ip, &ip_address, sizeof(i.params.ip));
	return set(sc, &i, EC_IP_ADDRESS, "IP address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_ip_address);

int ecrt_slave_config_eoe_subnet_mask(ec_slave_config_t *sc, struct in_addr subnet_mask)
{
	struct ec_ioc_sc_ip i = { 0 };

	memcpy(i.params.mask, &subnet_mask, sizeof(i.params.mask));
	return set(sc, &i, EC_IP_MASK, "subnet mask");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_subnet_mask);

int ecrt_slave_config_eoe_default_gateway(ec_slave_config_t *sc, struct in_addr gateway_address)
{
	struct ec_ioc_sc_ip i = { 0 };

	memcpy(i.params.gateway, &gateway_address, sizeof(i.params.gateway));
	return set(sc, &i, EC_IP_GATEWAY, "default gateway");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_default_gateway);

int ecrt_slave_config_eoe_dns_address(ec_slave_config_t *sc, struct in_addr dns_address)
{
	struct ec_ioc_sc_ip i = { 0 };

	memcpy(i.params.dns, &dns_address, sizeof(i.params.dns));
	return set(sc, &i, EC_IP_DNS, "DNS address");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_dns_address);

int ecrt_slave_config_eoe_hostname(ec_slave_config_t *sc, const char *name)
{
	struct ec_ioc_sc_ip i = { 0 };

	if (!name)
		return -EINVAL;
	/* a longer one is cut */
	strscpy(i.params.name, name, sizeof(i.params.name));
	return set(sc, &i, EC_IP_HOSTNAME, "host name");
}
EXPORT_SYMBOL_GPL(ecrt_slave_config_eoe_hostname);
