/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* Calls of ecrt.h that are written down: records of master/wire/compiled.h. */
#ifndef ECB_RECORDER_H
#define ECB_RECORDER_H

#include "load.h"
#include "../../../master/wire/compiled.h"

/**
 * struct record_handle - stands for a domain or a slave configuration
 * @next: made before
 * @to: where its calls are written
 * @number: in the order of creation
 */
struct record_handle {
	struct record_handle *next;
	struct record *to;
	uint32_t number;
};

/**
 * struct record - the image so far; it stands for a master
 * @data: bytes
 * @size: their number
 * @room: memory for so many
 * @body: where the body of the present record begins
 * @n: records
 * @n_domains: domains
 * @n_units: sync units
 * @n_groups: groups
 * @n_slaves: slave configurations
 * @n_places: registrations
 * @handles: all
 * @failed: there was no memory
 */
struct record {
	uint8_t *data;
	size_t size;
	size_t room;
	size_t body;
	uint32_t n;
	uint32_t n_domains;
	uint32_t n_units;
	uint32_t n_groups;
	uint32_t n_slaves;
	uint32_t n_places;
	struct record_handle *handles;
	bool failed;
};

extern const struct load_calls load_record;

/* what does not fit into memory is dropped; record_end() and record_finish() report it */
void record_begin(struct record *r, uint16_t op);
int record_end(struct record *r);
void record_u8(struct record *r, uint8_t v);
void record_u16(struct record *r, uint16_t v);
void record_u32(struct record *r, uint32_t v);
void record_u64(struct record *r, uint64_t v);
void record_bytes(struct record *r, const void *data, size_t size);
void record_text(struct record *r, const char *text);
uint32_t record_number(const void *handle);
/* header: before all, and when all is there; 0, -ENOMEM or -EFBIG */
void record_start(struct record *r);
int record_finish(struct record *r);
void record_free(struct record *r);

#endif
