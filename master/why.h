/* SPDX-License-Identifier: GPL-2.0-only */
/* Why a configured slave is not in OP. */
#ifndef EC_WHY_H
#define EC_WHY_H

#include <linux/types.h>

struct ec_config;

size_t ec_config_why(const struct ec_config *c, char *buf, size_t size);

#endif
