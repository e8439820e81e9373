// SPDX-License-Identifier: LGPL-2.1-or-later
/* The memory of a bus: taken piece by piece up to a limit, freed at once. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "fields.h"
#include "internal.h"
#include "../tools/text.h"

struct chunk {
	struct chunk *next;
	size_t used;
	size_t size;
	uint64_t data[];
};

#define CHUNK	65536u

void *ecb_alloc(struct whole *w, size_t size)
{
	struct chunk *c = w->chunks;
	void *at;

	size = (size + 7) & ~(size_t)7;
	if (!c || c->size - c->used < size) {
		size_t room = size > CHUNK ? size : CHUNK;

		errno = ENOMEM;
		if (size > ECB_MEMORY_MAX || w->used + room > ECB_MEMORY_MAX)
			return NULL;
		c = calloc(1, sizeof(*c) + room);
		if (!c)
			return NULL;
		c->size = room;
		c->next = w->chunks;
		w->chunks = c;
		w->used += room;
	}
	at = (char *)c->data + c->used;
	c->used += size;
	return at;
}

const char *ecb_copy(struct whole *w, const char *text, size_t len)
{
	char *to = ecb_alloc(w, len + 1);

	if (to)
		memcpy(to, text, len);
	return to;
}

void ecb_defaults(const struct type *type, void *item)
{
	for (size_t i = 0; i < type->count; i++) {
		const struct field *f = &type->fields[i];

		if (f->def && f->kind == K_REAL)
			*(double *)((char *)item + f->at) = (double)f->def;
		else if (f->def)
			scalar_set(f, (char *)item + f->at, f->def);
	}
}

struct list {
	void **items;
	size_t count;
};

void *ecb_append(struct whole *w, void *list, const struct type *type)
{
	struct list *l = list;
	void *item = ecb_alloc(w, type->size);

	if (!item)
		return NULL;
	/* full: 0, 1, 2, 4, 8... items */
	if (!(l->count & (l->count - 1))) {
		size_t room = l->count ? 2 * l->count : 1;
		void **grown = ecb_alloc(w, room * sizeof(*grown));

		if (!grown)
			return NULL;
		if (l->count)
			memcpy(grown, l->items, l->count * sizeof(*grown));
		l->items = grown;
	}
	ecb_defaults(type, item);
	l->items[l->count++] = item;
	return item;
}

ECB_API struct ecb_bus *ecb_bus_new(void)
{
	struct whole *w = calloc(1, sizeof(*w));

	if (!w)
		return NULL;
	w->bus.ethercat = ECB_VERSION;
	return &w->bus;
}

ECB_API void ecb_bus_free(struct ecb_bus *bus)
{
	struct whole *w = (struct whole *)bus;
	struct chunk *c, *next;

	if (!w)
		return;
	for (c = w->chunks; c; c = next) {
		next = c->next;
		free(c);
	}
	free(w);
}

/* U+FEFF, U+FFFE, U+FFFF: YAML has the first only as a mark, the others not at all */
static bool no_yaml(const unsigned char *p, int n)
{
	return n == 3 && p[0] == 0xef && ((p[1] == 0xbb && p[2] == 0xbf) ||
					  (p[1] == 0xbf && p[2] >= 0xbe));
}

ECB_API const char *ecb_bus_text(struct ecb_bus *bus, const char *text)
{
	char clean[TEXT_MAX + 1];
	size_t len = text ? strlen(text) : 0;

	errno = 0;
	if (!len)
		return NULL;
	if (len > TEXT_MAX)
		len = TEXT_MAX;
	/* bytes that are no UTF-8 are Latin-1 in many EEPROMs; the file is UTF-8 */
	for (size_t i = 0, step; i < len; i += step) {
		const unsigned char *p = (const unsigned char *)text + i;
		int n = utf8_len(p, len - i);

		step = n ? (size_t)n : 1;
		memcpy(clean + i, p, step);
		if (!n || !text_harmless(p, n) || no_yaml(p, n))
			memset(clean + i, '?', step);
	}
	return ecb_copy((struct whole *)bus, clean, len);
}

ECB_API struct ecb_master *ecb_master_add(struct ecb_bus *bus)
{
	return ecb_append((struct whole *)bus, &bus->masters, &type_master);
}

ECB_API struct ecb_slave *ecb_slave_add(struct ecb_bus *bus, struct ecb_master *master)
{
	return ecb_append((struct whole *)bus, &master->slaves, &type_slave);
}

ECB_API struct ecb_pdo *ecb_pdo_add(struct ecb_bus *bus, struct ecb_slave *slave)
{
	return ecb_append((struct whole *)bus, &slave->pdos, &type_pdo);
}

ECB_API struct ecb_entry *ecb_entry_add(struct ecb_bus *bus, struct ecb_pdo *pdo)
{
	return ecb_append((struct whole *)bus, &pdo->entries, &type_entry);
}

ECB_API struct ecb_module *ecb_module_add(struct ecb_bus *bus, struct ecb_slave *slave)
{
	return ecb_append((struct whole *)bus, &slave->modules, &type_module);
}

ECB_API struct ecb_clock *ecb_clock_add(struct ecb_bus *bus, struct ecb_slave *slave)
{
	slave->clock = ecb_alloc((struct whole *)bus, sizeof(*slave->clock));
	return slave->clock;
}

ECB_API struct ecb_command *ecb_startup_add(struct ecb_bus *bus, struct ecb_slave *slave,
					    const void *data, size_t size)
{
	struct whole *w = (struct whole *)bus;
	const char *copy = data ? ecb_copy(w, data, size) : NULL;
	struct ecb_command *c;

	if (data && !copy)
		return NULL;
	c = ecb_append(w, &slave->startup, &type_command);
	if (c && data)
		c->data = (struct ecb_bytes){ (const uint8_t *)copy, size };
	return c;
}

ECB_API struct ecb_unit *ecb_unit_add(struct ecb_bus *bus, struct ecb_master *master)
{
	return ecb_append((struct whole *)bus, &master->sync_units, &type_unit);
}

ECB_API struct ecb_group *ecb_group_add(struct ecb_bus *bus, struct ecb_master *master)
{
	return ecb_append((struct whole *)bus, &master->groups, &type_group);
}

ECB_API struct ecb_bytes ecb_command_data(const struct ecb_command *command, uint8_t number[8])
{
	static const uint8_t sizes[] = {
		[ECB_TYPE_BOOL] = 1, [ECB_TYPE_INT8] = 1, [ECB_TYPE_INT16] = 2,
		[ECB_TYPE_INT32] = 4, [ECB_TYPE_INT64] = 8, [ECB_TYPE_UINT8] = 1,
		[ECB_TYPE_UINT16] = 2, [ECB_TYPE_UINT32] = 4, [ECB_TYPE_UINT64] = 8,
	};

	if (!command->type || command->type >= ECB_TYPE_REAL32)
		return command->data;
	for (size_t i = 0; i < 8; i++)
		number[i] = (uint8_t)((uint64_t)command->value >> 8 * i);
	return (struct ecb_bytes){ number, sizes[command->type] };
}

ECB_API int ecb_bus_finish(struct ecb_bus *bus, const char *file, struct ecb_error *error)
{
	return ecb_rules((struct whole *)bus, file ? file : "bus", error);
}
