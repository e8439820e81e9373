// SPDX-License-Identifier: GPL-2.0-only
/* sdos --save, --compare and --compare-slave */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dict_image.h"
#include "out.h"

#define DIFFERENT	2	/* exit code */

static int by_number(const void *a, const void *b)
{
	const struct dict_entry *x = a, *y = b;

	return x->d.index != y->d.index ? (x->d.index > y->d.index) - (x->d.index < y->d.index) :
	       (x->d.subindex > y->d.subindex) - (x->d.subindex < y->d.subindex);
}

static void sort(struct dict_image *i)
{
	if (i->n)
		qsort(i->v, i->n, sizeof(*i->v), by_number);
}

/* while two dictionaries are compared */
struct comparison {
	const char *left;	/* names of the two */
	const char *right;
	size_t equal;
	size_t different;
	size_t unreadable;	/* on both sides */
};

/* @e is NULL: there is no such entry */
static void side(const char *key, const char *name, const struct dict_entry *e)
{
	const struct dict_value *v = e ? &e->value : NULL;

	out_object(key);
	out_text("    %s: ", name);
	if (!v)
		out_bool("missing", true, "no such entry");
	else if (v->abort)
		out_u("abort_code", v->abort, "abort 0x%08x", v->abort);
	else if (v->err)
		out_str("error", strerror(v->err), "%s", strerror(v->err));
	else if (v->data)
		dict_value_out(e->d.type, v->data, v->size);
	else
		out_bool("not_readable", true, "cannot be read");
	out_text("\n");
	out_end();
}

static void show(const struct comparison *c, const struct dict_entry *a,
		 const struct dict_entry *b, const char *kind)
{
	const struct dict_entry *e = a ? a : b;
	char access[7], type[32];

	dict_access_text(e->d.access, access);
	dict_type_text(e->d.type, type, sizeof(type));
	out_object(NULL);
	out_str("kind", kind, NULL);
	out_u("index", e->d.index, "  0x%04x", e->d.index);
	out_u("subindex", e->d.subindex, ":%02x, ", e->d.subindex);
	out_str("access", access, "%s, ", access);
	out_str("type", type, "%s, ", type);
	out_str("name", e->d.name, "\"%s\"\n", e->d.name);
	side("left", c->left, a);
	side("right", c->right, b);
	out_end();
}

static void compare_entry(struct comparison *c, const struct dict_entry *a,
			  const struct dict_entry *b)
{
	const struct dict_value *x = a ? &a->value : NULL, *y = b ? &b->value : NULL;

	if (x && y && x->data && y->data && x->size == y->size &&
	    !memcmp(x->data, y->data, x->size)) {
		c->equal++;
	} else if (x && y && !x->data && !y->data) {
		/* no line for entries that both slaves can read in no state */
		if (!x->abort && !x->err && !y->abort && !y->err)
			return;
		c->unreadable++;
		show(c, a, b, "unreadable");
	} else {
		c->different++;
		show(c, a, b, "different");
	}
}

static int compare(struct comparison *c, struct dict_image *a, struct dict_image *b)
{
	size_t i = 0, k = 0;

	if (a->vendor_id != b->vendor_id || a->product_code != b->product_code)
		note("%s is a device 0x%08x:0x%08x, %s a device 0x%08x:0x%08x", c->left,
		     a->vendor_id, a->product_code, c->right, b->vendor_id, b->product_code);
	sort(a);
	sort(b);
	out_str("left", c->left, NULL);
	out_str("right", c->right, NULL);
	out_array("entries");
	while (i < a->n || k < b->n) {
		int order = i == a->n ? 1 : k == b->n ? -1 : by_number(&a->v[i], &b->v[k]);

		compare_entry(c, order <= 0 ? &a->v[i] : NULL, order >= 0 ? &b->v[k] : NULL);
		i += order <= 0;
		k += order >= 0;
	}
	out_end();
	out_u("equal", c->equal, "%zu equal, ", c->equal);
	out_u("different", c->different, "%zu different, ", c->different);
	out_u("unreadable", c->unreadable, "%zu unreadable\n", c->unreadable);
	return c->different ? DIFFERENT : 0;
}

static int no_answer(const struct dict_image *i, const char *name)
{
	if (!i->failures)
		return 0;
	return fail("%s: %zu value(s) could not be transferred; read again", name, i->failures);
}

static int with_file(const struct tool *t, struct dev *d, const struct ect_slave *s)
{
	struct comparison c = { .right = t->compare };
	struct dict_image a = { 0 }, b = { 0 };
	char left[32];
	int ret;

	snprintf(left, sizeof(left), "slave %u", s->position);
	c.left = left;
	ret = dict_image_load(t->compare, &b) || dict_image_read(t, d, s, &a) ||
	      no_answer(&a, left) ? 1 : compare(&c, &a, &b);
	dict_image_free(&a);
	dict_image_free(&b);
	return ret;
}

static int with_slave(const struct tool *t, struct dev *d, const struct ect_slave *s)
{
	struct dict_image a = { 0 }, b = { 0 };
	char left[32], right[32];
	struct comparison c = { .left = left, .right = right };
	struct ect_slave other;
	int ret;

	if (dev_slave_at(d, (unsigned int)t->compare_slave, &other))
		return 1;
	snprintf(left, sizeof(left), "slave %u", s->position);
	snprintf(right, sizeof(right), "slave %u", other.position);
	ret = dict_image_read(t, d, s, &a) || dict_image_read(t, d, &other, &b) ||
	      no_answer(&a, left) || no_answer(&b, right) ? 1 : compare(&c, &a, &b);
	dict_image_free(&a);
	dict_image_free(&b);
	return ret;
}

static int save(const struct tool *t, struct dev *d, const struct ect_slave *s)
{
	struct dict_image i = { 0 };
	size_t refused = 0, values = 0;
	int ret;

	ret = dict_image_read(t, d, s, &i) || dict_image_save(t->save, &i);
	for (size_t k = 0; k < i.n; k++) {
		values += i.v[k].value.data != NULL;
		refused += i.v[k].value.abort != 0;
	}
	if (!ret) {
		out_str("output_file", t->save, NULL);
		out_u("entry_count", i.n, NULL);
		out_u("values", values, NULL);
		out_u("unreadable", refused, NULL);
		if (refused)
			note("%zu value(s) refused by the slave: the file has their abort codes",
			     refused);
		ret = no_answer(&i, t->save);
	}
	dict_image_free(&i);
	return ret;
}

static int single(const struct tool *t,
		  int (*fn)(const struct tool *t, struct dev *d, const struct ect_slave *s))
{
	struct ect_slave s;
	struct dev d;
	int ret;

	if (dev_open_single(&d, t, true))
		return 1;
	ret = dev_select_single(&d, t, &s);
	if (!ret) {
		out_u("master", d.master, NULL);
		out_u("position", s.position, NULL);
		ret = fn(t, &d, &s);
	}
	dev_close(&d);
	return ret;
}

/**
 * dict_save() - write the dictionary of a slave to a file
 * @t: command line
 *
 * Return: exit code.
 */
int dict_save(const struct tool *t)
{
	return single(t, save);
}

/**
 * dict_compare() - compare the dictionary of a slave with a file or with another slave
 * @t: command line
 *
 * Return: exit code: 0 equal, 2 different, 1 after a failure, which it has printed.
 */
int dict_compare(const struct tool *t)
{
	return single(t, t->compare ? with_file : with_slave);
}
