// SPDX-License-Identifier: GPL-2.0-only
/* Configurations without slave: lost behind a cable, missing, different, at another position. */
#include <stdio.h>

#include "why.h"

static bool absent(const struct why_config *c)
{
	return c->c.slave_position < 0 && !c->finding;
}

static bool same_device(const struct why_config *c, const struct slave *s)
{
	return s->vendor_id == c->c.vendor_id && s->product_code == c->c.product_code;
}

static bool at_position(const struct why_config *c)
{
	return absent(c) && !c->c.alias && (c->cause.kind == EC_CAUSE_NO_SLAVE ||
					    c->cause.kind == EC_CAUSE_DIFFERENT);
}

/* Slaves that were lost together have the same place; one cable explains all of them. */
static void lost_at(struct why *w, unsigned int position, unsigned int port, const char *text)
{
	const struct slave *s = position < w->bus.n ? &w->bus.v[position] : NULL;
	bool up = s && s->ports[port & 3].link_up;
	struct why_finding *f;
	char name[96];

	why_slave_name(w, position, name, sizeof(name));
	if (w->m.scan_busy || w->m.slaves_responding > w->bus.n) {
		/* which of several places is repaired shows when the scan has ended */
		f = why_scan(w);
		if (f->slave != WHY_NONE)
			f = why_add(w, "scan", WHY_SCAN_REMEDY, "%s", "");
		snprintf(f->what, sizeof(f->what),
			 "slaves reply again, %u of %u are read; the scan shows whether those behind port %u of %s reply as well; lost before: %s",
			 w->m.scan_index, w->m.scan_slaves, port, name, text);
		f->wait = true;
	} else {
		f = why_add(w, "cable",
			    "check the cable or contact behind this port, and the power of the next slave",
			    "no slave behind port %u of %s, link %s; lost: %s", port, name,
			    up ? "up" : "down", text);
	}
	f->slave = (int)position;
	f->port = (int)port;
	for (size_t i = 0; i < w->n_configs; i++) {
		const struct ec_cause *cause = &w->configs[i].cause;

		if (cause->kind == EC_CAUSE_LOST && cause->position == position &&
		    cause->port == port)
			w->configs[i].finding = (size_t)(f - w->f) + 1;
	}
}

/*
 * Behind lost slaves the positions are not those that are configured: what another
 * configuration finds there says nothing before the cable is repaired.
 */
static void moved_up(struct why *w, size_t cable)
{
	unsigned int from = ~0u;

	for (size_t i = 0; i < w->n_configs; i++)
		if (w->configs[i].cause.kind == EC_CAUSE_LOST && !w->configs[i].c.alias)
			from = min(from, w->configs[i].c.position);
	for (size_t i = 0; i < w->n_configs; i++)
		if (at_position(&w->configs[i]) && w->configs[i].c.position > from)
			w->configs[i].finding = cable;
}

/* what was lost behind slaves that are lost as well follows from their cable */
static void lost(struct why *w)
{
	size_t first = 0;

	for (size_t i = 0; i < w->n_configs; i++) {
		const struct why_config *c = &w->configs[i];

		if (!absent(c) || c->cause.kind != EC_CAUSE_LOST ||
		    c->cause.position == EC_UAPI_NONE16)
			continue;
		lost_at(w, c->cause.position, c->cause.port, c->text);
		first = first ? first : w->configs[i].finding;
	}
	for (size_t i = 0; i < w->n_configs; i++) {
		struct why_config *c = &w->configs[i];

		if (!absent(c) || c->cause.kind != EC_CAUSE_LOST)
			continue;
		if (!first) {
			why_add(w, "cable", "check cables and power up to the first lost slave",
				"%s", c->text)->config = (int)i;
			first = w->n;
		}
		c->finding = first;
	}
	if (first)
		moved_up(w, first);
}

/* the configuration of the smallest ring position whose slave is not there, or NULL */
static struct why_config *first_absent(struct why *w)
{
	struct why_config *first = NULL;

	for (size_t i = 0; i < w->n_configs; i++)
		if (at_position(&w->configs[i]) &&
		    (!first || w->configs[i].c.position < first->c.position))
			first = &w->configs[i];
	return first;
}

static unsigned int last_position(const struct why *w)
{
	unsigned int last = 0;

	for (size_t i = 0; i < w->n_configs; i++)
		if (!w->configs[i].c.alias)
			last = max(last, w->configs[i].c.position);
	return last;
}

/*
 * Do all slaves from @from on fit when they are looked for @gap positions earlier, but not all
 * where they are configured? Then those in between are missing.
 */
static bool shifted(const struct why *w, unsigned int from, unsigned int gap)
{
	bool any = from >= w->bus.n;

	/* more than the whole bus has: a match is chance, unless the bus ends where it should */
	if (!any && gap > w->bus.n && last_position(w) + 1 - gap != w->bus.n)
		return false;
	for (size_t i = 0; i < w->n_configs; i++) {
		const struct why_config *c = &w->configs[i];
		unsigned int at = c->c.position - gap;

		if (c->c.alias || c->c.position < from + gap)
			continue;
		if (at >= w->bus.n || !same_device(c, &w->bus.v[at]))
			return false;
		any |= at_position(c);
	}
	return any;
}

/* The only port without link of the slave before @position, where the next one should be. */
static int open_end(const struct why *w, unsigned int position)
{
	const struct slave *s = position ? &w->bus.v[position - 1] : NULL;
	int port = WHY_NONE;

	for (int p = 0; s && p < EC_UAPI_PORTS; p++) {
		if (s->ports[p].type < 2 || s->ports[p].link_up)
			continue;
		if (port != WHY_NONE)
			return WHY_NONE;
		port = p;
	}
	return port;
}

/* a slave of that identity that no configuration has, or NULL */
static const struct slave *elsewhere(const struct why *w, const struct why_config *c)
{
	for (size_t i = 0; i < w->bus.n; i++)
		if (same_device(c, &w->bus.v[i]) &&
		    (!w->bus.v[i].config || w->bus.v[i].differs))
			return &w->bus.v[i];
	return NULL;
}

/* Slaves are missing at one place, so that all behind it have moved up. */
static void missing(struct why *w)
{
	struct why_config *first = first_absent(w);
	unsigned int from, gap, last = last_position(w);
	struct why_finding *f;
	char name[96];

	/* a device that stands elsewhere on a complete bus is at the wrong place, not missing */
	if (!first || (w->bus.n > last && elsewhere(w, first)))
		return;
	/* where the ring ends, slaves without configuration are missing as well */
	from = min(first->c.position, (unsigned int)w->bus.n);
	for (gap = 1; from + gap <= last && !shifted(w, from, gap); gap++)
		;
	/* all of the rest: only when nothing is there instead */
	if (from + gap > last && from < w->bus.n)
		return;
	f = why_add(w, "missing",
		    "check power and cable of the missing slaves, or correct the configuration",
		    "%u %s missing from position %u on: the bus has %zu, %s %s", gap,
		    gap == 1 ? "slave" : "slaves", from, w->bus.n,
		    from ? why_slave_name(w, from - 1, name, sizeof(name)) : "the main device",
		    from < w->bus.n ?
		    "is followed by slaves configured further downstream" : "is the last one");
	f->config = (int)(first - w->configs);
	f->slave = (int)from - 1;
	f->port = open_end(w, from);
	for (size_t i = 0; i < w->n_configs; i++)
		if (at_position(&w->configs[i]))
			why_explain(w, &w->configs[i]);
}

/* "EL3102, 0x00000002/0x0c1e3052": the name is that of a slave of the same identity */
static void identity(const struct why *w, u32 vendor, u32 product, char *buf, size_t size)
{
	for (size_t i = 0; i < w->bus.n; i++) {
		const struct slave *s = &w->bus.v[i];

		if (s->vendor_id == vendor && s->product_code == product && s->order[0]) {
			snprintf(buf, size, "%s, 0x%08x/0x%08x", s->order, vendor, product);
			return;
		}
	}
	snprintf(buf, size, "0x%08x/0x%08x", vendor, product);
}

/* what is at the position of a configuration, and what is configured */
static void both(const struct why *w, const struct why_config *c, char *buf, size_t size)
{
	const struct slave *s = c->cause.position < w->bus.n ?
				       &w->bus.v[c->cause.position] : NULL;
	char is[96], shall[96];

	if (!s) {
		snprintf(buf, size, "%s", c->text);
		return;
	}
	identity(w, s->vendor_id, s->product_code, is, sizeof(is));
	identity(w, c->c.vendor_id, c->c.product_code, shall, sizeof(shall));
	snprintf(buf, size, "slave %u is %s, configured is %s", s->position, is, shall);
}

static void different(struct why *w, struct why_config *c)
{
	char text[256];
	const struct slave *s = elsewhere(w, c);
	struct why_finding *f;

	both(w, c, text, sizeof(text));
	if (s)
		f = why_add(w, "wrong_place",
			    "connect the slaves in the configured order, or correct the position in the application",
			    "the device configured at %u:%u is at position %u: %s", c->c.alias,
			    c->c.position, s->position, text);
	else
		f = why_add(w, "different",
			    "connect the configured device, or configure this one in the application",
			    "another device than configured at %u:%u: %s", c->c.alias,
			    c->c.position, text);
	f->slave = s ? s->position : c->cause.position;
	f->config = (int)(c - w->configs);
	why_explain(w, c);
}

/* a slave of that device whose alias is the configured one but for a typing error */
static const struct slave *meant(const struct why *w, const struct why_config *c)
{
	char wanted[8], alias[8];

	snprintf(wanted, sizeof(wanted), "%u", c->c.alias);
	for (size_t i = 0; i < w->bus.n; i++) {
		const struct slave *s = &w->bus.v[i];

		snprintf(alias, sizeof(alias), "%u", s->alias);
		if (same_device(c, s) && s->alias && (!s->config || s->differs) &&
		    typing_errors(wanted, alias) <= 1)
			return s;
	}
	return NULL;
}

static void no_alias(struct why *w, struct why_config *c)
{
	const struct slave *s = meant(w, c);
	struct why_finding *f;
	char name[80];

	f = why_add(w, "no_alias",
		    "use the ring position, or set the alias with the tool of the manufacturer (this version writes no EEPROM)",
		    "no slave has alias %u", c->c.alias);
	f->config = (int)(c - w->configs);
	why_explain(w, c);
	if (s) {
		why_remedy(f, "correct the alias in the application to %u, if %s is meant",
			   s->alias, why_slave_name(w, s->position, name, sizeof(name)));
		return;
	}
	s = elsewhere(w, c);
	if (s)
		snprintf(f->what, sizeof(f->what),
			 "no slave has alias %u; %s is such a device, alias %u", c->c.alias,
			 why_slave_name(w, s->position, name, sizeof(name)), s->alias);
}

static void other(struct why *w, struct why_config *c)
{
	struct why_finding *f;

	if (c->cause.kind == EC_CAUSE_NO_SLAVE)
		f = why_add(w, "missing",
			    "check power and cable of the missing slave, or correct the configuration",
			    "%s", c->text);
	else if (c->cause.kind == EC_CAUSE_UNATTACHED)
		f = why_add(w, "attaching", "repeat the command", "%s", c->text);
	else
		f = why_add(w, "taken", "connect the missing slave or restart the application",
			    "%s", c->text);
	f->wait = c->cause.kind == EC_CAUSE_UNATTACHED;
	f->config = (int)(c - w->configs);
	why_explain(w, c);
}

/**
 * why_absent() - why configurations have no slave
 * @w: what is known
 */
void why_absent(struct why *w)
{
	lost(w);
	missing(w);
	for (size_t i = 0; i < w->n_configs; i++) {
		struct why_config *c = &w->configs[i];

		if (!absent(c))
			continue;
		switch (c->cause.kind) {
		case EC_CAUSE_DIFFERENT:
			different(w, c);
			break;
		case EC_CAUSE_NO_ALIAS:
			no_alias(w, c);
			break;
		case EC_CAUSE_NO_SLAVE:
		case EC_CAUSE_TAKEN:
		case EC_CAUSE_UNATTACHED:
			other(w, c);
			break;
		default:	/* a slave that cannot be read, or an older module: why_slaves() */
			break;
		}
	}
}
