/* SPDX-License-Identifier: GPL-2.0-only */
/* Which slave is meant: by ring position, alias and offset, station address or device number. */
#ifndef EC_FIND_H
#define EC_FIND_H

#include <linux/types.h>
#include "../../include/uapi/ethercat_address.h"

struct ec_bus;
struct ec_slave;

int ec_find_check(const struct ec_ioc_address *a, const char **why);
int ec_find_slave(const struct ec_bus *bus, const struct ec_ioc_address *a, unsigned int *from,
		  struct ec_slave **slave);
unsigned int ec_find_alias(const struct ec_bus *bus, u16 alias);
bool ec_find_place(const struct ec_bus *bus, u16 alias, unsigned int alias_at, u16 position,
		   unsigned int *place);
int ec_find_index(const struct ec_bus *bus, u16 alias, unsigned int alias_at, u16 position,
		  unsigned int total);
struct ec_slave *ec_find_slave_at(const struct ec_bus *bus, u16 alias, u16 position,
				  unsigned int total);
int ec_find_group(const struct ec_slave *slave, u32 *steps, u16 *alias, u16 *distance);
size_t ec_find_text(const struct ec_bus *bus, const struct ec_ioc_address *a, char *buf,
		    size_t size);

#endif
