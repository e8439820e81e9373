/* SPDX-License-Identifier: GPL-2.0-only */
/* A cycle in words. */
#ifndef EC_TOOL_CYCLE_TEXT_H
#define EC_TOOL_CYCLE_TEXT_H

#include "dev.h"

const char *cycle_by(const struct ect_cycle *c);
const char *cycle_state(const struct ect_cycle *c);

#endif
