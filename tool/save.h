/* SPDX-License-Identifier: GPL-2.0-only */
/* Files that the user named for a result: complete, or unchanged. */
#ifndef EC_TOOL_SAVE_H
#define EC_TOOL_SAVE_H

#include <stdbool.h>
#include <stdio.h>

struct save {
	const char *path;
	char *part;	/* file that replaces @path at the end; NULL: @path itself is written */
	FILE *f;
	bool fresh;	/* @path must not exist at the end either */
};

int save_begin(struct save *s, const char *path);
int save_new(struct save *s, const char *path);
int save_end(struct save *s);
void save_cancel(struct save *s);

#endif
