/* SPDX-License-Identifier: GPL-2.0-only */
/* The way of a slave beyond PREOP. */
#ifndef EC_APPLY_UP_H
#define EC_APPLY_UP_H

struct ec_config;
struct ec_result;
struct ec_slave;

struct ec_result ec_apply_to_safeop(struct ec_slave *s, const struct ec_config *c);
struct ec_result ec_apply_to_op(struct ec_slave *s);

#endif
