// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "why.h"

#define S(n)	((n) == 1 ? "" : "s")

/* what -a, -p or SLAVE leave; nothing given: everything */
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

static bool config_chosen(const struct chosen *c, const struct why_config *config)
{
	if (config->c.slave_position >= 0)
		return is_chosen(c, config->c.slave_position);
	return select_config(&c->t->aliases, &c->t->positions, &config->c);
}

/* A finding without a place concerns everything. */
static bool shown(const struct why *w, const struct chosen *c, size_t i)
{
	const struct why_finding *f = &w->f[i];

	if (c->all || (f->slave == WHY_NONE && f->config == WHY_NONE))
		return true;
	if (is_chosen(c, f->slave))
		return true;
	if (f->config != WHY_NONE && config_chosen(c, &w->configs[f->config]))
		return true;
	for (size_t k = 0; k < w->n_configs; k++)
		if (w->configs[k].finding == i + 1 && config_chosen(c, &w->configs[k]))
			return true;
	return false;
}

static void config_text(const struct why_config *c, char *buf, size_t size)
{
	snprintf(buf, size, "%u:%u", c->c.alias, c->c.position);
}

static void number_or_null(const char *key, int v)
{
	if (v == WHY_NONE)
		out_null(key, NULL);
	else
		out_u(key, (unsigned int)v, NULL);
}

static void place(const struct why *w, const struct why_finding *f)
{
	char text[16] = "", name[96];

	if (f->config != WHY_NONE)
		config_text(&w->configs[f->config], text, sizeof(text));
	number_or_null("slave", f->slave);
	number_or_null("port", f->port);
	number_or_null("domain", f->domain);
	if (text[0])
		out_str("config", text, NULL);
	else
		out_null("config", NULL);
	if (f->slave != WHY_NONE)
		out_text("  Place: %s", why_slave_name(w, (unsigned int)f->slave, name,
						       sizeof(name)));
	if (f->slave != WHY_NONE && f->port != WHY_NONE)
		out_text(", port %d", f->port);
	if (text[0])
		out_text("%sconfiguration %s", f->slave != WHY_NONE ? ", " : "  Place: ", text);
	if (f->slave != WHY_NONE || text[0])
		out_text("\n");
}

/* slaves that do not reach OP because of the finding, without the one that it is about */
static void affected(const struct why *w, size_t i)
{
	const char *sep = "  Affected: ";
	char text[16];

	out_array("affected");
	for (size_t k = 0; k < w->n_configs; k++) {
		if (w->configs[k].finding != i + 1)
			continue;
		config_text(&w->configs[k], text, sizeof(text));
		out_str("", text, NULL);
		if (w->f[i].config == (int)k)
			continue;
		out_text("%s%s", sep, text);
		sep = ", ";
	}
	out_end();
	if (sep[0] == ',')
		out_text("\n");
}

/* in the order in which they are shown: faults first, as they explain more */
enum level { FAULT, WAIT, WARNING, LEVELS };

static const char *const level_keys[] = { "fault", "under_way", "warning" };
static const char *const level_names[] = { "Fault", "Under way", "Warning" };

static enum level level_of(const struct why_finding *f)
{
	return f->wait ? WAIT : f->warning ? WARNING : FAULT;
}

static void show(const struct why *w, size_t i)
{
	const struct why_finding *f = &w->f[i];

	out_object(NULL);
	out_str("level", level_keys[level_of(f)], "%s: ", level_names[level_of(f)]);
	out_str("cause", f->cause, NULL);
	out_str("text", f->what, "%s\n", f->what);
	place(w, f);
	if (f->code)
		out_u("code", f->code, NULL);
	else
		out_null("code", NULL);
	affected(w, i);
	out_str("remedy", f->remedy, "  Remedy: %s\n", f->remedy);
	out_end();
}

static const char *application(const struct why *w)
{
	switch (w->m.session) {
	case EC_SESSION_NONE:
		return "no application: no slave has to be in OP";
	case EC_SESSION_RESERVED:
		return "an application has reserved the master and not activated it: no slave has to be in OP";
	case EC_SESSION_DETACHED:
		return "detached session: the kernel runs the cycle, the application has exited";
	default:
		return "application active";
	}
}

/* findings that were shown, and faults of what is not selected */
struct count {
	size_t n[LEVELS];
	size_t elsewhere;
	bool nothing;		/* is selected here */
};

/* "2 faults" behind @before; nothing for 0 */
static void number(size_t n, const char *one, const char *more, const char *before)
{
	if (n)
		out_text("%s%zu %s", before, n, n == 1 ? one : more);
}

static void checked(const struct why *w)
{
	size_t in_op = 0;

	for (size_t i = 0; i < w->n_configs; i++)
		in_op += why_in_op(&w->configs[i]);
	out_text("Checked: link, cycle, %zu slave%s, %zu configuration%s, %zu of them in OP, %u domain%s, emergencies, clocks%s; %s.\n",
		 w->bus.n, S(w->bus.n), w->n_configs, S(w->n_configs), in_op, w->m.domain_count,
		 S(w->m.domain_count),
		 w->counters ? ", error counters of the ports" : "", application(w));
	if (!w->counters)
		out_text("Not checked: error counters of the ports; reading them needs write access to %s.\n",
			 w->d->path);
	if (w->silent)
		out_text("Not checked: error counters of %zu slave%s without reply.\n",
			 w->silent, S(w->silent));
}

/* Last: what was checked, so that silence means something. */
static void summary(const struct why *w, const struct count *n)
{
	bool well = !n->n[FAULT] && !n->n[WAIT];

	/* what does not exist is neither well nor faulty */
	if (n->nothing && well)
		out_null("well", NULL);
	else
		out_bool("well", well, NULL);
	out_u("faults_elsewhere", n->elsewhere, NULL);
	out_str("application", application(w), NULL);
	out_bool("error_counters_read", w->counters && !w->silent, NULL);
	if (n->nothing && well)
		return;
	if (!well) {
		number(n->n[FAULT], "fault", "faults", "");
		number(n->n[WAIT], "under way", "under way", n->n[FAULT] ? ", " : "No fault, ");
		number(n->n[WARNING], "warning", "warnings", ", ");
		out_text(". ");
	} else {
		out_text("%s well%s. ", n->elsewhere ? "The selection is" : "All is",
			 n->n[WARNING] ? " except for the warnings" : "");
	}
	number(n->elsewhere, "fault elsewhere: 'ethercat why'. ",
	       "faults elsewhere: 'ethercat why'. ", "");
	if (w->unreachable)
		out_text("Checked: link; all else can be checked after the repair.\n");
	else
		checked(w);
}

static void rules(struct why *w)
{
	w->unreachable = why_bus(w);
	if (w->unreachable)
		return;
	why_cycle(w);
	why_late_frames(w);
	why_absent(w);
	why_slaves(w);
	why_domains(w);
	why_clocks(w);
	why_counters(w);
	why_emergencies(w);
	why_lost_frames(w);
}

static int choose(const struct tool *t, const struct why *w, struct chosen *c, struct count *count)
{
	size_t n;

	*c = (struct chosen){ .t = t };
	c->all = list_all(&t->aliases) && list_all(&t->positions);
	if (select_slaves(&t->aliases, &t->positions, w->bus.v, w->bus.n, &c->slaves))
		return fail("out of memory");
	n = c->slaves.n;
	for (size_t i = 0; i < w->n_configs; i++)
		n += config_chosen(c, &w->configs[i]);
	dev_selected("slave or configuration", !c->all, n);
	count->nothing = !c->all && !n;
	return 0;
}

static int each(const struct tool *t, struct dev *d)
{
	struct chosen c = { .all = true };
	struct count n = { 0 };
	struct why w;

	if (why_read(&w, d) || choose(t, &w, &c, &n)) {
		why_free(&w);
		return 1;
	}
	rules(&w);
	out_object(NULL);
	out_u("master", d->master, NULL);
	if (d->selected > 1)
		out_text("Master%u\n", d->master);
	out_array("findings");
	for (enum level level = FAULT; level < LEVELS; level++) {
		for (size_t i = 0; i < w.n; i++) {
			if (level_of(&w.f[i]) != level)
				continue;
			if (!shown(&w, &c, i)) {
				n.elsewhere += level == FAULT;
				continue;
			}
			n.n[level]++;
			show(&w, i);
		}
	}
	out_end();
	summary(&w, &n);
	out_end();
	numbers_free(&c.slaves);
	n.n[FAULT] += w.failed;
	why_free(&w);
	return n.n[FAULT] || n.n[WAIT] ? 1 : 0;
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
