// SPDX-License-Identifier: GPL-2.0-only
/* The bus as a picture: a line of slaves stays in one column, branches are indented. */
#include <stdlib.h>
#include <string.h>

#include "absent.h"
#include "escape.h"
#include "report.h"
#include "slave_info.h"
#include "topology.h"

#define ROW		30	/* height of a slave with the gap above */
#define BOX		22	/* height of its box */
#define WIDTH		260	/* of a box */
#define INDENT		28	/* of a branch */
#define MAX_DEPTH	16	/* deeper branches are not indented further */
#define RIGHT		180	/* width of state, medium and ports beside a box */
#define LETTER		7	/* width of a letter of the errors behind it */
#define ERRORS_TEXT	256
#define NAME_LETTERS	34	/* characters of a name in its box */

static unsigned int left_of(const struct ect_node *n)
{
	return 10 + ((unsigned int)min(n->depth, (u32)MAX_DEPTH) + 1) * INDENT;
}

static const char *class_of(const struct ect_slave *s)
{
	if (s->error || s->differs || s->al_status & 0x10 || s->cause.kind == ECT_CAUSE_SILENT)
		return "error";
	switch (s->al_status & 0xf) {
	case 8:
		return "op";
	case 4:
		return "safeop";
	case 2:
		return "preop";
	default:
		return "other";
	}
}

/* The whole name is in the title, which a browser shows under the pointer. */
static void box(FILE *f, unsigned int x, unsigned int y, const char *class, const char *text)
{
	char name[NAME_LETTERS + 1];
	size_t n = strlen(text), cut = n < NAME_LETTERS ? n : NAME_LETTERS;

	/* half of a character at the end is that of no name */
	while (n > NAME_LETTERS && cut && ((unsigned char)text[cut] & 0xc0) == 0x80)
		cut--;
	snprintf(name, sizeof(name), "%.*s", (int)cut, text);
	fprintf(f, "<g><title>");
	escape_html(f, text);
	fprintf(f, "</title><rect class=\"box %s\" x=\"%u\" y=\"%u\" width=\"%u\" height=\"%u\" rx=\"3\"/><text x=\"%u\" y=\"%u\">", class, x, y, WIDTH, BOX, x + 6, y + 16);
	escape_html(f, name);
	fprintf(f, "%s</text></g>\n", n >= sizeof(name) ? "..." : "");
}

/* "port 0: 300 invalid, 7 receiver; port 1: 2 lost links" */
static void errors_text(const struct ect_slave *s, char *buf, size_t size)
{
	static const char *const what[FACTS_ERRORS] = { "invalid", "receiver", "forwarded",
							"lost links" };
	size_t at = 0;

	*buf = 0;
	for (unsigned int p = 0; p < ECT_PORTS; p++) {
		u32 counts[FACTS_ERRORS];
		size_t n = facts_errors(&s->ports[p], counts);
		bool first = true;

		for (size_t i = 0; i < n && at < size; i++) {
			if (!counts[i])
				continue;
			if (first)
				at += (size_t)snprintf(buf + at, size - at, "%sport %u:",
						       at ? "; " : "", p);
			if (at < size)
				at += (size_t)snprintf(buf + at, size - at, "%s %u %s",
						       first ? "" : ",", counts[i], what[i]);
			first = false;
		}
	}
}

static void slave_row(const struct report *r, const struct topo *t, const unsigned int *row,
		      const struct ect_node *n)
{
	const struct ect_slave *s = &r->facts.slaves.v[n->slave];
	unsigned int x = left_of(n), y = row[n->slave] * ROW, up = 0, trunk = 10 + INDENT / 2;
	char name[ECT_STRING], state[16], text[2 * ECT_STRING], errors[ERRORS_TEXT];

	if (n->parent != ECT_NONE32) {
		up = row[n->parent] * ROW;
		trunk = left_of(t->node[n->parent]) + (left_of(t->node[n->parent]) < x ? 14 : 0);
	}
	if (trunk < x)
		fprintf(r->f, "<path class=\"line\" d=\"M%u %uV%uH%u\"/>\n", trunk, up + BOX,
			y + BOX / 2, x);
	else
		fprintf(r->f, "<path class=\"line\" d=\"M%u %uV%u\"/>\n", x + 6, up + BOX, y);
	slave_name(s, name, sizeof(name));
	slave_state_text(s, state, sizeof(state));
	errors_text(s, errors, sizeof(errors));
	snprintf(text, sizeof(text), "%u  %s", s->position, name);
	box(r->f, x, y, class_of(s), text);
	fprintf(r->f, "<text x=\"%u\" y=\"%u\">", x + WIDTH + 8, y + 16);
	escape_html(r->f, state);
	fprintf(r->f, "  %s", port_type_text(s->ports[n->port & 3].type));
	if (n->parent != ECT_NONE32)
		fprintf(r->f, " %u&gt;%u", n->parent_port, n->port);
	if (*errors)
		fprintf(r->f, " <tspan class=\"bad\">%s</tspan>", errors);
	fputs("</text>\n", r->f);
}

static void picture(const struct report *r, const struct topo *t, unsigned int *row)
{
	const struct ect_node *n;
	unsigned int wide = 0;
	char text[ECT_STRING + 32];
	const struct ect_device *d = facts_device(&r->facts, 0);
	size_t longest = 0;
	char errors[ERRORS_TEXT];

	for (size_t i = 0; (n = ect_list_get(t->order, i)); i++) {
		row[n->slave] = (unsigned int)i + 1;
		wide = max(wide, left_of(n));
		errors_text(&r->facts.slaves.v[n->slave], errors, sizeof(errors));
		longest = max(longest, strlen(errors));
	}
	wide += WIDTH + RIGHT + LETTER * (unsigned int)longest;
	fprintf(r->f, "<svg role=\"img\" viewBox=\"0 0 %u %zu\" width=\"%u\">\n", wide,
		(t->n + 1) * ROW, wide);
	snprintf(text, sizeof(text), "Master%u  %s", r->facts.master, d ? d->name : "");
	box(r->f, 10, 0, d && d->link_up ? "other" : "error", text);
	for (size_t i = 0; (n = ect_list_get(t->order, i)); i++)
		slave_row(r, t, row, n);
	fputs("</svg>\n", r->f);
}

static FILE *page;	/* of absent_line() */

static void absent(const struct dev *d, const char *text)
{
	(void)d;
	html_text(page, "p", "fault", "%s", text);
}

int report_bus(const struct report *r)
{
	unsigned int *row = calloc(r->facts.slaves.n + 1, sizeof(*row));
	struct topo t;
	int ret;

	if (!row)
		return fail("out of memory");
	html_heading(r->f, "Bus");
	if (topo_build(&t, &r->facts.slaves)) {
		ret = 1;
	} else {
		picture(r, &t, row);
		page = r->f;
		ret = absent_show(r->d, &r->facts.slaves, absent);
	}
	topo_free(&t);
	free(row);
	return ret;
}
