/* SPDX-License-Identifier: GPL-2.0-only */
/* The mailbox that the EEPROM of a slave describes. */
#ifndef EC_SLAVE_MBOX_H
#define EC_SLAVE_MBOX_H

#include <linux/types.h>

struct ec_slave;

void ec_slave_settle_mbox(struct ec_slave *s);
void ec_slave_mbox_text(const struct ec_slave *s, char *buf, size_t size);

#endif
