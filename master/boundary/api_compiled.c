// SPDX-License-Identifier: GPL-2.0-only
/* A compiled bus file becomes the configuration of a master; for applications in the kernel. */
#include <linux/mm.h>
#include "../../lib/ecrt/ecrt_int.h"
#include "../base/limits.h"
#include "api_values.h"

/* a SyncManager in a domain: where its first registered entry is */
struct place {
	ec_domain_t *domain;
	ec_slave_config_t *slave;
	u64 bit;
};

/** struct build - one call of ecrt_master_load_compiled() */
struct build {
	/** @m: master */
	ec_master_t *m;
	/** @c: file; each array below has memory for all of its records */
	struct ec_compiled c;
	/** @domains: domains so far */
	ec_domain_t **domains;
	/** @n_domains: how many */
	u32 n_domains;
	/** @slaves: slave configurations so far */
	ec_slave_config_t **slaves;
	/** @placed: of each a bit for each SyncManager that is registered */
	u16 *placed;
	/** @n_slaves: how many */
	u32 n_slaves;
	/** @units: numbers of sync units so far */
	int *units;
	/** @n_units: how many */
	u32 n_units;
	/** @groups: numbers of hot connect groups so far */
	int *groups;
	/** @n_groups: how many */
	u32 n_groups;
	/** @places: registrations so far */
	struct place *places;
	/** @n_places: how many */
	u32 n_places;
	/** @to: result */
	struct ec_loaded *to;
};

static int add_domain(struct build *b)
{
	ec_domain_t *d = ecrt_master_create_domain(b->m);

	if (!d)
		return -EINVAL;
	b->domains[b->n_domains++] = d;
	return 0;
}

static int add_sync_unit(struct build *b, const struct ec_compiled_record *r)
{
	const ec_unit_config_t unit = {
		.name = r->name, .policy = (ec_unit_policy_t)r->policy, .limit = r->limit,
		.lease_cycles = r->lease_cycles, .repeats = r->repeats, .flags = r->flags,
	};
	int ret = ecrt_master_unit(b->m, &unit);

	if (ret < 0)
		return ret;
	b->units[b->n_units++] = ret;
	return 0;
}

static int add_slave(struct build *b, ec_slave_config_t *sc)
{
	if (!sc)
		return -EINVAL;
	b->slaves[b->n_slaves++] = sc;
	return 0;
}

static int add_group(struct build *b, const struct ec_compiled_record *r)
{
	const ec_group_info_t group = {
		.name = r->name, .by = (ec_group_by_t)r->kind, .value = r->number, .port = r->to,
		.at = r->slave == EC_COMPILED_NONE ? NULL : b->slaves[r->slave],
		.flags = r->flags,
	};
	int ret = ecrt_master_group(b->m, &group);

	if (ret < 0)
		return ret;
	b->groups[b->n_groups++] = ret;
	return 0;
}

static int add_command(ec_slave_config_t *sc, const struct ec_compiled_record *r)
{
	const ec_command_t command = {
		.kind = (ec_command_kind_t)r->kind, .index = r->index, .subindex = r->subindex,
		.complete = r->complete, .size = r->size,
		.data = r->expected ? NULL : r->data, .expect = r->expected ? r->data : NULL,
	};

	return ecrt_slave_config_command(sc, (ec_step_t)r->step, &command);
}

static int map_pdo(ec_slave_config_t *sc, u8 sm, struct ec_rbuf *at)
{
	struct ec_compiled_pdo pdo = ec_compiled_pdo(at);
	int ret = ecrt_slave_config_pdo_assign_add(sc, sm, pdo.index);

	/* without entries it keeps those of the slave */
	if (!ret && pdo.n_entries)
		ret = ecrt_slave_config_pdo_mapping_clear(sc, pdo.index);
	for (; !ret && pdo.n_entries; pdo.n_entries--) {
		struct ec_compiled_entry e = ec_compiled_entry(at);

		ret = ecrt_slave_config_pdo_mapping_add(sc, pdo.index, e.index, e.subindex,
							e.bits);
	}
	return ret;
}

static int begin_sm(ec_slave_config_t *sc, u8 sm, u8 dir)
{
	return ecrt_slave_config_sync_manager(sc, sm, (ec_direction_t)dir, EC_WD_DEFAULT) ?:
	       ecrt_slave_config_pdo_assign_clear(sc, sm);
}

/* what the slave has in a SyncManager: @pdo is the first PDO with entries */
struct present {
	u8 dir;
	bool any;
	bool entries;
	u16 pdo;
};

static void look_at_sms(ec_slave_config_t *sc, struct present *to)
{
	const struct ec_config *c = ec_api_config(sc);
	struct ec_sessions *ss = &ec_sc_master(sc)->sessions;
	unsigned int sm, i;

	memset(to, 0, EC_MAX_SM * sizeof(*to));
	ec_sessions_lock(ss);
	for (sm = 0; sm < EC_MAX_SM; sm++) {
		const struct ec_pdo_list *l = &c->sm[sm].pdos;

		to[sm].dir = c->sm[sm].dir == EC_CFG_DIR_OUTPUT ? EC_DIR_OUTPUT : EC_DIR_INPUT;
		to[sm].any = l->n;
		for (i = 0; i < l->n && !to[sm].entries; i++) {
			to[sm].entries = l->pdos[i].n_entries;
			to[sm].pdo = i;
		}
	}
	ec_sessions_unlock(ss);
}

/* The PDOs of the file are all that the slave has: other SyncManagers get none. */
static int map_pdos(ec_slave_config_t *sc, const struct ec_compiled_record *r)
{
	struct ec_rbuf at = ec_rbuf(r->data, r->size);
	struct present before[EC_MAX_SM];
	unsigned int sm, listed = 0;
	int ret = 0;

	look_at_sms(sc, before);
	while (!ret && ec_rbuf_left(&at)) {
		struct ec_compiled_sm s = ec_compiled_sm(&at);

		listed |= BIT(s.index);
		ret = begin_sm(sc, s.index, s.dir);
		for (; !ret && s.n_pdos; s.n_pdos--)
			ret = map_pdo(sc, s.index, &at);
	}
	for (sm = 0; !ret && sm < EC_MAX_SM; sm++)
		if (before[sm].any && !(listed & BIT(sm)))
			ret = begin_sm(sc, sm, before[sm].dir);
	return ret;
}

static int register_sm(struct build *b, u32 slave, u8 sm, u16 pdo, ec_domain_t *domain, u64 *at)
{
	unsigned int bit = 0;
	int ret = ecrt_slave_config_reg_pdo_entry_pos(b->slaves[slave], sm, pdo, 0, domain, &bit);

	if (ret < 0)
		return ret;
	b->placed[slave] |= BIT(sm);
	*at = 8ULL * ret + bit;
	return 0;
}

static int add_place(struct build *b, const struct ec_compiled_record *r)
{
	struct place *to = &b->places[b->n_places++];

	to->domain = b->domains[r->domain];
	to->slave = b->slaves[r->slave];
	return register_sm(b, r->slave, r->subindex, r->index, to->domain, &to->bit);
}

/* What only the slave knows is in the domain as well, without names. */
static int add_rest(struct build *b, const struct ec_compiled_record *r)
{
	struct present has[EC_MAX_SM];
	unsigned int sm;
	int ret = 0;
	u64 bit;

	look_at_sms(b->slaves[r->slave], has);
	for (sm = 0; !ret && sm < EC_MAX_SM; sm++)
		if (has[sm].entries && !(b->placed[r->slave] & BIT(sm)))
			ret = register_sm(b, r->slave, sm, has[sm].pdo, b->domains[r->domain],
					  &bit);
	return ret;
}

static int set_names(struct build *b, const struct ec_compiled_record *r)
{
	struct ec_ioc_names names = { .size = r->size, .data = (uintptr_t)r->data };
	int ret = ec_command(b->m, EC_IOC_SET_NAMES, &names);

	/* they are for tools only */
	return ret == -EDQUOT ? 0 : ret;
}

static int set_cycle(struct build *b, u64 ns)
{
	b->to->what.cycle_ns = ns;
	return ecrt_master_set_send_interval(b->m, div_u64(ns + 999, 1000));
}

static int add_value(struct build *b, const struct ec_compiled_record *r)
{
	const struct place *at = &b->places[r->place];
	u64 bit = at->bit + r->bit;
	ec_value_t v = {
		.domain = at->domain, .slave = at->slave, .byte = bit / 8, .bit = bit % 8,
	};

	/* the PDOs of the file are mapped, so this does not happen */
	if (bit + r->bits > 8ULL * ecrt_domain_size(at->domain))
		return ec_fail(b->m, -ERANGE, "find value %s behind byte %zu of its domain",
			       r->name, ecrt_domain_size(at->domain));
	ec_loaded_add(b->to, r, &v);
	return 0;
}

/* a record about one slave */
static int call_slave(struct build *b, const struct ec_compiled_record *r)
{
	ec_slave_config_t *sc = b->slaves[r->slave];

	switch (r->op) {
	case EC_COMPILED_FLAG:
		return ecrt_slave_config_flag(sc, r->name, r->value);
	case EC_COMPILED_SDO:
		return r->complete ?
			ecrt_slave_config_complete_sdo(sc, r->index, r->data, r->size) :
			ecrt_slave_config_sdo(sc, r->index, r->subindex, r->data, r->size);
	case EC_COMPILED_IDN:
		return ecrt_slave_config_idn(sc, r->subindex, r->index, (ec_al_state_t)r->step,
					     r->data, r->size);
	case EC_COMPILED_COMMAND:
		return add_command(sc, r);
	case EC_COMPILED_TIMEOUT:
		return ecrt_slave_config_state_timeout(sc, (ec_al_state_t)r->step,
						       (ec_al_state_t)r->to, r->ms);
	case EC_COMPILED_REPLY:
		return ecrt_slave_config_sdo_timeout(sc, r->ms);
	case EC_COMPILED_DC:
		b->to->what.clocks++;
		return ecrt_slave_config_dc(sc, r->index, r->sync0, r->value, r->sync1, 0);
	case EC_COMPILED_PDOS:
		return map_pdos(sc, r);
	case EC_COMPILED_PLACE:
		return add_place(b, r);
	case EC_COMPILED_REST:
		return add_rest(b, r);
	default:
		return ecrt_master_select_reference_clock(b->m, sc);
	}
}

static int call(struct build *b, const struct ec_compiled_record *r)
{
	switch (r->op) {
	case EC_COMPILED_DOMAIN:
		return add_domain(b);
	case EC_COMPILED_UNIT:
		return add_sync_unit(b, r);
	case EC_COMPILED_DOMAIN_UNIT:
		return ecrt_domain_set_unit(b->domains[r->domain], b->units[r->unit]);
	case EC_COMPILED_SLAVE:
		return add_slave(b, ecrt_master_slave_config(b->m, r->alias, r->position,
							      r->vendor, r->product));
	case EC_COMPILED_GROUP:
		return add_group(b, r);
	case EC_COMPILED_MEMBER:
		return add_slave(b, ecrt_master_group_config(b->m, b->groups[r->group],
							      r->position, r->vendor,
							      r->product));
	case EC_COMPILED_CYCLE:
		return set_cycle(b, r->ns);
	case EC_COMPILED_NAMES:
		return set_names(b, r);
	case EC_COMPILED_VALUE:
		return add_value(b, r);
	default:
		return call_slave(b, r);
	}
}

static int call_all(struct build *b)
{
	struct ec_rbuf at = ec_compiled_begin(&b->c);
	struct ec_compiled_record r;
	u32 i;
	int ret = 0;

	for (i = 0; i < b->c.n_records && !ret; i++) {
		if (!ec_compiled_next(&b->c, &at, &r))
			return -EINVAL;		/* it was valid */
		ret = call(b, &r);
		if (ret)
			ec_fail(b->m, ret, "load the compiled bus: byte %zu: %s", r.at,
				ec_compiled_op_name(r.op));
		cond_resched();
	}
	return ret;
}

static int check_limits(struct build *b)
{
	const struct ec_compiled *c = &b->c;

	if (c->n_domains <= EC_MAX_DOMAINS && c->n_slaves <= EC_MAX_CONFIGS &&
	    c->n_groups <= EC_MAX_GROUPS)
		return 0;
	return ec_fail(b->m, -EINVAL,
		       "load the compiled bus: %u domains, %u slaves, %u groups; limits %u, %u, %u",
		       c->n_domains, c->n_slaves, c->n_groups, EC_MAX_DOMAINS, EC_MAX_CONFIGS,
		       EC_MAX_GROUPS);
}

static int allocate(struct build *b)
{
	const struct ec_compiled *c = &b->c;

	b->domains = kvcalloc(c->n_domains + 1, sizeof(*b->domains), GFP_KERNEL);
	b->slaves = kvcalloc(c->n_slaves + 1, sizeof(*b->slaves), GFP_KERNEL);
	b->placed = kvcalloc(c->n_slaves + 1, sizeof(*b->placed), GFP_KERNEL);
	b->units = kvcalloc(c->n_units + 1, sizeof(*b->units), GFP_KERNEL);
	b->groups = kvcalloc(c->n_groups + 1, sizeof(*b->groups), GFP_KERNEL);
	b->places = kvcalloc(c->n_places + 1, sizeof(*b->places), GFP_KERNEL);
	b->to = ec_loaded_new(c);
	if (!b->domains || !b->slaves || !b->placed || !b->units || !b->groups || !b->places ||
	    !b->to)
		return ec_fail(b->m, -ENOMEM, "load the compiled bus");
	b->to->what.slaves = c->n_slaves;
	b->to->what.values = c->n_values;
	return 0;
}

static void free_all(struct build *b)
{
	kvfree(b->domains);
	kvfree(b->slaves);
	kvfree(b->placed);
	kvfree(b->units);
	kvfree(b->groups);
	kvfree(b->places);
	kvfree(b->to);
}

int ecrt_master_load_compiled(ec_master_t *master, const void *image, size_t size)
{
	struct build b = { .m = master };
	int ret;

	BUILD_BUG_ON(EC_COMPILED_NAMES_MAX != EC_UAPI_NAMES_MAX);
	if (!master || !image)
		return -EINVAL;
	if (!master->api->reserved)
		return ec_fail(master, -EPERM, "load the compiled bus: request the master first");
	if (READ_ONCE(master->api->active) || master->api->loaded)
		return ec_fail(master, -EBUSY,
			       "load the compiled bus: the master is active or has one; release it first");
	ret = ec_compiled_check(&b.c, image, size);
	if (ret)
		return ec_fail(master, ret, "load the compiled bus: byte %zu: %s", b.c.at,
			       b.c.why);
	ret = check_limits(&b) ?: allocate(&b) ?: call_all(&b);
	if (!ret) {
		master->api->loaded = b.to;
		b.to = NULL;
	}
	free_all(&b);
	return ret;
}
EXPORT_SYMBOL_GPL(ecrt_master_load_compiled);
