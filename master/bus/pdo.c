// SPDX-License-Identifier: GPL-2.0-only
/* Lists of PDOs. */
#include <linux/slab.h>
#include "../base/grow.h"
#include "../base/limits.h"
#include "pdo.h"

/**
 * ec_pdo_add() - append a PDO
 * @l: list
 * @index: PDO index
 * @name: string index
 *
 * Context: Process. May sleep.
 * Return: the PDO, valid until the list changes, or NULL.
 */
struct ec_pdo *ec_pdo_add(struct ec_pdo_list *l, u16 index, u8 name)
{
	struct ec_pdo *p;

	if (l->n >= EC_MAX_SC_PDOS)
		return NULL;
	p = ec_grow(l->pdos, l->n, sizeof(*p));
	if (!p)
		return NULL;
	l->pdos = p;
	p += l->n++;
	*p = (struct ec_pdo){ .index = index, .name = name };
	return p;
}

/**
 * ec_pdo_add_entry() - append an entry to the mapping of a PDO
 * @pdo: PDO
 * @e: entry, copied
 *
 * Context: Process. May sleep.
 * Return: 0, -ENOMEM, or -ENOSPC beyond 255 entries.
 */
int ec_pdo_add_entry(struct ec_pdo *pdo, const struct ec_pdo_entry *e)
{
	struct ec_pdo_entry *p;

	if (pdo->n_entries >= 255)
		return -ENOSPC;
	p = ec_grow(pdo->entries, pdo->n_entries, sizeof(*p));
	if (!p)
		return -ENOMEM;
	pdo->entries = p;
	p[pdo->n_entries++] = *e;
	return 0;
}

/* What one application has registered, another one has not. */
int ec_pdo_copy_entries(struct ec_pdo *dst, const struct ec_pdo *src)
{
	unsigned int i;
	int ret;

	for (i = 0; i < src->n_entries; i++) {
		struct ec_pdo_entry e = src->entries[i];

		e.registered = false;
		ret = ec_pdo_add_entry(dst, &e);
		if (ret)
			return ret;
	}
	return 0;
}

void ec_pdo_clear_entries(struct ec_pdo *pdo)
{
	kvfree(pdo->entries);
	pdo->entries = NULL;
	pdo->n_entries = 0;
}

void ec_pdo_list_clear(struct ec_pdo_list *l)
{
	unsigned int i;

	for (i = 0; i < l->n; i++)
		kvfree(l->pdos[i].entries);
	kvfree(l->pdos);
	l->pdos = NULL;
	l->n = 0;
}

/* Bytes that the PDOs and their entries need. */
size_t ec_pdo_list_memory(const struct ec_pdo_list *l)
{
	size_t bytes = l->n * sizeof(*l->pdos);
	unsigned int i;

	for (i = 0; i < l->n; i++)
		bytes += l->pdos[i].n_entries * sizeof(*l->pdos[i].entries);
	return bytes;
}

struct ec_pdo *ec_pdo_find(const struct ec_pdo_list *l, u16 index)
{
	unsigned int i;

	for (i = 0; i < l->n; i++)
		if (l->pdos[i].index == index)
			return &l->pdos[i];
	return NULL;
}

u32 ec_pdo_bits(const struct ec_pdo *pdo)
{
	unsigned int i;
	u32 bits = 0;

	for (i = 0; i < pdo->n_entries; i++)
		bits += pdo->entries[i].bits;
	return bits;
}

u32 ec_pdo_list_bytes(const struct ec_pdo_list *l)
{
	unsigned int i;
	u32 bits = 0;

	for (i = 0; i < l->n; i++)
		bits += ec_pdo_bits(&l->pdos[i]);
	return DIV_ROUND_UP(bits, 8);
}

int ec_pdo_list_copy(struct ec_pdo_list *dst, const struct ec_pdo_list *src)
{
	unsigned int i;

	for (i = 0; i < src->n; i++) {
		struct ec_pdo *p = ec_pdo_add(dst, src->pdos[i].index, src->pdos[i].name);

		if (!p || ec_pdo_copy_entries(p, &src->pdos[i]))
			return -ENOMEM;
	}
	return 0;
}

/* The entry that begins @bit bits behind the start of the process data, or NULL. */
const struct ec_pdo_entry *ec_pdo_list_at(const struct ec_pdo_list *l, u32 bit)
{
	unsigned int i, k;
	u32 at = 0;

	for (i = 0; i < l->n; i++)
		for (k = 0; k < l->pdos[i].n_entries; k++) {
			if (at == bit)
				return &l->pdos[i].entries[k];
			at += l->pdos[i].entries[k].bits;
		}
	return NULL;
}

static bool same_entries(const struct ec_pdo *a, const struct ec_pdo *b)
{
	unsigned int i;

	if (a->index != b->index || a->n_entries != b->n_entries)
		return false;
	for (i = 0; i < a->n_entries; i++)
		if (a->entries[i].index != b->entries[i].index ||
		    a->entries[i].sub != b->entries[i].sub ||
		    a->entries[i].bits != b->entries[i].bits)
			return false;
	return true;
}

/* Is it the same process data, apart from names? */
bool ec_pdo_list_same(const struct ec_pdo_list *a, const struct ec_pdo_list *b)
{
	unsigned int i;

	if (a->n != b->n)
		return false;
	for (i = 0; i < a->n; i++)
		if (!same_entries(&a->pdos[i], &b->pdos[i]))
			return false;
	return true;
}
