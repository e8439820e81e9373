/* SPDX-License-Identifier: GPL-2.0-only */
/* The values of a running session by name, and what they are now. */
#ifndef EC_TOOL_CURRENT_H
#define EC_TOOL_CURRENT_H

#include "data_types.h"
#include "dev.h"

#define CURRENT_TEXT	64	/* bytes of a value as text */

/**
 * struct current - values of a running session
 * @list: struct ect_value
 * @n: of them
 * @images: data of each domain
 * @sizes: of them in bytes
 * @domains: how many
 */
struct current {
	struct ect_list *list;
	size_t n;
	u8 **images;
	size_t *sizes;
	unsigned int domains;
};

/* both print what is wrong, and return 0 or 1 */
int current_read(struct dev *d, struct current *l);
int current_refresh(struct dev *d, struct current *l);
/* as current_refresh(), without a message: 0 or negative */
int current_poll(struct dev *d, struct current *l);
void current_free(struct current *l);

static inline const struct ect_value *current_at(const struct current *l, size_t i)
{
	return ect_list_get(l->list, i);
}

/* a value of that name, or NULL after printing which one is nearly called so */
const struct ect_value *current_find(const struct dev *d, const struct current *l,
				     const char *name);
/* whether a name is meant by @pattern, with * and ? */
bool current_matches(const struct ect_value *v, const char *pattern);

/* the lowest 64 bits; false: it is longer */
bool current_bits(const struct current *l, const struct ect_value *v, u64 *bits);
struct ec_type current_type(const struct ect_value *v);
void current_format(const struct current *l, const struct ect_value *v, char *buf, size_t size);
/* 0, or 1 after printing what is wrong */
int current_parse(const struct ect_value *v, const char *text, u64 *bits);

#endif
