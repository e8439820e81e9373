// SPDX-License-Identifier: GPL-2.0-only
#include "select.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "../master/wire/env.h"

/* decimal only; values beyond any bus are clamped, they select nothing */
static bool number(const char **p, unsigned int *value)
{
	unsigned long v = 0;

	if (**p < '0' || **p > '9')
		return false;
	for (; **p >= '0' && **p <= '9'; (*p)++) {
		v = v * 10 + (unsigned long)(**p - '0');
		if (v >= LIST_OPEN)
			v = LIST_OPEN - 1;
	}
	*value = (unsigned int)v;
	return true;
}

/**
 * list_parse() - parse a number list
 * @l: result
 * @text: as typed
 * @why: set to what is wrong with it
 *
 * Return: 0, or -EINVAL.
 */
int list_parse(struct list *l, const char *text, const char **why)
{
	const char *p = text;

	*l = (struct list){ .given = true };
	while (*p) {
		struct list_item it = { 0, LIST_OPEN };
		bool first, last = false;

		if (*p == ',') {
			p++;
			continue;
		}
		first = number(&p, &it.from);
		if (*p == '-') {
			p++;
			last = number(&p, &it.to);
		} else {
			it.to = it.from;
			last = first;
		}
		if (*p && *p != ',') {
			*why = !strncmp(p, "x", 1) || !strncmp(p, "X", 1) ?
				"numbers are decimal here" : "expected N, N-M, N-, -M or -";
			return -EINVAL;
		}
		if (!first && !last && it.to != LIST_OPEN) {
			*why = "expected N, N-M, N-, -M or -";
			return -EINVAL;
		}
		if (l->n == LIST_ITEMS) {
			*why = "too many items";
			return -EINVAL;
		}
		l->item[l->n++] = it;
	}
	if (!l->n) {
		*why = "the list is empty";
		return -EINVAL;
	}
	return 0;
}

/**
 * position_parse() - parse ring positions, or "1001:1" as listings show it
 * @aliases: set if @text has an alias that is not 0
 * @positions: result
 * @text: as typed
 * @why: set to what is wrong with it
 *
 * Return: 0, or -EINVAL.
 */
int position_parse(struct list *aliases, struct list *positions, const char *text,
		   const char **why)
{
	const char *at = text;
	unsigned int alias;

	if (!number(&at, &alias) || *at != ':')
		return list_parse(positions, text, why);
	if (alias > 0xffff) {
		*why = "an alias is at most 65535";
		return -EINVAL;
	}
	if (alias)
		*aliases = (struct list){ .given = true, .n = 1, .item = { { alias, alias } } };
	return list_parse(positions, at + 1, why);
}

/* true if the list does not narrow anything down */
bool list_all(const struct list *l)
{
	return !l->given || (l->n == 1 && !l->item[0].from && l->item[0].to == LIST_OPEN);
}

static int numbers_add(struct numbers *n, unsigned int v)
{
	if (!(n->n & (n->n + 1)) || !n->v) {
		unsigned int *more = realloc(n->v, 2 * (n->n + 1) * sizeof(*more));

		if (!more)
			return -ENOMEM;
		n->v = more;
	}
	n->v[n->n++] = v;
	return 0;
}

void numbers_free(struct numbers *n)
{
	free(n->v);
	*n = (struct numbers){ 0 };
}

/**
 * list_expand() - the numbers below @count that a list names
 * @l: list
 * @count: how many exist
 * @out: result, to be freed with numbers_free()
 *
 * Return: 0, or -ENOMEM.
 */
int list_expand(const struct list *l, unsigned int count, struct numbers *out)
{
	static const struct list_item all = { 0, LIST_OPEN };
	unsigned int items = l->given ? l->n : 1;

	*out = (struct numbers){ 0 };
	for (unsigned int i = 0; i < items && count; i++) {
		struct list_item it = l->given ? l->item[i] : all;
		unsigned int from = it.from, to = it.to;
		int ret = 0;

		if (to == LIST_OPEN && from >= count)
			continue;
		if (from >= count && to >= count)
			continue;
		from = min(from, count - 1);
		to = min(to, count - 1);
		for (;; from < to ? from++ : from--) {
			ret = numbers_add(out, from);
			if (ret || from == to)
				break;
		}
		if (ret) {
			numbers_free(out);
			return ret;
		}
	}
	return 0;
}

/* true if the list was typed as one number */
bool list_single(const struct list *l, unsigned int *value)
{
	if (!l->given || l->n != 1 || l->item[0].from != l->item[0].to)
		return false;
	*value = l->item[0].from;
	return true;
}

static int select_group(const struct list *positions, const struct ect_slave *slaves,
			size_t count, size_t first, struct numbers *out)
{
	struct numbers k;
	size_t end;
	int ret;

	for (end = first + 1; end < count && !slaves[end].alias; end++)
		;
	ret = list_expand(positions, (unsigned int)(end - first), &k);
	for (size_t i = 0; !ret && i < k.n; i++)
		ret = numbers_add(out, (unsigned int)first + k.v[i]);
	numbers_free(&k);
	return ret;
}

/* by alias: 1 + position of the first slave with it, 0: none; to be freed */
static u32 *first_with(const struct ect_slave *slaves, size_t count)
{
	u32 *first = calloc(0x10000, sizeof(*first));

	for (size_t i = count; first && i > 0; i--)
		first[slaves[i - 1].alias] = (u32)i;
	if (first)
		first[0] = 0;	/* no alias, not to be selected */
	return first;
}

/**
 * select_slaves() - ring positions that -a and -p select
 * @aliases: -a
 * @positions: -p; with -a relative to the slave with the alias
 * @slaves: the bus in ring order
 * @count: slaves on it
 * @out: result, to be freed with numbers_free()
 *
 * A slave with an alias begins a group that lasts up to the next slave with
 * an alias. When an alias occurs twice, only its first group counts.
 *
 * Return: 0, or -ENOMEM.
 */
int select_slaves(const struct list *aliases, const struct list *positions,
		  const struct ect_slave *slaves, size_t count, struct numbers *out)
{
	struct numbers a;
	u32 *first;
	int ret;

	if (list_all(aliases))
		return list_expand(positions, (unsigned int)count, out);
	*out = (struct numbers){ 0 };
	ret = list_expand(aliases, 0x10000, &a);
	if (ret)
		return ret;
	first = first_with(slaves, count);
	ret = first ? 0 : -ENOMEM;
	for (size_t i = 0; !ret && i < a.n; i++)
		if (first[a.v[i]])
			ret = select_group(positions, slaves, count, first[a.v[i]] - 1, out);
	free(first);
	numbers_free(&a);
	if (ret)
		numbers_free(out);
	return ret;
}

static bool listed(const struct list *l, unsigned int v)
{
	for (unsigned int i = 0; i < l->n; i++) {
		unsigned int a = l->item[i].from, b = l->item[i].to;

		if (v >= min(a, b) && v <= max(a, b))
			return true;
	}
	return !l->given;
}

/**
 * select_config() - do -a and -p select a slave configuration
 * @aliases: -a
 * @positions: -p; without -a of the configurations with alias 0
 * @config: configuration
 *
 * Return: true if so.
 */
bool select_config(const struct list *aliases, const struct list *positions,
		   const struct ect_config *config)
{
	if (!list_all(aliases))
		return listed(aliases, config->alias) && listed(positions, config->position);
	if (list_all(positions))
		return true;
	return !config->alias && listed(positions, config->position);
}
