/* SPDX-License-Identifier: GPL-2.0-only */
/* A thread that shows the progress of a call of the library. */
#ifndef EC_TOOL_PROGRESS_THREAD_H
#define EC_TOOL_PROGRESS_THREAD_H

#include <pthread.h>

#include "progress.h"

/**
 * struct progress_thread - such a thread
 * @done: how much is done; the call writes it
 * @all: of so much, 0: not known
 * @unit: of both
 * @thread: thread
 * @runs: there is one
 * @shown: it has shown something
 * @end: the call has ended
 * @lock: protects @end
 * @ended: it is set
 */
struct progress_thread {
	u64 done;
	u64 all;
	const char *unit;
	pthread_t thread;
	bool runs;
	bool shown;
	bool end;
	pthread_mutex_t lock;
	pthread_cond_t ended;
};

void progress_thread_begin(struct progress_thread *w, const struct tool *t);
void progress_thread_end(struct progress_thread *w);

#endif
