// SPDX-License-Identifier: LGPL-2.1-or-later
/* What slaves have reported themselves: emergencies that stand. */
#include <stdio.h>
#include <time.h>

#include "../../master/wire/sii.h"
#include "why.h"

static void emergency(struct why *w, const struct ect_slave *s)
{
	const struct ect_emergency *e;
	struct ect_finding *f;
	struct ect_list *list;
	char when[32] = "?";
	struct tm tm;
	time_t t;

	/* the slave was disconnected meanwhile */
	if (ect_emergencies_read(w->h, s->device, NULL, &list))
		return;
	e = ect_list_get(list, ect_list_count(list) - 1);
	if (!e || !(e->code & 0xff00)) {
		ect_list_free(list);
		return;		/* the error is over */
	}
	t = (time_t)(e->time_ns / 1000000000);
	if (gmtime_r(&t, &tm))
		strftime(when, sizeof(when), "%Y-%m-%d %H:%M:%S UTC", &tm);
	f = why_add(w, EMERGENCY, when, e->code, e->text, e->error_register);
	why_remedy(f, EMERGENCY, s->position);
	f->evidence_count = 1;
	f->evidence[0] = e->error_register;
	f->slave = s->position;
	f->code = e->code;
	ect_list_free(list);
}

/**
 * why_emergencies() - slaves whose last emergency is not a reset of errors
 * @w: what is known
 */
void why_emergencies(struct why *w)
{
	for (size_t i = 0; i < w->bus->n; i++)
		if (why_slave(w, i)->mbox_protocols & EC_SII_PROTO_COE)
			emergency(w, why_slave(w, i));
}
