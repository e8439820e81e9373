// SPDX-License-Identifier: GPL-2.0-only
/* What the master knows, and the list of findings. */
#include "why.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "text.h"

/* the kernel's cause and its words; an older module has only the words */
static int read_why(struct dev *d, struct why_config *c)
{
	struct ec_ioc_config_why w = { .index = c->c.index };
	int err = dev_ioctl(d, EC_IOC_CONFIG_WHY, &w);

	if (err)
		return err;
	string_clean(w.text, sizeof(w.text));
	c->cause = w.cause;
	snprintf(c->text, sizeof(c->text), "%s", w.text);
	return 0;
}

static int read_configs(struct why *w)
{
	struct dev *d = w->d;

	w->configs = calloc(w->m.config_count + 1u, sizeof(*w->configs));
	if (!w->configs)
		return fail("out of memory");
	for (u32 i = 0; i < w->m.config_count; i++) {
		struct why_config *c = &w->configs[i];
		int err;

		c->c = (struct ec_ioc_config){ .index = i };
		err = dev_ioctl(d, EC_IOC_CONFIG, &c->c);
		err = err ? err : read_why(d, c);
		if (err == ENOENT)
			break;	/* the application has exited */
		if (err)
			return dev_fail(d, err, "Master%u: cannot read configuration %u", d->master,
					i);
		w->n_configs++;
	}
	return 0;
}

/**
 * why_read() - read what the master knows, without bus traffic
 * @w: result, to be freed with why_free()
 * @d: device file
 *
 * Return: 0, or 1 after printing the error.
 */
int why_read(struct why *w, struct dev *d)
{
	*w = (struct why){ .d = d };
	return dev_slaves(d, &w->bus) || dev_master(d, &w->m) || read_configs(w);
}

void why_free(struct why *w)
{
	slaves_free(&w->bus);
	free(w->configs);
	free(w->f);
	*w = (struct why){ .d = NULL };
}

/**
 * why_add() - add a finding
 * @w: what is known
 * @cause: name for programs
 * @remedy: what to do
 * @fmt: what was found, and expected
 *
 * Return: it, without place; valid until the next one. Without memory one that is not kept.
 */
struct why_finding *why_add(struct why *w, const char *cause, const char *remedy,
			    const char *fmt, ...)
{
	static struct why_finding lost;
	struct why_finding *f = realloc(w->f, (w->n + 1) * sizeof(*f));
	va_list ap;

	if (f)
		w->f = f;
	else if (!w->failed)
		w->failed = fail("out of memory");
	f = f ? &f[w->n++] : &lost;
	*f = (struct why_finding){
		.cause = cause, .slave = WHY_NONE, .port = WHY_NONE, .config = WHY_NONE,
		.domain = WHY_NONE,
	};
	snprintf(f->remedy, sizeof(f->remedy), "%s", remedy);
	va_start(ap, fmt);
	vsnprintf(f->what, sizeof(f->what), fmt, ap);
	va_end(ap);
	return f;
}

/**
 * why_remedy() - what to do, with the place in it
 * @f: finding
 * @fmt: text
 */
void why_remedy(struct why_finding *f, const char *fmt, ...)
{
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(f->remedy, sizeof(f->remedy), fmt, ap);
	va_end(ap);
}

/* the newest finding explains why the slave of @c is not in OP */
void why_explain(struct why *w, struct why_config *c)
{
	if (!c->finding)
		c->finding = w->n;
}

bool why_in_op(const struct why_config *c)
{
	return c->c.state & EC_STATUS_SC_OP;
}

/* order number or name of a slave, for a text */
const char *why_slave_name(const struct why *w, unsigned int position, char *buf, size_t size)
{
	const struct slave *s = position < w->bus.n ? &w->bus.v[position] : NULL;

	if (s && s->order[0])
		snprintf(buf, size, "slave %u (%s)", position, s->order);
	else
		snprintf(buf, size, "slave %u", position);
	return buf;
}
