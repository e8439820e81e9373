// SPDX-License-Identifier: GPL-2.0-only
#include "files.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "../lib/tools/text.h"
#include "../master/wire/foe.h"
#include "io.h"
#include "out.h"
#include "progress_thread.h"

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
	/* the length of the file is known for a write only */
	struct progress_thread w = { .all = f->write ? f->size : 0, .unit = "bytes" };
	double begin;
	long n;

	begin = now_s();
	progress_thread_begin(&w, t);
	if (f->write)
		n = ect_foe_write(d->h, s->device, f->name, f->password, f->data, f->size, &w.done);
	else
		n = ect_foe_read(d->h, s->device, f->name, f->password, f->data, f->size, &w.done);
	progress_thread_end(&w);
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
