// SPDX-License-Identifier: LGPL-2.1-or-later
/* IP parameters: what the library asks the kernel for. */
#include "session.h"

#include <arpa/inet.h>
#include <errno.h>
#include <string.h>

static const struct ec_ip_params *told(unsigned int which)
{
	const struct ec_ioc_sc_ip *arg = (void *)fake.arg;

	CHECK(fake.last == EC_IOC_SC_IP && arg->config == 5 && !arg->flags);
	CHECK(arg->params.which == which);
	return &arg->params;
}

void eoe(void)
{
	static const unsigned char mac[6] = { 2, 0, 0, 0xec, 1, 7 };
	ec_master_t *m = start();
	ec_slave_config_t *sc = ecrt_master_slave_config(m, 0, 5, 1, 2);
	const struct ec_ip_params *p;
	struct in_addr addr;
	unsigned int calls;

	addr.s_addr = htonl(0xc0a80011);
	CHECK(!ecrt_slave_config_eoe_mac_address(sc, mac));
	p = told(EC_IP_MAC);
	CHECK(!memcmp(p->mac, mac, 6) && !p->ip[0] && !p->name[0]);
	CHECK(!ecrt_slave_config_eoe_ip_address(sc, addr));
	p = told(EC_IP_ADDRESS);
	CHECK(p->ip[0] == 192 && p->ip[1] == 168 && !p->ip[2] && p->ip[3] == 17);
	CHECK(!p->mac[0] && !p->mask[0]);
	CHECK(!ecrt_slave_config_eoe_subnet_mask(sc, addr));
	CHECK(told(EC_IP_MASK)->mask[0] == 192);
	CHECK(!ecrt_slave_config_eoe_default_gateway(sc, addr));
	CHECK(told(EC_IP_GATEWAY)->gateway[3] == 17);
	CHECK(!ecrt_slave_config_eoe_dns_address(sc, addr));
	CHECK(told(EC_IP_DNS)->dns[1] == 168);

	/* 31 characters and the terminator */
	CHECK(!ecrt_slave_config_eoe_hostname(sc, "mixer"));
	CHECK(!strcmp(told(EC_IP_HOSTNAME)->name, "mixer"));
	CHECK(!ecrt_slave_config_eoe_hostname(sc,
					      "a23456789b23456789c23456789d23456"));
	CHECK(!strcmp(told(EC_IP_HOSTNAME)->name,
		      "a23456789b23456789c23456789d234"));

	calls = fake.calls;
	CHECK(ecrt_slave_config_eoe_mac_address(sc, NULL) == -EINVAL);
	CHECK(ecrt_slave_config_eoe_hostname(sc, NULL) == -EINVAL);
	CHECK(fake.calls == calls);
	fake.refuse = EC_IOC_SC_IP;
	fake.err = EBUSY;
	fake.reason = "the master is active";
	CHECK(ecrt_slave_config_eoe_ip_address(sc, addr) == -EBUSY);
	ecrt_release_master(m);
}
