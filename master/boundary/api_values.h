/* SPDX-License-Identifier: GPL-2.0-only */
/* Values of a compiled bus file by their names; for applications in the kernel. */
#ifndef EC_API_VALUES_H
#define EC_API_VALUES_H

#include "../../include/ecrt.h"
#include "../wire/compiled.h"

struct ec_master;

/**
 * struct ec_loaded_value - a value
 * @name: in @texts of struct ec_loaded
 * @v: where and what it is; @v.unit likewise
 */
struct ec_loaded_value {
	const char *name;
	ec_value_t v;
};

/**
 * struct ec_loaded - what was loaded
 * @what: for the application
 * @texts: names and units
 * @used: bytes of them
 * @n: values so far
 * @values: in the order of their names
 */
struct ec_loaded {
	ec_loaded_t what;
	char *texts;
	size_t used;
	u32 n;
	struct ec_loaded_value values[];
};

struct ec_loaded *ec_loaded_new(const struct ec_compiled *c);
void ec_loaded_add(struct ec_loaded *l, const struct ec_compiled_record *r, ec_value_t *v);
void ec_loaded_free(struct ec_master *m);

#endif
