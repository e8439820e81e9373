/* SPDX-License-Identifier: GPL-2.0-only */
/* Configure a slave as the application requires. */
#ifndef EC_APPLY_H
#define EC_APPLY_H

#include <linux/types.h>

struct ec_config;
struct ec_pdo_list;
struct ec_slave;

/* Note why a slave cannot be configured: @ret, returned, and a text. */
#define ec_apply_fail(s, ret, cause, ...) \
	({ ec_slave_fail(s, EC_SLAVE_CONFIG_FAILED, cause, __VA_ARGS__); (ret); })

void ec_apply(struct ec_slave *s);

/* apply_regs.c */
int ec_apply_regs(struct ec_slave *s, const struct ec_config *c);
int ec_apply_clear_fmmus(struct ec_slave *s);
int ec_apply_clear_pdos(struct ec_slave *s);
int ec_apply_clear(struct ec_slave *s);

/* apply_pdo.c */
int ec_apply_pdos(struct ec_slave *s, const struct ec_config *c);
const struct ec_pdo_list *ec_apply_pdos_of(const struct ec_slave *s, const struct ec_config *c,
					   unsigned int sm);

#endif
