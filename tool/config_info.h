/* SPDX-License-Identifier: GPL-2.0-only */
#ifndef EC_TOOL_CONFIG_INFO_H
#define EC_TOOL_CONFIG_INFO_H

#include "dev.h"

#define CONFIG_NAME	(ECT_STRING + 8)

const char *config_name(const struct ect_config *c, char *buf, size_t size);
int config_failed(struct dev *d, int err, const struct ect_config *c);
int config_commands(struct dev *d, const struct ect_config *c, const char *in);
int config_info(struct dev *d, const struct ect_config *c, const char *indent);

#endif
