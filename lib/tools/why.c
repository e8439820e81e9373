// SPDX-License-Identifier: LGPL-2.1-or-later
/* The state of the master, the list of findings, and the rules in their order. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "why.h"

/* result */
struct ect_why {
	struct ect_list *findings;
	struct ect_list *configs;
	struct ect_list *slaves;
	struct ect_checked checked;
};

static const struct {
	const char *cause;
	u32 level;
	const char *evidence;
	const char *remedy;
} rows[] = {
#define FAULT		ECT_FAULT
#define UNDER_WAY	ECT_UNDER_WAY
#define WARNING		ECT_WARNING
#define ROW(id, cause, level, evidence, remedy, what)	{ cause, level, evidence, remedy },
	WHY_TEXTS(ROW)
};

static int read_config(struct why *w, u32 index)
{
	struct ect_config_why why = { .struct_size = sizeof(why) };
	struct ect_config config = { .struct_size = sizeof(config) };
	struct ect_explained *c;
	int ret = ect_config_read(w->h, index, &config);

	ret = ret ? ret : ect_config_why(w->h, index, &why);
	if (ret)
		return ret;
	/* an optional group that is not connected is no fault */
	if (config.group && !config.group_mandatory && why.cause.kind == ECT_CAUSE_NO_GROUP)
		return 0;
	c = ect_list_add(w->configs);
	if (!c)
		return ect_no_memory(w->h);
	c->config = config;
	c->cause = why.cause;
	memcpy(c->text, why.text, sizeof(c->text));
	return 0;
}

/* without bus traffic */
static int read_all(struct why *w)
{
	int ret = ect_slaves_read(w->h, &w->bus);

	ret = ret ? ret : ect_get_master(w->h, &w->m);
	ret = ret ? ret : ect_devices_read(w->h, &w->devices);
	ret = ret ? ret : ect_absent_read(w->h, &w->absent);
	if (ret)
		return ret;
	w->configs = ect_list_new(sizeof(struct ect_explained));
	w->findings = ect_list_new(sizeof(struct ect_finding));
	if (!w->configs || !w->findings)
		return ect_no_memory(w->h);
	for (u32 i = 0; i < w->m.config_count && !ret; i++)
		ret = read_config(w, i);
	return ret == -ENOENT ? 0 : ret;	/* the application has exited */
}

static void set_text(struct ect_finding *f, enum why_text id, const char *fmt, va_list ap)
{
	f->level = rows[id].level;
	snprintf(f->cause, sizeof(f->cause), "%s", rows[id].cause);
	snprintf(f->remedy, sizeof(f->remedy), "%s", rows[id].remedy);
	vsnprintf(f->text, sizeof(f->text), fmt, ap);
}

void why_set_finding(struct ect_finding *f, enum why_text id, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	set_text(f, id, fmt, ap);
	va_end(ap);
}

struct ect_finding *why_add_finding(struct why *w, enum why_text id, const char *fmt, ...)
{
	struct ect_finding *f = ect_list_add(w->findings);
	va_list ap;

	w->failed |= !f;
	f = f ? f : &w->lost;
	f->slave = ECT_NONE;
	f->port = ECT_NONE;
	f->config = ECT_NONE;
	f->domain = ECT_NONE;
	va_start(ap, fmt);
	set_text(f, id, fmt, ap);
	va_end(ap);
	return f;
}

void why_set_remedy(struct ect_finding *f, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(f->remedy, sizeof(f->remedy), fmt, ap);
	va_end(ap);
}

/* the newest finding explains why the slave of @c is not in OP */
void why_explain(struct why *w, struct ect_explained *c)
{
	if (!c->finding)
		c->finding = (u32)w->findings->n;
}

bool why_in_op(const struct ect_explained *c)
{
	return c->config.in_op;
}

/* the master, open for writing, to be freed; NULL: the user may not do that */
struct ect_handle *why_open(struct why *w)
{
	struct ect_handle *h = ect_new();

	w->failed |= !h;
	if (!h || !ect_open_path(h, w->h->path, ECT_OPEN_WRITE))
		return h;
	ect_free(h);
	return NULL;
}

bool why_has(const struct why *w, const char *cause)
{
	for (size_t i = 0; i < w->findings->n; i++)
		if (!strcmp(why_finding(w, i)->cause, cause))
			return true;
	return false;
}

/* order number or name of a slave, for a text */
const char *why_slave_name(const struct why *w, unsigned int position, char *buf, size_t size)
{
	const struct ect_slave *s = position < w->bus->n ? why_slave(w, position) : NULL;

	if (s && s->order[0])
		snprintf(buf, size, "slave %u (%s)", position, s->order);
	else
		snprintf(buf, size, "slave %u", position);
	return buf;
}

/* Return: no slave can be reached */
static bool apply_rules(struct why *w)
{
	if (why_bus(w))
		return true;
	why_ring(w);
	why_cycle(w);
	why_late_frames(w);
	why_absent(w);
	why_ports(w);
	why_units(w);
	why_slaves(w);
	why_domains(w);
	why_clocks(w);
	why_counters(w);
	why_emergencies(w);
	why_drives(w);
	why_lost_frames(w);
	return false;
}

static struct ect_why *result(struct why *w, bool unreachable)
{
	struct ect_why *r = calloc(1, sizeof(*r));

	if (!r)
		return NULL;
	r->checked = (struct ect_checked){
		.struct_size = sizeof(r->checked), .unreachable = unreachable,
		.session = w->m.session, .slaves = (u32)w->bus->n, .configs = (u32)w->configs->n,
		.domains = w->m.domain_count, .counters = w->counters, .silent = w->silent,
		.unasked = w->unasked,
	};
	for (size_t i = 0; i < w->configs->n; i++)
		r->checked.in_op += why_in_op(why_config(w, i));
	for (size_t i = 0; i < w->findings->n; i++) {
		struct ect_finding *f = why_finding(w, i);

		if (f->slave >= 0 && (size_t)f->slave < w->bus->n)
			f->device = why_slave(w, (size_t)f->slave)->device;
	}
	r->findings = w->findings;
	r->configs = w->configs;
	r->slaves = w->bus;
	return r;
}

static int find_out(struct ect_handle *h, struct ect_why **to, bool quiet)
{
	struct why w = { .h = h, .quiet = quiet };
	int ret = read_all(&w);
	bool unreachable = !ret && apply_rules(&w);

	*to = ret || w.failed ? NULL : result(&w, unreachable);
	ect_list_free(w.devices);
	ect_list_free(w.absent);
	if (*to)
		return 0;
	ect_list_free(w.bus);
	ect_list_free(w.configs);
	ect_list_free(w.findings);
	return ret ? ret : ect_no_memory(h);
}

int ect_why(struct ect_handle *h, struct ect_why **to)
{
	return find_out(h, to, false);
}

int ect_why_quiet(struct ect_handle *h, struct ect_why **to)
{
	return find_out(h, to, true);
}

void ect_why_free(struct ect_why *w)
{
	if (!w)
		return;
	ect_list_free(w->findings);
	ect_list_free(w->configs);
	ect_list_free(w->slaves);
	free(w);
}

const struct ect_list *ect_why_findings(const struct ect_why *w)
{
	return w->findings;
}

const struct ect_list *ect_why_configs(const struct ect_why *w)
{
	return w->configs;
}

const struct ect_list *ect_why_slaves(const struct ect_why *w)
{
	return w->slaves;
}

const struct ect_checked *ect_why_checked(const struct ect_why *w)
{
	return &w->checked;
}

int ect_evidence(const struct ect_finding *f, unsigned int i, char *name, size_t size)
{
	const char *words = "";

	if (i >= f->evidence_count)
		return -ENOENT;
	/* all rows of a cause with numbers have the same ones */
	for (size_t k = 0; k < ARRAY_SIZE(rows) && !*words; k++)
		if (!strcmp(rows[k].cause, f->cause))
			words = rows[k].evidence;
	for (; i && *words; i--) {
		words += strcspn(words, " ");
		words += *words == ' ';
	}
	if (!*words)
		return -ENOENT;
	snprintf(name, size, "%.*s", (int)strcspn(words, " "), words);
	return 0;
}
