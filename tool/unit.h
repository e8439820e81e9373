/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units of the application, in words. */
#ifndef EC_TOOL_UNIT_H
#define EC_TOOL_UNIT_H

#include "dev.h"

const char *unit_policy(const struct ect_unit *u);
const char *unit_run(const struct ect_unit *u);
const char *unit_outputs(const struct ect_unit *u);
bool unit_of_domain(struct dev *d, unsigned int domain, struct ect_unit *u);

#endif
