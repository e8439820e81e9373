// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "out.h"
#include "tool.h"

#define MAX_CMDS	64

static int ambiguous(const char *text, const struct cmd **found, int n)
{
	char names[512] = "";

	for (int i = 0; i < n; i++) {
		strncat(names, i ? ", " : "", sizeof(names) - strlen(names) - 1);
		strncat(names, found[i]->name, sizeof(names) - strlen(names) - 1);
	}
	return usage_error("'%s' is ambiguous: %s", text, names);
}

static const struct cmd *find(const char *text)
{
	const struct cmd *found[MAX_CMDS];
	int n = cmd_lookup(text, found);

	if (n > 1)
		ambiguous(text, found, n);
	else if (!n)
		usage_error("unknown command '%s'", text);
	return n == 1 ? found[0] : NULL;
}

/* options are never refused, but one without effect is likely a mistake */
static void check_options(const struct cmd *c, const char *seen)
{
	for (const struct opt *o = opts; o->letter; o++)
		if (o->letter != 'j' && strchr(seen, o->letter) && !strchr(c->opts, o->letter))
			note("warning: option --%s has no effect on '%s'", o->name, c->name);
}

static int run(struct tool *t, const struct cmd *c, int nargs, char **args)
{
	int ret, err;

	if (nargs < c->min_args)
		return usage_error("missing argument: ethercat %s %s", c->name, c->args);
	if (nargs > c->max_args)
		return usage_error("unexpected argument '%s'", args[c->max_args]);
	out_start(t->json);
	ret = c->run(t, nargs, args);
	err = out_finish();
	if (err && !ret)
		ret = fail_full(-err, NULL, 0, "cannot write the output");
	return ret;
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

	args = calloc((size_t)argc + 1, sizeof(*args));
	if (!args)
		return fail("out of memory");
	ret = 1;
	if (argc == 2 && !strcmp(argv[1], "--version"))
		argv[1] = "version";
	if (options_parse(&t, argc, argv, args, &nargs, &help, seen, sizeof(seen)))
		goto out;
	error_context("", t.json);
	if (!nargs) {
		help_all(!help);
		ret = !help;
		goto out;
	}
	c = find(args[0]);
	if (!c)
		goto out;
	shown = c->alias_of ? cmd_exact(c->alias_of) : c;
	error_context(c->name, t.json);
	ret = 0;
	if (help) {
		help_cmd(shown);
		goto out;
	}
	if (!shown->run) {
		ret = fail("this command is not part of version " EC_TOOL_VERSION);
		goto out;
	}
	check_options(shown, seen);
	ret = run(&t, shown, nargs - 1, args + 1);
out:
	free(args);
	return ret;
}
