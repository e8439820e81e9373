/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs of a slave by its EEPROM and its object dictionary. */
#ifndef EC_SLAVE_PDO_H
#define EC_SLAVE_PDO_H

#include <linux/types.h>

struct ec_pdo;
struct ec_pdo_list;
struct ec_slave;

int ec_slave_read_pdos(struct ec_slave *slave);
void ec_slave_name_pdos(const struct ec_slave *slave, struct ec_pdo_list *l);
const struct ec_pdo *ec_slave_find_pdo(const struct ec_slave *slave, u16 index);
bool ec_slave_pdos_pending(const struct ec_slave *s);
void ec_slave_clear_warning(struct ec_slave *s);
void ec_slave_read_coe_pdos(struct ec_slave *s);
int ec_slave_read_sm_pdos(struct ec_slave *s, unsigned int sm);
void ec_slave_set_sm_pdos(struct ec_slave *s, unsigned int sm, const struct ec_pdo_list *l);

#endif
