/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Names that are in use, so that a bus of 65,535 equal slaves is named in linear time. */
#ifndef ECB_TABLE_H
#define ECB_TABLE_H

#include <stddef.h>
#include <stdint.h>

struct seat {
	const char *key;	/* belongs to the caller */
	size_t value;
};

struct table {
	struct seat *seats;
	size_t mask;
};

int table_init(struct table *t, size_t keys);
void table_free(struct table *t);
struct seat *table_find(const struct table *t, const char *key);

#endif
