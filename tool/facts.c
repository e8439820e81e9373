// SPDX-License-Identifier: GPL-2.0-only
#include "facts.h"

#include <stdio.h>
#include <stdlib.h>

#include "../master/wire/sii.h"

/* an application that exits meanwhile takes its domains along */
static int read_domains(struct dev *d, struct facts *f)
{
	f->domains = calloc(f->m.domain_count + 1, sizeof(*f->domains));
	if (!f->domains)
		return fail("out of memory");
	for (unsigned int i = 0; i < f->m.domain_count; i++) {
		struct ect_domain *dom = &f->domains[i];

		dom->struct_size = sizeof(*dom);
		if (ect_domain_read(d->h, i, dom))
			break;
		f->domain_count++;
	}
	return 0;
}

/* Without an application, and with an older module, there are none. */
static int read_units(struct dev *d, struct facts *f)
{
	for (;;) {
		struct ect_unit *more = realloc(f->units, (f->unit_count + 1) * sizeof(*more));

		if (!more)
			return fail("out of memory");
		f->units = more;
		more[f->unit_count] = (struct ect_unit){ .struct_size = sizeof(*more) };
		if (ect_unit_read(d->h, (unsigned int)f->unit_count, &more[f->unit_count]))
			return 0;
		f->unit_count++;
	}
}

static int read_emergencies(struct dev *d, struct facts *f)
{
	f->emergencies = calloc(f->slaves.n + 1, sizeof(*f->emergencies));
	if (!f->emergencies)
		return fail("out of memory");
	for (size_t i = 0; i < f->slaves.n; i++) {
		const struct ect_slave *s = &f->slaves.v[i];
		struct ect_list *list = NULL;

		if (!(s->mbox_protocols & EC_SII_PROTO_COE) ||
		    ect_emergencies_read(d->h, s->device, &f->emergencies[i], &list))
			f->emergencies[i] = NO_COUNT;
		ect_list_free(list);
	}
	return 0;
}

/**
 * facts_read() - read all that a master shows at a glance
 * @d: open file of the master
 * @f: result, to be freed with facts_free() also after a failure
 *
 * Causes no frame; needs no write permission.
 *
 * Return: 0, or 1 after printing an error.
 */
int facts_read(struct dev *d, struct facts *f)
{
	int err;

	*f = (struct facts){ .master = d->master, .c = { .struct_size = sizeof(f->c) } };
	snprintf(f->release, sizeof(f->release), "%s", ect_version(d->h)->release);
	if (dev_master(d, &f->m) || dev_devices(d, &f->devices) || dev_slaves(d, &f->slaves))
		return 1;
	err = ect_cycle_read(d->h, &f->c);
	if (err)
		return dev_fail(d, err, "Master%u: cannot read cycle statistics", d->master);
	return read_domains(d, f);
}

int facts_read_more(struct dev *d, struct facts *f)
{
	return read_units(d, f) || read_emergencies(d, f);
}

void facts_free(struct facts *f)
{
	ect_list_free(f->devices);
	slaves_free(&f->slaves);
	free(f->domains);
	free(f->units);
	free(f->emergencies);
	*f = (struct facts){ 0 };
}

size_t facts_errors(const struct ect_port *p, u32 counts[FACTS_ERRORS])
{
	const u32 all[FACTS_ERRORS] = { p->invalid, p->receiver, p->forwarded, p->lost_link };

	for (size_t i = 0; i < FACTS_ERRORS; i++)
		counts[i] = all[i];
	return p->type < 2 ? 0 : min((size_t)p->errors_known, (size_t)FACTS_ERRORS);
}

/* the owner of a master, in words */
const char *facts_session(const struct ect_master *m)
{
	switch (m->session) {
	case ECT_SESSION_NONE:
		return "no application";
	case ECT_SESSION_DETACHED:
		return m->left ? "'ethercat run'" : "detached session";
	default:
		return m->owner;
	}
}

const struct ect_device *facts_device(const struct facts *f, size_t i)
{
	return ect_list_get(f->devices, i);
}
