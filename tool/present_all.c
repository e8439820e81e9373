// SPDX-License-Identifier: GPL-2.0-only
#include "present_all.h"

#include <stdlib.h>

#include "progress_thread.h"

#define THREADS	16u	/* slaves that are read at once on a bus without session */

/* what the threads share; @next and @done are atomic */
struct work {
	struct present *v;
	size_t n;
	size_t next;
	u64 *done;
};

static void read_some(struct work *w, struct ect_handle *h)
{
	size_t i;

	while ((i = __atomic_fetch_add(&w->next, 1, __ATOMIC_RELAXED)) < w->n) {
		present_read(h, &w->v[i]);
		__atomic_fetch_add(w->done, 1, __ATOMIC_RELAXED);
	}
}

struct reader {
	pthread_t thread;
	struct work *work;
	struct ect_handle *h;
};

static void *run(void *arg)
{
	struct reader *r = arg;

	read_some(r->work, r->h);
	return NULL;
}

/* a handle belongs to one thread; with fewer of them it takes longer */
static unsigned int begin(struct reader *r, unsigned int most, struct work *w, const char *path)
{
	unsigned int n = 0;

	while (n < most) {
		r[n] = (struct reader){ .work = w, .h = ect_new() };
		if (!r[n].h || ect_open_path(r[n].h, path, ECT_OPEN_WRITE) ||
		    pthread_create(&r[n].thread, NULL, run, &r[n])) {
			ect_free(r[n].h);
			break;
		}
		n++;
	}
	return n;
}

/*
 * Beside the cycle of a session the slaves are read one by one: a mailbox message at a time takes
 * the place of an acyclic frame, and the session's own have theirs.
 */
int present_read_all(const struct tool *t, struct dev *d, struct present *v, size_t n)
{
	struct ect_master m = { .struct_size = sizeof(m) };
	struct progress_thread progress = { .all = n, .unit = "slaves" };
	struct work w = { .v = v, .n = n, .done = &progress.done };
	struct reader readers[THREADS];
	unsigned int most = 0, k;

	if (dev_master(d, &m))
		return 1;
	if (!m.active && n > 1)
		most = (unsigned int)min(n - 1, (size_t)THREADS - 1);
	progress_thread_begin(&progress, t);
	k = begin(readers, most, &w, ect_path(d->h));
	read_some(&w, d->h);
	for (unsigned int i = 0; i < k; i++) {
		pthread_join(readers[i].thread, NULL);
		ect_free(readers[i].h);
	}
	progress_thread_end(&progress);
	return 0;
}
