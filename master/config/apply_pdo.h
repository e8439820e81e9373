/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs that a slave must have. */
#ifndef EC_APPLY_PDO_H
#define EC_APPLY_PDO_H

struct ec_config;
struct ec_pdo_list;
struct ec_result;
struct ec_slave;

struct ec_result ec_apply_pdos(struct ec_slave *s, const struct ec_config *c);
const struct ec_pdo_list *ec_apply_pdos_of(const struct ec_slave *s, const struct ec_config *c,
					   unsigned int sm);

#endif
