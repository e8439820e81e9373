// SPDX-License-Identifier: GPL-2.0-only
/* Commands for IP parameters of slaves with EoE. */
#include "../config/config.h"
#include "../mailbox/eoe.h"
#include "ioctl.h"
#include "../session/session.h"
#include "../bus/slave.h"
#include "../bus/slave_ip.h"

static_assert(EC_IP_ALL == EC_EOE_ALL && EC_IP_NAME == EC_EOE_NAME);
static_assert(sizeof(struct ec_ip_params) == sizeof(struct ec_eoe_ip));
static_assert(offsetof(struct ec_ip_params, ip) == offsetof(struct ec_eoe_ip, ip));

/* No copy of the parameters of a command: both structures have the same layout. */
static struct ec_eoe_ip *eoe_ip(struct ec_ip_params *p)
{
	return (struct ec_eoe_ip *)p;
}

static int check_params(struct ec_call *call, const struct ec_ip_params *u)
{
	if (!u->which || u->which & ~EC_IP_ALL)
		return ec_refuse(call, -EINVAL, "IP parameters 0x%x; name at least one, of 0x%x",
				 u->which, EC_IP_ALL);
	return 0;
}

static int failed(struct ec_call *call, const struct ec_ioc_ip *i, int ret)
{
	switch (ret) {
	case -EREMOTEIO:
		return ec_refuse(call, -EIO,
				 "slave %u: IP parameters refused: EoE result 0x%04x (%s)",
				 call->slave->position, i->result, ec_eoe_result_text(i->result));
	case -EMSGSIZE:
		return ec_refuse(call, ret,
				 "the mailbox of slave %u is too small for IP parameters, or larger than a datagram",
				 call->slave->position);
	default:
		return ec_ioc_mbox_failed(call, ret, "EoE", "IP parameters");
	}
}

int ec_ioc_ip_set(struct ec_call *call)
{
	struct ec_ioc_ip *i = call->arg;
	int ret = check_params(call, &i->params);
	u16 result = 0;

	if (ret)
		return ret;
	ret = ec_slave_give_ip(call->slave, eoe_ip(&i->params), &result);
	i->result = result;
	return failed(call, i, ret);
}

int ec_ioc_ip_get(struct ec_call *call)
{
	struct ec_ioc_ip *i = call->arg;
	u16 result = 0;
	int ret = ec_eoe_get_ip(&call->slave->mbox, eoe_ip(&i->params), &result);

	i->result = result;
	return failed(call, i, ret);
}

int ec_ioc_sc_ip(struct ec_call *call)
{
	struct ec_ioc_sc_ip *i = call->arg;

	return check_params(call, &i->params) ?:
	       ec_ioc_limit(call, ec_config_ip(call->config, eoe_ip(&i->params)));
}

int ec_ioc_config_ip(struct ec_call *call)
{
	const struct ec_startup *u = ec_startup_find(call->config, EC_STARTUP_IP, 0);
	static const struct ec_eoe_ip none;
	struct ec_ioc_sc_ip *i = call->arg;

	*eoe_ip(&i->params) = u ? *(const struct ec_eoe_ip *)u->data : none;
	return 0;
}
