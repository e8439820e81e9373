/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of libethercat-bus share. */
#ifndef ECB_INTERNAL_H
#define ECB_INTERNAL_H

#include <stdarg.h>
#include <stdbool.h>

#include "ethercat-bus.h"

#define ECB_API	__attribute__((visibility("default")))

struct chunk;

/* a bus with the memory of everything that belongs to it */
struct whole {
	struct ecb_bus bus;
	struct chunk *chunks;
	size_t used;		/* bytes of all chunks */
};

/* memory.c: NULL sets errno to ENOMEM */
void *ecb_alloc(struct whole *w, size_t size);
const char *ecb_copy(struct whole *w, const char *text, size_t len);

struct type;
/* a list is a pointer to an array of pointers, and the count behind it */
void *ecb_append(struct whole *w, void *list, const struct type *type);
void ecb_defaults(const struct type *type, void *item);

/* report.c: sets the text "FILE:LINE:COLUMN: ..." and returns -EINVAL */
int ecb_report(struct ecb_error *e, const char *file, size_t line, size_t column,
	       const char *fmt, ...) __attribute__((format(printf, 5, 6)));

/* rules.c */
int ecb_rules(struct whole *w, const char *file, struct ecb_error *e);

#endif
