/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_SLAVE_INFO_H
#define EC_TOOL_SLAVE_INFO_H

#include "dev.h"

/* of the list: 'E' failed, '!' not the configured one, '+' fine */
char slave_flag(const struct ect_slave *s);
void slave_state_text(const struct ect_slave *s, char *buf, size_t size);
void slave_info(struct dev *d, const struct ect_slave *s);
bool slave_has_dc(const struct ect_slave *s);
const char *port_type_text(unsigned int type);

#endif
