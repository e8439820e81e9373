// SPDX-License-Identifier: GPL-2.0-only
#include "../bus/slave.h"
#include "../mailbox/eoe.h"
#include "apply.h"
#include "config.h"

/**
 * ec_apply_ip() - write the configured IP parameters
 * @slave: slave in PREOP
 * @c: its configuration
 *
 * Context: Worker. Waits for bus traffic.
 * Return: 0, also when there are none; or as ec_eoe_set_ip(), told already.
 */
int ec_apply_ip(struct ec_slave *slave, const struct ec_config *c)
{
	char why[96];
	u16 result;
	int ret;

	if (!c->ip.which)
		return 0;
	ret = ec_eoe_set_ip(&slave->mbox, &c->ip, &result);
	if (!ret || ret == -ECANCELED || ret == -EINTR)
		return ret;
	if (ret == -EREMOTEIO)
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED,
			      "IP parameters refused: EoE result 0x%04x (%s)", result,
			      ec_eoe_result_text(result));
	else if (ret == -EPROTONOSUPPORT)
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED,
			      "IP parameters configured, but the slave has no EoE; remove ecrt_slave_config_eoe_*()");
	else
		ec_slave_fail(slave, EC_SLAVE_CONFIG_FAILED, "IP parameters failed: %s",
			      ec_mbox_fail_text(ret, "EoE", why, sizeof(why)));
	return ret;
}
