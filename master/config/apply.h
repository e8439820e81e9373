/* SPDX-License-Identifier: GPL-2.0-only */
/* Configure a slave as the application requires. */
#ifndef EC_APPLY_H
#define EC_APPLY_H

#include <linux/types.h>

struct ec_config;
struct ec_pdo_list;
struct ec_result;
struct ec_slave;

void ec_apply(struct ec_slave *s);

/* apply_regs.c */
struct ec_result ec_apply_regs(struct ec_slave *s, const struct ec_config *c);
int ec_apply_clear_fmmus(struct ec_slave *s);
int ec_apply_clear_pdos(struct ec_slave *s);
int ec_apply_clear(struct ec_slave *s);

/* apply_pdo.c */
struct ec_result ec_apply_pdos(struct ec_slave *s, const struct ec_config *c);
const struct ec_pdo_list *ec_apply_pdos_of(const struct ec_slave *s, const struct ec_config *c,
					   unsigned int sm);

#endif
