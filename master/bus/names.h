/* SPDX-License-Identifier: GPL-2.0-only */
/* Names from the object dictionary of a slave, for what its EEPROM has no name for. */
#ifndef EC_NAMES_H
#define EC_NAMES_H

#include <linux/types.h>
#include "ethercat.h"

struct ec_slave;

#define EC_MAX_NAMES	256	/* of one slave; PDOs and their entries */
#define EC_NAME_OBJECT	0x100	/* instead of a subindex: the whole object */

/**
 * struct ec_od_name - one name
 * @index: object
 * @sub: subindex, or EC_NAME_OBJECT
 * @text: UTF-8; empty: the slave has none
 */
struct ec_od_name {
	u16 index;
	u16 sub;
	char text[EC_UAPI_STRING];
};

/**
 * struct ec_names - names of a slave
 * @n: entries in @v
 * @v: they are added, and stay
 */
struct ec_names {
	unsigned int n;
	struct ec_od_name *v;
};

const char *ec_names_find(const struct ec_slave *s, u16 index, u16 sub);
bool ec_names_pending(const struct ec_slave *s);
void ec_names_read(struct ec_slave *s);
void ec_names_free(struct ec_slave *s);

#endif
