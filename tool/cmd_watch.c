// SPDX-License-Identifier: GPL-2.0-only
/* Values of a running session while they change, also of that of an application. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "current.h"
#include "out.h"
#include "screen.h"

#define EVERY_S		0.1
#define MARK_S		1.0	/* a change is marked so long */

/**
 * struct watch - values that are watched
 * @l: all values
 * @shown: index of each watched one in @l
 * @n: how many
 * @before: text of each
 * @changed: when it has changed last, now_s(); 0: never
 */
struct watch {
	struct current l;
	size_t *shown;
	size_t n;
	char (*before)[CURRENT_TEXT];
	double *changed;
};

static void watch_free(struct watch *w)
{
	current_free(&w->l);
	free(w->shown);
	free(w->before);
	free(w->changed);
}

static bool is_meant(const struct ect_value *v, int argc, char **argv)
{
	for (int i = 0; i < argc; i++)
		if (current_matches(v, argv[i]))
			return true;
	return !argc;
}

/* Each name means a value at least: a typo is no empty table. */
static int check_names(const struct dev *d, const struct current *l, int argc, char **argv)
{
	for (int i = 0; i < argc; i++) {
		size_t k = 0;

		while (k < l->n && !current_matches(current_at(l, k), argv[i]))
			k++;
		if (k == l->n) {
			current_find(d, l, argv[i]);
			return 1;
		}
	}
	return 0;
}

static int begin(const struct tool *t, struct dev *d, struct watch *w, int argc, char **argv)
{
	*w = (struct watch){ 0 };
	if (current_read_as(t, d, t->file, &w->l) || check_names(d, &w->l, argc, argv))
		return 1;
	w->shown = calloc(w->l.n + 1, sizeof(*w->shown));
	w->before = calloc(w->l.n + 1, sizeof(*w->before));
	w->changed = calloc(w->l.n + 1, sizeof(*w->changed));
	if (!w->shown || !w->before || !w->changed)
		return fail("out of memory");
	for (size_t i = 0; i < w->l.n; i++)
		if (is_meant(current_at(&w->l, i), argc, argv))
			w->shown[w->n++] = i;
	return 0;
}

/* One line for each value that is another one than before */
static void print_changes(const struct dev *d, struct watch *w, double from)
{
	for (size_t i = 0; i < w->n; i++) {
		const struct ect_value *v = current_at(&w->l, w->shown[i]);
		char text[CURRENT_TEXT];

		current_format(&w->l, v, text, sizeof(text));
		if (!strcmp(text, w->before[i]))
			continue;
		memcpy(w->before[i], text, sizeof(text));
		out_object(NULL);
		out_u("master", d->master, NULL);
		out_f("time_s", now_s() - from, "%9.3f", now_s() - from);
		out_str("name", v->name, "  %s", v->name);
		out_str("value", text, " = %s", text);
		if (*current_unit_text(&w->l, v))
			out_str("unit", current_unit_text(&w->l, v), " %s",
				current_unit_text(&w->l, v));
		out_text("\n");
		out_end();
	}
	fflush(stdout);
}

/* All of them, as far as the terminal has lines; a change has a star. */
static void redraw(const struct dev *d, struct watch *w)
{
	unsigned int lines, columns;
	double now = now_s();

	screen_size(&lines, &columns);
	screen_begin();
	screen_line(columns, "Master%u: %zu value(s), Ctrl-C ends", d->master, w->n);
	for (size_t i = 0; i < w->n; i++) {
		const struct ect_value *v = current_at(&w->l, w->shown[i]);
		char text[CURRENT_TEXT];
		int room = (int)columns - 30;

		current_format(&w->l, v, text, sizeof(text));
		if (w->before[i][0] && strcmp(text, w->before[i]))
			w->changed[i] = now;
		memcpy(w->before[i], text, sizeof(text));
		if (i + 3 > lines)
			continue;
		if (*current_unit_text(&w->l, v))
			snprintf(text + strlen(text), sizeof(text) - strlen(text), " %.8s",
				 current_unit_text(&w->l, v));
		screen_line(columns, "%c %-*.*s %-3s %20s",
			    w->changed[i] && now - w->changed[i] < MARK_S ? '*' : ' ', room, room,
			    v->name, v->dir == ECT_DIR_OUTPUT ? "out" : "in", text);
	}
	if (w->n + 2 > lines)
		screen_line(columns, "... %zu more: name some of them", w->n + 2 - lines);
	screen_end();
}

static int watch(const struct tool *t, struct dev *d, struct watch *w)
{
	double from = now_s(), every = t->watch_s > 0 ? t->watch_s : EVERY_S;
	bool table = out_to_terminal() && !out_is_json();
	int err = 0;

	screen_catch_end();
	while (!err && !screen_ended()) {
		if (table)
			redraw(d, w);
		else
			print_changes(d, w, from);
		if (ferror(stdout))
			break;
		screen_wait(every);
		err = current_poll(d, &w->l);
	}
	screen_forget_interruption();
	if (err == -ESTALE || err == -ENOENT || err == -EINVAL) {
		note("Master%u: the session has ended", d->master);
		return 0;
	}
	return err ? dev_fail(d, err, "Master%u: cannot read the process data", d->master) : 0;
}

static int run(struct tool *t, int argc, char **argv)
{
	struct watch w;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, false))
		return 1;
	ret = begin(t, &d, &w, argc, argv) || watch(t, &d, &w);
	watch_free(&w);
	dev_close(&d);
	return ret;
}

const struct cmd cmd_watch = {
	.name = "watch",
	.run = run,
	.args = "[<NAME>...]",
	.opts = "mWi",
	.summary = "Show values of the running session while they change",
	.help = "Names are those of 'ethercat data --names'; * and ? stand for any characters, quote\n"
		"them for the shell. Without a name all values are shown. On a terminal it is a table,\n"
		"in which a star marks what has changed within a second; otherwise there is a line for\n"
		"each value, then for each change: seconds, name, value. With --file names, types,\n"
		"units and scaling are those of a bus file; no slave is asked. Values are read ten\n"
		"times a second, or in the time of --watch: what is shorter is not seen. It only reads,\n"
		"also the session of an application, and sends no frame.\n",
	.json = "each line is an object: master, time_s, name, value (text), unit",
	.flags = CMD_ONE_MASTER | CMD_LINES,
	.max_args = 1000,
};
