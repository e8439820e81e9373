/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_CONFIG_INFO_H
#define EC_TOOL_CONFIG_INFO_H

#include "dev.h"

int config_info(struct dev *d, const struct ect_config *c, const char *indent);

#endif
