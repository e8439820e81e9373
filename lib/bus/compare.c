// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "fields.h"
#include "match.h"

struct comparison {
	unsigned int flags;
	ecb_difference_fn fn;
	void *ctx;
	long count;
	uint32_t master;
	const char *slave;
};

static uint32_t line_of(const void *item)
{
	return item ? *(const uint32_t *)item : 0;
}

/* @a: what is expected, @b: what is found; items or NULL */
static void differ(struct comparison *c, unsigned int kind, const char *key, const void *a,
		   const char *expected, const void *b, const char *found, const char *remedy)
{
	struct ecb_difference d = {
		.kind = kind, .master = c->master, .line = line_of(a), .found_line = line_of(b),
		.slave = c->slave, .key = key, .expected = expected, .found = found,
		.remedy = c->flags & ECB_COMPARE_MACHINE ? remedy : "",
	};

	c->count++;
	c->fn(c->ctx, &d);
}

static const char *remedy_of(const struct field *f)
{
	if (!strcmp(f->key, "alias"))
		return "write the alias with 'ethercat alias', or change it in the file";
	if (!strcmp(f->key, "serial") || !strcmp(f->key, "identification"))
		return "install the expected device, or change the number in the file";
	return "change the slave, or the file";
}

static void compare_items(struct comparison *c, const struct type *type, const char *path,
			  const void *a, const void *b);

static void print(const struct field *f, const void *from, char *buf, size_t size)
{
	if (scalar_given(f, from))
		scalar_print(f, from, buf, size);
	else
		snprintf(buf, size, "none");
}

/* also beyond what is printed of them */
static bool same_bytes(const struct ecb_bytes *a, const struct ecb_bytes *b)
{
	return a->size == b->size && (!a->size || !memcmp(a->data, b->data, a->size));
}

static void compare_scalars(struct comparison *c, const struct field *f, const char *path,
			    const void *a, const void *b)
{
	const void *x = (const char *)a + f->at, *y = (const char *)b + f->at;
	char expected[ECB_VALUE], found[ECB_VALUE], key[128];

	/* an entry without object is a gap, which is expected as well */
	if (c->flags & ECB_COMPARE_MACHINE && !scalar_given(f, x) && strcmp(f->key, "object"))
		return;
	print(f, x, expected, sizeof(expected));
	print(f, y, found, sizeof(found));
	if (!strcmp(expected, found) && (f->kind != K_BYTES || same_bytes(x, y)))
		return;
	snprintf(key, sizeof(key), "%s%s", path, f->key);
	differ(c, ECB_VALUE_DIFFERS, key, a, expected, b, found, remedy_of(f));
}

/* a name or an index that is unique in its list is the first field of an item */
static bool has_key(const struct type *type)
{
	return type->fields[0].flags & F_REQUIRED &&
		(type->fields[0].kind == K_NAME || type->fields[0].kind == K_NUMBER);
}

static void key_of(const struct type *type, const void *item, size_t i, char *buf, size_t size)
{
	if (has_key(type))
		scalar_print(&type->fields[0], (const char *)item + type->fields[0].at, buf, size);
	else
		snprintf(buf, size, "%zu", i + 1);
}

static const void *same_key(const struct type *type, const void *item, size_t i,
			    void *const *others, size_t n)
{
	char key[ECB_WORD], other[ECB_WORD];

	if (!has_key(type))
		return i < n ? others[i] : NULL;
	key_of(type, item, i, key, sizeof(key));
	for (size_t k = 0; k < n; k++) {
		key_of(type, others[k], k, other, sizeof(other));
		if (!strcmp(key, other))
			return others[k];
	}
	return NULL;
}

static size_t pdo_at(void *const *pdos, size_t n, const struct ecb_pdo *p)
{
	size_t i = 0;

	while (i < n && ((const struct ecb_pdo *)pdos[i])->index != p->index)
		i++;
	return i;
}

/* the order of PDOs within a SyncManager is that of their data; one difference for each */
static void compare_order(struct comparison *c, void *const *x, size_t n, void *const *y, size_t k)
{
	size_t last[256], at;
	const struct ecb_pdo *before[256] = { NULL };
	char key[64], expected[64], found[64];

	for (size_t i = 0; i < n; i++) {
		const struct ecb_pdo *p = x[i], *peer;

		at = pdo_at(y, k, p);
		peer = at < k ? y[at] : NULL;
		if (!peer || peer->sm != p->sm)
			continue;
		if (before[p->sm] && at < last[p->sm]) {
			snprintf(key, sizeof(key), "pdos 0x%04x order", p->index);
			snprintf(expected, sizeof(expected), "behind 0x%04x",
				 before[p->sm]->index);
			snprintf(found, sizeof(found), "before it");
			differ(c, ECB_VALUE_DIFFERS, key, p, expected, peer, found,
			       "assign PDOs in the order of the file, or change the file");
		}
		before[p->sm] = p;
		last[p->sm] = at;
	}
}

static void by_slot(const struct ecb_slave *s, const struct ecb_module *to[UINT8_MAX + 1])
{
	memset(to, 0, (UINT8_MAX + 1) * sizeof(*to));
	for (size_t i = 0; i < s->module_count; i++)
		to[s->modules[i]->slot] = s->modules[i];
}

static void ident(const struct ecb_module *m, char *buf, size_t size)
{
	if (m)
		snprintf(buf, size, "ident 0x%08x%s%s", m->ident, m->name ? ", " : "",
			 m->name ? m->name : "");
	else
		snprintf(buf, size, "an empty slot");
}

/* slot by slot */
static void compare_modules(struct comparison *c, const struct ecb_slave *a,
			    const struct ecb_slave *b)
{
	const struct ecb_module *as[UINT8_MAX + 1], *bs[UINT8_MAX + 1];
	char key[32], expected[192], found[192], remedy[96];

	if (!a->module_count && (c->flags & ECB_COMPARE_MACHINE || !b->module_count))
		return;
	by_slot(a, as);
	by_slot(b, bs);
	for (unsigned int slot = 1; slot <= UINT8_MAX; slot++) {
		const struct ecb_module *x = as[slot], *y = bs[slot];

		if (x ? y && x->ident == y->ident : !y)
			continue;
		snprintf(key, sizeof(key), "module in slot %u", slot);
		ident(x, expected, sizeof(expected));
		ident(y, found, sizeof(found));
		if (x)
			snprintf(remedy, sizeof(remedy),
				 "plug the expected module into slot %u, or change modules in the file",
				 slot);
		else
			snprintf(remedy, sizeof(remedy),
				 "remove it from slot %u, or add it to modules in the file", slot);
		differ(c, ECB_VALUE_DIFFERS, key, x ? (const void *)x : a, expected,
		       y ? (const void *)y : b, found, remedy);
	}
}

static void compare_lists(struct comparison *c, const struct field *f, const char *path,
			  const void *a, const void *b)
{
	void *const *x = *(void *const *const *)((const char *)a + f->at);
	void *const *y = *(void *const *const *)((const char *)b + f->at);
	size_t n = *(const size_t *)((const char *)a + f->at + sizeof(void *));
	size_t k = *(const size_t *)((const char *)b + f->at + sizeof(void *));
	char sub[128], key[ECB_WORD];

	if (c->flags & ECB_COMPARE_MACHINE && !n)
		return;
	for (size_t i = 0; i < n; i++) {
		const void *peer = same_key(f->type, x[i], i, y, k);

		key_of(f->type, x[i], i, key, sizeof(key));
		snprintf(sub, sizeof(sub), "%s%s %s%s", path, f->key, key, peer ? " " : "");
		if (peer)
			compare_items(c, f->type, sub, x[i], peer);
		else
			differ(c, ECB_MISSING, sub, x[i], f->type->name, NULL, "",
			       "map and assign PDOs as in the file, or change the file");
	}
	if (f->type == &type_pdo)
		compare_order(c, x, n, y, k);
	for (size_t i = 0; i < k; i++) {
		if (same_key(f->type, y[i], i, x, n))
			continue;
		key_of(f->type, y[i], i, key, sizeof(key));
		snprintf(sub, sizeof(sub), "%s%s %s", path, f->key, key);
		differ(c, ECB_EXTRA, sub, NULL, "", y[i], f->type->name,
		       "map and assign PDOs as in the file, or change the file");
	}
}

static void compare_fields(struct comparison *c, const struct field *f, const char *path,
			   const void *a, const void *b)
{
	const void *x = f->kind == K_ITEM ? *(void *const *)((const char *)a + f->at) : NULL;
	const void *y = f->kind == K_ITEM ? *(void *const *)((const char *)b + f->at) : NULL;
	char sub[128];

	if (f->kind == K_LATER || (c->flags & ECB_COMPARE_MACHINE && !(f->flags & F_MACHINE)))
		return;
	if (f->type == &type_module) {
		compare_modules(c, a, b);
	} else if (f->kind == K_LIST) {
		compare_lists(c, f, path, a, b);
	} else if (f->kind != K_ITEM) {
		compare_scalars(c, f, path, a, b);
	} else if (x && y) {
		snprintf(sub, sizeof(sub), "%s%s ", path, f->key);
		compare_items(c, f->type, sub, x, y);
	} else if (x || y) {
		differ(c, x ? ECB_MISSING : ECB_EXTRA, f->key, x, x ? f->type->name : "", y,
		       y ? f->type->name : "", "change the file");
	}
}

static void compare_items(struct comparison *c, const struct type *type, const char *path,
			  const void *a, const void *b)
{
	for (size_t i = 0; i < type->count; i++)
		compare_fields(c, &type->fields[i], path, a, b);
}

static void identity(const struct ecb_slave *s, char *buf, size_t size)
{
	snprintf(buf, size, "%s%svendor 0x%08x, product 0x%08x", s->type ? s->type : "",
		 s->type ? ", " : "", s->vendor, s->product);
}

static void place(const struct side *s, size_t parent, unsigned int port, char *buf, size_t size)
{
	if (parent == NO_SLAVE)
		snprintf(buf, size, "the master");
	else
		snprintf(buf, size, "port %u of '%s'", port, s->slaves[parent]->name);
}

static void compare_places(struct comparison *c, const struct match *m, size_t i, size_t k)
{
	unsigned int port_a, port_b;
	size_t pa = match_parent(&m->a, i, &port_a), pb = match_parent(&m->b, k, &port_b);
	char expected[128], found[128], remedy[256];

	if (c->flags & ECB_COMPARE_MACHINE && m->a.slaves[i]->port == ECB_NONE8)
		return;
	if (pa == NO_SLAVE ? pb == NO_SLAVE : pb == m->a.peer[pa] && port_a == port_b)
		return;
	place(&m->a, pa, port_a, expected, sizeof(expected));
	/* what the other side calls it is not known here */
	if (pb == NO_SLAVE)
		place(&m->b, pb, port_b, found, sizeof(found));
	else
		place(&m->a, m->b.peer[pb], port_b, found, sizeof(found));
	snprintf(remedy, sizeof(remedy), "connect it to %s, or change parent and port in the file",
		 expected);
	differ(c, ECB_MOVED, "port", m->a.slaves[i], expected, m->b.slaves[k], found, remedy);
}

static void compare_revisions(struct comparison *c, const struct ecb_slave *a,
			      const struct ecb_slave *b)
{
	char expected[64], found[64];

	if (!a->revision || a->revision_rule == ECB_REVISION_ANY || a->revision == b->revision ||
	    (a->revision_rule == ECB_REVISION_AT_LEAST && b->revision > a->revision))
		return;
	snprintf(expected, sizeof(expected), "%s0x%08x",
		 a->revision_rule == ECB_REVISION_AT_LEAST ? "at least " : "", a->revision);
	snprintf(found, sizeof(found), "0x%08x", b->revision);
	differ(c, ECB_VALUE_DIFFERS, "revision", a, expected, b, found,
	       "if this revision is right, set revision, or revision_rule: at_least, in the file");
}

static void compare_slaves(struct comparison *c, const struct match *m, size_t i, size_t k)
{
	const struct ecb_slave *a = m->a.slaves[i], *b = m->b.slaves[k];
	bool machine = c->flags & ECB_COMPARE_MACHINE;
	char expected[256], found[256];

	if (!same_identity(a, b)) {
		identity(a, expected, sizeof(expected));
		identity(b, found, sizeof(found));
		differ(c, ECB_EXCHANGED, "", a, expected, b, found,
		       "install the expected device, or change vendor and product in the file");
		return;
	}
	compare_places(c, m, i, k);
	if (machine)
		compare_revisions(c, a, b);
	for (size_t n = 0; n < type_slave.count; n++) {
		const struct field *f = &type_slave.fields[n];

		if (strcmp(f->key, "parent") && strcmp(f->key, "port") &&
		    (!machine || strcmp(f->key, "revision")))
			compare_fields(c, f, "", a, b);
	}
}

/* a slave that only one side has */
static void alone(struct comparison *c, const struct match *m, size_t i, bool expected)
{
	const struct side *s = expected ? &m->a : &m->b;
	size_t parent = s->parent[i];
	const struct ecb_slave *slave = s->slaves[i];
	char who[256], at[128], remedy[256];

	identity(slave, who, sizeof(who));
	if (!expected && parent != NO_SLAVE && s->peer[parent] != NO_SLAVE)
		place(&m->a, s->peer[parent], slave->port, at, sizeof(at));
	else
		place(s, parent, slave->port, at, sizeof(at));
	if (slave->port != ECB_NONE8)
		snprintf(who + strlen(who), sizeof(who) - strlen(who), ", at %s", at);
	c->slave = slave->name;
	if (expected) {
		if (slave->port == ECB_NONE8)
			at[0] = 0;
		snprintf(remedy, sizeof(remedy), "connect it%s%s, or remove it from the file",
			 at[0] ? " to " : "", at);
		differ(c, ECB_MISSING, "", slave, who, NULL, "", remedy);
	} else {
		differ(c, ECB_EXTRA, "", NULL, "", slave, who,
		       "remove it from the bus, or add it to the file");
	}
}

static int compare_masters(struct comparison *c, const struct ecb_master *a,
			   const struct ecb_master *b)
{
	struct match m;
	int ret = match_slaves(&m, a, b, !(c->flags & ECB_COMPARE_MACHINE));

	c->slave = "";
	for (size_t i = 0; i < type_master.count && !ret; i++)
		if (type_master.fields[i].type != &type_slave)
			compare_fields(c, &type_master.fields[i], "", a, b);
	for (size_t i = 0; i < m.a.count && !ret; i++) {
		c->slave = a->slaves[i]->name;
		if (m.a.peer[i] == NO_SLAVE)
			alone(c, &m, i, true);
		else
			compare_slaves(c, &m, i, m.a.peer[i]);
	}
	for (size_t i = 0; i < m.b.count && !ret; i++)
		if (m.b.peer[i] == NO_SLAVE)
			alone(c, &m, i, false);
	match_free(&m);
	return ret;
}

ECB_API long ecb_compare(const struct ecb_bus *expected, const struct ecb_bus *found,
			 unsigned int flags, ecb_difference_fn fn, void *ctx)
{
	struct comparison c = { .flags = flags, .fn = fn, .ctx = ctx, .slave = "" };
	const struct ecb_bus *sides[] = { expected, found };

	for (int side = 0; side < 2; side++)
		for (size_t i = 0; i < sides[side]->master_count; i++) {
			const struct ecb_bus *other = sides[!side];
			const struct ecb_master *m = sides[side]->masters[i];
			size_t k = 0;

			while (k < other->master_count && other->masters[k]->index != m->index)
				k++;
			c.master = m->index;
			c.slave = "";
			if (k == other->master_count)
				differ(&c, side ? ECB_EXTRA : ECB_MISSING, "", side ? NULL : m,
				       side ? "" : "a master", side ? m : NULL,
				       side ? "a master" : "",
				       "select masters with -m, or change the file");
			else if (!side && compare_masters(&c, m, other->masters[k]))
				return -ENOMEM;
		}
	return c.count;
}
