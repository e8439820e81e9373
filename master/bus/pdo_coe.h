/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs of the object dictionary of a slave. */
#ifndef EC_PDO_COE_H
#define EC_PDO_COE_H

struct ec_pdo_list;
struct ec_slave;

void ec_slave_clear_warning(struct ec_slave *s);
void ec_slave_read_coe_pdos(struct ec_slave *s);
int ec_slave_read_sm_pdos(struct ec_slave *s, unsigned int sm);
void ec_slave_set_sm_pdos(struct ec_slave *s, unsigned int sm, const struct ec_pdo_list *l);

#endif
