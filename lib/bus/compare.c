// SPDX-License-Identifier: LGPL-2.1-or-later
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "compare_int.h"

static uint32_t line_of(const void *item)
{
	return item ? *(const uint32_t *)item : 0;
}

void differ(struct comparing *c, unsigned int kind, const char *key, const void *a,
	    const char *expected, const void *b, const char *found, const char *remedy)
{
	struct ecb_difference d = {
		.kind = kind, .master = c->master, .line = line_of(a), .found_line = line_of(b),
		.slave = c->slave, .key = key, .expected = expected, .found = found,
		.remedy = c->flags & ECB_COMPARE_MACHINE ? remedy : "",
	};

	c->count += kind != ECB_PENDING;
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

/* a lease of a machine is a number of cycles */
static bool same_lease(const struct comparing *c, const struct field *f, const void *x,
		       const void *y)
{
	int64_t d = f->kind == K_TIME ? *(const int64_t *)x - *(const int64_t *)y : 0;

	return c->flags & ECB_COMPARE_MACHINE && !strcmp(f->key, "lease") && d &&
		(d < 0 ? -d : d) < c->cycle;
}

static void compare_scalars(struct comparing *c, const struct field *f, const char *path,
			    const void *a, const void *b)
{
	const void *x = (const char *)a + f->at, *y = (const char *)b + f->at;
	char expected[ECB_VALUE], found[ECB_VALUE], key[128];

	/* an entry without object is a gap, which is expected as well */
	if (c->flags & ECB_COMPARE_MACHINE && !scalar_given(f, x) && strcmp(f->key, "object"))
		return;
	print(f, x, expected, sizeof(expected));
	print(f, y, found, sizeof(found));
	if ((!strcmp(expected, found) && (f->kind != K_BYTES || same_bytes(x, y))) ||
	    same_lease(c, f, x, y))
		return;
	snprintf(key, sizeof(key), "%s%s", path, f->key);
	differ(c, ECB_VALUE_DIFFERS, key, a, expected, b, found, remedy_of(f));
}

/* whether a machine has it, and it was read */
static bool is_known(const struct comparing *c, const struct field *f)
{
	uint32_t known = c->known;

	if (c->flags & ECB_COMPARE_SLAVES)
		known &= ECB_KNOWN_MODULES;
	return f->flags & F_MACHINE && (!f->known || known & f->known);
}

static void compare_fields(struct comparing *c, const struct field *f, const char *path,
			   const void *a, const void *b)
{
	const void *x = f->kind == K_ITEM ? *(void *const *)((const char *)a + f->at) : NULL;
	const void *y = f->kind == K_ITEM ? *(void *const *)((const char *)b + f->at) : NULL;
	bool machine = c->flags & ECB_COMPARE_MACHINE;
	char sub[128];

	if (f->kind == K_LATER || (machine && !is_known(c, f)))
		return;
	if (f->type == &type_module) {
		compare_modules(c, a, b);
	} else if (f->type == &type_command && machine) {
		compare_startup(c, a, b);
	} else if (f->kind == K_LIST) {
		compare_lists(c, f, path, a, b);
	} else if (f->kind != K_ITEM) {
		compare_scalars(c, f, path, a, b);
	} else if (x && y) {
		snprintf(sub, sizeof(sub), "%s%s ", path, f->key);
		compare_items(c, f->type, sub, x, y);
	} else if (x || (y && !machine)) {
		differ(c, x ? ECB_MISSING : ECB_EXTRA, f->key, x, x ? f->type->name : "", y,
		       y ? f->type->name : "", "configure it as in the file, or change the file");
	}
}

void compare_items(struct comparing *c, const struct type *type, const char *path, const void *a,
		   const void *b)
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

static void compare_places(struct comparing *c, const struct match *m, size_t i, size_t k)
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

static void compare_revisions(struct comparing *c, const struct ecb_slave *a,
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

static void compare_slaves(struct comparing *c, const struct match *m, size_t i, size_t k)
{
	const struct ecb_slave *a = m->a.slaves[i], *b = m->b.slaves[k];
	bool machine = c->flags & ECB_COMPARE_MACHINE;
	char expected[256], found[384], at[128];

	c->known = b->known;
	if (!same_identity(a, b)) {
		identity(a, expected, sizeof(expected));
		identity(b, found, sizeof(found));
		if (a->port != ECB_NONE8) {
			place(&m->a, m->a.parent[i], a->port, at, sizeof(at));
			snprintf(found + strlen(found), sizeof(found) - strlen(found),
				 ", at %s", at);
		}
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
static void alone(struct comparing *c, const struct match *m, size_t i, bool expected)
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

static int compare_masters(struct comparing *c, const struct ecb_master *a,
			   const struct ecb_master *b)
{
	struct match m;
	int ret = match_slaves(&m, a, b, !(c->flags & ECB_COMPARE_MACHINE));

	c->slave = "";
	c->known = b->known;
	c->cycle = b->cycle;
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
	return ret ? ret : c->err;
}

static const struct ecb_master *same_master(const struct ecb_bus *bus, const struct ecb_master *m)
{
	for (size_t i = 0; i < bus->master_count; i++)
		if (bus->masters[i]->index == m->index)
			return bus->masters[i];
	return NULL;
}

ECB_API long ecb_pairs(const struct ecb_bus *expected, const struct ecb_bus *found,
		       unsigned int flags, ecb_pair_fn fn, void *ctx)
{
	long count = 0;

	for (size_t i = 0; i < expected->master_count; i++) {
		const struct ecb_master *a = expected->masters[i], *b = same_master(found, a);
		struct match m;
		int ret = b ? match_slaves(&m, a, b, !(flags & ECB_COMPARE_MACHINE)) : 0;

		for (size_t k = 0; b && !ret && k < a->slave_count; k++) {
			size_t peer = m.a.peer[k];

			if (peer == NO_SLAVE || !same_identity(a->slaves[k], b->slaves[peer]))
				continue;
			fn(ctx, a, a->slaves[k], b->slaves[peer]);
			count++;
		}
		if (b)
			match_free(&m);
		if (ret)
			return ret;
	}
	return count;
}

ECB_API long ecb_compare(const struct ecb_bus *expected, const struct ecb_bus *found,
			 unsigned int flags, ecb_difference_fn fn, void *ctx)
{
	struct comparing c = { .flags = flags, .fn = fn, .ctx = ctx, .slave = "" };
	const struct ecb_bus *sides[] = { expected, found };

	for (int side = 0; side < 2; side++)
		for (size_t i = 0; i < sides[side]->master_count; i++) {
			const struct ecb_master *m = sides[side]->masters[i];
			const struct ecb_master *other = same_master(sides[!side], m);

			c.master = m->index;
			c.slave = "";
			if (!other)
				differ(&c, side ? ECB_EXTRA : ECB_MISSING, "", side ? NULL : m,
				       side ? "" : "a master", side ? m : NULL,
				       side ? "a master" : "",
				       "select masters with -m, or change the file");
			else if (!side && compare_masters(&c, m, other))
				return -ENOMEM;
		}
	return c.count;
}
