// SPDX-License-Identifier: GPL-2.0-only
#include "top_names.h"

#ifdef EC_TOOL_NO_BUS
int top_names_read(const struct tool *t, struct dev *d, const struct slaves *all,
		   struct top_names *x)
{
	(void)d;
	(void)all;
	(void)x;
	return t->file ? fail("--file: this 'ethercat' was built without libyaml") : 0;
}

const char *top_name(const struct top_names *x, const struct ect_slave *s)
{
	(void)x;
	(void)s;
	return NULL;
}

void top_names_free(struct top_names *x)
{
	(void)x;
}
#else
#include <stdlib.h>
#include <string.h>

#include "current.h"

static bool same_slaves(const struct top_names *x, const struct slaves *all)
{
	for (size_t i = 0; i < all->n && i < x->n; i++)
		if (x->devices[i] != all->v[i].device)
			return false;
	return all->n == x->n;
}

/* which slave is which in the file is asked again when the bus has changed */
static int read_file(const struct tool *t, struct dev *d, const struct slaves *all,
		     struct top_names *x)
{
	if (x->devices && same_slaves(x, all))
		return 0;
	free(x->devices);
	bus_pair_free(&x->paired);
	x->devices = calloc(all->n + 1, sizeof(*x->devices));
	if (!x->devices)
		return fail("out of memory");
	x->n = all->n;
	for (size_t i = 0; i < x->n; i++)
		x->devices[i] = all->v[i].device;
	return bus_pair(t, d, t->file, &x->paired);
}

/* The text is that of another user. One that is not valid names nothing. */
static int read_session(struct dev *d, struct top_names *x)
{
	struct ecb_error e;
	char *text;
	size_t size;
	int err = current_text(d, &text, &size);

	if (err)
		return dev_fail(d, err, "Master%u: cannot read the names of its application",
				d->master);
	if (size == x->size && (!size || !memcmp(text, x->text, size))) {
		free(text);
		return 0;
	}
	free(x->text);
	ecb_bus_free(x->bus);
	x->bus = NULL;
	x->text = text;
	x->size = size;
	if (text && !ecb_file_parse(&x->bus, "names of the application", text, size, &e) &&
	    x->bus->master_count == 1)
		return 0;
	ecb_bus_free(x->bus);
	x->bus = NULL;
	return 0;
}

int top_names_read(const struct tool *t, struct dev *d, const struct slaves *all,
		   struct top_names *x)
{
	return t->file ? read_file(t, d, all, x) : read_session(d, x);
}

/* the slaves of the text are in the order of the configurations */
static const struct ecb_slave *slave_of(const struct top_names *x, const struct ect_slave *s)
{
	if (x->paired.of)
		return s->position < x->paired.n ? x->paired.of[s->position] : NULL;
	if (!x->bus || !s->config || s->config > x->bus->masters[0]->slave_count)
		return NULL;
	return x->bus->masters[0]->slaves[s->config - 1];
}

const char *top_name(const struct top_names *x, const struct ect_slave *s)
{
	const struct ecb_slave *named = slave_of(x, s);

	return named && named->vendor == s->vendor_id && named->product == s->product_code ?
		named->name : NULL;
}

void top_names_free(struct top_names *x)
{
	free(x->devices);
	bus_pair_free(&x->paired);
	free(x->text);
	ecb_bus_free(x->bus);
}
#endif
