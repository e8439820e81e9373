// SPDX-License-Identifier: GPL-2.0-only
/* The master, what is wrong, and its settings. */
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>

#include "config_info.h"
#include "cycle_text.h"
#include "report.h"
#include "sys.h"
#include "why_text.h"

static const char *const level_class[WHY_LEVELS] = { "fault", "note", "warning" };

static void line(FILE *f, const char *name, const char *value)
{
	html_row(f);
	html_cell(f, "%s", name);
	html_cell(f, "%s", value);
}

static void summary(const struct report *r)
{
	const struct facts *x = &r->facts;
	char text[256];
	struct utsname u;

	html_heading(r->f, "Summary");
	html_table(r->f, "|");
	line(r->f, "Session", facts_session(&x->m));
	snprintf(text, sizeof(text), "%u, %u reply", x->m.slave_count, x->m.slaves_responding);
	line(r->f, "Slaves", text);
	snprintf(text, sizeof(text), "%s by %s", cycle_state(&x->c), cycle_by(&x->c));
	line(r->f, "Cycle", x->c.kind == ECT_CYCLE_BY_NOBODY ? "none yet" : text);
	line(r->f, "Module", x->release);
	line(r->f, "Tool", EC_TOOL_VERSION);
	if (!uname(&u)) {
		snprintf(text, sizeof(text), "%s %s %s", u.sysname, u.release, u.machine);
		line(r->f, "Kernel", text);
	}
	html_table_end(r->f);
}

static void links(const struct report *r)
{
	const struct ect_device *d;

	html_heading(r->f, "Links");
	html_table(r->f, "Link|Interface|State|Frames sent|Received|Lost|Late|Unmatched|Foreign|Send errors|Lost per second, 60 s");
	for (size_t i = 0; (d = facts_device(&r->facts, i)); i++) {
		html_row(r->f);
		html_cell(r->f, "%s", i ? "backup" : "main");
		html_cell(r->f, "%s", d->name);
		html_cell(r->f, "%s", !d->attached ? "waited for" : d->link_up ? "up" : "down");
		html_cell(r->f, "%llu", (unsigned long long)d->tx_frames);
		html_cell(r->f, "%llu", (unsigned long long)d->rx_frames);
		html_cell(r->f, "%llu", (unsigned long long)d->lost);
		html_cell(r->f, "%llu", (unsigned long long)d->late);
		html_cell(r->f, "%llu", (unsigned long long)d->unmatched);
		html_cell(r->f, "%llu", (unsigned long long)d->foreign);
		html_cell(r->f, "%llu", (unsigned long long)d->tx_errors);
		html_cell(r->f, "%u", d->loss_rate[ECT_RATES - 1]);
	}
	html_table_end(r->f);
}

static void findings(const struct report *r)
{
	const struct ect_list *all = ect_why_findings(r->why);
	const struct ect_finding *n;
	size_t shown = 0;

	for (u32 level = 0; level < WHY_LEVELS; level++)
		for (size_t i = 0; (n = ect_list_get(all, i)); i++) {
			if (n->level != level)
				continue;
			shown++;
			html_text(r->f, "p", level_class[level], "%s: %s", why_level_names[level],
				  n->text);
			html_text(r->f, "p", NULL, "Remedy: %s", n->remedy);
		}
	if (!shown)
		html_text(r->f, "p", NULL, "All is well.");
	html_text(r->f, "p", "note", "Checked: %s.", why_application(ect_why_checked(r->why)));
}

static void configs(const struct report *r)
{
	const struct ect_list *all = ect_why_configs(r->why);
	const struct ect_explained *e;
	char name[CONFIG_NAME];

	if (!ect_list_count(all))
		return;
	html_table(r->f, "Configuration|Slave|In OP|Cause");
	for (size_t i = 0; (e = ect_list_get(all, i)); i++) {
		html_row(r->f);
		html_cell(r->f, "%s", config_name(&e->config, name, sizeof(name)));
		html_cell(r->f, "%d", e->config.slave_position);
		html_cell(r->f, "%s", e->config.in_op ? "yes" : "no");
		html_cell(r->f, "%s", e->text);
	}
	html_table_end(r->f);
}

static void parameter(FILE *f, const char *module, const char *name)
{
	char path[512], value[256];
	FILE *p;

	snprintf(path, sizeof(path), "%s/module/%s/parameters/%s", sys_fs(), module, name);
	p = fopen(path, "r");
	if (!p)
		return;		/* readable by root only */
	if (!fgets(value, sizeof(value), p))
		*value = 0;
	fclose(p);
	value[strcspn(value, "\n")] = 0;
	html_row(f);
	html_cell(f, "%s", module);
	html_cell(f, "%s", name);
	html_cell(f, "%s", value);
}

/* module parameters, in the order of their names */
static void settings(const struct report *r)
{
	static const char *const modules[] = { "ec_master", "ec_generic", "ec_intel", "ec_sim" };

	html_heading(r->f, "Settings");
	html_table(r->f, "Module|Parameter|Value");
	for (size_t i = 0; i < ARRAY_SIZE(modules); i++) {
		struct dirent **names;
		char path[256];
		int n;

		snprintf(path, sizeof(path), "%s/module/%s/parameters", sys_fs(), modules[i]);
		n = scandir(path, &names, NULL, alphasort);
		for (int k = 0; k < n; k++) {
			if (names[k]->d_name[0] != '.')
				parameter(r->f, modules[i], names[k]->d_name);
			free(names[k]);
		}
		if (n >= 0)
			free(names);
	}
	html_table_end(r->f);
}

int report_state(const struct report *r)
{
	summary(r);
	html_heading(r->f, "What is wrong");
	findings(r);
	configs(r);
	links(r);
	settings(r);
	return 0;
}
