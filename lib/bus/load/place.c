// SPDX-License-Identifier: LGPL-2.1-or-later
/* Which slave of the machine each slave of the file is, and what PDOs it gets. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "load.h"
#include "../match.h"

/* the slaves of the file as they are looked for, with the texts of differences */
struct search {
	struct load *l;
	struct ecb_slave *copies;
	struct ecb_slave **slaves;
	struct ecb_master want;
	long differences;
};

static struct plan *plan_of(struct load *l, const char *slave)
{
	for (size_t i = 0; i < l->want->slave_count; i++)
		if (!strcmp(l->want->slaves[i]->name, slave))
			return &l->plans[i];
	return NULL;
}

/* The first difference becomes the error; a group may be absent, and what is not in the file. */
static void difference(void *ctx, const struct ecb_difference *d)
{
	struct search *s = ctx;
	const struct plan *p = plan_of(s->l, d->slave);
	const char *what = d->kind == ECB_MISSING ? "missing" :
		d->kind == ECB_EXCHANGED ? "exchanged" : d->kind == ECB_MOVED ? "moved" : "differs";
	bool value = d->kind == ECB_VALUE_DIFFERS;

	if (d->kind == ECB_EXTRA || !p || p->group >= 0)
		return;
	if (!s->differences++)
		ecb_report(s->l->e, s->l->file, d->line, 0, "slave '%s' %s%s%s: %s%s%s%s; %s",
			   d->slave, value ? d->key : "", value ? " " : "", what,
			   *d->found ? "expected " : "", d->expected, *d->found ? ", found " : "",
			   d->found, d->remedy);
}

static void find_group(struct load *l, struct plan *p)
{
	p->group = -1;
	for (size_t i = 0; p->s->group && i < l->want->group_count; i++)
		if (!strcmp(p->s->group, l->want->groups[i]->name))
			p->group = (long)i;
}

/* an identification, which an application does not see */
static bool hides(const struct plan *p)
{
	return p->s->identification && p->group < 0;
}

static int refuse_hidden(struct load *l, const struct plan *p)
{
	return BAD(l, p->s->line,
		   "slave '%s': an application does not see the identification of slaves; use an alias, or a hot connect group with this identification",
		   p->s->name);
}

/* The head of a group is found by what is known of the group. */
static int prepare(struct search *s)
{
	struct load *l = s->l;
	size_t n = l->want->slave_count;
	uint8_t seen[128] = { 0 };

	s->copies = calloc(n + 1, sizeof(*s->copies));
	s->slaves = calloc(n + 1, sizeof(*s->slaves));
	if (!s->copies || !s->slaves)
		return load_no_memory(l);
	s->want = *l->want;
	s->want.slaves = s->slaves;
	for (size_t i = 0; i < n; i++) {
		struct plan *p = &l->plans[i];
		struct ecb_slave *c = &s->copies[i];

		p->s = l->want->slaves[i];
		find_group(l, p);
		if (!l->how->found && hides(p))
			return refuse_hidden(l, p);
		*c = *p->s;
		s->slaves[i] = c;
		if (p->group < 0 || seen[p->group]++)
			continue;
		if (!c->alias)
			c->alias = l->want->groups[p->group]->alias;
		if (!c->identification)
			c->identification = l->want->groups[p->group]->identification;
	}
	return 0;
}

static int compare(struct search *s)
{
	struct load *l = s->l;
	struct ecb_master found = *l->found, *a = &s->want, *b = &found;
	const struct ecb_bus expected = { .masters = &a, .master_count = 1 };
	const struct ecb_bus machine = { .masters = &b, .master_count = 1 };
	size_t len;
	long n;

	found.index = s->want.index;
	n = ecb_compare(&expected, &machine, ECB_COMPARE_MACHINE | ECB_COMPARE_SLAVES, difference,
			s);
	if (n < 0)
		return load_no_memory(l);
	if (!s->differences || l->how->flags & ECB_LOAD_PARTIAL)
		return 0;
	len = strlen(l->e->text);
	if (s->differences > 1)
		snprintf(l->e->text + len, sizeof(l->e->text) - len,
			 " (%ld more differences; 'ethercat bus check' shows all)",
			 s->differences - 1);
	return -ENODEV;
}

static int refuse_behind(struct load *l, const struct plan *p)
{
	return BAD(l, p->s->line,
		   "slave '%s' is connected behind a hot connect group; put it into that group, or connect it elsewhere",
		   p->s->name);
}

/* Is found slave @k the head of a group, whatever it is? */
static bool is_head(const struct load *l, const struct match *m, size_t k)
{
	const struct ecb_slave *s = l->found->slaves[k];
	size_t up = m->b.parent[k], at = up == NO_SLAVE ? NO_SLAVE : m->b.peer[up];
	const char *parent = at == NO_SLAVE ? "" : l->want->slaves[at]->name;

	for (size_t i = 0; i < l->want->group_count; i++) {
		const struct ecb_group *g = l->want->groups[i];

		if (g->alias ? s->alias == g->alias :
		    g->identification ? s->identification == g->identification :
		    g->parent && s->port == g->port && !strcmp(parent, g->parent))
			return true;
	}
	return false;
}

/* Slaves before the break of a ring that is open and has slaves behind it; else SIZE_MAX. */
static size_t slaves_before_break(const struct load *l)
{
	ec_master_link_state_t front = { 0 }, back = { 0 };

	if (ecrt_master_link_state(l->m, 1, &back) || ecrt_master_link_state(l->m, 0, &front))
		return SIZE_MAX;
	return back.slaves_responding ? front.slaves_responding : SIZE_MAX;
}

/* Positions behind a break count from the far end of the whole ring: which slaves are missing? */
static int check_ring(struct load *l)
{
	size_t front = SIZE_MAX, i;
	bool missing = false;

	for (i = 0; i < l->want->slave_count; i++)
		missing |= l->plans[i].omitted;
	if (missing)
		front = slaves_before_break(l);
	for (i = 0; i < l->want->slave_count; i++) {
		const struct plan *p = &l->plans[i];

		if (p->there && p->position >= front && p->group < 0 &&
		    (!p->s->alias || p->s->alias != p->there->alias))
			return BAD(l, p->s->line,
				   "slave '%s' is behind the break of a ring from which slaves are missing, so its position is not certain; close the ring, connect what is missing, or give it an alias",
				   p->s->name);
	}
	return 0;
}

/*
 * Ring positions, as ec_groups_mark() counts: without the heads of groups and all slaves behind
 * them, also those that the file does not have.
 */
static int find_positions(struct load *l, const struct match *m)
{
	size_t n = l->found->slave_count, before = 0;
	bool *in = calloc(n + 1, sizeof(*in));
	int ret = in ? 0 : load_no_memory(l);

	for (size_t k = 0; k < n && !ret; k++) {
		size_t up = m->b.parent[k], i = m->b.peer[k];
		struct plan *p = i == NO_SLAVE ? NULL : &l->plans[i];

		in[k] = is_head(l, m, k) || (up < k && in[up]);
		if (p && p->there) {
			/* of groups by identification, which an application does not see */
			in[k] |= p->group >= 0;
			p->ring = k - before;
		}
		if (p && p->there && p->group < 0 && in[k])
			ret = refuse_behind(l, p);
		before += in[k];
	}
	free(in);
	return ret;
}

static int take_peers(struct load *l, const struct match *m)
{
	int ret;

	for (size_t i = 0; i < l->want->slave_count; i++) {
		struct plan *p = &l->plans[i];
		size_t k = m->a.peer[i];

		if (k != NO_SLAVE && same_identity(p->s, l->found->slaves[k])) {
			p->there = l->found->slaves[k];
			p->position = k;
		}
		/* a group may come later */
		p->omitted = !p->there && p->group < 0;
	}
	ret = find_positions(l, m);
	return ret ? ret : check_ring(l);
}

/* without the slave at whose port it is, a group cannot be configured */
static void omit_groups(struct load *l)
{
	for (size_t i = 0; i < l->want->slave_count; i++) {
		struct plan *p = &l->plans[i];
		const char *parent = p->group >= 0 ? l->want->groups[p->group]->parent : NULL;
		const struct plan *at = parent ? plan_of(l, parent) : NULL;

		p->omitted |= at && at->omitted;
	}
}

static const struct ecb_pdo *pdo_of(const struct ecb_slave *s, const struct ecb_pdo *like)
{
	for (size_t i = 0; s && i < s->pdo_count; i++)
		if (s->pdos[i]->index == like->index && s->pdos[i]->sm == like->sm)
			return s->pdos[i];
	return NULL;
}

/* no offset of a value depends on the entries of the last one */
static bool is_last(const struct ecb_slave *s, size_t i)
{
	const struct ecb_pdo *p = s->pdos[i];

	while (++i < s->pdo_count)
		if (s->pdos[i]->sm == p->sm)
			return false;
	return true;
}

/* the PDOs of the file, or those that the slave has */
static int choose_pdos(struct load *l, struct plan *p)
{
	const struct ecb_slave *from = p->s->pdo_count ? p->s : p->there;
	size_t n = from ? from->pdo_count : 0;

	p->pdos = calloc(n + 1, sizeof(*p->pdos));
	if (!p->pdos)
		return load_no_memory(l);
	p->n_pdos = n;
	for (size_t i = 0; i < n; i++) {
		p->pdos[i] = from->pdos[i];
		if (from->pdos[i]->entry_count || from == p->there)
			continue;
		p->pdos[i] = pdo_of(p->there, from->pdos[i]);
		if (!p->pdos[i] && is_last(from, i))
			p->pdos[i] = from->pdos[i];
		if (!p->pdos[i])
			return BAD(l, from->pdos[i]->line,
				   "PDO 0x%04x of '%s' has no entries here, and SM%u of the slave has no such PDO; give its entries",
				   from->pdos[i]->index, p->s->name, from->pdos[i]->sm);
	}
	return 0;
}

int load_place(struct load *l)
{
	struct search s = { .l = l };
	struct match m = { 0 };
	int ret = prepare(&s);

	if (!ret)
		ret = compare(&s);
	if (!ret && match_slaves(&m, &s.want, l->found, false))
		ret = load_no_memory(l);
	if (!ret)
		ret = take_peers(l, &m);
	if (!ret)
		omit_groups(l);
	match_free(&m);
	free(s.copies);
	free(s.slaves);
	for (size_t i = 0; i < l->want->slave_count && !ret; i++)
		if (!l->plans[i].omitted)
			ret = choose_pdos(l, &l->plans[i]);
	return ret;
}

/* @from has no entries of a PDO: those of the slave are known when the master is configured */
static int check_entries(struct load *l, const struct ecb_slave *from, size_t i)
{
	const struct ecb_pdo *pdo = from->pdos[i];

	return pdo->entry_count || is_last(from, i) ? 0 :
		BAD(l, pdo->line,
		    "PDO 0x%04x of '%s' has no entries here, and other PDOs of SM%u follow; give its entries",
		    pdo->index, from->name, pdo->sm);
}

static int place_slave(struct load *l, size_t i, size_t ring)
{
	struct plan *p = &l->plans[i];
	const struct ecb_slave *s = p->s;
	const struct plan *up = s->parent ? plan_of(l, s->parent) : NULL;
	int ret = 0;

	if (hides(p))
		return refuse_hidden(l, p);
	if (up && up->group >= 0 && p->group < 0)
		return refuse_behind(l, p);
	p->there = s;
	p->position = i;
	p->ring = ring;
	p->pdos = calloc(s->pdo_count + 1, sizeof(*p->pdos));
	if (!p->pdos)
		return load_no_memory(l);
	p->n_pdos = s->pdo_count;
	for (size_t k = 0; k < s->pdo_count && !ret; k++) {
		p->pdos[k] = s->pdos[k];
		ret = check_entries(l, s, k);
	}
	return ret;
}

int load_place_offline(struct load *l)
{
	size_t ring = 0;
	int ret = 0;

	for (size_t i = 0; i < l->want->slave_count; i++) {
		l->plans[i].s = l->want->slaves[i];
		find_group(l, &l->plans[i]);
	}
	for (size_t i = 0; i < l->want->slave_count && !ret; i++) {
		ret = place_slave(l, i, ring);
		/* members of groups do not count */
		ring += l->plans[i].group < 0;
	}
	return ret;
}
