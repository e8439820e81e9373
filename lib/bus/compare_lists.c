// SPDX-License-Identifier: LGPL-2.1-or-later
/* Lists of two buses: by the key of an item, or else by its place. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare_int.h"

#define REMEDY	"map and assign PDOs as in the file, or change the file"

/* an item of a list */
struct keyed {
	const struct field *key;
	void *item;
	size_t at;
};

/* @sorted is made when an item is not at the same place as on the other side */
struct items {
	const struct type *type;
	void *const *v;
	size_t n;
	struct keyed *sorted;
};

/* a name or an index that is unique in its list is the first field of an item */
static bool has_key(const struct type *type)
{
	return type->fields[0].flags & F_REQUIRED &&
		(type->fields[0].kind == K_NAME || type->fields[0].kind == K_NUMBER);
}

static const void *key_at(const struct keyed *k)
{
	return (const char *)k->item + k->key->at;
}

static int by_key(const void *a, const void *b)
{
	const struct keyed *x = a, *y = b;
	uint64_t m, n;

	if (x->key->kind == K_NAME)
		return strcmp(*(const char *const *)key_at(x), *(const char *const *)key_at(y));
	m = scalar_number(x->key, key_at(x));
	n = scalar_number(x->key, key_at(y));
	return m < n ? -1 : m > n;
}

static int sort(struct items *l)
{
	l->sorted = calloc(l->n + 1, sizeof(*l->sorted));
	if (!l->sorted)
		return -ENOMEM;
	for (size_t i = 0; i < l->n; i++)
		l->sorted[i] = (struct keyed){ l->type->fields, l->v[i], i };
	qsort(l->sorted, l->n, sizeof(*l->sorted), by_key);
	return 0;
}

/* where in @others item @i of @l is, or at the end */
static size_t find(struct comparing *c, const struct items *l, size_t i, struct items *others)
{
	const struct keyed key = { l->type->fields, l->v[i], i }, *found;

	if (i < others->n && (!has_key(l->type) ||
			      !by_key(&key, &(struct keyed){ key.key, others->v[i], i })))
		return i;
	if (!has_key(l->type) || c->err)
		return others->n;
	if (!others->sorted)
		c->err = sort(others);
	if (c->err)
		return others->n;
	found = bsearch(&key, others->sorted, others->n, sizeof(key), by_key);
	return found ? found->at : others->n;
}

/* the order of PDOs within a SyncManager is that of their data; one difference for each */
static void compare_order(struct comparing *c, const struct items *x, struct items *y)
{
	size_t last[256], at;
	const struct ecb_pdo *before[256] = { NULL };
	char key[64], expected[64];

	for (size_t i = 0; i < x->n; i++) {
		const struct ecb_pdo *p = x->v[i], *peer;

		at = find(c, x, i, y);
		peer = at < y->n ? y->v[at] : NULL;
		if (!peer || peer->sm != p->sm)
			continue;
		if (before[p->sm] && at < last[p->sm]) {
			snprintf(key, sizeof(key), "pdos 0x%04x order", p->index);
			snprintf(expected, sizeof(expected), "behind 0x%04x",
				 before[p->sm]->index);
			differ(c, ECB_VALUE_DIFFERS, key, p, expected, peer, "before it",
			       "assign PDOs in the order of the file, or change the file");
		}
		before[p->sm] = p;
		last[p->sm] = at;
	}
}

static void path_of(const struct field *f, const char *path, const void *item, size_t i,
		    char *buf, size_t size)
{
	const struct field *first = f->type->fields;
	char key[ECB_WORD];

	if (has_key(f->type))
		scalar_print(first, (const char *)item + first->at, key, sizeof(key));
	else
		snprintf(key, sizeof(key), "%zu", i + 1);
	snprintf(buf, size, "%s%s %s", path, f->key, key);
}

static struct items items_of(const struct field *f, const void *in)
{
	const char *at = (const char *)in + f->at;

	return (struct items){
		.type = f->type, .v = *(void *const *const *)at,
		.n = *(const size_t *)(at + sizeof(void *)),
	};
}

static const char *remedy_of(const struct field *f)
{
	return f->type == &type_pdo || f->type == &type_entry ? REMEDY :
		"configure it as in the file, or change the file";
}

void compare_lists(struct comparing *c, const struct field *f, const char *path, const void *a,
		   const void *b)
{
	struct items x = items_of(f, a), y = items_of(f, b);
	char sub[128];
	size_t at;

	if (c->flags & ECB_COMPARE_MACHINE && !x.n)
		return;
	for (size_t i = 0; i < x.n; i++) {
		at = find(c, &x, i, &y);
		path_of(f, path, x.v[i], i, sub, sizeof(sub) - 1);
		if (at < y.n) {
			strcat(sub, " ");
			compare_items(c, f->type, sub, x.v[i], y.v[at]);
		} else {
			differ(c, ECB_MISSING, sub, x.v[i], f->type->name, NULL, "", remedy_of(f));
		}
	}
	if (f->type == &type_pdo)
		compare_order(c, &x, &y);
	for (size_t i = 0; i < y.n; i++) {
		if (find(c, &y, i, &x) < x.n)
			continue;
		path_of(f, path, y.v[i], i, sub, sizeof(sub));
		differ(c, ECB_EXTRA, sub, NULL, "", y.v[i], f->type->name, remedy_of(f));
	}
	free(x.sorted);
	free(y.sorted);
}
