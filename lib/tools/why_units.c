// SPDX-License-Identifier: LGPL-2.1-or-later
/* Sync units whose outputs are not those of their application. */
#include "../../master/wire/al.h"
#include "why.h"

/* The slaves of a domain are not in OP because of the newest finding. */
static void explain(struct why *w, unsigned int domain)
{
	struct ect_domain dom = { .struct_size = sizeof(dom) };

	if (ect_domain_read(w->h, domain, &dom))
		return;
	for (u32 i = 0; i < dom.fmmu_count; i++) {
		struct ect_fmmu f = { .struct_size = sizeof(f) };

		if (!ect_domain_fmmu(w->h, domain, i, &f) && f.config &&
		    f.config <= w->configs->n &&
		    why_config(w, f.config - 1)->config.al_status == EC_AL_SAFEOP)
			why_explain(w, why_config(w, f.config - 1));
	}
}

static const char *sends(const struct ect_unit *u)
{
	return u->outputs == ECT_UNIT_HELD ? "held" : "zero";
}

static void unit(struct why *w, const struct ect_unit *u)
{
	struct ect_finding *f;

	if (u->down) {
		f = u->policy == ECT_UNIT_STOP ? why_add(w, UNIT_STOPPED, u->name) :
						 why_add(w, UNIT_DOWN, u->name);
		f->evidence_count = 1;
		f->evidence[0] = u->faults;
		for (u32 i = 0; i < w->m.domain_count && i < 64; i++)
			if (u->policy == ECT_UNIT_STOP || u->domains >> i & 1)
				explain(w, i);
	} else if (u->lease_ended) {
		f = why_add(w, UNIT_LEASE, u->name, u->lease_cycles, sends(u));
		f->evidence_count = 1;
		f->evidence[0] = u->lease_cycles;
	} else if (!u->authority) {
		why_add(w, UNIT_NO_AUTHORITY, u->name, sends(u));
	}
}

/**
 * why_units() - sync units that send other outputs than those of the application
 * @w: what is known
 *
 * A unit that has failed, and returns by itself, has the cause of its slaves.
 */
void why_units(struct why *w)
{
	if (!w->m.active)
		return;
	for (unsigned int i = 0; ; i++) {
		struct ect_unit u = { .struct_size = sizeof(u) };

		if (ect_unit_read(w->h, i, &u))
			return;
		if (u.active)
			unit(w, &u);
	}
}
