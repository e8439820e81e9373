/* SPDX-License-Identifier: GPL-2.0-only */
/* The worker of a slave. */
#ifndef EC_APPLY_H
#define EC_APPLY_H

struct ec_slave;

void ec_apply(struct ec_slave *s);

#endif
