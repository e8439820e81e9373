// SPDX-License-Identifier: GPL-2.0-only
/* PDOs that the application did not name: those of the slave, or of its startup SDOs. */
#include <linux/err.h>
#include <linux/sched.h>
#include <linux/slab.h>
#include "config.h"
#include "../base/limits.h"
#include "../bus/slave.h"
#include "../bus/slave_pdo.h"

/* values of an object that lists PDOs or entries; those beyond @n count once @n is larger */
struct values {
	u32 v[255];
	unsigned int n;
};

/* Start from the PDOs that the slave has. */
static int slave_defaults(struct ec_config *c, const struct ec_slave *slave)
{
	unsigned int sm;
	int ret = 0;

	lockdep_assert_held(c->wanted->lock);
	down_read(&slave->bus->topo);
	for (sm = 0; sm < slave->n_sms && !ret; sm++) {
		if (c->sm[sm].dir || c->sm[sm].pdos.n)
			continue;
		c->sm[sm].dir = slave->sms[sm].control & EC_SM_DIR_WRITE ?
				EC_CFG_DIR_OUTPUT : EC_CFG_DIR_INPUT;
		ret = ec_pdo_list_copy(&c->sm[sm].pdos, &slave->pdos.sm[sm]);
	}
	up_read(&slave->bus->topo);
	return ret;
}

/* The configuration of the same slave in the session that is to be taken over, or NULL. */
static const struct ec_config *predecessor(const struct ec_config *c)
{
	const struct ec_wanted *w = c->wanted->before;

	lockdep_assert_held(c->wanted->lock);
	if (!w)
		return NULL;
	ec_for_each_config(x, w)
		if (!strcmp(x->name, c->name))
			return x->vendor == c->vendor && x->product == c->product ? x : NULL;
	return NULL;
}

/* Start as that configuration did, whether the slave was connected then, or is now. */
static int inherit_defaults(struct ec_config *c, const struct ec_config *from)
{
	unsigned int sm;
	int ret = 0;

	for (sm = 0; sm < EC_MAX_SM && !ret; sm++) {
		c->sm[sm].dir = from->sm[sm].dir;
		if (!from->sm[sm].explicit)
			ret = ec_pdo_list_copy(&c->sm[sm].pdos, &from->sm[sm].pdos);
	}
	return ret;
}

/**
 * ec_config_begin() - give a new configuration the PDOs that it starts with
 * @c: configuration, attached to its slave if that is connected
 *
 * They are those of the session that is to be taken over, or those that the slave has.
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: 0; -ENOMEM: a part of them is missing, which must not be written to the slave.
 */
int ec_config_begin(struct ec_config *c)
{
	const struct ec_config *before = predecessor(c);
	unsigned int i;
	int ret = 0;

	lockdep_assert_held(c->wanted->lock);
	if (before)
		ret = inherit_defaults(c, before);
	else if (c->slave)
		ret = slave_defaults(c, c->slave);
	if (ret)
		return ret;
	/* as many as slaves have */
	for (i = 0; i < EC_MAX_SM; i++)
		ec_budget_add(&c->wanted->budget, ec_pdo_list_memory(&c->sm[i].pdos));
	return 0;
}

static u32 le(const u8 *data, u32 size)
{
	u8 b[4] = { 0 };

	memcpy(b, data, min_t(u32, size, sizeof(b)));
	return get_unaligned_le32(b);
}

/* One startup SDO; subindex 0 has two bytes in complete access. */
static void config_pdos_follow(struct values *x, const struct ec_startup *u, unsigned int bytes)
{
	unsigned int i = u->sub ? u->sub - 1 : 0;
	u32 at = u->complete && !u->sub ? 2 : 0;

	if (!u->sub)
		x->n = u->data[0];
	if (u->complete)
		for (; i < ARRAY_SIZE(x->v) && at + bytes <= u->size; i++, at += bytes)
			x->v[i] = le(u->data + at, bytes);
	else if (u->sub)
		x->v[i] = le(u->data, u->size);
}

/* The startup SDOs for object @index in their order; false: there is none. */
static bool follow_all(const struct ec_config *c, u16 index, struct values *x, unsigned int bytes)
{
	const struct ec_startup *u;
	bool any = false;

	lockdep_assert_held(c->wanted->lock);
	list_for_each_entry(u, &c->startup, list) {
		if (u->type != EC_STARTUP_SDO || u->index != index)
			continue;
		config_pdos_follow(x, u, bytes);
		any = true;
	}
	cond_resched();
	return any;
}

/* The mapping that the slave has for a PDO, or had in the session to be taken over. */
static int found_entries(const struct ec_config *c, u16 index, struct ec_pdo *p)
{
	const struct ec_config *before = predecessor(c);
	const struct ec_slave *slave = c->slave;
	const struct ec_pdo *known;
	unsigned int sm;
	int ret;

	for (sm = 0; before && sm < EC_MAX_SM; sm++) {
		known = ec_pdo_find(&before->sm[sm].pdos, index);
		if (known)
			return ec_pdo_copy_entries(p, known);
	}
	if (!slave)
		return 0;
	down_read(&slave->bus->topo);
	known = ec_slave_find_pdo(slave, index);
	ret = known ? ec_pdo_copy_entries(p, known) : 0;
	up_read(&slave->bus->topo);
	return ret;
}

/**
 * ec_config_known_entries() - the mapping of a PDO that the application has not given
 * @c: configuration
 * @index: PDO
 * @p: result, entries are appended; initially it has none
 *
 * It is the one that the slave has, as the startup SDOs change it.
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: 0, -ENOMEM.
 */
int ec_config_known_entries(const struct ec_config *c, u16 index, struct ec_pdo *p)
{
	struct values *x = kzalloc(sizeof(*x), GFP_KERNEL);
	int ret = x ? found_entries(c, index, p) : -ENOMEM;
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	if (ret)
		goto out;
	for (i = 0; i < p->n_entries; i++)
		x->v[i] = ec_pdo_entry_value(&p->entries[i]);
	x->n = p->n_entries;
	if (!follow_all(c, index, x, 4))
		goto out;
	ec_pdo_clear_entries(p);
	for (i = 0; i < x->n && !ret; i++) {
		const struct ec_pdo_entry e = {
			.index = x->v[i] >> 16, .sub = x->v[i] >> 8, .bits = x->v[i],
		};

		ret = ec_pdo_add_entry(p, &e);
	}
out:
	kfree(x);
	return ret;
}

/* What the application has not named: the numbers of the PDOs of a SyncManager. */
static void found_assignment(const struct ec_config *c, unsigned int sm, struct values *x)
{
	const struct ec_config *before = predecessor(c);
	const struct ec_pdo_list *l = NULL;
	unsigned int i;

	if (before && !before->sm[sm].explicit)
		l = &before->sm[sm].pdos;
	else if (!before && c->slave)
		l = &c->slave->pdos.sm[sm];
	if (!l)
		return;
	x->n = min_t(unsigned int, l->n, ARRAY_SIZE(x->v));
	for (i = 0; i < x->n; i++)
		x->v[i] = l->pdos[i].index;
}

/* The PDOs that a SyncManager has after the startup SDOs. */
static int made_pdos(const struct ec_config *c, unsigned int sm, struct ec_pdo_list *l)
{
	struct values *x = kzalloc(sizeof(*x), GFP_KERNEL);
	int ret = x ? 0 : -ENOMEM;
	unsigned int i;

	if (ret)
		return ret;
	if (c->slave)
		down_read(&c->slave->bus->topo);
	found_assignment(c, sm, x);
	if (c->slave)
		up_read(&c->slave->bus->topo);
	follow_all(c, EC_PDO_ASSIGN + sm, x, 2);
	for (i = 0; i < x->n && !ret; i++) {
		struct ec_pdo *p = x->v[i] ? ec_pdo_add(l, x->v[i], 0) : NULL;

		if (p)
			ret = ec_config_known_entries(c, p->index, p);
		else if (x->v[i])
			ret = -ENOMEM;
	}
	kfree(x);
	if (!ret && c->slave)
		ec_slave_name_pdos(c->slave, l);
	return ret;
}

/* Did the application name them itself, or have they their place in a domain? */
static bool is_settled(const struct ec_config *c, unsigned int sm)
{
	unsigned int i;

	for (i = 0; i < c->n_fmmus; i++)
		if (c->fmmus[i].sm == sm)
			return true;
	return c->sm[sm].explicit;
}

static int follow_sm(struct ec_config *c, unsigned int sm)
{
	struct ec_config_sm *has = &c->sm[sm];
	struct ec_pdo_list l = { 0 };
	int ret = made_pdos(c, sm, &l);

	if (!ret)
		ret = ec_budget_charge(&c->wanted->budget, ec_pdo_list_memory(&l));
	if (ret) {
		ec_pdo_list_clear(&l);
		return ret;
	}
	ec_budget_release(&c->wanted->budget, ec_pdo_list_memory(&has->pdos));
	ec_pdo_list_clear(&has->pdos);
	has->pdos = l;
	if (!has->dir && l.n)
		has->dir = ec_pdo_is_output(l.pdos[0].index) ? EC_CFG_DIR_OUTPUT :
							       EC_CFG_DIR_INPUT;
	return 0;
}

/**
 * ec_config_follow_sdo() - PDOs as a new startup SDO leaves them
 * @c: configuration that has the SDO already
 * @index: object of the SDO
 *
 * So entries can be registered that the startup SDOs make. PDOs that the application has named,
 * or some of whose entries are registered, stay: the slave is compared with them.
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: 0, -ENOMEM, -EDQUOT as ec_budget_charge().
 */
int ec_config_follow_sdo(struct ec_config *c, u16 index)
{
	unsigned int sm;
	int ret = 0;

	lockdep_assert_held(c->wanted->lock);
	if (!ec_pdo_is_assign(index) && !ec_pdo_is_mapping(index))
		return 0;
	for (sm = 0; sm < EC_MAX_SM && !ret; sm++)
		if (!is_settled(c, sm) && (index == EC_PDO_ASSIGN + sm ||
					   ec_pdo_find(&c->sm[sm].pdos, index)))
			ret = follow_sm(c, sm);
	return ret;
}
