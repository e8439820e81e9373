// SPDX-License-Identifier: LGPL-2.1-or-later
/* The rule that makes names of slaves and values; it stands here only. */
#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ethercat-bus/names.h"
#include "internal.h"
#include "table.h"

#define WORD_MAX	56	/* characters; "_65535" fits behind them */

ECB_API size_t ecb_name_word(char *to, const char *text)
{
	size_t n = 0;

	for (; text && *text; text++) {
		char c = *text;

		if (c >= 'A' && c <= 'Z')
			c += 'a' - 'A';
		if ((c < 'a' || c > 'z') && (c < '0' || c > '9'))
			c = '_';
		if (c == '_' && (!n || to[n - 1] == '_'))
			continue;
		if (n == WORD_MAX)
			break;
		to[n++] = c;
	}
	if (n && to[n - 1] == '_')
		n--;
	to[n] = 0;
	return n;
}

/*
 * The name becomes one that no other seat has. A seat's value is the number from which on a free
 * one is searched: "_3" is not searched again for each of 65,535 equal names.
 */
static void take(struct table *t, char *name, size_t size)
{
	struct seat *seat = table_find(t, name);
	size_t len = strlen(name), n;

	if (!seat->key) {
		seat->key = name;
		return;
	}
	for (n = seat->value < 2 ? 2 : seat->value;; n++) {
		snprintf(name + len, size - len, "_%zu", n);
		if (!table_find(t, name)->key)
			break;
	}
	seat->value = n + 1;
	table_find(t, name)->key = name;
}

static int keep(struct table *t, const char *name)
{
	struct seat *seat = table_find(t, name);

	if (seat->key)
		return -EEXIST;
	seat->key = name;
	return 0;
}

ECB_API int ecb_name_slaves(struct ecb_slave_name *slaves, size_t count)
{
	struct table t;
	int ret = table_init(&t, count);

	for (size_t i = 0; i < count && !ret; i++)
		if (slaves[i].name[0])
			ret = keep(&t, slaves[i].name);
	for (size_t i = 0; i < count && !ret; i++) {
		struct ecb_slave_name *s = &slaves[i];

		if (s->name[0])
			continue;
		if (!ecb_name_word(s->name, s->order) && !ecb_name_word(s->name, s->text) &&
		    !ecb_name_word(s->name, s->group))
			strcpy(s->name, "slave");
		take(&t, s->name, sizeof(s->name));
	}
	table_free(&t);
	return ret;
}

static void entry_word(const struct ecb_entry_name *e, char *to)
{
	if (!ecb_name_word(to, e->text))
		snprintf(to, ECB_WORD, "x%04x_%02x", e->index, e->subindex);
}

static bool unnamed(const struct ecb_entry_name *e)
{
	return e->index && !e->name[0];
}

/* words that entries share, before one of them has a name */
static void name_entry(struct ecb_entry_name *e, const struct table *words)
{
	char word[ECB_WORD], pdo[ECB_WORD];

	entry_word(e, word);
	if (table_find(words, word)->value < 2) {
		strcpy(e->name, word);
		return;
	}
	if (!ecb_name_word(pdo, e->pdo))
		snprintf(pdo, sizeof(pdo), "x%04x", e->pdo_index);
	snprintf(e->name, sizeof(e->name), "%s.%s", pdo, word);
}

ECB_API int ecb_name_entries(struct ecb_entry_name *entries, size_t count)
{
	char (*texts)[ECB_WORD] = calloc(count, sizeof(*texts));
	struct table words = { 0 }, t = { 0 };
	int ret = texts || !count ? 0 : -ENOMEM;

	if (!ret)
		ret = table_init(&words, count);
	if (!ret)
		ret = table_init(&t, count);
	for (size_t i = 0; i < count && !ret; i++) {
		struct seat *seat;

		if (entries[i].index && entries[i].name[0])
			ret = keep(&t, entries[i].name);
		if (!unnamed(&entries[i]))
			continue;
		entry_word(&entries[i], texts[i]);
		seat = table_find(&words, texts[i]);
		seat->key = texts[i];
		seat->value++;
	}
	for (size_t i = 0; i < count && !ret; i++) {
		if (!unnamed(&entries[i]))
			continue;
		name_entry(&entries[i], &words);
		take(&t, entries[i].name, sizeof(entries[i].name));
	}
	table_free(&t);
	table_free(&words);
	free(texts);
	return ret;
}

ECB_API size_t ecb_name_value(char *to, const char *slave, const char *entry)
{
	int n = *entry ? snprintf(to, ECB_VALUE, "%s.%s", slave, entry) : 0;

	if (n <= 0 || n >= ECB_VALUE) {
		*to = 0;
		return 0;
	}
	return n;
}
