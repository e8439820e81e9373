// SPDX-License-Identifier: GPL-2.0-only
/* What slaves have reported themselves: emergencies that stand. */
#include <stdio.h>
#include <time.h>

#include "../master/wire/emergency.h"
#include "../master/wire/sii.h"
#include "why.h"

static void emergency(struct why *w, const struct slave *s)
{
	struct ec_emergency last[EC_EMERGENCIES];
	struct ec_ioc_emergencies i = {
		.slave = s->slave, .size = sizeof(last), .data = (uintptr_t)last,
	};
	const struct ec_emergency *e;
	struct why_finding *f;
	char when[32] = "?";
	struct tm tm;
	time_t t;

	/* a slave that has left */
	if (dev_ioctl(w->d, EC_IOC_EMERGENCIES, &i) || i.size < sizeof(*e) ||
	    i.size > sizeof(last))
		return;
	e = &last[i.size / sizeof(*e) - 1];
	if (!(e->code & 0xff00))
		return;		/* the error is over */
	t = (time_t)(e->time_ns / 1000000000);
	if (gmtime_r(&t, &tm))
		strftime(when, sizeof(when), "%Y-%m-%d %H:%M:%S UTC", &tm);
	f = why_add(w, "emergency", "",
		    "the last CoE emergency stands, since %s: code 0x%04x (%s), error register 0x%02x",
		    when, e->code, ec_emergency_text(e->code, i.profile), e->error_register);
	why_remedy(f, "see this code in the manual of the slave, remove its cause, and reset the error in the slave; all its messages: 'ethercat emergencies -p %u'",
		   s->position);
	f->warning = true;
	f->slave = s->position;
	f->code = e->code;
}

/**
 * why_emergencies() - slaves whose last emergency was not taken back
 * @w: what is known
 */
void why_emergencies(struct why *w)
{
	for (size_t i = 0; i < w->bus.n; i++)
		if (w->bus.v[i].mbox_protocols & EC_SII_PROTO_COE)
			emergency(w, &w->bus.v[i]);
}
