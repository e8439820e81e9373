// SPDX-License-Identifier: GPL-2.0-only
/* A recording in a terminal: dots of Braille patterns, two by four in a character, or stars. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "plot.h"
#include "tool.h"

#define LABEL		11	/* characters before a drawing */
#define LINES		6	/* of a value */
#define FLAG_LINES	2	/* of one that is 0 or 1 */
#define GAP_MARK	'x'

/**
 * struct text - the drawing of a value
 * @wide: characters in a line
 * @high: lines
 * @dots_x: dots of a character, in a line
 * @dots_y: one above the other
 * @dots: of all characters, in lines
 * @bins: of each column of dots
 */
struct text {
	size_t wide;
	size_t high;
	unsigned int dots_x;
	unsigned int dots_y;
	unsigned char *dots;
	struct plot_bin *bins;
};

static void dot(struct text *t, size_t x, size_t y)
{
	static const unsigned char braille[2][4] = { { 1, 2, 4, 64 }, { 8, 16, 32, 128 } };
	size_t at = y / t->dots_y * t->wide + x / t->dots_x;

	t->dots[at] |= t->dots_x == 1 ? 1 : braille[x % 2][y % 4];
}

/* The dot of a value: 0 is the highest one. */
static size_t dot_of(const struct text *t, const struct plot_axis *a, double value)
{
	size_t last = t->high * t->dots_y - 1;

	return (size_t)((1 - plot_part(a, value)) * (double)last + 0.5);
}

static void draw(struct text *t, const struct plot_axis *a)
{
	memset(t->dots, 0, t->wide * t->high);
	for (size_t x = 0; x < t->wide * t->dots_x; x++) {
		const struct plot_bin *b = &t->bins[x];

		if (!b->any || !isfinite(b->min) || !isfinite(b->max))
			continue;
		for (size_t y = dot_of(t, a, b->max); y <= dot_of(t, a, b->min); y++)
			dot(t, x, y);
	}
}

static void print_char(FILE *to, unsigned char dots, bool unicode)
{
	unsigned int code = 0x2800 + dots;

	if (!unicode || !dots)
		fputc(dots ? '*' : ' ', to);
	else
		fprintf(to, "%c%c%c", 0xe0 | code >> 12, 0x80 | (code >> 6 & 63),
			0x80 | (code & 63));
}

/* The highest and the lowest value stand beside their lines. */
static void print_lines(FILE *to, const struct text *t, const struct plot_axis *a, bool unicode)
{
	for (size_t y = 0; y < t->high; y++) {
		size_t end = t->wide;

		while (end && !t->dots[y * t->wide + end - 1])
			end--;
		if (!y)
			fprintf(to, "%*.6g ", LABEL - 2, a->max);
		else if (y + 1 == t->high)
			fprintf(to, "%*.6g ", LABEL - 2, a->min);
		else
			fprintf(to, "%*s", LABEL - 1, "");
		fputc('|', to);
		for (size_t x = 0; x < end; x++)
			print_char(to, t->dots[y * t->wide + x], unicode);
		fputc('\n', to);
	}
}

/* Where records are missing, on the axis of the time */
static void print_axis(FILE *to, const struct text *t)
{
	fprintf(to, "%*s+", LABEL - 1, "");
	for (size_t x = 0; x < t->wide; x++) {
		bool gap = false;

		for (unsigned int k = 0; k < t->dots_x; k++)
			gap |= t->bins[x * t->dots_x + k].gap;
		fputc(gap ? GAP_MARK : '-', to);
	}
	fputc('\n', to);
}

static void print_times(FILE *to, const struct text *t, const struct plot_view *v)
{
	struct plot_axis a = plot_axis(v->from, v->to, 5);
	char line[512];
	size_t end = 0;
	double at;

	memset(line, ' ', sizeof(line));
	for (unsigned int i = 0; plot_label(&a, i, &at); i++) {
		size_t x = LABEL + (size_t)(plot_part(&a, at) * (double)(t->wide - 1) + 0.5);
		char label[32];
		int n = snprintf(label, sizeof(label), "%.6g", at);

		if (x < end + 1 || n < 0 || x + (size_t)n > LABEL + t->wide ||
		    x + (size_t)n >= sizeof(line))
			continue;
		memcpy(line + x, label, (size_t)n);
		end = x + (size_t)n;
	}
	fprintf(to, "%.*s\n", (int)end, line);
}

static size_t gaps_of(const struct plot_view *v)
{
	size_t n = 0;

	for (size_t i = 0; v->lost && i < v->data->rows; i++)
		n += v->lost[i] > 0;
	return n;
}

int plot_text(FILE *to, const struct plot_view *v, const struct plot_column *const *c, size_t n,
	      unsigned int columns, bool unicode)
{
	struct text t = {
		/* the last column of some terminals begins a new line */
		.wide = columns - LABEL - 1, .dots_x = unicode ? 2 : 1, .dots_y = unicode ? 4 : 1,
	};
	size_t gaps = gaps_of(v);

	t.dots = calloc(t.wide * LINES, 1);
	t.bins = calloc(t.wide * t.dots_x, sizeof(*t.bins));
	if (!t.dots || !t.bins) {
		free(t.dots);
		free(t.bins);
		return fail("out of memory");
	}
	for (size_t i = 0; i < n; i++) {
		struct plot_axis a = plot_range(c[i], v->data->rows, 2);

		t.high = c[i]->flag ? FLAG_LINES : LINES;
		fprintf(to, "%.*s%s%.*s%s\n", (int)columns / 2, c[i]->name,
			*c[i]->unit ? " [" : "", (int)columns / 4, c[i]->unit,
			*c[i]->unit ? "]" : "");
		plot_bins(v, c[i], t.bins, t.wide * t.dots_x);
		draw(&t, &a);
		print_lines(to, &t, &a, unicode);
	}
	print_axis(to, &t);
	print_times(to, &t, v);
	fprintf(to, "%*s%s", LABEL, "", v->time ? "time [s]" : "row");
	if (*v->data->since)
		fprintf(to, ", 0 is %.40s", v->data->since);
	if (gaps)
		fprintf(to, "; %c: records missing", GAP_MARK);
	fputc('\n', to);
	free(t.dots);
	free(t.bins);
	return 0;
}
