// SPDX-License-Identifier: LGPL-2.1-or-later
/* Modules slot by slot, and startup commands against present values. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare_int.h"

#define SHOWN	16	/* bytes of a value in a message */

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

void compare_modules(struct comparing *c, const struct ecb_slave *a, const struct ecb_slave *b)
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

static void show(const struct ecb_bytes *b, char *buf, size_t size)
{
	size_t n = 0;

	for (size_t i = 0; i < b->size && i < SHOWN; i++)
		n += (size_t)snprintf(buf + n, size - n, "%s%02x", i ? " " : "", b->data[i]);
	if (b->size > SHOWN)
		snprintf(buf + n, size - n, "... (%zu bytes)", b->size);
}

/* a startup command by its object */
struct by_object {
	uint64_t object;	/* with complete access as a bit */
	const struct ecb_command *command;
};

/* of one object in the order of the file, so that the last one is the one that counts */
static int by_object(const void *a, const void *b)
{
	const struct by_object *x = a, *y = b;

	if (x->object != y->object)
		return x->object < y->object ? -1 : 1;
	return (x->command->line > y->command->line) - (x->command->line < y->command->line);
}

static struct by_object *sorted(const struct ecb_slave *s, size_t *n)
{
	struct by_object *v = calloc(s->startup_count + 1, sizeof(*v));

	*n = 0;
	for (size_t i = 0; v && i < s->startup_count; i++) {
		const struct ecb_command *x = s->startup[i];

		if (x->sdo != ECB_NONE32)
			v[(*n)++] = (struct by_object){ (uint64_t)x->sdo << 1 | x->complete, x };
	}
	if (v)
		qsort(v, *n, sizeof(*v), by_object);
	return v;
}

/*
 * The master writes a value on the way to a state, so a slave that no session has brought there has
 * another one rightly: it is pending.
 */
static void compare_values(struct comparing *c, const struct ecb_command *x,
			   const struct ecb_command *y, uint8_t state)
{
	static const struct {
		const char *name;
		uint8_t state;
	} at[] = { { "PREOP", 2 }, { "SAFEOP", 4 }, { "OP", 8 } };
	char key[64], expected[96], found[96], remedy[128];
	uint8_t number[8];
	struct ecb_bytes want = ecb_command_data(x, number);
	bool done = state >= at[x->at].state;

	if (want.size == y->data.size && !memcmp(want.data, y->data.data, want.size))
		return;
	snprintf(key, sizeof(key), "startup 0x%04x:%02x", ECB_INDEX(x->sdo), ECB_SUBINDEX(x->sdo));
	show(&want, expected, sizeof(expected));
	show(&y->data, found, sizeof(found));
	if (done)
		snprintf(remedy, sizeof(remedy),
			 "the running session has not written it, or it has changed; change the file, or apply it");
	else
		snprintf(remedy, sizeof(remedy),
			 "the master writes it on the way to %s when the file is applied",
			 at[x->at].name);
	differ(c, done ? ECB_VALUE_DIFFERS : ECB_PENDING, key, x, expected, y, found, remedy);
}

void compare_startup(struct comparing *c, const struct ecb_slave *a, const struct ecb_slave *b)
{
	size_t n, k, at = 0;
	struct by_object *x = sorted(a, &n), *y = sorted(b, &k);

	if (!x || !y)
		c->err = -ENOMEM;
	for (size_t i = 0; i < n && !c->err; i++) {
		while (at < k && y[at].object < x[i].object)
			at++;
		if (at < k && y[at].object == x[i].object &&
		    (i + 1 == n || x[i + 1].object != x[i].object))
			compare_values(c, x[i].command, y[at].command, b->state);
	}
	free(x);
	free(y);
}
