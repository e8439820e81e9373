/* SPDX-License-Identifier: GPL-2.0-only */
/* PDOs of the EEPROM of a slave. */
#ifndef EC_SLAVE_PDO_H
#define EC_SLAVE_PDO_H

#include <linux/types.h>

struct ec_pdo;
struct ec_pdo_list;
struct ec_slave;

int ec_slave_read_pdos(struct ec_slave *slave);
void ec_slave_note_profile(struct ec_slave *slave);
void ec_slave_name_pdos(const struct ec_slave *slave, struct ec_pdo_list *l);
const struct ec_pdo *ec_slave_find_pdo(const struct ec_slave *slave, u16 index);

#endif
