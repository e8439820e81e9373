// SPDX-License-Identifier: GPL-2.0-only
/* A recording as SVG: one drawing above the other, with one axis of time. */
#include <math.h>

#include "plot.h"
#include "tool.h"

#define WIDE		960
#define LEFT		90
#define RIGHT		20
#define TOP		30
#define BOTTOM		50
#define HIGH		150	/* of a value */
#define FLAG_HIGH	40	/* of one that is 0 or 1 */
#define BETWEEN		34
#define PLOT		(WIDE - LEFT - RIGHT)

/* characters that mean something in XML */
static void print_escaped(FILE *to, const char *s)
{
	for (; *s; s++) {
		switch (*s) {
		case '<':
			fputs("&lt;", to);
			break;
		case '>':
			fputs("&gt;", to);
			break;
		case '&':
			fputs("&amp;", to);
			break;
		case '"':
			fputs("&quot;", to);
			break;
		default:
			/* names of a slave are ASCII; other bytes may be no UTF-8 */
			fputc((unsigned char)*s < 0x80 ? *s : '?', to);
		}
	}
}

static unsigned int high_of(const struct plot_column *c)
{
	return c->flag ? FLAG_HIGH : HIGH;
}

static double x_of(const struct plot_view *v, double time)
{
	return LEFT + plot_part(&(struct plot_axis){ .min = v->from, .max = v->to }, time) * PLOT;
}

static double y_of(const struct plot_axis *a, double value, double top, unsigned int high)
{
	return top + (1 - plot_part(a, value)) * high;
}

static void print_frame(FILE *to, const struct plot_column *c, const struct plot_axis *a,
			double top)
{
	unsigned int high = high_of(c);
	double at;

	fprintf(to, "<text x=\"%d\" y=\"%.1f\" class=\"name\">", LEFT, top - 6);
	print_escaped(to, c->name);
	if (*c->unit) {
		fputs(" [", to);
		print_escaped(to, c->unit);
		fputs("]", to);
	}
	fputs("</text>\n", to);
	fprintf(to, "<rect x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%u\" class=\"frame\"/>\n",
		LEFT, top, PLOT, high);
	for (unsigned int i = 0; plot_label(a, i, &at); i++) {
		double y = y_of(a, at, top, high);

		fprintf(to, "<line x1=\"%d\" y1=\"%.1f\" x2=\"%d\" y2=\"%.1f\" class=\"grid\"/><text x=\"%d\" y=\"%.1f\" class=\"value\">%.6g</text>\n", LEFT, y,
			LEFT + PLOT, y, LEFT - 6, y + 4, at);
	}
}

/* A line up to where records are missing, then another one */
static void print_lines(FILE *to, const struct plot_bin *bins, const struct plot_axis *a,
			double top, unsigned int high)
{
	bool open = false;

	for (int x = 0; x < PLOT; x++) {
		const struct plot_bin *b = &bins[x];
		bool drawn = b->any && isfinite(b->min) && isfinite(b->max);

		if (open && (!drawn || b->gap)) {
			fputs("\"/>\n", to);
			open = false;
		}
		if (!drawn)
			continue;
		fputs(open ? " " : "<polyline class=\"line\" points=\"", to);
		open = true;
		fprintf(to, "%d,%.1f", LEFT + x, y_of(a, b->min, top, high));
		if (b->max > b->min)
			fprintf(to, " %d,%.1f %d,%.1f", LEFT + x, y_of(a, b->max, top, high),
				LEFT + x, y_of(a, b->last, top, high));
	}
	if (open)
		fputs("\"/>\n", to);
}

/* As many as fit on the picture, not in the file */
static void print_gaps(FILE *to, const struct plot_bin *bins, double top, unsigned int high)
{
	for (int x = 0, from; x < PLOT; x++) {
		double lost = 0;

		for (from = x; x < PLOT && bins[x].gap; x++)
			lost += bins[x].lost;
		if (x > from)
			fprintf(to, "<rect x=\"%d\" y=\"%.1f\" width=\"%d\" height=\"%u\" class=\"gap\"><title>%.0f records are missing</title></rect>\n",
				LEFT + from, top, x - from, high, lost);
	}
}

static void print_times(FILE *to, const struct plot_view *v, double top)
{
	struct plot_axis a = plot_axis(v->from, v->to, 8);
	double at;

	for (unsigned int i = 0; plot_label(&a, i, &at); i++)
		fprintf(to, "<text x=\"%.1f\" y=\"%.1f\" class=\"time\">%.6g</text>\n",
			x_of(v, at), top + 16, at);
	fprintf(to, "<text x=\"%d\" y=\"%.1f\" class=\"time\">%s", LEFT + PLOT / 2, top + 36,
		v->time ? "time [s]" : "row");
	if (*v->data->since) {
		fputs(", 0 is ", to);
		print_escaped(to, v->data->since);
	}
	fputs("</text>\n", to);
}

static void print_begin(FILE *to, unsigned int high)
{
	fprintf(to, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%u\" viewBox=\"0 0 %d %u\">\n",
		WIDE, high, WIDE, high);
	fputs("<style>\n"
	      "text { font: 12px sans-serif; fill: #222 }\n"
	      ".name { font-weight: bold } .value { text-anchor: end } .time { text-anchor: middle }\n"
	      ".frame { fill: none; stroke: #888 } .grid { stroke: #ddd }\n"
	      ".line { fill: none; stroke: #06c; stroke-width: 1.2 } .gap { fill: #d40; fill-opacity: 0.25 }\n"
	      "</style>\n"
	      "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n", to);
}

void plot_svg(FILE *to, const struct plot_view *v, const struct plot_column *const *c, size_t n)
{
	struct plot_bin bins[PLOT];
	unsigned int high = TOP + BOTTOM;
	double top = TOP;

	for (size_t i = 0; i < n; i++)
		high += high_of(c[i]) + BETWEEN;
	print_begin(to, high);
	for (size_t i = 0; i < n; i++) {
		struct plot_axis a = plot_range(c[i], v->data->rows, 5);

		print_frame(to, c[i], &a, top);
		plot_bins(v, c[i], bins, PLOT);
		print_gaps(to, bins, top, high_of(c[i]));
		print_lines(to, bins, &a, top, high_of(c[i]));
		top += high_of(c[i]) + BETWEEN;
	}
	print_times(to, v, top - BETWEEN);
	fputs("</svg>\n", to);
}
