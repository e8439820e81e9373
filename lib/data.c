// SPDX-License-Identifier: LGPL-2.1-or-later
/* Data of libraries above this one. */

#include <stdlib.h>

#include "internal.h"

struct ec_master_data {
	struct ec_master_data *next;
	void *data;
	void (*release)(void *data);
};

static struct ec_master_data *find(const struct ec_master *m, void (*release)(void *data))
{
	struct ec_master_data *d = m->data;

	while (d && d->release != release)
		d = d->next;
	return d;
}

void ec_master_free_data(struct ec_master *m)
{
	struct ec_master_data *d;

	while ((d = m->data)) {
		m->data = d->next;
		if (d->data)
			d->release(d->data);
		free(d);
	}
}

int ecrt_master_set_data(ec_master_t *master, void *data, void (*release)(void *data))
{
	struct ec_master_data *d;
	void *before;

	if (!master || !release)
		return -EINVAL;
	d = find(master, release);
	if (!d) {
		d = calloc(1, sizeof(*d));
		if (!d)
			return -ENOMEM;
		d->release = release;
		d->next = master->data;
		master->data = d;
	}
	before = d->data;
	d->data = data;
	if (before && before != data)
		release(before);
	return 0;
}

void *ecrt_master_data(const ec_master_t *master, void (*release)(void *data))
{
	const struct ec_master_data *d = master ? find(master, release) : NULL;

	return d ? d->data : NULL;
}
