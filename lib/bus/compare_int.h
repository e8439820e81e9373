/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of ecb_compare() share. */
#ifndef ECB_COMPARE_INT_H
#define ECB_COMPARE_INT_H

#include "fields.h"
#include "match.h"

/**
 * struct comparing - state of a call of ecb_compare()
 * @flags: of the call
 * @fn: called for each difference
 * @ctx: for @fn
 * @count: differences so far; what is pending is none
 * @master: index of the present master
 * @slave: name of the present slave, "": none
 * @known: ECB_KNOWN_* of what is found
 * @cycle: of the present master in ns, 0: not known
 * @err: -ENOMEM, or 0
 */
struct comparing {
	unsigned int flags;
	ecb_difference_fn fn;
	void *ctx;
	long count;
	uint32_t master;
	const char *slave;
	uint32_t known;
	int64_t cycle;
	int err;
};

/* compare.c; @a: what is expected, @b: what is found; items or NULL */
void differ(struct comparing *c, unsigned int kind, const char *key, const void *a,
	    const char *expected, const void *b, const char *found, const char *remedy);
void compare_items(struct comparing *c, const struct type *type, const char *path, const void *a,
		   const void *b);

/* compare_lists.c */
void compare_lists(struct comparing *c, const struct field *f, const char *path, const void *a,
		   const void *b);

/* compare_slots.c */
void compare_modules(struct comparing *c, const struct ecb_slave *a, const struct ecb_slave *b);
void compare_startup(struct comparing *c, const struct ecb_slave *a, const struct ecb_slave *b);

#endif
