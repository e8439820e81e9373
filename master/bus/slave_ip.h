/* SPDX-License-Identifier: GPL-2.0-only */
/* IP parameters of a slave with EoE. */
#ifndef EC_SLAVE_IP_H
#define EC_SLAVE_IP_H

#include "../wire/eoe.h"

struct ec_slave;

int ec_slave_give_ip(struct ec_slave *s, const struct ec_eoe_ip *p, u16 *result);

#endif
