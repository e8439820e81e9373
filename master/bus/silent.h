/* SPDX-License-Identifier: GPL-2.0-only */
/* Slaves of the list that do not reply. */
#ifndef EC_SILENT_H
#define EC_SILENT_H

#include <linux/types.h>

struct ec_slave;

bool ec_slave_set_silent(struct ec_slave *s, const char *why);
bool ec_slave_set_replies(struct ec_slave *s);

#endif
