// SPDX-License-Identifier: GPL-2.0-only
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "dev.h"
#include "out.h"
#include "tool.h"

static const struct cmd *find(const char *text)
{
	const struct cmd *found[EC_TOOL_COMMANDS];
	int n = cmd_lookup(text, found);

	if (n > 1)
		cmd_ambiguous(text, found, n);
	else if (!n)
		cmd_unknown(text);
	return n == 1 ? found[0] : NULL;
}

/* options are never refused, but one without effect is likely a mistake */
static void check_options(const struct cmd *c, const char *seen)
{
	for (const struct opt *o = opts; o->letter; o++)
		if (o->letter != 'j' && strchr(seen, o->letter) && !strchr(c->opts, o->letter))
			note("warning: option --%s has no effect on '%s'", o->name, c->name);
}

/*
 * With stdout closed, opening the device file would make it stdout. The
 * stand-in refuses the wrong direction, so lost output is an error.
 */
static void fill_std_files(void)
{
	for (int fd = 0; fd < 3; fd++)
		if (fcntl(fd, F_GETFD) < 0 && errno == EBADF &&
		    open("/dev/null", fd ? O_RDONLY : O_WRONLY) < 0)
			return;
}

static int run(struct tool *t, const struct cmd *c, int nargs, char **args)
{
	bool compares = c->flags & CMD_COMPARES;
	int ret, err;

	if (nargs < c->min_args)
		return usage_error("missing argument: ethercat %s %s", c->name, c->args) + compares;
	if (nargs > c->max_args)
		return usage_error("unexpected argument '%s'", args[c->max_args]) + compares;
	if (c->flags & CMD_LINES || (t->follow && strchr(c->opts, 'F')))
		out_start_lines(t->json);
	else
		out_start(t->json);
	ret = c->run(t, nargs, args);
	if (!ret)
		ret = dev_nothing_selected();
	err = out_finish();
	if (err && (!ret || compares))
		ret = fail_full(-err, NULL, 0, "cannot write the output") + compares;
	return ret;
}

/* of one command, or with NULL of all */
static int show_help(const struct tool *t, const struct cmd *c)
{
	int err;

	out_start(t->json);
	if (t->json)
		help_json(c);
	else if (c)
		help_cmd(c);
	else
		help_all(false);
	err = out_finish();
	return err ? fail_full(-err, NULL, 0, "cannot write the output") : 0;
}

int main(int argc, char **argv)
{
	const struct cmd *c, *shown;
	char seen[64];
	struct tool t;
	char **args;
	int nargs;
	bool help;
	int ret;

	fill_std_files();
	args = calloc((size_t)argc + 1, sizeof(*args));
	if (!args)
		return fail("out of memory");
	ret = 1;
	if (argc == 2 && !strcmp(argv[1], "--version"))
		argv[1] = "version";
	if (options_parse(&t, argc, argv, args, &nargs, &help, seen, sizeof(seen))) {
		c = argc > 1 ? cmd_exact(argv[1]) : NULL;
		ret = c && c->flags & CMD_COMPARES ? 2 : 1;
		goto out;
	}
	error_context("", t.json);
	if (!nargs) {
		if (help)
			ret = show_help(&t, NULL);
		else
			help_all(true);
		goto out;
	}
	c = find(args[0]);
	if (!c)
		goto out;
	shown = c->alias_of ? cmd_exact(c->alias_of) : c;
	error_context(c->name, t.json);
	if (help) {
		ret = show_help(&t, shown);
		goto out;
	}
	check_options(shown, seen);
	ret = run(&t, shown, nargs - 1, args + 1);
out:
	free(args);
	return ret;
}
