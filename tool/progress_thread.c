// SPDX-License-Identifier: GPL-2.0-only
#include "progress_thread.h"

#include <stdio.h>

#include "dev.h"

/* True: the call has ended. */
static bool wait_ms(struct progress_thread *w, long ms)
{
	double t = now_s() + (double)ms / 1000;
	struct timespec until;

	until.tv_sec = (time_t)t;
	until.tv_nsec = (long)((t - (double)until.tv_sec) * 1e9);
	while (!w->end && !pthread_cond_timedwait(&w->ended, &w->lock, &until))
		;
	return w->end;
}

static void show_progress(struct progress_thread *w)
{
	w->shown = true;
	fputc('\r', stderr);
	progress_bar(__atomic_load_n(&w->done, __ATOMIC_RELAXED), w->all, w->unit);
}

static void *progress_run(void *arg)
{
	struct progress_thread *w = arg;
	long ms = PROGRESS_FIRST_MS;

	pthread_mutex_lock(&w->lock);
	for (; !wait_ms(w, ms); ms = PROGRESS_NEXT_MS)
		show_progress(w);
	pthread_mutex_unlock(&w->lock);
	return NULL;
}

/**
 * progress_thread_begin() - show the progress of the call that follows
 * @w: thread; @all and @unit are set
 * @t: options
 */
void progress_thread_begin(struct progress_thread *w, const struct tool *t)
{
	pthread_condattr_t attr;

	if (!progress_wanted(t))
		return;
	pthread_mutex_init(&w->lock, NULL);
	pthread_condattr_init(&attr);
	pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
	pthread_cond_init(&w->ended, &attr);
	pthread_condattr_destroy(&attr);
	w->runs = !pthread_create(&w->thread, NULL, progress_run, w);
}

/**
 * progress_thread_end() - the call has ended
 * @w: thread
 */
void progress_thread_end(struct progress_thread *w)
{
	if (!w->runs)
		return;
	pthread_mutex_lock(&w->lock);
	w->end = true;
	pthread_cond_signal(&w->ended);
	pthread_mutex_unlock(&w->lock);
	pthread_join(w->thread, NULL);
	if (!w->shown)
		return;
	show_progress(w);
	fputc('\n', stderr);
}
