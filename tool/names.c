// SPDX-License-Identifier: GPL-2.0-only
/* Command names and their abbreviations. */
#include <string.h>

#include "out.h"
#include "../lib/tools/text.h"
#include "tool.h"

/* the letters of @text in order; a repeated letter may match the same one */
static bool contains(const char *name, const char *text)
{
	for (; *text; text++) {
		name = strchr(name, *text);
		if (!name)
			return false;
	}
	return true;
}

static bool matches(const char *name, const char *text, bool prefix)
{
	return prefix ? !strncmp(name, text, strlen(text)) : contains(name, text);
}

const struct cmd *cmd_exact(const char *name)
{
	for (const struct cmd *const *c = cmds; *c; c++)
		if (!strcmp((*c)->name, name))
			return *c;
	return NULL;
}

/* a command of this version, or another name of one */
static bool exists(const struct cmd *c)
{
	return c->run || c->alias_of;
}

/**
 * cmd_lookup() - find a command by its name or an abbreviation
 * @text: as typed
 * @found: array for all commands; receives the candidates of the stage that
 *	had any
 *
 * An exact name wins, also of a command that this version lacks; then come the names
 * users of older tools abbreviate, by prefix and by letters in order; then the names
 * added since.
 *
 * Return: number of candidates.
 */
int cmd_lookup(const char *text, const struct cmd **found)
{
	int n = 0;

	found[0] = cmd_exact(text);
	if (found[0])
		return 1;
	for (int stage = 0; stage < 4 && !n && *text; stage++)
		for (const struct cmd *const *c = cmds; *c; c++)
			if (exists(*c) && ((*c)->flags & CMD_HISTORIC ? 0 : 1) == stage / 2 &&
			    matches((*c)->name, text, !(stage % 2)))
				found[n++] = *c;
	return n;
}

/* the long option that @word, without "--", nearly is, or NULL */
const char *opt_nearest(const char *word)
{
	const char *nearest = NULL;

	for (const struct opt *o = opts; o->letter; o++)
		nearest = text_nearer(word, nearest, o->name);
	return nearest;
}

/* Prints that no command is called @text, and which one is nearly; returns 1. */
int cmd_unknown(const char *text)
{
	const char *nearest = NULL;

	for (const struct cmd *const *c = cmds; *c; c++)
		if (exists(*c))
			nearest = text_nearer(text, nearest, (*c)->name);
	if (!nearest)
		return usage_error("unknown command '%s'", text);
	return usage_error("unknown command '%s'; did you mean '%s'?", text, nearest);
}

/* Prints which commands @text may be; returns 1. */
int cmd_ambiguous(const char *text, const struct cmd **found, int n)
{
	char names[512] = "";

	for (int i = 0; i < n; i++) {
		strncat(names, i ? ", " : "", sizeof(names) - strlen(names) - 1);
		strncat(names, found[i]->name, sizeof(names) - strlen(names) - 1);
	}
	return usage_error("'%s' is ambiguous: %s", text, names);
}
