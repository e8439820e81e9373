// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "table.h"

/* for at most @keys keys: a quarter of the seats at least stays free */
int table_init(struct table *t, size_t keys)
{
	size_t n = 8;

	while (n / 4 * 3 < keys) {
		if (n > SIZE_MAX / 2 / sizeof(*t->seats))
			return -ENOMEM;
		n *= 2;
	}
	t->seats = calloc(n, sizeof(*t->seats));
	t->mask = n - 1;
	return t->seats ? 0 : -ENOMEM;
}

void table_free(struct table *t)
{
	free(t->seats);
	t->seats = NULL;
}

/* the seat of a key, or the free one that it may take by setting @key */
struct seat *table_find(const struct table *t, const char *key)
{
	uint64_t hash = 0xcbf29ce484222325u;
	size_t i;

	for (const char *c = key; *c; c++)
		hash = (hash ^ (unsigned char)*c) * 0x100000001b3u;
	for (i = (hash ^ hash >> 29) & t->mask; t->seats[i].key; i = (i + 1) & t->mask)
		if (!strcmp(t->seats[i].key, key))
			break;
	return &t->seats[i];
}
