/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SLAVE_INFO_H
#define EC_TOOL_SLAVE_INFO_H

#include "dev.h"

void slave_info(unsigned int master, const struct ec_ioc_slave *s);
bool slave_has_dc(const struct ec_ioc_slave *s);
const char *port_type_text(unsigned int type);

#endif
