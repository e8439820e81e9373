// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config_info.h"
#include "dev.h"
#include "out.h"
#include "why_text.h"

#define S(n)	((n) == 1 ? "" : "s")

/* all that was found on a master */
struct report {
	const struct dev *d;
	struct ect_why *why;
	const struct ect_list *findings;
	const struct ect_list *configs;
	const struct ect_checked *checked;
};

/* what -a, -p or SLAVE select; none given: everything */
struct chosen {
	bool all;
	struct numbers slaves;
	const struct tool *t;
};

static bool is_chosen(const struct chosen *c, int slave)
{
	for (size_t i = 0; i < c->slaves.n; i++)
		if (c->slaves.v[i] == (unsigned int)slave)
			return true;
	return false;
}

static bool config_chosen(const struct chosen *c, const struct ect_explained *e)
{
	if (e->config.slave_position >= 0)
		return is_chosen(c, e->config.slave_position);
	return select_config(&c->t->aliases, &c->t->positions, &e->config);
}

static const struct ect_finding *finding(const struct report *r, size_t i)
{
	return ect_list_get(r->findings, i);
}

static const struct ect_explained *config(const struct report *r, size_t i)
{
	return ect_list_get(r->configs, i);
}

/* A finding without a place concerns everything. */
static bool shown(const struct report *r, const struct chosen *c, size_t i)
{
	const struct ect_finding *f = finding(r, i);
	const struct ect_explained *e;

	if (c->all || (f->slave == ECT_NONE && f->config == ECT_NONE))
		return true;
	if (is_chosen(c, f->slave))
		return true;
	if (f->config != ECT_NONE && config_chosen(c, config(r, (size_t)f->config)))
		return true;
	for (size_t k = 0; (e = config(r, k)); k++)
		if (e->finding == i + 1 && config_chosen(c, e))
			return true;
	return false;
}

/* with its order number */
static void place_text(const struct report *r, int slave)
{
	const struct ect_slave *s = ect_list_get(ect_why_slaves(r->why), (size_t)slave);

	out_text("  Place: slave %d", slave);
	if (s && s->order[0])
		out_text(" (%s)", s->order);
}

static void number_or_null(const char *key, int v)
{
	if (v == ECT_NONE)
		out_null(key, NULL);
	else
		out_u(key, (unsigned int)v, NULL);
}

static void place(const struct report *r, const struct ect_finding *f)
{
	char text[CONFIG_NAME] = "";

	if (f->config != ECT_NONE)
		config_name(&config(r, (size_t)f->config)->config, text, sizeof(text));
	number_or_null("slave", f->slave);
	number_or_null("port", f->port);
	number_or_null("domain", f->domain);
	if (text[0])
		out_str("config", text, NULL);
	else
		out_null("config", NULL);
	if (f->slave != ECT_NONE)
		place_text(r, f->slave);
	if (f->slave != ECT_NONE && f->port != ECT_NONE)
		out_text(", port %d", f->port);
	if (text[0])
		out_text("%sconfiguration %s", f->slave != ECT_NONE ? ", " : "  Place: ", text);
	if (f->slave != ECT_NONE || text[0])
		out_text("\n");
}

/* slaves that do not reach OP because of the finding, without the one that it is about */
static void affected(const struct report *r, size_t i)
{
	const char *sep = "  Affected: ";
	const struct ect_explained *e;
	char text[CONFIG_NAME];

	out_array("affected");
	for (size_t k = 0; (e = config(r, k)); k++) {
		if (e->finding != i + 1)
			continue;
		config_name(&e->config, text, sizeof(text));
		out_str("", text, NULL);
		if (finding(r, i)->config == (int)k)
			continue;
		out_text("%s%s", sep, text);
		sep = ", ";
	}
	out_end();
	if (sep[0] == ',')
		out_text("\n");
}

static void show(const struct report *r, size_t i)
{
	const struct ect_finding *f = finding(r, i);

	out_object(NULL);
	out_str("level", why_level_keys[f->level], "%s: ", why_level_names[f->level]);
	out_str("cause", f->cause, NULL);
	out_str("text", f->text, "%s\n", f->text);
	place(r, f);
	if (f->code)
		out_u("code", f->code, NULL);
	else
		out_null("code", NULL);
	affected(r, i);
	out_str("remedy", f->remedy, "  Remedy: %s\n", f->remedy);
	out_end();
}

/* findings that were shown, and faults of what is not selected */
struct count {
	size_t n[WHY_LEVELS];
	size_t elsewhere;
	bool nothing;		/* is selected here */
};

/* "2 faults" behind @before; nothing for 0 */
static void number(size_t n, const char *one, const char *more, const char *before)
{
	if (n)
		out_text("%s%zu %s", before, n, n == 1 ? one : more);
}

static void checked(const struct report *r)
{
	const struct ect_checked *c = r->checked;

	out_text("Checked: link, cycle, %u slave%s, %u configuration%s, %u of them in OP, %u domain%s, emergencies, clocks%s; %s.\n",
		 c->slaves, S(c->slaves), c->configs, S(c->configs), c->in_op, c->domains,
		 S(c->domains), c->counters ? ", error counters of the ports" : "",
		 why_application(r->checked));
	if (!c->counters)
		out_text("Not checked: error counters of the ports; reading them needs write access to %s.\n",
			 ect_path(r->d->h));
	if (c->unasked)
		out_text("Not checked: errors of drives (SoE) of %u slave%s; asking them needs write access to %s.\n",
			 c->unasked, S(c->unasked), ect_path(r->d->h));
	if (c->silent)
		out_text("Not checked: error counters of %u slave%s without reply.\n", c->silent,
			 S(c->silent));
}

/* Last: what was checked, so that silence means something. */
static void summary(const struct report *r, const struct count *n)
{
	bool well = !n->n[ECT_FAULT] && !n->n[ECT_UNDER_WAY];

	/* a selection of nothing is neither well nor faulty */
	if (n->nothing && well)
		out_null("well", NULL);
	else
		out_bool("well", well, NULL);
	out_u("faults_elsewhere", n->elsewhere, NULL);
	out_str("application", why_application(r->checked), NULL);
	out_bool("error_counters_read", r->checked->counters && !r->checked->silent, NULL);
	if (n->nothing && well)
		return;
	if (!well) {
		number(n->n[ECT_FAULT], "fault", "faults", "");
		number(n->n[ECT_UNDER_WAY], "under way", "under way", n->n[ECT_FAULT] ? ", " : "No fault, ");
		number(n->n[ECT_WARNING], "warning", "warnings", ", ");
		out_text(". ");
	} else {
		out_text("%s well%s. ", n->elsewhere ? "The selection is" : "All is",
			 n->n[ECT_WARNING] ? " except for the warnings" : "");
	}
	number(n->elsewhere, "fault elsewhere: 'ethercat why'. ",
	       "faults elsewhere: 'ethercat why'. ", "");
	if (r->checked->unreachable)
		out_text("Checked: link; all else can be checked after the repair.\n");
	else
		checked(r);
}

static int choose(const struct tool *t, const struct report *r, struct chosen *c,
		  struct count *count)
{
	const struct ect_explained *e;
	struct slaves bus;
	size_t n;

	*c = (struct chosen){ .t = t };
	c->all = list_all(&t->aliases) && list_all(&t->positions);
	if (slaves_copy(&bus, ect_why_slaves(r->why)))
		return 1;
	n = (size_t)select_slaves(&t->aliases, &t->positions, bus.v, bus.n, &c->slaves);
	slaves_free(&bus);
	if (n)
		return fail("out of memory");
	n = c->slaves.n;
	for (size_t i = 0; (e = config(r, i)); i++)
		n += config_chosen(c, e);
	dev_selected("slave or configuration", !c->all, n);
	count->nothing = !c->all && !n;
	return 0;
}

static void show_all(const struct report *r, const struct chosen *c, struct count *n)
{
	const struct ect_finding *f;

	for (u32 level = ECT_FAULT; level < WHY_LEVELS; level++) {
		for (size_t i = 0; (f = finding(r, i)); i++) {
			if (f->level != level)
				continue;
			if (!shown(r, c, i)) {
				n->elsewhere += level == ECT_FAULT;
				continue;
			}
			n->n[level]++;
			show(r, i);
		}
	}
}

static int report(const struct tool *t, const struct report *r)
{
	struct chosen c = { .all = true };
	struct count n = { 0 };

	if (choose(t, r, &c, &n))
		return 1;
	out_object(NULL);
	out_u("master", r->d->master, NULL);
	if (r->d->selected > 1)
		out_text("Master%u\n", r->d->master);
	out_array("findings");
	show_all(r, &c, &n);
	out_end();
	summary(r, &n);
	out_end();
	numbers_free(&c.slaves);
	return n.n[ECT_FAULT] || n.n[ECT_UNDER_WAY] ? 1 : 0;
}

static int each(const struct tool *t, struct dev *d)
{
	struct report r = { .d = d };
	int ret = ect_why(d->h, &r.why);

	if (ret)
		return dev_fail(d, ret, "Master%u: cannot read what is known of the bus",
				d->master);
	r.findings = ect_why_findings(r.why);
	r.configs = ect_why_configs(r.why);
	r.checked = ect_why_checked(r.why);
	ret = report(t, &r);
	ect_why_free(r.why);
	return ret;
}

static int run(struct tool *t, int argc, char **argv)
{
	const char *why;
	int ret;

	if (argc && t->positions.given)
		return usage_error("SLAVE and --position exclude each other");
	if (argc && position_parse(&t->aliases, &t->positions, argv[0], &why))
		return usage_error("invalid slave '%s': %s", argv[0], why);
	out_array("masters");
	ret = dev_each(t, false, each);
	out_end();
	return ret;
}

const struct cmd cmd_why = {
	.name = "why",
	.run = run,
	.args = "[SLAVE]",
	.opts = "map",
	.summary = "Find out why slaves are not in OP",
	.help = "Goes from the symptoms to the causes: device, link, cycle, missing and different slaves,\n"
		"PDOs, SDOs, AL status codes, clocks, working counters, EEPROMs, error counters. Each fault\n"
		"has its place, the configurations affected by it (alias:position), and a remedy. A fault\n"
		"that stops ten slaves is reported once. Warnings stop no slave;\n"
		"what is under way has not failed so far. SLAVE is a list of ring\n"
		"positions, as of --position.\n"
		"Reads what the master knows, without bus traffic, so any user may run it; only the error\n"
		"counters of the ports are read from the slaves, with write access. Exit code: 0 all is\n"
		"well, 1 there is a fault or something is under way, or the command failed. A master without application is well.\n"
		"  ethercat why\n"
		"  ethercat why 4\n",
	.json = "masters[]: master, findings[] (level (fault, under_way, warning), cause, text, slave, port, domain,\n"
		"config (null: none), code, affected[], remedy),\n"
		"well (null: nothing selected), faults_elsewhere (not of SLAVE), application,\n"
		"error_counters_read (of all slaves)",
	.max_args = 1,
};
