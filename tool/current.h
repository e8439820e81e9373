/* SPDX-License-Identifier: GPL-2.0-only */
/* The values of a running session by name, and what they are now. */
#ifndef EC_TOOL_CURRENT_H
#define EC_TOOL_CURRENT_H

#include "data_types.h"
#include "dev.h"

#define CURRENT_TEXT	64	/* bytes of a value as text */

/** struct current_unit - raw number * @scale + @offset, in @text (NULL: none) */
struct current_unit {
	double scale;
	double offset;
	char *text;
};

/**
 * struct current - values of a running session
 * @list: struct ect_value
 * @units: of each value; NULL: the application names none
 * @n: of them
 * @images: data of each domain
 * @sizes: of them in bytes
 * @domains: how many
 * @sends: of the session at the last poll
 * @before: names that the slaves give; NULL: none was replaced
 * @text: what the application says of its values; NULL: nothing
 * @text_size: of it in bytes
 */
struct current {
	struct ect_list *list;
	struct current_unit *units;
	size_t n;
	u8 **images;
	size_t *sizes;
	unsigned int domains;
	u64 sends;
	char (*before)[sizeof(((struct ect_value *)0)->name)];
	char *text;
	size_t text_size;
};

/* both print what is wrong, and return 0 or 1 */
int current_read(struct dev *d, struct current *l);
/* with names, types, units and scaling of a bus file; @file NULL: as current_read() */
int current_read_as(const struct tool *t, struct dev *d, const char *file, struct current *l);
struct ecb_slave;
/* value @i as @s of a bus file calls it; each entry of @s is used once */
int current_rename_value(struct current *l, size_t i, const struct ecb_slave *s);
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

/* NULL: none of them has one */
static inline const struct current_unit *current_unit(const struct current *l,
						      const struct ect_value *v)
{
	return l->units ? &l->units[v - current_at(l, 0)] : NULL;
}

/* "": none */
static inline const char *current_unit_text(const struct current *l, const struct ect_value *v)
{
	const struct current_unit *u = current_unit(l, v);

	return u && u->text ? u->text : "";
}

/* current_names.c */
/* what the application says of its values, to be freed; NULL: nothing. 0 or negative */
int current_text(struct dev *d, char **text, size_t *size);
int current_rename(struct dev *d, struct current *l);
/* names that several values got are not taken; 0, or 1 after printing the error */
int current_distinct(struct current *l);
bool current_is_scaled(const struct current *l, const struct ect_value *v);
double current_scaled(const struct current *l, const struct ect_value *v, double raw);
/* the raw number of a scaled value, as text; false: @text is no number */
bool current_unscaled(const struct current *l, const struct ect_value *v, const char *text,
		      char *buf, size_t size);

/* the lowest 64 bits; false: it is longer */
bool current_bits(const struct current *l, const struct ect_value *v, u64 *bits);
struct ec_type current_type(const struct ect_value *v);
/* the scaled number that @bits of current_type() are */
double current_number(const struct current *l, const struct ect_value *v, u64 bits);
/* scaled, without unit */
void current_format(const struct current *l, const struct ect_value *v, char *buf, size_t size);
/* @text is scaled; 0, or 1 after printing what is wrong */
int current_parse(const struct current *l, const struct ect_value *v, const char *text, u64 *bits);

#endif
