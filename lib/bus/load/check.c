// SPDX-License-Identifier: LGPL-2.1-or-later
/* What the file says and ecrt.h cannot do, before anything is configured. */
#include <errno.h>
#include <string.h>

#include "load.h"

/* the order in which the master writes the commands of the step to SAFEOP */
static unsigned int rank(const struct ecb_command *c)
{
	return c->sdo != ECB_NONE32 ? 0 : c->idn != ECB_NONE32 ? 1 : 2;
}

static const char *const rank_name[] = { "SDOs", "IDNs", "registers" };

static int check_startup(struct load *l, const struct ecb_slave *s)
{
	unsigned int last = 0;

	for (size_t i = 0; i < s->startup_count; i++) {
		const struct ecb_command *c = s->startup[i];

		if (c->at == ECB_AT_PREOP && c->reg == ECB_NONE32)
			return BAD(l, c->line,
				   "startup command of '%s' at preop: there is no mailbox before PREOP; expected a register, or 'at: safeop'",
				   s->name);
		if (c->complete && ECB_SUBINDEX(c->sdo))
			return BAD(l, c->line,
				   "startup command of '%s': complete access begins at subindex 0; expected 0x%04x:00",
				   s->name, ECB_INDEX(c->sdo));
		if (c->at != ECB_AT_SAFEOP)
			continue;
		if (rank(c) < last)
			return BAD(l, c->line,
				   "startup command of '%s': at safeop the master writes %s before %s; move it before them",
				   s->name, rank_name[rank(c)], rank_name[last]);
		last = rank(c);
	}
	return 0;
}

static int check_slave(struct load *l, const struct plan *p)
{
	const struct ecb_group *g = p->group >= 0 ? l->want->groups[p->group] : NULL;

	if (g && ((p->s->alias && p->s->alias != g->alias) ||
		  (p->s->identification && p->s->identification != g->identification)))
		return BAD(l, p->s->line,
			   "slave '%s': a member of a hot connect group is known by the group; remove its alias and identification",
			   p->s->name);
	for (unsigned int sm = 0; sm < EC_MAX_SYNC_MANAGERS && !p->omitted; sm++)
		for (size_t i = 0; i < p->n_pdos; i++)
			if (p->pdos[i]->sm == sm &&
			    load_direction(l, p, sm) == EC_DIR_INVALID)
				return BAD(l, p->s->line,
					   "PDO 0x%04x of '%s': SM%u is not known as one of inputs or of outputs; expected 0x1600 to 0x17ff, or 0x1a00 to 0x1bff",
					   p->pdos[i]->index, p->s->name, sm);
	return check_startup(l, p->s);
}

static int check_unit(struct load *l, const struct ecb_unit *u)
{
	const struct ecb_master *m = l->want;
	size_t i = 0;

	while (i < m->slave_count && (!m->slaves[i]->sync_unit ||
				      strcmp(m->slaves[i]->sync_unit, u->name)))
		i++;
	if (i == m->slave_count)
		return BAD(l, u->line, "sync unit '%s' has no slaves; remove it, or name it in 'sync_unit' of a slave",
			   u->name);
	if (u->lease && !m->cycle)
		return BAD(l, u->line, "sync unit '%s': a lease counts cycles; give the 'cycle' of the master",
			   u->name);
	return 0;
}

/*
 * An application does not see identifications, so not where such a group is: what counts from
 * there on by ring position might be another slave.
 */
static int check_hidden(struct load *l, const struct ecb_group *g)
{
	if (!g->identification || g->alias || l->how->found)
		return 0;
	for (size_t i = 0; i < l->want->slave_count; i++) {
		const struct plan *p = &l->plans[i];

		if (p->there && p->group < 0 && p->position && !p->s->alias)
			return BAD(l, g->line,
				   "hot connect group '%s': an application does not see identifications, and slave '%s' has no alias; give it one, or use 'ethercat run'",
				   g->name, p->s->name);
	}
	return 0;
}

static int check_group(struct load *l, size_t group)
{
	int ret = check_hidden(l, l->want->groups[group]);

	if (ret)
		return ret;
	for (size_t i = 0; i < l->want->slave_count; i++)
		if (l->plans[i].group == (long)group)
			return 0;
	return BAD(l, l->want->groups[group]->line,
		   "hot connect group '%s' has no slaves; remove it, or name it in 'group' of a slave",
		   l->want->groups[group]->name);
}

static int check_master(struct load *l)
{
	const struct ecb_master *m = l->want;

	if (m->main_device || m->backup_device)
		return BAD(l, m->line,
			   "an application does not choose the devices of the master; remove main_device and backup_device, and start the master with them (main_devices= of ec_master)");
	for (size_t i = 0; i < m->slave_count; i++)
		if (m->reference_clock && !strcmp(m->slaves[i]->name, m->reference_clock) &&
		    l->plans[i].omitted)
			return BAD(l, m->slaves[i]->line,
				   "reference clock '%s' is missing; connect it, or remove 'reference_clock'",
				   m->reference_clock);
	return 0;
}

int load_check(struct load *l)
{
	int ret = check_master(l);

	for (size_t i = 0; i < l->want->sync_unit_count && !ret; i++)
		ret = check_unit(l, l->want->sync_units[i]);
	for (size_t i = 0; i < l->want->group_count && !ret; i++)
		ret = check_group(l, i);
	for (size_t i = 0; i < l->want->slave_count && !ret; i++)
		ret = check_slave(l, &l->plans[i]);
	return ret;
}
