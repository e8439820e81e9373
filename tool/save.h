/* SPDX-License-Identifier: GPL-2.0-only */
/* Files that the user named for a result: complete, or unchanged. */
#ifndef EC_TOOL_SAVE_H
#define EC_TOOL_SAVE_H

#include <stdio.h>

struct save {
	const char *path;
	char *part;	/* file that replaces @path at the end; NULL: @path itself is written */
	FILE *f;
};

int save_begin(struct save *s, const char *path);
int save_end(struct save *s);

#endif
