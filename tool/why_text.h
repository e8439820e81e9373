/* SPDX-License-Identifier: GPL-2.0-only */
/* What ect_why() has found, in words. */
#ifndef EC_TOOL_WHY_TEXT_H
#define EC_TOOL_WHY_TEXT_H

#include "dev.h"

/* in the order in which they are shown: faults first, as they explain more */
#define WHY_LEVELS	(ECT_WARNING + 1)

extern const char *const why_level_keys[WHY_LEVELS];
extern const char *const why_level_names[WHY_LEVELS];

const char *why_application(const struct ect_checked *c);

#endif
