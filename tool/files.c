// SPDX-License-Identifier: GPL-2.0-only
#include "files.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../lib/tools/text.h"
#include "../master/wire/foe.h"
#include "io.h"
#include "out.h"
#include "progress.h"

/* state of the thread that shows the progress of a transfer */
struct watch {
	const struct foe *f;
	u64 done;	/* written by the kernel */
	bool shown;
	bool end;
	pthread_mutex_t lock;
	pthread_cond_t ended;
};

/* True: the transfer has ended. */
static bool wait_ms(struct watch *w, long ms)
{
	double t = now_s() + (double)ms / 1000;
	struct timespec until;

	until.tv_sec = (time_t)t;
	until.tv_nsec = (long)((t - (double)until.tv_sec) * 1e9);
	while (!w->end && !pthread_cond_timedwait(&w->ended, &w->lock, &until))
		;
	return w->end;
}

static void show(struct watch *w)
{
	w->shown = true;
	fputc('\r', stderr);
	/* the length of the file is known for a write only */
	progress_bar(__atomic_load_n(&w->done, __ATOMIC_RELAXED), w->f->write ? w->f->size : 0,
		     "bytes");
}

static void *watch_run(void *arg)
{
	struct watch *w = arg;
	long ms = PROGRESS_FIRST_MS;

	pthread_mutex_lock(&w->lock);
	for (; !wait_ms(w, ms); ms = PROGRESS_NEXT_MS)
		show(w);
	pthread_mutex_unlock(&w->lock);
	return NULL;
}

static bool watch_begin(struct watch *w, const struct tool *t, pthread_t *thread)
{
	pthread_condattr_t attr;
	bool ok;

	if (!progress_wanted(t))
		return false;
	pthread_mutex_init(&w->lock, NULL);
	pthread_condattr_init(&attr);
	pthread_condattr_setclock(&attr, CLOCK_MONOTONIC);
	pthread_cond_init(&w->ended, &attr);
	pthread_condattr_destroy(&attr);
	ok = !pthread_create(thread, NULL, watch_run, w);
	return ok;
}

static void watch_end(struct watch *w, pthread_t thread)
{
	pthread_mutex_lock(&w->lock);
	w->end = true;
	pthread_cond_signal(&w->ended);
	pthread_mutex_unlock(&w->lock);
	pthread_join(thread, NULL);
	if (!w->shown)
		return;
	show(w);
	fputc('\n', stderr);
}

/* The optional second argument. */
int foe_password(int argc, char **argv, struct foe *f)
{
	u64 v = 0;

	if (argc > 1 && io_number("password", argv[1], 0xffffffff, &v))
		return 1;
	f->password = (u32)v;
	return 0;
}

static int failed(struct dev *d, int err, const struct ect_slave *s, const struct foe *f)
{
	u32 code = ect_error_code(d->h);
	const char *text = ec_foe_error_text(code) ?: "unknown code", *own;
	const char *verb = f->write ? "write" : "read", *reason;
	char name[ECT_FOE_NAME + 1];

	snprintf(name, sizeof(name), "%s", f->name);
	string_clean(name, sizeof(name));
	if (!code)
		return dev_fail(d, err, "Master%u slave %u: cannot %s file '%s'", d->master,
				s->position, verb, name);
	reason = ect_reason(d->h);
	own = strstr(reason, "; text of the slave: ");
	if (own && !strcasecmp(strchr(own, ':') + 2, text))
		own = NULL;
	return fail_cause(-err, reason, own ? own + 2 : NULL,
			  "Master%u slave %u: cannot %s file '%s': 0x%08x: %s", d->master,
			  s->position, verb, name, code, text);
}

int foe_check_name(const char *name)
{
	size_t n = strlen(name), i;

	if (!n || n > ECT_FOE_NAME)
		return usage_error("invalid file name '%s': expected 1 to %u characters", name,
				   ECT_FOE_NAME);
	for (i = 0; i < n; i++)
		if (name[i] < ' ' || name[i] > '~')
			return usage_error("invalid file name: expected printable characters; name the file on the slave with -o");
	return 0;
}

/* A read sets @f->size to the bytes received. */
int foe_transfer(struct dev *d, const struct tool *t, const struct ect_slave *s, struct foe *f)
{
	struct watch w = { .f = f };
	pthread_t thread;
	double begin;
	bool watched;
	long n;

	begin = now_s();
	watched = watch_begin(&w, t, &thread);
	if (f->write)
		n = ect_foe_write(d->h, s->device, f->name, f->password, f->data, f->size, &w.done);
	else
		n = ect_foe_read(d->h, s->device, f->name, f->password, f->data, f->size, &w.done);
	if (watched)
		watch_end(&w, thread);
	if (n < 0)
		return failed(d, (int)n, s, f);
	if (!f->write)
		f->size = (u32)n;
	if (t->verbosity > 0)
		fprintf(stderr, "%u bytes in %.2f s\n", f->size, now_s() - begin);
	out_u("master", d->master, NULL);
	out_u("position", s->position, NULL);
	out_str("name", f->name, NULL);
	out_u("size_bytes", f->size, NULL);
	return 0;
}

const char *base_name(const char *path)
{
	const char *slash = strrchr(path, '/');

	return slash ? slash + 1 : path;
}
