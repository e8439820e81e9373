/* SPDX-License-Identifier: GPL-2.0-only */
/* Number lists and what they select (-m, -a, -p, -d). */
#ifndef EC_TOOL_SELECT_H
#define EC_TOOL_SELECT_H

#include <stdbool.h>
#include <stddef.h>

#include "../include/ethercat-tools.h"

#define LIST_OPEN	0xffffffffU	/* "up to the highest present" */
#define LIST_ITEMS	1024

struct list_item {
	unsigned int from;
	unsigned int to;
};

/**
 * struct list - list = item {"," item}, item = N | N-M | N- | -M | -
 * @given: false: the default, which selects everything
 * @n: items used
 * @item: in the order typed
 */
struct list {
	bool given;
	unsigned int n;
	struct list_item item[LIST_ITEMS];
};

/* numbers of an expanded list, in order and with duplicates */
struct numbers {
	size_t n;
	unsigned int *v;
};

int list_parse(struct list *l, const char *text, const char **why);
int position_parse(struct list *aliases, struct list *positions, const char *text,
		   const char **why);
bool list_all(const struct list *l);
int list_expand(const struct list *l, unsigned int count, struct numbers *out);
bool list_single(const struct list *l, unsigned int *value);
void numbers_free(struct numbers *n);

int select_slaves(const struct list *aliases, const struct list *positions,
		  const struct ect_slave *slaves, size_t count, struct numbers *out);
bool select_config(const struct list *aliases, const struct list *positions,
		   const struct ect_config *config);

#endif
