// SPDX-License-Identifier: LGPL-2.1-or-later
/* What belongs together in a bus: names, and what refers to them. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fields.h"
#include "internal.h"
#include "table.h"
#include "../tools/text.h"

struct check {
	struct whole *w;
	const char *file;
	struct ecb_error *e;
	const struct ecb_master *m;
	struct table slaves;	/* names, with the index of the slave */
};

#define BAD(c, line, ...)	ecb_report((c)->e, (c)->file, line, 0, __VA_ARGS__)

static int no_memory(struct check *c)
{
	ecb_report(c->e, c->file, 0, 0, "out of memory");
	return -ENOMEM;
}

static int entry(struct check *c, const struct ecb_entry *e)
{
	static const uint8_t bits[] = {
		[ECB_TYPE_BOOL] = 1, [ECB_TYPE_INT8] = 8, [ECB_TYPE_INT16] = 16,
		[ECB_TYPE_INT32] = 32, [ECB_TYPE_INT64] = 64, [ECB_TYPE_UINT8] = 8,
		[ECB_TYPE_UINT16] = 16, [ECB_TYPE_UINT32] = 32, [ECB_TYPE_UINT64] = 64,
		[ECB_TYPE_REAL32] = 32, [ECB_TYPE_REAL64] = 64,
	};

	if (!e->object && (e->name || e->type || e->unit))
		return BAD(c, e->line, "a PDO entry without object is a gap; expected only 'bits'");
	if (e->type && bits[e->type] != e->bits)
		return BAD(c, e->line, "type of %u bits for an entry of %u bits; expected the same",
			   bits[e->type], e->bits);
	if (e->scale == 0)
		return BAD(c, e->line, "'scale' 0 makes each value the same; expected another number");
	return 0;
}

/* from the file, or x6000_01 */
static int name_values(struct check *c, struct ecb_slave *s)
{
	struct ecb_entry_name *names;
	size_t n = 0, at = 0;
	int ret = 0;

	for (size_t p = 0; p < s->pdo_count; p++)
		n += s->pdos[p]->entry_count;
	names = calloc(n ? n : 1, sizeof(*names));
	if (!names)
		return no_memory(c);
	for (size_t p = 0; p < s->pdo_count; p++)
		for (size_t i = 0; i < s->pdos[p]->entry_count; i++, at++) {
			const struct ecb_entry *e = s->pdos[p]->entries[i];

			names[at].index = ECB_INDEX(e->object);
			names[at].subindex = ECB_SUBINDEX(e->object);
			names[at].pdo = s->pdos[p]->name;
			names[at].pdo_index = s->pdos[p]->index;
			if (e->name)
				snprintf(names[at].name, sizeof(names[at].name), "%s", e->name);
		}
	ret = ecb_name_entries(names, n);
	at = 0;
	for (size_t p = 0; p < s->pdo_count && !ret; p++)
		for (size_t i = 0; i < s->pdos[p]->entry_count && !ret; i++, at++) {
			struct ecb_entry *e = s->pdos[p]->entries[i];

			if (e->name || !e->object)
				continue;
			e->name = ecb_copy(c->w, names[at].name, strlen(names[at].name));
			ret = e->name ? 0 : -ENOMEM;
		}
	free(names);
	if (ret == -EEXIST)
		return BAD(c, s->line,
			   "slave '%s' has two values of the same name; expected different names",
			   s->name);
	return ret ? no_memory(c) : 0;
}

static int pdos(struct check *c, struct ecb_slave *s)
{
	uint8_t seen[65536 / 8] = { 0 };
	int ret = 0;

	for (size_t i = 0; i < s->pdo_count && !ret; i++) {
		const struct ecb_pdo *p = s->pdos[i];

		if (seen[p->index / 8] >> p->index % 8 & 1)
			return BAD(c, p->line, "PDO 0x%04x twice; expected it once for a slave",
				   p->index);
		seen[p->index / 8] |= (uint8_t)(1 << p->index % 8);
		for (size_t k = 0; k < p->entry_count && !ret; k++)
			ret = entry(c, p->entries[k]);
	}
	return ret || !s->pdo_count ? ret : name_values(c, s);
}

static int modules(struct check *c, const struct ecb_slave *s)
{
	bool seen[256] = { false };

	for (size_t i = 0; i < s->module_count; i++) {
		const struct ecb_module *m = s->modules[i];

		if (seen[m->slot])
			return BAD(c, m->line, "slot %u twice; expected it once for a slave",
				   m->slot);
		seen[m->slot] = true;
	}
	if (s->write_modules && !s->module_count)
		return BAD(c, s->line, "'write_modules' of slave '%s' without 'modules'", s->name);
	return 0;
}

/* whether a number fits into a type */
static bool fits(unsigned int type, int64_t v)
{
	unsigned int bits = type == ECB_TYPE_BOOL ? 1 :
		8u << (type - (type >= ECB_TYPE_UINT8 ? ECB_TYPE_UINT8 : ECB_TYPE_INT8));

	if (type >= ECB_TYPE_REAL32)
		return false;
	if (type == ECB_TYPE_BOOL || type >= ECB_TYPE_UINT8)
		return v >= 0 && (bits == 64 || v < (int64_t)1 << bits);
	return bits == 64 || (v >= -((int64_t)1 << (bits - 1)) && v < (int64_t)1 << (bits - 1));
}

static int command(struct check *c, const struct ecb_command *s)
{
	unsigned int targets = (s->reg != ECB_NONE32) + (s->sdo != ECB_NONE32) +
		(s->idn != ECB_NONE32);

	if (targets != 1)
		return BAD(c, s->line,
			   "a startup command with %u targets; expected one of register, sdo and idn",
			   targets);
	if (!s->data.size == !s->type)
		return BAD(c, s->line, "a startup command needs either 'data', or 'type' and 'value'");
	if (!s->type && s->value)
		return BAD(c, s->line, "'value' of a startup command without 'type'");
	if (s->type && !fits(s->type, s->value))
		return BAD(c, s->line, "value %lld does not fit into its type; reals need 'data'",
			   (long long)s->value);
	if (s->complete && s->sdo == ECB_NONE32)
		return BAD(c, s->line, "'complete' without 'sdo'");
	if (s->drive && s->idn == ECB_NONE32)
		return BAD(c, s->line, "'drive' without 'idn'");
	return 0;
}

static int missing(struct check *c, uint32_t line, const char *what, const char *name,
		   const char *nearest)
{
	return nearest ? BAD(c, line, "no %s '%.60s'; did you mean '%s'?", what, name, nearest) :
		BAD(c, line, "no %s '%.60s' in this master", what, name);
}

/* @line: of what refers to it */
static int refers_to_slave(struct check *c, const char *name, uint32_t line)
{
	const struct ecb_master *m = c->m;
	const char *nearest = NULL;
	struct seat *seat;

	if (!name)
		return 0;
	seat = table_find(&c->slaves, name);
	if (seat->key)
		return 0;
	for (size_t i = 0; i < m->slave_count; i++)
		nearest = text_nearer(name, nearest, m->slaves[i]->name);
	return missing(c, line, "slave", name, nearest);
}

static int slave(struct check *c, size_t i)
{
	struct ecb_slave *s = c->m->slaves[i];
	const struct ecb_master *m = c->m;
	const char *nearest = NULL;
	size_t k;
	int ret = refers_to_slave(c, s->parent, s->line);

	if (ret)
		return ret;
	if (!s->parent != (s->port == ECB_NONE8))
		return BAD(c, s->line, "slave '%s' needs both 'parent' and 'port', or none of them",
			   s->name);
	for (k = 0; s->group && k < m->group_count && strcmp(s->group, m->groups[k]->name);)
		k++;
	if (s->group && k == m->group_count) {
		for (k = 0; k < m->group_count; k++)
			nearest = text_nearer(s->group, nearest, m->groups[k]->name);
		return missing(c, s->line, "hot connect group", s->group, nearest);
	}
	for (k = 0; s->sync_unit && k < m->sync_unit_count &&
	     strcmp(s->sync_unit, m->sync_units[k]->name);)
		k++;
	if (s->sync_unit && k == m->sync_unit_count) {
		for (k = 0; k < m->sync_unit_count; k++)
			nearest = text_nearer(s->sync_unit, nearest, m->sync_units[k]->name);
		return missing(c, s->line, "sync unit", s->sync_unit, nearest);
	}
	ret = modules(c, s);
	if (!ret)
		ret = pdos(c, s);
	for (k = 0; k < s->startup_count && !ret; k++)
		ret = command(c, s->startup[k]);
	return ret;
}

/* names of slaves: those of the file, the others made of their types */
static int name_slaves(struct check *c)
{
	const struct ecb_master *m = c->m;
	struct ecb_slave_name *names = calloc(m->slave_count + 1, sizeof(*names));
	struct seat *seat;
	int ret = 0;

	if (!names)
		return no_memory(c);
	for (size_t i = 0; i < m->slave_count && !ret; i++) {
		const char *name = m->slaves[i]->name;

		names[i].order = m->slaves[i]->type;
		if (!name)
			continue;
		snprintf(names[i].name, sizeof(names[i].name), "%s", name);
		seat = table_find(&c->slaves, name);
		if (seat->key)
			ret = BAD(c, m->slaves[i]->line,
				  "slave '%s' twice, first in line %u; expected different names",
				  name, m->slaves[seat->value]->line);
		seat->key = name;
		seat->value = i;
	}
	if (!ret && ecb_name_slaves(names, m->slave_count))
		ret = no_memory(c);
	for (size_t i = 0; i < m->slave_count && !ret; i++) {
		struct ecb_slave *s = m->slaves[i];

		if (!s->name)
			s->name = ecb_copy(c->w, names[i].name, strlen(names[i].name));
		if (!s->name) {
			ret = no_memory(c);
			break;
		}
		seat = table_find(&c->slaves, s->name);
		seat->key = s->name;
		seat->value = i;
	}
	free(names);
	return ret;
}

static int units(struct check *c)
{
	const struct ecb_master *m = c->m;

	for (size_t i = 0; i < m->sync_unit_count; i++)
		for (size_t k = 0; k < i; k++)
			if (!strcmp(m->sync_units[i]->name, m->sync_units[k]->name))
				return BAD(c, m->sync_units[i]->line, "sync unit '%s' twice",
					   m->sync_units[i]->name);
	return 0;
}

static int groups(struct check *c)
{
	const struct ecb_master *m = c->m;

	for (size_t i = 0; i < m->group_count; i++) {
		const struct ecb_group *g = m->groups[i];
		int ret = refers_to_slave(c, g->parent, g->line);

		for (size_t k = 0; k < i; k++)
			if (!strcmp(g->name, m->groups[k]->name))
				return BAD(c, g->line, "hot connect group '%s' twice", g->name);
		if (ret)
			return ret;
		if (!g->parent != (g->port == ECB_NONE8) ||
		    !!g->alias + !!g->identification + !!g->parent != 1)
			return BAD(c, g->line,
				   "hot connect group '%s' needs exactly one of alias, identification, and parent with port",
				   g->name);
		if (g->fast && !g->parent)
			return BAD(c, g->line, "'fast' of a hot connect group without 'parent'");
	}
	return 0;
}

/* an alias and an identification are of one slave */
static int signs(struct check *c)
{
	const struct ecb_master *m = c->m;
	size_t *first = calloc(2 * 65536, sizeof(*first));
	int ret = 0;

	if (!first)
		return no_memory(c);
	for (size_t i = 0; i < m->slave_count && !ret; i++) {
		const struct ecb_slave *s = m->slaves[i];
		size_t *alias = &first[s->alias], *id = &first[65536 + s->identification];

		if (s->line && s->alias && *alias)
			ret = BAD(c, s->line, "alias %u of '%s' is that of '%s'; expected another one",
				  s->alias, s->name, m->slaves[*alias - 1]->name);
		else if (s->line && s->identification && *id)
			ret = BAD(c, s->line,
				  "identification %u of '%s' is that of '%s'; expected another one",
				  s->identification, s->name, m->slaves[*id - 1]->name);
		*alias = *id = i + 1;
	}
	free(first);
	return ret;
}

/* parents lead to the master; they may stand behind, as in a bus that begins at another port */
static int circles(struct check *c)
{
	const struct ecb_master *m = c->m;
	size_t *seen = calloc(m->slave_count + 1, sizeof(*seen));
	int ret = 0;

	if (!seen)
		return no_memory(c);
	for (size_t i = 0; i < m->slave_count && !ret; i++) {
		size_t p = i;

		while (!seen[p]) {
			seen[p] = i + 1;
			if (!m->slaves[p]->parent)
				break;
			p = table_find(&c->slaves, m->slaves[p]->parent)->value;
			if (seen[p] != i + 1)
				continue;
			ret = BAD(c, m->slaves[p]->line,
				  "slave '%s' is upstream of itself; expected parents that lead to the master",
				  m->slaves[p]->name);
			break;
		}
	}
	free(seen);
	return ret;
}

static int master(struct check *c)
{
	int ret = table_init(&c->slaves, c->m->slave_count + 1);

	if (ret)
		return no_memory(c);
	ret = name_slaves(c);
	if (!ret)
		ret = units(c);
	if (!ret)
		ret = groups(c);
	if (!ret)
		ret = signs(c);
	for (size_t i = 0; i < c->m->slave_count && !ret; i++)
		ret = slave(c, i);
	if (!ret)
		ret = circles(c);
	if (!ret)
		ret = refers_to_slave(c, c->m->reference_clock, c->m->line);
	table_free(&c->slaves);
	return ret;
}

int ecb_rules(struct whole *w, const char *file, struct ecb_error *e)
{
	struct check c = { .w = w, .file = file, .e = e };
	uint32_t seen = 0;
	int ret = 0;

	for (size_t i = 0; i < w->bus.master_count && !ret; i++) {
		const struct ecb_master *m = w->bus.masters[i];

		if (seen >> m->index & 1)
			return BAD(&c, m->line, "master %u twice; expected different values of index",
				   m->index);
		seen |= 1u << m->index;
		c.m = m;
		ret = master(&c);
	}
	return ret;
}
