/* SPDX-License-Identifier: GPL-2.0-only */
/* EoE: IP parameters of a slave. */
#ifndef EC_EOE_H
#define EC_EOE_H

#include <linux/types.h>
#include "../wire/eoe.h"

struct ec_config;
struct ec_slave;

int ec_eoe_set_ip(struct ec_slave *slave, const struct ec_eoe_ip *p, u16 *result);
int ec_eoe_get_ip(struct ec_slave *slave, struct ec_eoe_ip *p, u16 *result);
int ec_eoe_apply(struct ec_slave *slave, const struct ec_config *c);

#endif
