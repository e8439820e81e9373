// SPDX-License-Identifier: GPL-2.0-only
/* Commands for IP parameters of slaves with EoE. */
#include "../config/config.h"
#include "../mailbox/eoe.h"
#include "ioctl.h"
#include "../session/session.h"
#include "../bus/slave.h"

static_assert(EC_IP_ALL == EC_EOE_ALL && EC_IP_NAME == EC_EOE_NAME);

static void from_uapi(struct ec_eoe_ip *p, const struct ec_ip_params *u)
{
	p->which = u->which;
	memcpy(p->mac, u->mac, sizeof(p->mac));
	memcpy(p->ip, u->ip, sizeof(p->ip));
	memcpy(p->mask, u->mask, sizeof(p->mask));
	memcpy(p->gateway, u->gateway, sizeof(p->gateway));
	memcpy(p->dns, u->dns, sizeof(p->dns));
	memcpy(p->name, u->name, sizeof(p->name));
}

static void to_uapi(struct ec_ip_params *u, const struct ec_eoe_ip *p)
{
	u->which = p->which;
	memcpy(u->mac, p->mac, sizeof(u->mac));
	memcpy(u->ip, p->ip, sizeof(u->ip));
	memcpy(u->mask, p->mask, sizeof(u->mask));
	memcpy(u->gateway, p->gateway, sizeof(u->gateway));
	memcpy(u->dns, p->dns, sizeof(u->dns));
	memcpy(u->name, p->name, sizeof(u->name));
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
				 "slave %u: IP parameters refused: EoE result 0x%04x (%s)", i->position,
				 i->result, ec_eoe_result_text(i->result));
	case -EMSGSIZE:
		return ec_refuse(call, ret,
				 "the mailbox of slave %u is too small for IP parameters, or larger than a datagram",
				 i->position);
	default:
		return ec_ioc_mbox_failed(call, ret, i->position, "EoE", "IP parameters");
	}
}

int ec_ioc_ip_set(struct ec_call *call)
{
	struct ec_ioc_ip *i = call->arg;
	struct ec_eoe_ip p;
	int ret = check_params(call, &i->params);

	if (ret)
		return ret;
	from_uapi(&p, &i->params);
	return failed(call, i, ec_eoe_set_ip(&call->slave->mbox, &p, &i->result));
}

int ec_ioc_ip_get(struct ec_call *call)
{
	struct ec_ioc_ip *i = call->arg;
	struct ec_eoe_ip p;
	int ret = failed(call, i, ec_eoe_get_ip(&call->slave->mbox, &p, &i->result));

	if (!ret)
		to_uapi(&i->params, &p);
	return ret;
}

int ec_ioc_sc_ip(struct ec_call *call)
{
	struct ec_ioc_sc_ip *i = call->arg;
	struct ec_eoe_ip p;
	int ret = check_params(call, &i->params);

	if (ret)
		return ret;
	from_uapi(&p, &i->params);
	return ec_ioc_limit(call, ec_config_ip(call->config, &p));
}

int ec_ioc_config_ip(struct ec_call *call)
{
	const struct ec_startup *u = ec_startup_find(call->config, EC_STARTUP_IP, 0);
	static const struct ec_eoe_ip none;
	struct ec_ioc_sc_ip *i = call->arg;

	to_uapi(&i->params, u ? (const struct ec_eoe_ip *)u->data : &none);
	return 0;
}
