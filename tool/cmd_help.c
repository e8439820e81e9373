// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "../master/wire/types.h"
#include "tool.h"

static void types(void)
{
	puts("Data types for --type:\n");
	for (unsigned int i = 0; i < ec_types_count; i++) {
		const struct ec_type *t = &ec_types[i];

		if (t->bits)
			printf("  %-14s %2u bit\n", t->name, t->bits);
		else
			printf("  %-14s variable\n", t->name);
	}
	puts("\nRaw values are hex bytes: 0x12 0x34, or 1234.");
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct cmd *found[64];
	int n;

	if (t->skin && !strcmp(t->skin, "roff")) {
		help_roff();
		return 0;
	}
	if (!argc) {
		help_all(false);
		return 0;
	}
	if (!strcmp(argv[0], "types")) {
		types();
		return 0;
	}
	n = cmd_lookup(argv[0], found);
	if (n > 1)
		return usage_error("'%s' is ambiguous", argv[0]);
	if (!n)
		return usage_error("unknown command '%s'", argv[0]);
	if (found[0]->alias_of)
		found[0] = cmd_exact(found[0]->alias_of);
	if (!found[0]->run)
		return fail("'%s' is not part of version " EC_TOOL_VERSION, found[0]->name);
	help_cmd(found[0]);
	return 0;
}

const struct cmd cmd_help = {
	.name = "help",
	.run = run,
	.args = "[COMMAND | types]",
	.opts = "s",
	.summary = "Explain a command",
	.max_args = 1,
};
