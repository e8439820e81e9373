/* SPDX-License-Identifier: GPL-2.0-only */
/* EoE: IP parameters of a slave. */
#ifndef EC_EOE_H
#define EC_EOE_H

#include <linux/types.h>
#include "../wire/eoe.h"

struct ec_mbox;

int ec_eoe_set_ip(struct ec_mbox *mb, const struct ec_eoe_ip *p, u16 *result);
int ec_eoe_give_ip(struct ec_mbox *mb, const struct ec_eoe_ip *p, const u8 mac[6], u16 *result);
int ec_eoe_get_ip(struct ec_mbox *mb, struct ec_eoe_ip *p, u16 *result);

#endif
