// SPDX-License-Identifier: GPL-2.0-only
/* Commands that show what the application has configured. */
#include <linux/mm.h>
#include <linux/slab.h>
#include "../config/config.h"
#include "../cycle/cycle_thread.h"
#include "../cycle/domain.h"
#include "ioctl.h"
#include "../master.h"
#include "../session/session.h"
#include "../bus/slave.h"

#define WALK	64	/* list entries, */
#define PIECE	4096	/* and bytes to copy, at once */

/* Begins to look at the session; NULL with the reason noted when there is none. */
static struct ec_session *look(struct ec_file *f, int *ret)
{
	struct ec_master *m = f->master;
	struct ec_session *s;

	*ret = ec_show_begin(m);
	if (*ret)
		return NULL;
	/* an application sees its own */
	s = ec_session_of(m, f) ?: m->session;
	if (s)
		return s;
	ec_show_end(m);
	*ret = ec_refuse(f, -ENOENT, "no application has reserved master %u", m->base->index);
	return NULL;
}

static int done(struct ec_file *f, int ret)
{
	ec_show_end(f->master);
	return ret;
}

/**
 * ec_ioc_show_config() - find a configuration, to look at it
 * @f: open file
 * @index: of the configuration
 * @ret: why there is none
 *
 * An application sees its own session, everybody else that which runs.
 *
 * Context: Process. May sleep. As after ec_show_begin() when one is returned.
 * Return: configuration, or NULL with the reason noted.
 */
struct ec_config *ec_ioc_show_config(struct ec_file *f, u32 index, int *ret)
{
	struct ec_session *s = look(f, ret);

	if (!s)
		return NULL;
	if (index < s->n_configs)
		return s->configs[index];
	*ret = done(f, ec_refuse(f, -ENOENT, "there are %u slave configurations, not %u",
				 s->n_configs, index + 1));
	return NULL;
}

/* The same with a domain. */
static struct ec_domain *show_domain(struct ec_file *f, u32 index, int *ret)
{
	struct ec_session *s = look(f, ret);

	if (!s)
		return NULL;
	if (index < s->n_domains)
		return s->domains[index];
	*ret = done(f, ec_refuse(f, -ENOENT, "there are %u domains, not %u", s->n_domains,
				 index + 1));
	return NULL;
}

int ec_ioc_config(struct ec_file *f, void *arg)
{
	struct ec_ioc_config *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	i->alias = c->alias;
	i->position = c->position;
	i->vendor_id = c->vendor;
	i->product_code = c->product;
	i->slave_position = c->slave ? c->slave->position : -1;
	i->al_status = c->slave ? c->slave->al_status : 0;
	i->watchdog_divider = c->wd_divider;
	i->watchdog_intervals = c->wd_intervals;
	i->dc_assign_activate = c->dc_assign;
	memcpy(i->dc_cycle, c->dc_cycle, sizeof(i->dc_cycle));
	memcpy(i->dc_shift, c->dc_shift, sizeof(i->dc_shift));
	i->sdo_count = c->n_sdos;
	i->state = ec_session_config_status(c);
	i->flag_count = c->n_flags;
	return done(f, 0);
}

int ec_ioc_config_sm(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_sm *i = arg;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	if (i->sm >= EC_MAX_SM)
		ret = ec_refuse(f, -ENOENT, "SyncManagers are 0 to %u", EC_MAX_SM - 1);
	else {
		i->dir = c->sm[i->sm].dir;
		i->watchdog = c->sm[i->sm].watchdog;
		i->pdo_count = c->sm[i->sm].pdos.n;
	}
	return done(f, ret);
}

static const struct ec_pdo *pdo(struct ec_file *f, const struct ec_config *c, u8 sm, u32 pos,
				int *ret)
{
	if (sm < EC_MAX_SM && pos < c->sm[sm].pdos.n)
		return &c->sm[sm].pdos.pdos[pos];
	*ret = ec_refuse(f, -ENOENT, "no PDO %u at SM%u", pos, sm);
	return NULL;
}

int ec_ioc_config_pdo(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_pdo *i = arg;
	const struct ec_pdo *p;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	p = pdo(f, c, i->sm, i->pdo_pos, &ret);
	if (p) {
		i->pdo_index = p->index;
		i->entry_count = p->n_entries;
	}
	return done(f, ret);
}

int ec_ioc_config_entry(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_entry *i = arg;
	const struct ec_pdo *p;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	p = pdo(f, c, i->sm, i->pdo_pos, &ret);
	if (p && i->entry_pos >= p->n_entries)
		ret = ec_refuse(f, -ENOENT, "PDO 0x%04x has %u entries", p->index, p->n_entries);
	else if (p) {
		i->entry_index = p->entries[i->entry_pos].index;
		i->subindex = p->entries[i->entry_pos].sub;
		i->bits = p->entries[i->entry_pos].bits;
	}
	return done(f, ret);
}

/* Copies in pieces; returns as ec_show_pause() in between. */
static int copy_pieces(struct ec_file *f, void *to, const void *from, u32 size)
{
	u32 pos;
	int ret;

	for (pos = 0; pos < size; pos += PIECE) {
		ret = pos ? ec_show_pause(f->master) : 0;
		if (ret)
			return ret;
		memcpy(to + pos, from + pos, min(size - pos, PIECE));
	}
	return 0;
}

/* Return: as ec_show_pause(), or -ENOENT; 0: the section goes on. */
static int find_sdo(struct ec_file *f, const struct ec_config *c, u32 n,
		    const struct ec_config_sdo **found)
{
	const struct ec_config_sdo *sdo;
	u32 k = 0;
	int ret;

	list_for_each_entry(sdo, &c->sdos, list) {
		if (k == n) {
			*found = sdo;
			return 0;
		}
		ret = ++k % WALK ? 0 : ec_show_pause(f->master);
		if (ret)
			return ret;
	}
	return done(f, ec_refuse(f, -ENOENT, "configuration %u has %u startup SDOs", c->index,
				 c->n_sdos));
}

/* @copy has room for @room bytes. */
static int show_sdo(struct ec_file *f, struct ec_ioc_config_sdo *i, void *copy, u32 room,
		    u32 *size)
{
	const struct ec_config_sdo *sdo = NULL;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	ret = find_sdo(f, c, i->sdo_pos, &sdo);
	if (ret)
		return ret;
	i->flags = sdo->complete ? EC_SDO_FLAG_COMPLETE : 0;
	i->sdo_index = sdo->index;
	i->subindex = sdo->sub;
	i->size = sdo->size;
	*size = min_t(u32, room, sdo->size);
	ret = copy_pieces(f, copy, sdo->data, *size);
	return ret ?: done(f, 0);
}

int ec_ioc_config_sdo(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_sdo *i = arg;
	u32 room = min_t(u32, i->size, EC_MAX_SDO_SIZE), size = 0;
	void *copy = kvmalloc(room, GFP_KERNEL_ACCOUNT);
	int ret;

	if (!copy)
		return -ENOMEM;
	do
		ret = show_sdo(f, i, copy, room, &size);
	while (ret == -EAGAIN);
	return ec_ioc_hand_over(i->data, copy, size, ret);
}

/* As find_sdo(). */
static int find_idn(struct ec_file *f, const struct ec_config *c, u32 pos,
		    const struct ec_config_idn **found)
{
	const struct ec_config_idn *idn;
	u32 k = 0;
	int ret;

	list_for_each_entry(idn, &c->idns, list) {
		if (k == pos) {
			*found = idn;
			return 0;
		}
		ret = ++k % WALK ? 0 : ec_show_pause(f->master);
		if (ret)
			return ret;
	}
	return done(f, ec_refuse(f, -ENOENT, "configuration %u has %u startup IDNs", c->index,
				 c->n_idns));
}

/* @copy has room for @room bytes. */
static int show_idn(struct ec_file *f, struct ec_ioc_config_idn *i, void *copy, u32 room,
		    u32 *size)
{
	const struct ec_config_idn *idn = NULL;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	ret = find_idn(f, c, i->idn_pos, &idn);
	if (ret)
		return ret;
	i->idn = idn->idn;
	i->drive = idn->drive;
	i->state = idn->state;
	i->size = idn->size;
	*size = min_t(u32, room, idn->size);
	ret = copy_pieces(f, copy, idn->data, *size);
	return ret ?: done(f, 0);
}

int ec_ioc_config_idn(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_idn *i = arg;
	u32 room = min_t(u32, i->size, EC_MAX_SOE_SIZE), size = 0;
	void *copy = kvmalloc(room, GFP_KERNEL_ACCOUNT);
	int ret;

	if (!copy)
		return -ENOMEM;
	do
		ret = show_idn(f, i, copy, room, &size);
	while (ret == -EAGAIN);
	return ec_ioc_hand_over(i->data, copy, size, ret);
}

int ec_ioc_config_flag(struct ec_file *f, void *arg)
{
	struct ec_ioc_config_flag *i = arg;
	struct ec_config_flag *flag;
	u32 k = 0;
	int ret = 0;
	struct ec_config *c = ec_ioc_show_config(f, i->index, &ret);

	if (!c)
		return ret;
	list_for_each_entry(flag, &c->flags, list) {
		if (k++ != i->flag_pos)
			continue;
		i->value = flag->value;
		memcpy(i->key, flag->key, sizeof(i->key));
		return done(f, 0);
	}
	return done(f, ec_refuse(f, -ENOENT, "there are %u flags, not %u", c->n_flags,
				 i->flag_pos + 1));
}

int ec_ioc_domain(struct ec_file *f, void *arg)
{
	struct ec_ioc_domain *i = arg;
	int ret = 0;
	struct ec_domain *d = show_domain(f, i->index, &ret);

	if (!d)
		return ret;
	i->size = d->size;
	i->logical = d->logical;
	i->expected = d->expected;
	i->fmmu_count = d->n_fmmus;
	i->options = d->options;
	i->max_age = d->max_age;
	if (d->session->active) {
		const struct ec_status *st = d->session->shared->status;

		i->datagram_count = d->n_dgrams;
		i->datagram_bytes = d->dgram_bytes;
		i->working_counter = READ_ONCE(st->domains[d->index].working_counter);
		i->age = READ_ONCE(st->domains[d->index].age);
	}
	return done(f, 0);
}

int ec_ioc_domain_fmmu(struct ec_file *f, void *arg)
{
	struct ec_ioc_domain_fmmu *i = arg;
	const struct ec_config_fmmu *fm;
	int ret = 0;
	struct ec_domain *d = show_domain(f, i->index, &ret);

	if (!d)
		return ret;
	if (i->fmmu >= d->n_fmmus)
		ret = ec_refuse(f, -ENOENT, "domain %u has %u FMMUs", i->index, d->n_fmmus);
	else {
		fm = &d->fmmus[i->fmmu].config->fmmus[d->fmmus[i->fmmu].fmmu];
		i->alias = d->fmmus[i->fmmu].config->alias;
		i->position = d->fmmus[i->fmmu].config->position;
		i->sm = fm->sm;
		i->dir = fm->dir;
		i->offset = fm->offset;
		i->size = fm->size;
		i->logical = d->logical + fm->logical;
	}
	return done(f, ret);
}

/* @copy has room for @room bytes. */
static int show_data(struct ec_file *f, struct ec_ioc_domain_data *i, void *copy, u32 room)
{
	int ret = 0;
	struct ec_domain *d = show_domain(f, i->index, &ret);
	u32 pos;

	if (!d)
		return ret;
	if (!d->session->active)
		return done(f, ec_refuse(f, -ENOENT, "the application has not activated the master"));
	i->size = min_t(u32, room, d->size);
	for (pos = 0; pos < i->size; pos += PIECE) {
		u32 n = min(i->size - pos, PIECE);

		ret = pos ? ec_show_pause(f->master) : 0;
		if (ret)
			return ret;
		memcpy(copy + pos, ec_domain_data(d) + pos, n);
		ec_cycle_thread_outputs(d->session, copy + pos, d->offset + pos, n);
	}
	return done(f, 0);
}

int ec_ioc_domain_data(struct ec_file *f, void *arg)
{
	struct ec_ioc_domain_data *i = arg;
	u32 room = min_t(u32, i->size, EC_MAX_IMAGE);
	void *copy = kvmalloc(room, GFP_KERNEL_ACCOUNT);
	int ret;

	if (!copy)
		return -ENOMEM;
	do
		ret = show_data(f, i, copy, room);
	while (ret == -EAGAIN);
	return ec_ioc_hand_over(i->data, copy, i->size, ret);
}
