/* SPDX-License-Identifier: GPL-2.0-only */
/* Values of a compiled bus file by their names; for applications in the kernel. */
#ifndef EC_API_VALUES_H
#define EC_API_VALUES_H

#include "../../include/ecrt.h"
#include "../wire/compiled.h"

struct ec_master;

/** struct ec_loaded_value - a value */
struct ec_loaded_value {
	/** @name: in ec_loaded.texts */
	const char *name;
	/** @v: where and what it is; so is its unit */
	ec_value_t v;
};

/** struct ec_loaded - what was loaded */
struct ec_loaded {
	/** @what: for the application */
	ec_loaded_t what;
	/** @texts: names and units */
	char *texts;
	/** @used: bytes of them */
	size_t used;
	/** @n: values so far */
	u32 n;
	/** @values: in the order of their names */
	struct ec_loaded_value values[];
};

struct ec_loaded *ec_loaded_new(const struct ec_compiled *c);
void ec_loaded_add(struct ec_loaded *l, const struct ec_compiled_record *r, ec_value_t *v);
void ec_loaded_free(struct ec_master *m);

#endif
