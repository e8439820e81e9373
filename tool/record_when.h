/* SPDX-License-Identifier: GPL-2.0-only */
/* A condition over values of a record. */
#ifndef EC_TOOL_RECORD_WHEN_H
#define EC_TOOL_RECORD_WHEN_H

#include <stdbool.h>
#include <stddef.h>

#include "data_types.h"

struct when;

/* what a name stands for */
struct when_name {
	size_t index;		/* in the values of when_true() */
	struct ec_type type;
};

/* finds a name; 0, or 1 after printing that there is none */
typedef int when_find(void *ctx, const char *name, struct when_name *to);

/* 0 with a result for when_free(), or 1 after printing what is wrong and in which column */
int when_parse(const char *text, when_find *find, void *ctx, struct when **result);
bool when_true(const struct when *w, const u64 *bits);
void when_free(struct when *w);

#endif
