// SPDX-License-Identifier: GPL-2.0-only
/* A recording as a drawing. */
#define _GNU_SOURCE	/* strcasestr() */
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../lib/tools/text.h"
#include "out.h"
#include "plot.h"
#include "save.h"
#include "screen.h"
#include "tool.h"

#define DRAWN_MAX	64	/* values in a drawing */

/* columns that 'ethercat record' adds */
static bool is_fixed(const char *name)
{
	static const char *const names[] = { "time_s", "app_time_ns", "cycle", "lost", "wc" };

	for (unsigned int i = 0; i < ARRAY_SIZE(names); i++)
		if (!strcmp(name, names[i]))
			return true;
	return false;
}

static bool is_meant(const struct plot_column *c, int argc, char **argv)
{
	for (int i = 0; i < argc; i++)
		if (!fnmatch(argv[i], c->name, 0))
			return true;
	return !argc && !is_fixed(c->name);
}

static int no_column(const char *file, const struct plot_data *p, const char *name)
{
	const char *nearest = NULL;

	for (size_t i = 0; i < p->n; i++)
		nearest = text_nearer(name, nearest, p->columns[i].name);
	if (nearest)
		return fail("%s has no value %s; did you mean %s?", file, name, nearest);
	return fail("%s has no value %s", file, name);
}

static int choose(const char *file, const struct plot_data *p, int argc, char **argv,
		  const struct plot_column **chosen, size_t *n)
{
	for (int i = 0; i < argc; i++) {
		size_t k = 0;

		while (k < p->n && fnmatch(argv[i], p->columns[k].name, 0))
			k++;
		if (k == p->n)
			return no_column(file, p, argv[i]);
	}
	*n = 0;
	for (size_t k = 0; k < p->n; k++) {
		if (!is_meant(&p->columns[k], argc, argv))
			continue;
		if (*n == DRAWN_MAX)
			return fail("%s has more than %d values: name those to be drawn", file,
				    DRAWN_MAX);
		chosen[(*n)++] = &p->columns[k];
	}
	return *n ? 0 : fail("%s has no values", file);
}

/* What the terminal shows; in a pipe and without a locale it is what the user reads it with. */
static bool is_unicode(void)
{
	static const char *const names[] = { "LC_ALL", "LC_CTYPE", "LANG" };

	for (unsigned int i = 0; i < ARRAY_SIZE(names); i++) {
		const char *v = getenv(names[i]);

		if (v && *v)
			return strcasestr(v, "utf-8") || strcasestr(v, "utf8");
	}
	return false;
}

/* The drawing must not replace the recording, by any of its names. */
static bool is_same(const char *from, const char *to)
{
	struct stat a, b;

	if (strcmp(from, "-") ? stat(from, &a) : fstat(STDIN_FILENO, &a))
		return false;
	return !stat(to, &b) && S_ISREG(b.st_mode) && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

static int draw(const struct tool *t, const char *from, const struct plot_data *p,
		const struct plot_column *const *c, size_t n)
{
	unsigned int lines, columns = 80;
	struct plot_view v;
	struct save s;

	plot_view(p, &v);
	if (!t->output_file) {
		if (out_to_terminal())
			screen_size(&lines, &columns);
		return plot_text(stdout, &v, c, n, min(columns, 200u), is_unicode());
	}
	if (is_same(from, t->output_file))
		return fail("'%s' is the recording; use another name", t->output_file);
	if (t->force ? save_begin(&s, t->output_file) : save_new(&s, t->output_file))
		return 1;
	plot_svg(s.f, &v, c, n);
	if (save_end(&s))
		return 1;
	if (out_is_json()) {
		out_object(NULL);
		out_str("file", t->output_file, NULL);
		out_u("values", n, NULL);
		out_u("records", p->rows, NULL);
		out_end();
	}
	return 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct plot_column *chosen[DRAWN_MAX];
	struct plot_data p;
	size_t n = 0;
	int ret;

	if (t->json && !t->output_file)
		return usage_error("--json needs --output-file: the drawing goes to stdout");
	ret = plot_read(argv[0], &p);
	if (!ret && !p.rows)
		ret = fail("%s has no records", argv[0]);
	ret = ret || choose(argv[0], &p, argc - 1, argv + 1, chosen, &n) ||
		draw(t, argv[0], &p, chosen, n);
	plot_free(&p);
	return ret;
}

const struct cmd cmd_plot = {
	.name = "plot",
	.run = run,
	.args = "<FILE> [<NAME>...]",
	.opts = "of",
	.summary = "Draw a recording",
	.help = "FILE is one of 'ethercat record', CSV or .npy; - is stdin. Names are those of its columns;\n"
		"* and ? stand for any characters. Without a name all recorded values are drawn, one\n"
		"above the other. With --output-file an SVG is written, else text: as wide as the\n"
		"terminal, 80 columns in a pipe, with Braille patterns where LANG has UTF-8. An existing\n"
		"SVG is replaced with --force, the recording never. Where\n"
		"records are missing the line has a gap, which is marked. Other CSV files with a line of\n"
		"names and numbers below it are drawn as well, over time_s or the number of the row.\n",
	.json = "file, values, records",
	.min_args = 1,
	.max_args = 1000,
};
