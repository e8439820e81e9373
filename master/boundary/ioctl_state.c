// SPDX-License-Identifier: GPL-2.0-only
/* Commands about the states of an application's slaves. */
#include "ioctl.h"
#include "../session/session.h"
#include "../config/why.h"

int ec_ioc_config_why(struct ec_call *call)
{
	struct ec_ioc_config_why *i = call->arg;

	i->len = ec_config_why(call->config, i->text, sizeof(i->text));
	return 0;
}

int ec_ioc_slaves_down(struct ec_call *call)
{
	int ret = ec_session_slaves_down(call->session);

	return ret == -EINVAL ? ec_refuse(call, ret, "the master is not active") : ret;
}
