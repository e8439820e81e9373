/* SPDX-License-Identifier: GPL-2.0-only */
/* A line on a terminal about work that takes longer than a second. */
#ifndef EC_TOOL_PROGRESS_H
#define EC_TOOL_PROGRESS_H

#include "tool.h"

#define PROGRESS_FIRST_MS	1000	/* shorter work shows no progress */
#define PROGRESS_NEXT_MS	200

/**
 * struct progress - work that shows its progress
 * @wanted: a user at a terminal sees it
 * @shown: there is a line
 * @due_s: when the next one is due (now_s())
 */
struct progress {
	bool wanted;
	bool shown;
	double due_s;
};

bool progress_wanted(const struct tool *t);
void progress_bar(u64 done, u64 all, const char *unit);

void progress_begin(struct progress *p, const struct tool *t);
void progress_step(struct progress *p, const char *what, u64 done, u64 all, const char *unit);
void progress_end(struct progress *p);

#endif
