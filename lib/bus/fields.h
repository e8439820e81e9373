/* SPDX-License-Identifier: LGPL-2.1-or-later */
/*
 * The one table of what may be in a bus file. Reader, writer, schema and ecb_compare() follow it,
 * and so do the texts of errors.
 */
#ifndef ECB_FIELDS_H
#define ECB_FIELDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum kind {
	K_NUMBER,	/* unsigned, of @size bytes */
	K_SIGNED,	/* int64_t */
	K_REAL,
	K_BOOL,
	K_TEXT,
	K_NAME,		/* a word */
	K_VALUE,	/* a word, or two with a dot */
	K_WORD,		/* number of one of @words, of @size bytes */
	K_TIME,		/* int64_t, ns */
	K_BYTES,
	K_OBJECT,	/* index and subindex */
	K_IDN,
	K_ITEM,		/* pointer to an item of @type */
	K_LIST,		/* items of @type, with the count behind */
	K_LATER,	/* known, and not supported yet */
};

#define F_REQUIRED	1
#define F_HEX		2
#define F_SIGN		4	/* a time may be negative */
#define F_MACHINE	8	/* what a machine can be asked for */

#define TEXT_MAX	127	/* bytes of a text */
#define BYTES_MAX	4096	/* of startup data */

struct type;

struct field {
	const char *key;
	enum kind kind;
	unsigned int flags;
	size_t at;
	size_t size;
	uint64_t min;
	uint64_t max;
	uint64_t def;		/* value of what is not given */
	uint32_t known;		/* F_MACHINE: only if this was read, ECB_KNOWN_* */
	const char *const *words;
	const struct type *type;
	const char *text;	/* for the schema */
};

struct type {
	const char *name;	/* in messages: "a slave" */
	size_t size;
	const struct field *fields;
	size_t count;
	size_t most;		/* items of a list */
};

extern const struct type type_bus;
extern const struct type type_master;
extern const struct type type_slave;
extern const struct type type_command;
extern const struct type type_unit;
extern const struct type type_group;
extern const struct type type_module;
extern const struct type type_pdo;
extern const struct type type_entry;

/* scalar.c; @len: bytes without the 0 behind them. NULL, or what is wrong beside the expectation */
struct whole;
bool scalar_parse(struct whole *w, const struct field *f, const char *text, size_t len, void *to);
/* "a number from 0 to 65535" */
void scalar_expected(const struct field *f, char *buf, size_t size);
/* regular expression of the texts that are valid, or NULL */
const char *scalar_pattern(const struct field *f);
/* whether it is not what stands for "not given" */
bool scalar_given(const struct field *f, const void *from);
/* as in a file, without quotes; of K_BYTES up to what fits */
void scalar_print(const struct field *f, const void *from, char *buf, size_t size);
uint64_t scalar_number(const struct field *f, const void *from);
void scalar_set(const struct field *f, void *to, uint64_t value);

#endif
