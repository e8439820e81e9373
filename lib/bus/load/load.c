// SPDX-License-Identifier: LGPL-2.1-or-later
/* A bus file becomes the configuration of a master: checks first, then ecrt.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "load.h"

int load_no_memory(struct load *l)
{
	ecb_report(l->e, l->file, 0, 0, "out of memory");
	return -ENOMEM;
}

int load_failed(struct load *l, uint32_t line, int err, const char *fmt, ...)
{
	char what[256], why[256] = "";
	va_list ap;

	va_start(ap, fmt);
	vsnprintf(what, sizeof(what), fmt, ap);
	va_end(ap);
	if (l->offline || ecrt_master_reason(l->m, why, sizeof(why)))
		why[0] = 0;
	ecb_report(l->e, l->file, line, 0, "%s (%s)%s%s", what, strerror(-err), why[0] ? ": " : "",
		   why);
	return err;
}

static const struct load_calls load_ecrt = {
	.create_domain = ecrt_master_create_domain,
	.unit = ecrt_master_unit,
	.set_unit = ecrt_domain_set_unit,
	.slave = ecrt_master_slave_config,
	.group = ecrt_master_group,
	.member = ecrt_master_group_config,
	.flag = ecrt_slave_config_flag,
	.sdo = ecrt_slave_config_sdo,
	.complete_sdo = ecrt_slave_config_complete_sdo,
	.sdo32 = ecrt_slave_config_sdo32,
	.idn = ecrt_slave_config_idn,
	.command = ecrt_slave_config_command,
	.state_timeout = ecrt_slave_config_state_timeout,
	.sdo_timeout = ecrt_slave_config_sdo_timeout,
	.dc = ecrt_slave_config_dc,
	.pdos = ecrt_slave_config_pdos,
	.reg = ecrt_slave_config_reg_pdo_entry_pos,
	.reference_clock = ecrt_master_select_reference_clock,
	.interval = ecrt_master_set_send_interval,
	.names = ecrt_master_set_names,
};

/* what a call that returns a handle has left in errno */
static int error_of_handle(void)
{
	return errno ? -errno : -EINVAL;
}

static size_t unit_of(const struct load *l, const struct ecb_slave *s)
{
	size_t i = 0;

	while (i < l->want->sync_unit_count &&
	       (!s->sync_unit || strcmp(s->sync_unit, l->want->sync_units[i]->name)))
		i++;
	return i;
}

/* a domain for each sync unit that has slaves, and one for slaves without */
static int create_domain(struct load *l, size_t i)
{
	const struct ecb_unit *u = i < l->want->sync_unit_count ? l->want->sync_units[i] : NULL;
	ec_unit_config_t c = { 0 };
	int unit, ret;

	l->domains[i] = l->calls->create_domain(l->m);
	if (!l->domains[i])
		return load_failed(l, u ? u->line : 0, error_of_handle(), "cannot create a domain");
	if (!u)
		return 0;
	c.name = u->name;
	c.policy = (ec_unit_policy_t)u->policy;
	c.limit = u->limit;
	if (u->lease)
		c.lease_cycles = (uint32_t)((u->lease + l->want->cycle - 1) / l->want->cycle);
	c.repeats = u->repeats;
	c.flags = (u->needs_authority ? EC_UNIT_AUTHORITY : 0) |
		(u->lease_holds ? EC_UNIT_LEASE_HOLD : 0) | (u->offered ? EC_UNIT_OFFERED : 0);
	unit = l->calls->unit(l->m, &c);
	ret = unit < 0 ? unit : l->calls->set_unit(l->domains[i], unit);
	return ret ? load_failed(l, u->line, ret, "cannot create sync unit '%s'", u->name) : 0;
}

static int create_domains(struct load *l)
{
	int ret = 0;

	l->domains = calloc(l->want->sync_unit_count + 1, sizeof(ec_domain_t *));
	if (!l->domains)
		return load_no_memory(l);
	for (size_t i = 0; i <= l->want->sync_unit_count && !ret; i++)
		for (size_t k = 0; k < l->want->slave_count && !l->domains[i] && !ret; k++)
			if (!l->plans[k].omitted && unit_of(l, l->plans[k].s) == i)
				ret = create_domain(l, i);
	return ret;
}

static int configure_single(struct load *l, struct plan *p)
{
	uint16_t alias = p->there->alias == p->s->alias ? p->s->alias : 0;

	if (p->sc)
		return 0;
	p->config = l->n_configs++;
	p->sc = l->calls->slave(l->m, alias, alias ? 0 : (uint16_t)p->ring, p->s->vendor,
				p->s->product);
	return p->sc ? 0 : load_failed(l, p->s->line, error_of_handle(),
				       "slave '%s': cannot configure it", p->s->name);
}

static struct plan *plan_by_name(struct load *l, const char *slave)
{
	size_t i = 0;

	while (strcmp(l->want->slaves[i]->name, slave))
		i++;
	return &l->plans[i];
}

static int configure_group(struct load *l, size_t index)
{
	const struct ecb_group *g = l->want->groups[index];
	struct plan *at = g->parent ? plan_by_name(l, g->parent) : NULL;
	ec_group_info_t info = {
		.name = g->name, .by = g->alias ? EC_GROUP_ALIAS : g->identification ?
			EC_GROUP_ID : EC_GROUP_PORT,
		.value = g->alias ? g->alias : g->identification, .port = at ? g->port : 0,
		.flags = (g->mandatory ? EC_GROUP_MANDATORY : 0) | (g->fast ? EC_GROUP_FAST : 0),
	};
	uint16_t member = 0;
	int group, ret = 0;

	if (at && at->omitted)
		return 0;
	if (at && at->group >= 0 && !at->sc)
		return BAD(l, g->line,
			   "hot connect group '%s': its parent is in another group, which has to stand before it",
			   g->name);
	if (at)
		ret = configure_single(l, at);
	if (ret)
		return ret;
	info.at = at ? at->sc : NULL;
	group = l->calls->group(l->m, &info);
	if (group < 0)
		return load_failed(l, g->line, group, "cannot create hot connect group '%s'",
				   g->name);
	for (size_t i = 0; i < l->want->slave_count; i++) {
		struct plan *p = &l->plans[i];

		if (p->group != (long)index)
			continue;
		p->config = l->n_configs++;
		p->sc = l->calls->member(l->m, (unsigned int)group, member++, p->s->vendor,
					 p->s->product);
		if (!p->sc)
			return load_failed(l, p->s->line, error_of_handle(),
					   "slave '%s': cannot configure it", p->s->name);
	}
	return 0;
}

/* groups before what is known by its ring position */
static int configure_slaves(struct load *l)
{
	int ret = 0;

	for (size_t i = 0; i < l->want->group_count && !ret; i++)
		ret = configure_group(l, i);
	for (size_t i = 0; i < l->want->slave_count && !ret; i++)
		if (!l->plans[i].omitted && l->plans[i].group < 0)
			ret = configure_single(l, &l->plans[i]);
	for (size_t i = 0; i < l->want->slave_count && !ret; i++)
		if (!l->plans[i].omitted)
			ret = load_configure(l, &l->plans[i]);
	return ret;
}

static int add_values(struct load *l, const struct plan *p, const struct ecb_pdo *pdo,
		      struct ecb_value *v, uint64_t *bit)
{
	for (size_t i = 0; i < pdo->entry_count; i++) {
		const struct ecb_entry *e = pdo->entries[i];

		v->object = e->object;
		v->byte = (uint32_t)(*bit / 8);
		v->bit = *bit % 8;
		v->bits = e->bits;
		v->type = e->type;
		v->scale = e->scale;
		v->offset = e->offset;
		*bit += e->bits;
		if (e->object && loaded_add(l->to, p->s->name, e, v))
			return load_no_memory(l);
	}
	return 0;
}

/* The whole SyncManager is in the domain with its first entry. */
static int register_sm(struct load *l, const struct plan *p, unsigned int sm)
{
	size_t unit = unit_of(l, p->s);
	struct ecb_value v = {
		.struct_size = sizeof(v), .domain = l->domains[unit], .slave = p->sc,
		.output = load_direction(l, p, sm) == EC_DIR_OUTPUT,
	};
	unsigned int pos = 0, first = 0;
	uint64_t bit = UINT64_MAX;
	int ret = 0;

	for (size_t i = 0; i < p->n_pdos && !ret; i++) {
		const struct ecb_pdo *pdo = p->pdos[i];
		int at;

		if (pdo->sm != sm)
			continue;
		if (pdo->entry_count && bit == UINT64_MAX) {
			at = l->calls->reg(p->sc, (uint8_t)sm, pos, 0, l->domains[unit], &first);
			if (at < 0)
				return load_failed(l, p->s->line, at,
						   "slave '%s': cannot register PDO 0x%04x",
						   p->s->name, pdo->index);
			bit = 8 * (uint64_t)at + first;
			l->to->regs++;
		}
		pos++;
		ret = add_values(l, p, pdo, &v, &bit);
	}
	return ret;
}

/* a slave of a unit whose frames are repeated can stand that, as its vendor says */
static int allow_repeats(struct load *l, const struct plan *p)
{
	size_t i = unit_of(l, p->s);
	int ret;

	if (i == l->want->sync_unit_count || l->want->sync_units[i]->repeats < 2)
		return 0;
	ret = l->calls->flag(p->sc, "FrameRepeatSupport", 1);
	return ret ? load_failed(l, p->s->line, ret, "slave '%s': cannot configure it",
				 p->s->name) : 0;
}

/* entries that only the slave knows */
static bool has_unknown(const struct plan *p)
{
	for (size_t i = 0; i < p->n_pdos; i++)
		if (!p->pdos[i]->entry_count)
			return true;
	return !p->n_pdos;
}

static int register_values(struct load *l)
{
	int ret = 0;

	for (size_t i = 0; i < l->want->slave_count && !ret; i++) {
		const struct plan *p = &l->plans[i];

		if (p->omitted)
			continue;
		ret = allow_repeats(l, p);
		for (unsigned int sm = 0; sm < EC_MAX_SYNC_MANAGERS && !ret; sm++)
			ret = register_sm(l, p, sm);
		if (!ret && l->calls->rest && has_unknown(p))
			ret = l->calls->rest(p->sc, l->domains[unit_of(l, p->s)]);
	}
	return ret;
}

static int set_up_master(struct load *l)
{
	const struct ecb_master *m = l->want;
	int ret = 0;

	if (m->reference_clock)
		ret = l->calls->reference_clock(l->m, plan_by_name(l, m->reference_clock)->sc);
	if (ret)
		return load_failed(l, m->line, ret, "cannot select the reference clock");
	if (m->cycle)
		ret = l->calls->interval(l->m, (size_t)((m->cycle + 999) / 1000));
	return ret ? load_failed(l, m->line, ret, "cannot set the cycle") : 0;
}

static int describe(struct load *l)
{
	uint32_t slaves = 0, clocks = 0;
	int ret = loaded_sort(l->to);

	if (ret)
		return BAD(l, l->want->line,
			   "two values have the same name; give all entries of their slave names");
	for (size_t i = 0; i < l->want->slave_count; i++) {
		slaves += !l->plans[i].omitted;
		clocks += !l->plans[i].omitted && l->plans[i].s->clock;
	}
	loaded_describe(l->to, slaves, clocks, l->want->cycle);
	return 0;
}

static int keep(struct load *l)
{
	int ret = ecrt_master_set_data(l->m, l->to, loaded_free);

	if (ret)
		return load_no_memory(l);
	l->to = NULL;
	return 0;
}

int load_apply(struct load *l)
{
	int ret = create_domains(l);

	if (!ret)
		ret = configure_slaves(l);
	if (!ret)
		ret = register_values(l);
	if (!ret)
		ret = set_up_master(l);
	if (!ret)
		ret = load_publish_names(l);
	return ret ? ret : describe(l);
}

/* by its index, or the only one */
static int choose_master(struct load *l)
{
	const struct ecb_bus *b = l->how->bus;

	for (size_t i = 0; i < b->master_count; i++)
		if (b->master_count == 1 || b->masters[i]->index == l->how->index)
			l->want = b->masters[i];
	return l->want ? 0 : BAD(l, 0, "no master %u in the file; expected one of its masters",
				 l->how->index);
}

int load_begin(struct load *l)
{
	int ret = choose_master(l);

	if (ret)
		return ret;
	l->plans = calloc(l->want->slave_count + 1, sizeof(*l->plans));
	l->to = loaded_new();
	return l->plans && l->to ? 0 : load_no_memory(l);
}

void load_end(struct load *l)
{
	for (size_t i = 0; l->plans && i < l->want->slave_count; i++)
		free(l->plans[i].pdos);
	free(l->plans);
	free(l->domains);
	ecb_bus_free(l->read);
	loaded_free(l->to);
}

ECB_API int ecrt_master_load_bus(ec_master_t *master, const struct ecb_load *load,
				 struct ecb_error *error)
{
	struct ecb_load how = { 0 };
	struct load l = { .m = master, .calls = &load_ecrt, .how = &how, .e = error };
	int ret;

	if (!error || !load || load->struct_size < offsetof(struct ecb_load, found))
		return -EINVAL;
	memset(error, 0, sizeof(*error));
	memcpy(&how, load, load->struct_size < sizeof(how) ? load->struct_size : sizeof(how));
	l.file = how.file ? how.file : "bus";
	if (!how.bus || how.flags & ~(ECB_LOAD_PARTIAL | ECB_LOAD_CHECK) ||
	    !(how.flags & ECB_LOAD_CHECK ? (void *)how.found : (void *)master))
		return BAD(&l, 0, "needs a bus, known flags, and a master, or slaves to check");
	if (ecrt_master_data(master, loaded_free))
		return BAD(&l, 0, "a bus is loaded already; release or deactivate the master first");
	l.found = how.found;
	ret = load_begin(&l);
	if (!ret && !l.found)
		ret = load_read_machine(&l);
	if (!ret)
		ret = load_place(&l);
	if (!ret)
		ret = load_check(&l);
	if (!ret && !(how.flags & ECB_LOAD_CHECK)) {
		ret = load_apply(&l);
		if (!ret)
			ret = keep(&l);
	}
	load_end(&l);
	return ret;
}

ECB_API int ecrt_master_load(ec_master_t *master, const char *path, struct ecb_error *error)
{
	struct ecb_load load = { .struct_size = sizeof(load), .file = path };
	struct ecb_bus *bus;
	int ret = ecb_file_read(&bus, path, error);

	if (ret)
		return ret;
	load.bus = bus;
	if (bus->master_count == 1)
		ret = ecrt_master_load_bus(master, &load, error);
	else
		ret = ecb_report(error, path, 0, 0,
				 "%zu masters; expected one, or ecrt_master_load_bus() with its index",
				 bus->master_count);
	ecb_bus_free(bus);
	return ret;
}
