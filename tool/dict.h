/* SPDX-License-Identifier: GPL-2.0-only */
/* The object dictionary of a slave, read entry by entry; functions print errors. */
#ifndef EC_TOOL_DICT_H
#define EC_TOOL_DICT_H

#include "dev.h"

/**
 * struct dict_value - value of an entry
 * @data: bytes, in a buffer with one byte more; NULL: none was read
 * @size: how many
 * @abort: abort code of the slave, 0: none
 * @err: errno of a transfer without answer, 0: none
 */
struct dict_value {
	u8 *data;
	size_t size;
	u32 abort;
	int err;
};

/**
 * struct dict_entry - entry of an object
 * @d: as the slave describes it
 * @value: now
 */
struct dict_entry {
	struct ect_entry d;
	struct dict_value value;
};

/**
 * struct dict_reader - what is done with the dictionary of a slave
 * @entries: read the entries
 * @values: read the values of the entries
 * @limits: and their limits
 * @listing: what it shows goes to stdout while it is read: no progress on the same terminal
 * @object: called for each object
 * @entry: for each entry of it; the memory it points to is freed afterwards
 * @object_end: behind the entries of it, may be NULL
 * @ctx: of the caller
 */
struct dict_reader {
	bool entries;
	bool values;
	bool limits;
	bool listing;
	void (*object)(const struct dict_reader *r, const struct ect_object *o);
	void (*entry)(const struct dict_reader *r, const struct dict_entry *e);
	void (*object_end)(const struct dict_reader *r);
	void *ctx;
};

bool dict_described(const struct ect_slave *s);
int dict_read(const struct tool *t, struct dev *d, const struct ect_slave *s,
	      const struct dict_reader *r);

void dict_access_text(u16 access, char to[7]);
void dict_type_text(u16 type, char *to, size_t size);
char *dict_value_text(u16 type, u8 *data, size_t size);
void dict_value_out(u16 type, u8 *data, size_t size);

#endif
