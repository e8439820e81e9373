// SPDX-License-Identifier: GPL-2.0-only
/* Values of a session as a bus file calls them. */
#include <stdlib.h>
#include <string.h>

#include "bus_machine.h"
#include "current.h"

/* slaves of the file by their ring position */
struct named {
	const struct ecb_master *machine;	/* slaves in the order of the ring */
	const struct ecb_slave **files;
	size_t named;
};

static void pair(void *ctx, const struct ecb_master *m, const struct ecb_slave *file,
		 const struct ecb_slave *found)
{
	struct named *n = ctx;

	(void)m;
	for (size_t i = 0; i < n->machine->slave_count; i++)
		if (n->machine->slaves[i] == found) {
			n->files[i] = file;
			n->named++;
			return;
		}
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
	struct bus_wish wish = { .serials = true };
	struct ecb_bus *file, *machine;
	struct ecb_error e;
	struct named n = { 0 };
	int ret = 0;

	if (ecb_file_read(&file, path, &e))
		return fail("%s", e.text);
	if (bus_of_master(t, d, &wish, &machine))
		return ecb_bus_free(file), 1;
	n.machine = machine->masters[0];
	n.files = calloc(n.machine->slave_count + 1, sizeof(*n.files));
	if (!n.files || ecb_pairs(file, machine, ECB_COMPARE_MACHINE, pair, &n) < 0)
		ret = fail("out of memory");
	else if (!n.named)
		ret = fail("%s: none of its slaves is on the bus of master %u; 'ethercat bus check' compares them",
			   path, d->master);
	for (size_t i = 0; i < l->n && !ret; i++) {
		s32 at = current_at(l, i)->position;

		if (at >= 0 && (size_t)at < n.machine->slave_count && n.files[at])
			ret = current_rename_value(l, i, n.files[at]);
	}
	if (!ret)
		ret = check_twice(path, l);
	free(n.files);
	ecb_bus_free(machine);
	ecb_bus_free(file);
	return ret;
}
