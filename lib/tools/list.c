// SPDX-License-Identifier: LGPL-2.1-or-later
/* Lists of results: one kind of memory for all of them. */
#include <stdlib.h>

#include "internal.h"

struct ect_list *ect_list_new(size_t size)
{
	struct ect_list *l = calloc(1, sizeof(*l));

	if (l)
		l->size = (size + 7) & ~(size_t)7;
	return l;
}

void *ect_list_add(struct ect_list *l)
{
	u32 *element;

	if (l->n == l->room) {
		size_t room = l->room ? 2 * l->room : 16;
		u8 *at = realloc(l->at, room * l->size);

		if (!at)
			return NULL;
		l->at = at;
		l->room = room;
	}
	element = ect_list_at(l, l->n++);
	memset(element, 0, l->size);
	*element = (u32)l->size;	/* struct_size is the first member of each */
	return element;
}

void *ect_list_at(const struct ect_list *l, size_t i)
{
	return l->at + i * l->size;
}

size_t ect_list_count(const struct ect_list *l)
{
	return l ? l->n : 0;
}

const void *ect_list_get(const struct ect_list *l, size_t i)
{
	return i < ect_list_count(l) ? ect_list_at(l, i) : NULL;
}

void ect_list_free(struct ect_list *l)
{
	if (!l)
		return;
	free(l->at);
	free(l);
}
