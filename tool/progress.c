// SPDX-License-Identifier: GPL-2.0-only
#include "progress.h"

#include <stdio.h>
#include <unistd.h>

#include "dev.h"

#define BAR	"##############################"

/* only for a user at a terminal */
bool progress_wanted(const struct tool *t)
{
	return !t->json && t->verbosity >= 0 && isatty(STDERR_FILENO);
}

/**
 * progress_bar() - the rest of a line about progress
 * @done: so much
 * @all: of so much, 0: unknown
 * @unit: of both
 */
void progress_bar(u64 done, u64 all, const char *unit)
{
	u64 part = min(done, all);
	int n = all ? (int)((sizeof(BAR) - 1) * part / all) : 0;

	if (all)
		fprintf(stderr, "[%.*s%*s] %3u %%, %llu of %llu %s", n, BAR,
			(int)sizeof(BAR) - 1 - n, "", (unsigned int)(100 * part / all),
			(unsigned long long)done, (unsigned long long)all, unit);
	else
		fprintf(stderr, "%llu %s", (unsigned long long)done, unit);
	fflush(stderr);
}

void progress_begin(struct progress *p, const struct tool *t)
{
	*p = (struct progress){
		.wanted = progress_wanted(t), .due_s = now_s() + PROGRESS_FIRST_MS / 1000.0,
	};
}

/* to be called often: it shows something when it is due */
void progress_step(struct progress *p, const char *what, u64 done, u64 all, const char *unit)
{
	double now;

	if (!p->wanted)
		return;
	now = now_s();
	if (now < p->due_s)
		return;
	p->due_s = now + PROGRESS_NEXT_MS / 1000.0;
	p->shown = true;
	fprintf(stderr, "\r%s: ", what);
	progress_bar(done, all, unit);
}

/* End the line: other output begins a new one. */
void progress_end(struct progress *p)
{
	if (p->shown)
		fputc('\n', stderr);
	p->shown = false;
}
