// SPDX-License-Identifier: GPL-2.0-only
/* Slaves and values of a session as a bus file calls them. */
#include <stdlib.h>
#include <string.h>

#include "bus_machine.h"
#include "current.h"

static void pair(void *ctx, const struct ecb_master *m, const struct ecb_slave *file,
		 const struct ecb_slave *found)
{
	struct bus_paired *x = ctx;

	(void)m;
	for (size_t i = 0; i < x->n; i++)
		if (x->machine->masters[0]->slaves[i] == found) {
			x->of[i] = file;
			x->named++;
			return;
		}
}

void bus_pair_free(struct bus_paired *x)
{
	free(x->of);
	ecb_bus_free(x->machine);
	ecb_bus_free(x->file);
	*x = (struct bus_paired){ 0 };
}

int bus_pair(const struct tool *t, struct dev *d, const char *path, struct bus_paired *x)
{
	struct bus_wish wish = { .serials = true };
	struct ecb_bus *machine;
	struct ecb_error e;

	*x = (struct bus_paired){ 0 };
	if (ecb_file_read(&x->file, path, &e))
		return fail("%s", e.text);
	if (bus_of_master(t, d, &wish, &machine))
		return 1;
	x->machine = machine;
	x->n = machine->masters[0]->slave_count;
	x->of = calloc(x->n + 1, sizeof(*x->of));
	if (!x->of || ecb_pairs(x->file, machine, ECB_COMPARE_MACHINE, pair, x) < 0)
		return fail("out of memory");
	if (!x->named)
		return fail("%s: none of its slaves is on the bus of master %u; 'ethercat bus check' compares them",
			    path, d->master);
	return 0;
}

static int by_name(const void *a, const void *b)
{
	return strcmp((*(const struct ect_value *const *)a)->name,
		      (*(const struct ect_value *const *)b)->name);
}

/* a name of the file may be one that a slave which is not in the file has */
static int check_twice(const char *path, const struct current *l)
{
	const struct ect_value **v = calloc(l->n + 1, sizeof(*v));
	int ret = v ? 0 : fail("out of memory");

	for (size_t i = 0; v && i < l->n; i++)
		v[i] = current_at(l, i);
	if (v)
		qsort(v, l->n, sizeof(*v), by_name);
	for (size_t i = 1; v && i < l->n && !ret; i++)
		if (!strcmp(v[i - 1]->name, v[i]->name))
			ret = fail("%s: two values of the session are called %s then; name their slaves in the file",
				   path, v[i]->name);
	free(v);
	return ret;
}

int bus_values(const struct tool *t, struct dev *d, const char *path, struct current *l)
{
	struct bus_paired x;
	int ret = bus_pair(t, d, path, &x);

	for (size_t i = 0; i < l->n && !ret; i++) {
		s32 at = current_at(l, i)->position;

		if (at >= 0 && (size_t)at < x.n && x.of[at])
			ret = current_rename_value(l, i, x.of[at]);
	}
	if (!ret)
		ret = check_twice(path, l);
	bus_pair_free(&x);
	return ret;
}
