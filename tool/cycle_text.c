// SPDX-License-Identifier: GPL-2.0-only
#include "cycle_text.h"

const char *cycle_by(const struct ect_cycle *c)
{
	static const char *const by[] = { "nobody", "application", "kernel" };

	return c->kind < ARRAY_SIZE(by) ? by[c->kind] : "unknown";
}

const char *cycle_state(const struct ect_cycle *c)
{
	if (!c->active)
		return "ended";
	switch (c->state) {
	case ECT_CYCLE_STALLED:
		return "stalled";
	case ECT_CYCLE_STOPPED:
		return "stopped";
	case ECT_CYCLE_WAITING:
		return "waiting";
	default:
		return "running";
	}
}
