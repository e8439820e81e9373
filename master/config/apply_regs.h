/* SPDX-License-Identifier: GPL-2.0-only */
/* SyncManagers and FMMUs of a slave. */
#ifndef EC_APPLY_REGS_H
#define EC_APPLY_REGS_H

struct ec_config;
struct ec_result;
struct ec_slave;

struct ec_result ec_apply_regs(struct ec_slave *s, const struct ec_config *c);
int ec_apply_clear_fmmus(struct ec_slave *s);
int ec_apply_clear_pdos(struct ec_slave *s);
int ec_apply_clear(struct ec_slave *s);
int ec_apply_op_only_on(struct ec_slave *s);
int ec_apply_op_only_off(struct ec_slave *s);

#endif
