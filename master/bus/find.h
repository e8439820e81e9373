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
size_t ec_find_text(const struct ec_bus *bus, const struct ec_ioc_address *a, char *buf,
		    size_t size);

#endif
