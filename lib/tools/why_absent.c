// SPDX-License-Identifier: LGPL-2.1-or-later
/* Configurations without slave: lost behind a cable, missing, different, at another position. */
#include <stdio.h>

#include "../../master/wire/port_text.h"
#include "text.h"
#include "why.h"

static int config_index(const struct why *w, const struct ect_explained *c)
{
	return (int)(((const u8 *)c - w->configs->at) / w->configs->size);
}

/* 1 + index */
static u32 finding_number(const struct why *w, const struct ect_finding *f)
{
	return f == &w->lost ? 0 : (u32)(((const u8 *)f - w->findings->at) / w->findings->size) + 1;
}

static bool absent(const struct ect_explained *c)
{
	return c->config.slave_position < 0 && !c->finding;
}

static bool same_device(const struct ect_explained *c, const struct ect_slave *s)
{
	return s->vendor_id == c->config.vendor_id && s->product_code == c->config.product_code;
}

static bool at_position(const struct ect_explained *c)
{
	return absent(c) && !c->config.alias && (c->cause.kind == ECT_CAUSE_NO_SLAVE ||
					    c->cause.kind == ECT_CAUSE_DIFFERENT);
}

/* What is absent behind a port, or NULL. */
static const struct ect_absent *absent_at(const struct why *w, const struct ect_slave *s,
					  unsigned int port)
{
	const struct ect_absent *a;

	for (size_t i = 0; s && (a = ect_list_get(w->absent, i)); i++)
		if (a->device == s->device && a->port == port)
			return a;
	return NULL;
}

static const char *slaves_word(const struct ect_absent *a)
{
	return a->slaves == 1 ? "slave" : "slaves";
}

/* Slaves that were lost together have the same place; one cable explains all of them. */
static void lost_at(struct why *w, unsigned int position, unsigned int port, const char *text)
{
	const struct ect_slave *s = position < w->bus->n ? why_slave(w, position) : NULL;
	bool up = s && s->ports[port & 3].link_up;
	const struct ect_absent *a = absent_at(w, s, port);
	struct ect_finding *f;
	char name[96], since[24];

	why_slave_name(w, position, name, sizeof(name));
	if (w->m.scan_busy || w->m.slaves_responding > w->bus->n) {
		/* which of several places is repaired shows when the scan has ended */
		f = why_scan(w);
		if (f->slave != ECT_NONE)
			f = why_add(w, SCAN, w->m.scan_index, w->m.scan_slaves);
		why_change(f, LOST_AGAIN, w->m.scan_index, w->m.scan_slaves, port, name, text);
		f->evidence_count = 2;
		f->evidence[0] = w->m.scan_index;
		f->evidence[1] = w->m.scan_slaves;
	} else if (a) {
		f = why_add(w, CABLE_OF, port, name, a->slaves, slaves_word(a),
			    text_duration(a->since_ns, since, sizeof(since)), a->first, a->name,
			    up ? "up" : "down");
		f->evidence_count = 1;
		f->evidence[0] = a->slaves;
	} else {
		f = why_add(w, CABLE, port, name, up ? "up" : "down", text);
	}
	f->slave = (int)position;
	f->port = (int)port;
	for (size_t i = 0; i < w->configs->n; i++) {
		const struct ect_cause *cause = &why_config(w, i)->cause;

		if (cause->kind == ECT_CAUSE_LOST && cause->position == position &&
		    cause->port == port)
			why_config(w, i)->finding = finding_number(w, f);
	}
}

/*
 * Downstream of lost slaves the ring positions are not the configured ones. Another slave at a
 * configured position is no finding before the cable is repaired.
 */
static void moved_up(struct why *w, u32 cable)
{
	unsigned int from = ~0u;

	for (size_t i = 0; i < w->configs->n; i++)
		if (why_config(w, i)->cause.kind == ECT_CAUSE_LOST &&
		    !why_config(w, i)->config.alias)
			from = min(from, why_config(w, i)->config.position);
	for (size_t i = 0; i < w->configs->n; i++)
		if (at_position(why_config(w, i)) && why_config(w, i)->config.position > from)
			why_config(w, i)->finding = cable;
}

/* slaves downstream of other lost slaves need no finding of their own */
static void lost(struct why *w)
{
	u32 first = 0;

	for (size_t i = 0; i < w->configs->n; i++) {
		const struct ect_explained *c = why_config(w, i);

		if (!absent(c) || c->cause.kind != ECT_CAUSE_LOST ||
		    c->cause.position == ECT_NONE16)
			continue;
		lost_at(w, c->cause.position, c->cause.port, c->text);
		first = first ? first : why_config(w, i)->finding;
	}
	for (size_t i = 0; i < w->configs->n; i++) {
		struct ect_explained *c = why_config(w, i);

		if (!absent(c) || c->cause.kind != ECT_CAUSE_LOST)
			continue;
		if (!first) {
			why_add(w, CABLE_LOST, c->text)->config = (int)i;
			first = (u32)w->findings->n;
		}
		c->finding = first;
	}
	if (first)
		moved_up(w, first);
}

/* the configuration of the smallest ring position whose slave is absent, or NULL */
static struct ect_explained *first_absent(struct why *w)
{
	struct ect_explained *first = NULL;

	for (size_t i = 0; i < w->configs->n; i++)
		if (at_position(why_config(w, i)) &&
		    (!first || why_config(w, i)->config.position < first->config.position))
			first = why_config(w, i);
	return first;
}

static unsigned int last_position(const struct why *w)
{
	unsigned int last = 0;

	for (size_t i = 0; i < w->configs->n; i++)
		if (!why_config(w, i)->config.alias)
			last = max(last, why_config(w, i)->config.position);
	return last;
}

/*
 * Do all slaves from @from on match @gap positions upstream of where they are configured, but not
 * all of them where they are configured? Then the @gap slaves in between are missing.
 */
static bool shifted(const struct why *w, unsigned int from, unsigned int gap)
{
	bool any = from >= w->bus->n;

	/* a gap longer than the bus: a match is chance, unless the bus ends where it would then */
	if (!any && gap > w->bus->n && last_position(w) + 1 - gap != w->bus->n)
		return false;
	for (size_t i = 0; i < w->configs->n; i++) {
		const struct ect_explained *c = why_config(w, i);
		unsigned int at = c->config.position - gap;

		if (c->config.alias || c->config.position < from + gap)
			continue;
		if (at >= w->bus->n || !same_device(c, why_slave(w, at)))
			return false;
		any |= at_position(c);
	}
	return any;
}

/* The only port without link of the slave before @position, where the next one should be. */
static int open_end(const struct why *w, unsigned int position)
{
	const struct ect_slave *s = position ? why_slave(w, position - 1) : NULL;
	int port = ECT_NONE;

	for (int p = 0; s && p < ECT_PORTS; p++) {
		if (s->ports[p].type < 2 || s->ports[p].link_up)
			continue;
		if (port != ECT_NONE)
			return ECT_NONE;
		port = p;
	}
	return port;
}

/* a slave of that identity that no configuration has, or NULL */
static const struct ect_slave *elsewhere(const struct why *w, const struct ect_explained *c)
{
	for (size_t i = 0; i < w->bus->n; i++)
		if (same_device(c, why_slave(w, i)) &&
		    (!why_slave(w, i)->config || why_slave(w, i)->differs))
			return why_slave(w, i);
	return NULL;
}

static bool has_groups(const struct why *w)
{
	for (size_t i = 0; i < w->configs->n; i++)
		if (why_config(w, i)->config.group)
			return true;
	return false;
}

/* Slaves are missing at one place, so that all behind it have moved up. */
static void missing(struct why *w)
{
	struct ect_explained *first = first_absent(w);
	unsigned int from, gap, last = last_position(w);
	struct ect_finding *f;
	char name[96];

	/* slaves of hot connect groups do not count: places are not known here */
	if (has_groups(w))
		return;
	/* a device that stands elsewhere on a complete bus is at the wrong place, not missing */
	if (!first || (w->bus->n > last && elsewhere(w, first)))
		return;
	/* at the end of the ring, slaves without configuration are missing as well */
	from = min(first->config.position, (unsigned int)w->bus->n);
	for (gap = 1; from + gap <= last && !shifted(w, from, gap); gap++)
		;
	/* the whole rest is missing only if no other slave is in its place */
	if (from + gap > last && from < w->bus->n)
		return;
	f = why_add(w, MISSING, gap, gap == 1 ? "slave" : "slaves", from, w->bus->n,
		    from ? why_slave_name(w, from - 1, name, sizeof(name)) : "the main device",
		    from < w->bus->n ?
		    "is followed by slaves configured further downstream" : "is the last one");
	f->evidence_count = 1;
	f->evidence[0] = gap;
	f->config = config_index(w, first);
	f->slave = (int)from - 1;
	f->port = open_end(w, from);
	for (size_t i = 0; i < w->configs->n; i++)
		if (at_position(why_config(w, i)))
			why_explain(w, why_config(w, i));
}

/* "EL3102, 0x00000002/0x0c1e3052": the name is that of a slave of the same identity */
static void identity(const struct why *w, u32 vendor, u32 product, char *buf, size_t size)
{
	for (size_t i = 0; i < w->bus->n; i++) {
		const struct ect_slave *s = why_slave(w, i);

		if (s->vendor_id == vendor && s->product_code == product && s->order[0]) {
			snprintf(buf, size, "%s, 0x%08x/0x%08x", s->order, vendor, product);
			return;
		}
	}
	snprintf(buf, size, "0x%08x/0x%08x", vendor, product);
}

/* what is at the position of a configuration, and what is configured */
static void both(const struct why *w, const struct ect_explained *c, char *buf, size_t size)
{
	const struct ect_slave *s = c->cause.position < w->bus->n ?
				       why_slave(w, c->cause.position) : NULL;
	char is[96], shall[96];

	if (!s) {
		snprintf(buf, size, "%s", c->text);
		return;
	}
	identity(w, s->vendor_id, s->product_code, is, sizeof(is));
	identity(w, c->config.vendor_id, c->config.product_code, shall, sizeof(shall));
	snprintf(buf, size, "slave %u is %s, configured is %s", s->position, is, shall);
}

static void different(struct why *w, struct ect_explained *c)
{
	char text[256];
	const struct ect_slave *s = elsewhere(w, c);
	struct ect_finding *f;

	both(w, c, text, sizeof(text));
	if (s)
		f = why_add(w, WRONG_PLACE, c->config.alias, c->config.position, s->position, text);
	else
		f = why_add(w, DIFFERENT, c->config.alias, c->config.position, text);
	f->slave = s ? s->position : c->cause.position;
	f->config = config_index(w, c);
	why_explain(w, c);
}

/* a slave of that device whose alias is the configured one but for a typing error */
static const struct ect_slave *meant(const struct why *w, const struct ect_explained *c)
{
	char wanted[8], alias[8];

	snprintf(wanted, sizeof(wanted), "%u", c->config.alias);
	for (size_t i = 0; i < w->bus->n; i++) {
		const struct ect_slave *s = why_slave(w, i);

		snprintf(alias, sizeof(alias), "%u", s->alias);
		if (same_device(c, s) && s->alias && (!s->config || s->differs) &&
		    text_typos(wanted, alias) <= 1)
			return s;
	}
	return NULL;
}

static void no_alias(struct why *w, struct ect_explained *c)
{
	const struct ect_slave *s = meant(w, c);
	struct ect_finding *f;
	char name[80];

	f = why_add(w, NO_ALIAS, c->config.alias);
	f->evidence_count = 1;
	f->evidence[0] = c->config.alias;
	f->config = config_index(w, c);
	why_explain(w, c);
	if (s) {
		why_remedy(f, ALIAS_MEANT, s->alias,
			   why_slave_name(w, s->position, name, sizeof(name)));
		return;
	}
	s = elsewhere(w, c);
	if (s)
		why_change(f, NO_ALIAS_BUT, c->config.alias,
			   why_slave_name(w, s->position, name, sizeof(name)), s->alias);
}

/* One finding for a group; the kernel says what is missing or wrong. */
static void group(struct why *w, struct ect_explained *c)
{
	struct ect_finding *f;

	if (c->cause.kind == ECT_CAUSE_NO_GROUP)
		f = why_add(w, GROUP_ABSENT, c->text);
	else
		f = why_add(w, GROUP_WRONG, c->text);
	f->config = config_index(w, c);
	if (c->cause.kind == ECT_CAUSE_GROUP)
		f->slave = c->cause.position;
	for (size_t i = 0; i < w->configs->n; i++)
		if (why_config(w, i)->config.group == c->config.group)
			why_explain(w, why_config(w, i));
}

static void other(struct why *w, struct ect_explained *c)
{
	struct ect_finding *f;

	if (c->cause.kind == ECT_CAUSE_NO_SLAVE)
		f = why_add(w, MISSING_ONE, c->text);
	else if (c->cause.kind == ECT_CAUSE_RING)
		f = why_add(w, RING_PLACE, c->text);
	else if (c->cause.kind == ECT_CAUSE_UNATTACHED)
		f = why_add(w, ATTACHING, c->text);
	else
		f = why_add(w, TAKEN, c->text);
	f->config = config_index(w, c);
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
	for (size_t i = 0; i < w->configs->n; i++) {
		struct ect_explained *c = why_config(w, i);

		if (!absent(c))
			continue;
		switch (c->cause.kind) {
		case ECT_CAUSE_DIFFERENT:
			different(w, c);
			break;
		case ECT_CAUSE_NO_ALIAS:
			no_alias(w, c);
			break;
		case ECT_CAUSE_NO_GROUP:
		case ECT_CAUSE_GROUP:
			group(w, c);
			break;
		case ECT_CAUSE_NO_SLAVE:
		case ECT_CAUSE_RING:
		case ECT_CAUSE_TAKEN:
		case ECT_CAUSE_UNATTACHED:
			other(w, c);
			break;
		default:	/* an unreadable slave, or an older module: why_slaves() */
			break;
		}
	}
}

/* slaves that no configuration misses: nothing else has reported their port */
static void unused(struct why *w, const struct ect_slave *s, const struct ect_absent *a)
{
	struct ect_finding *f;
	char name[96], since[24];

	for (size_t i = 0; i < w->findings->n; i++)
		if (why_finding(w, i)->slave == s->position && why_finding(w, i)->port == a->port)
			return;
	f = why_add(w, ABSENT, a->port, why_slave_name(w, s->position, name, sizeof(name)),
		    a->slaves, slaves_word(a), text_duration(a->since_ns, since, sizeof(since)),
		    a->first, a->name, s->ports[a->port & 3].link_up ? "up" : "down");
	f->evidence_count = 1;
	f->evidence[0] = a->slaves;
	f->slave = s->position;
	f->port = a->port;
}

static void kept(struct why *w, const struct ect_slave *s, unsigned int port)
{
	const struct ec_port_text *text = ec_port_text(s->port_kept[port]);
	struct ect_behind b = { .struct_size = sizeof(b) };
	char name[96], device[160] = "", remedy[160];
	struct ect_finding *f;

	if (text->device && !ect_behind_read(w->h, s->device, port, &b))
		text_behind(&b, device, sizeof(device));
	f = why_add(w, PORT_KEPT, port, why_slave_name(w, s->position, name, sizeof(name)),
		    text->reason, device);
	snprintf(remedy, sizeof(remedy), "%s, or 'ethercat slaves -p %u --let-in %u'",
		 text->remedy, s->position, port);
	why_remedy(f, PLAIN, text->device ? remedy : text->remedy);
	f->slave = s->position;
	f->port = (int)port;
}

/**
 * why_ports() - ports behind which slaves are absent, or that stay closed
 * @w: what is known
 */
void why_ports(struct why *w)
{
	const struct ect_absent *a;

	for (size_t i = 0; i < w->bus->n; i++) {
		const struct ect_slave *s = why_slave(w, i);

		for (unsigned int p = 0; p < ECT_PORTS; p++) {
			a = absent_at(w, s, p);
			if (a && !w->m.scan_busy)
				unused(w, s, a);
			if (s->port_kept[p])
				kept(w, s, p);
		}
	}
}
