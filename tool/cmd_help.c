// SPDX-License-Identifier: GPL-2.0-only
#include <stdio.h>
#include <string.h>

#include "data_types.h"
#include "out.h"
#include "tool.h"

static void types(void)
{
	out_text("Data types for --type:\n\n");
	out_array("types");
	for (unsigned int i = 0; i < ec_types_count; i++) {
		const struct ec_type *t = &ec_types[i];

		out_object(NULL);
		out_str("name", t->name, "  %-14s ", t->name);
		if (t->bits)
			out_u("size_bits", t->bits, "%2u bit\n", t->bits);
		else
			out_null("size_bits", "variable\n");
		out_end();
	}
	out_end();
	out_text("\nRaw values are hex bytes: 0x12 0x34, or 1234.\n");
}

static int run(struct tool *t, int argc, char **argv)
{
	const struct cmd *found[64];
	bool man = t->skin && !strcmp(t->skin, "roff");
	int n;

	if (!argc) {
		if (man)
			help_roff();
		else if (out_is_json())
			help_json(NULL);
		else
			help_all(false);
		return 0;
	}
	if (!strcmp(argv[0], "types")) {
		types();
		return 0;
	}
	n = cmd_lookup(argv[0], found);
	if (n > 1)
		return cmd_ambiguous(argv[0], found, n);
	if (!n)
		return cmd_unknown(argv[0]);
	if (found[0]->alias_of)
		found[0] = cmd_exact(found[0]->alias_of);
	if (man)
		help_roff_cmd(found[0]);
	else if (out_is_json())
		help_json(found[0]);
	else
		help_cmd(found[0]);
	return 0;
}

const struct cmd cmd_help = {
	.name = "help",
	.run = run,
	.args = "[COMMAND | types]",
	.opts = "s",
	.summary = "Explain a command",
	.json = "commands[]: name, also[], arguments, summary, text, one_master, json, options[]\n"
		"(long, short, argument, text); without COMMAND also options[] of all; of types:\n"
		"types[]: name, size_bits (or null)",
	.max_args = 1,
};
