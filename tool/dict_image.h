/* SPDX-License-Identifier: GPL-2.0-only */
/* A dictionary with its values, of a slave or of a file; functions print errors. */
#ifndef EC_TOOL_DICT_IMAGE_H
#define EC_TOOL_DICT_IMAGE_H

#include "dict.h"

/**
 * struct dict_image - dictionary of a slave at one time
 * @vendor_id: of the slave
 * @product_code: of the slave
 * @revision_number: of the slave
 * @v: entries; a value has its own memory
 * @n: how many
 * @failures: values whose transfer had no answer
 * @no_memory: entries are missing
 */
struct dict_image {
	u32 vendor_id;
	u32 product_code;
	u32 revision_number;
	struct dict_entry *v;
	size_t n;
	size_t failures;
	bool no_memory;
};

int dict_image_read(const struct tool *t, struct dev *d, const struct ect_slave *s,
		    struct dict_image *i);
int dict_image_load(const char *path, struct dict_image *i);
int dict_image_save(const char *path, const struct dict_image *i);
void dict_image_free(struct dict_image *i);

/* the commands sdos --save, --compare and --compare-slave */
int dict_save(const struct tool *t);
int dict_compare(const struct tool *t);

#endif
