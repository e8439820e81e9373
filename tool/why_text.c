// SPDX-License-Identifier: GPL-2.0-only
#include "why_text.h"

const char *const why_level_keys[WHY_LEVELS] = { "fault", "under_way", "warning" };
const char *const why_level_names[WHY_LEVELS] = { "Fault", "Under way", "Warning" };

const char *why_application(const struct ect_checked *c)
{
	switch (c->session) {
	case ECT_SESSION_NONE:
		return "no application: no slave has to be in OP";
	case ECT_SESSION_RESERVED:
		return "an application has reserved the master and not activated it: no slave has to be in OP";
	case ECT_SESSION_DETACHED:
		return "detached session: the kernel runs the cycle, the application has exited";
	default:
		return "application active";
	}
}
