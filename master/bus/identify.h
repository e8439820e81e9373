/* SPDX-License-Identifier: GPL-2.0-only */
/* Explicit device identification: a number that is set at the device, with switches for example. */
#ifndef EC_IDENTIFY_H
#define EC_IDENTIFY_H

#include <linux/types.h>

struct ec_bus;
struct ec_slave;

bool ec_identify_is_due(const struct ec_slave *s);
void ec_identify(struct ec_slave *s);
void ec_identify_all(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n);

#endif
