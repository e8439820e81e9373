// SPDX-License-Identifier: GPL-2.0-only
#include "unit.h"

/* ECT_UNIT_CONTINUE .. */
const char *unit_policy(const struct ect_unit *u)
{
	static const char *const names[] = { "continue", "zero", "hold", "SAFEOP", "stop" };

	return u->policy < ARRAY_SIZE(names) ? names[u->policy] : "?";
}

const char *unit_run(const struct ect_unit *u)
{
	static const char *const names[] = { "starting", "complete", "failed" };

	return u->run < ARRAY_SIZE(names) ? names[u->run] : "?";
}

const char *unit_outputs(const struct ect_unit *u)
{
	static const char *const names[] = { "of the application", "zero", "held" };

	if (u->held && u->outputs == ECT_UNIT_VALUES)
		return "of another application";
	return u->outputs < ARRAY_SIZE(names) ? names[u->outputs] : "?";
}

/* false: the domain is in none */
bool unit_of_domain(struct dev *d, unsigned int domain, struct ect_unit *u)
{
	unsigned int i;

	for (i = 0; ; i++) {
		*u = (struct ect_unit){ .struct_size = sizeof(*u) };
		if (ect_unit_read(d->h, i, u))
			return false;
		if (domain < 64 && u->domains >> domain & 1)
			return true;
	}
}
