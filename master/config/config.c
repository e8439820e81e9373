// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include <linux/vmalloc.h>
#include "config.h"
#include "domain.h"
#include "../base/grow.h"
#include "../base/limits.h"
#include "../bus/slave.h"

/**
 * ec_config_find() - the configuration of a slave
 * @w: what an application configures
 * @alias: alias or 0
 * @position: position
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process, lock of the session held.
 * Return: configuration; NULL when there is none; ERR_PTR(-ENOENT) when it exists with
 * another identity.
 */
struct ec_config *ec_config_find(const struct ec_wanted *w, u16 alias, u16 position, u32 vendor,
				 u32 product)
{
	lockdep_assert_held(w->lock);
	ec_for_each_config(c, w) {
		if (!c->group && c->alias == alias && c->position == position)
			return c->vendor == vendor && c->product == product ? c : ERR_PTR(-ENOENT);
	}
	return NULL;
}

/**
 * ec_config_create() - make a configuration
 * @w: what an application configures
 * @alias: alias or 0
 * @position: position
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: configuration, or ERR_PTR: -ENOMEM, -ENOSPC beyond EC_MAX_CONFIGS, -EDQUOT as
 * ec_budget_charge().
 */
struct ec_config *ec_config_create(struct ec_wanted *w, u16 alias, u16 position, u32 vendor,
				   u32 product)
{
	struct ec_config *c, **p;
	int ret;

	lockdep_assert_held(w->lock);
	if (w->n_configs >= EC_MAX_CONFIGS)
		return ERR_PTR(-ENOSPC);
	ret = ec_budget_charge(&w->budget, sizeof(*c) + sizeof(*p));
	if (ret)
		return ERR_PTR(ret);
	p = ec_grow(w->configs, w->n_configs, sizeof(*p));
	if (p)
		w->configs = p;
	c = p ? kzalloc(sizeof(*c), GFP_KERNEL_ACCOUNT) : NULL;
	if (!c) {
		ec_budget_release(&w->budget, sizeof(*c) + sizeof(*p));
		return ERR_PTR(-ENOMEM);
	}
	c->wanted = w;
	c->index = w->n_configs;
	c->alias = alias;
	c->position = position;
	c->vendor = vendor;
	c->product = product;
	scnprintf(c->name, sizeof(c->name), "%u:%u", alias, position);
	INIT_LIST_HEAD(&c->startup);
	INIT_LIST_HEAD(&c->flags);
	INIT_LIST_HEAD(&c->replay.writes);
	w->configs[w->n_configs++] = c;
	return c;
}

/**
 * ec_config_drop() - remove the configuration that was added last
 * @c: configuration that could not begin, detached from its slave
 *
 * Context: Process, lock of the session held. May sleep.
 */
void ec_config_drop(struct ec_config *c)
{
	struct ec_wanted *w = c->wanted;

	lockdep_assert_held(w->lock);
	w->n_configs--;
	ec_budget_release(&w->budget, sizeof(*c) + sizeof(*w->configs));
	ec_config_free(c);
}

void ec_config_free(struct ec_config *c)
{
	struct ec_config_flag *flag, *next;
	struct ec_startup *u, *after;
	unsigned int i;

	for (i = 0; i < EC_MAX_SM; i++)
		ec_pdo_list_clear(&c->sm[i].pdos);
	list_splice(&c->replay.writes, &c->startup);
	list_for_each_entry_safe(u, after, &c->startup, list)
		kvfree(u);
	list_for_each_entry_safe(flag, next, &c->flags, list)
		kvfree(flag);
	kfree(c);
}

int ec_config_sync(struct ec_config *c, u8 sm, u8 dir, u8 watchdog)
{
	lockdep_assert_held(c->wanted->lock);
	if (sm >= EC_MAX_SM)
		return -ENOENT;
	if ((dir != EC_CFG_DIR_OUTPUT && dir != EC_CFG_DIR_INPUT) || watchdog > EC_CFG_WD_DISABLE)
		return -EINVAL;
	c->sm[sm].dir = dir;
	c->sm[sm].watchdog = watchdog;
	return 0;
}

int ec_config_assign_add(struct ec_config *c, u8 sm, u16 pdo)
{
	struct ec_pdo *p;
	int ret;

	lockdep_assert_held(c->wanted->lock);
	if (sm >= EC_MAX_SM)
		return -EINVAL;
	if (c->sm[sm].pdos.n >= EC_MAX_SC_PDOS)
		return -ENOSPC;
	ret = ec_budget_charge(&c->wanted->budget, sizeof(*p));
	if (ret)
		return ret;
	p = ec_pdo_add(&c->sm[sm].pdos, pdo, 0);
	if (!p) {
		ec_budget_release(&c->wanted->budget, sizeof(*p));
		return -ENOMEM;
	}
	c->sm[sm].explicit = true;
	ret = ec_config_known_entries(c, pdo, p);
	ec_budget_add(&c->wanted->budget, p->n_entries * sizeof(*p->entries));
	return ret;
}

int ec_config_assign_clear(struct ec_config *c, u8 sm)
{
	lockdep_assert_held(c->wanted->lock);
	if (sm >= EC_MAX_SM)
		return -EINVAL;
	ec_budget_release(&c->wanted->budget, ec_pdo_list_memory(&c->sm[sm].pdos));
	ec_pdo_list_clear(&c->sm[sm].pdos);
	c->sm[sm].explicit = true;
	return 0;
}

static struct ec_pdo *config_find(struct ec_config *c, u16 pdo)
{
	unsigned int i;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; i < EC_MAX_SM; i++) {
		struct ec_pdo *p = ec_pdo_find(&c->sm[i].pdos, pdo);

		if (p) {
			c->sm[i].explicit = true;
			return p;
		}
	}
	return NULL;
}

int ec_config_map_add(struct ec_config *c, u16 pdo, const struct ec_pdo_entry *e)
{
	struct ec_pdo *p = config_find(c, pdo);
	int ret = p ? ec_budget_charge(&c->wanted->budget, sizeof(*e)) : -ENOENT;

	if (ret)
		return ret;
	ret = ec_pdo_add_entry(p, e);
	if (ret)
		ec_budget_release(&c->wanted->budget, sizeof(*e));
	return ret;
}

int ec_config_map_clear(struct ec_config *c, u16 pdo)
{
	struct ec_pdo *p = config_find(c, pdo);

	if (p) {
		ec_budget_release(&c->wanted->budget, p->n_entries * sizeof(*p->entries));
		ec_pdo_clear_entries(p);
	} else {
		ec_warn(c->wanted, "slave %s: PDO 0x%04x is not assigned, nothing to clear\n",
			c->name, pdo);
	}
	return 0;
}

/**
 * ec_config_alloc() - allocate memory for a part of a configuration, and charge for it
 * @w: what an application configures
 * @size: bytes
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: zeroed memory for kvfree(); ERR_PTR: -ENOMEM, -EDQUOT as ec_budget_charge().
 */
void *ec_config_alloc(struct ec_wanted *w, size_t size)
{
	int ret = ec_budget_charge(&w->budget, size);
	void *p;

	lockdep_assert_held(w->lock);
	if (ret)
		return ERR_PTR(ret);
	/*
	 * A value may be large. kmalloc() would take contiguous pages for it, and up to twice as
	 * many as the session is charged.
	 */
	p = size <= PAGE_SIZE ? kzalloc(size, GFP_KERNEL_ACCOUNT) :
	    __vmalloc(size, GFP_KERNEL_ACCOUNT | __GFP_ZERO | __GFP_NOWARN);
	if (p)
		return p;
	ec_budget_release(&w->budget, size);
	return ERR_PTR(-ENOMEM);
}

int ec_config_sdo_add(struct ec_config *c, u16 index, u8 sub, bool complete, const u8 *data,
		      u32 size)
{
	const struct ec_startup u = {
		.type = EC_STARTUP_SDO, .transition = EC_TRANSITION_PS, .index = index,
		.sub = sub, .complete = complete, .size = size,
	};
	struct ec_startup *added = ec_startup_add(c, &u, data);
	int ret;

	lockdep_assert_held(c->wanted->lock);
	if (IS_ERR(added))
		return PTR_ERR(added);
	ret = ec_config_follow_sdo(c, index);
	if (ret)
		ec_startup_del(c, added);
	else if (c->slave && !(c->slave->info.protocols & EC_SII_PROTO_COE))
		ec_slave_warn(c->slave, "has no CoE; the startup SDO 0x%04x:%02x will fail\n",
			      index, sub);
	return ret;
}

/* @drive is below EC_SOE_DRIVES, @state is PREOP or SAFEOP */
int ec_config_idn_add(struct ec_config *c, u8 drive, u16 idn, u8 state, const u8 *data, u32 size)
{
	const struct ec_startup u = {
		.type = EC_STARTUP_IDN, .index = idn, .sub = drive, .size = size,
		.transition = state == EC_AL_PREOP ? EC_TRANSITION_PS : EC_TRANSITION_SO,
	};

	return PTR_ERR_OR_ZERO(ec_startup_add(c, &u, data));
}

/**
 * ec_config_reg() - configure a write of a register of 16 bits
 * @c: configuration
 * @reg: register
 * @value: replaces an earlier value; 0: the register is not written
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: 0, or as ec_startup_add().
 */
int ec_config_reg(struct ec_config *c, u16 reg, u16 value)
{
	const struct ec_startup what = {
		.type = EC_STARTUP_REG, .transition = EC_TRANSITION_PS, .index = reg, .size = 2,
	};
	struct ec_startup *u = ec_startup_find(c, EC_STARTUP_REG, reg);
	u8 data[2];

	lockdep_assert_held(c->wanted->lock);
	put_unaligned_le16(value, data);
	if (u && !value)
		ec_startup_del(c, u);
	else if (u)
		memcpy(u->data, data, sizeof(data));
	else if (value)
		u = ec_startup_add(c, &what, data);
	return PTR_ERR_OR_ZERO(u);
}

/* @key is shorter than EC_UAPI_STRING; a later value replaces an earlier one */
int ec_config_flag_set(struct ec_config *c, const char *key, s32 value)
{
	struct ec_config_flag *flag;

	lockdep_assert_held(c->wanted->lock);
	list_for_each_entry(flag, &c->flags, list) {
		if (strcmp(flag->key, key))
			continue;
		flag->value = value;
		return 0;
	}
	if (c->n_flags >= EC_MAX_SC_FLAGS)
		return -ENOSPC;
	flag = ec_config_alloc(c->wanted, sizeof(*flag));
	if (IS_ERR(flag))
		return PTR_ERR(flag);
	strscpy(flag->key, key, sizeof(flag->key));
	/* the EEPROM is the slave's from PREOP on anyway */
	if (strcmp(key, EC_FLAG_WAIT_SAFEOP) && strcmp(key, EC_FLAG_ANY_PDOS) &&
	    strcmp(key, EC_FLAG_REVISION) && strcmp(key, EC_FLAG_SERIAL) &&
	    strcmp(key, EC_FLAG_REPEAT) && strcmp(key, EC_FLAG_HOLD) &&
	    strcmp(key, EC_FLAG_NO_FRMW) && strcmp(key, "AssignToPdi"))
		ec_info(c->wanted, "slave %s: flag %s has no effect\n", c->name, key);
	flag->value = value;
	list_add_tail(&flag->list, &c->flags);
	c->n_flags++;
	return 0;
}

/**
 * ec_config_ip() - IP parameters to be written by EoE
 * @c: configuration
 * @p: parameters; those not in @which stay unchanged
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0, or as ec_startup_add().
 */
int ec_config_ip(struct ec_config *c, const struct ec_eoe_ip *p)
{
	static const struct ec_eoe_ip none;
	const struct ec_startup what = {
		.type = EC_STARTUP_IP, .transition = EC_TRANSITION_PS, .size = sizeof(*p),
	};
	struct ec_startup *u = ec_startup_find(c, EC_STARTUP_IP, 0) ?:
			       ec_startup_add(c, &what, &none);
	struct ec_eoe_ip *ip;

	lockdep_assert_held(c->wanted->lock);
	if (IS_ERR(u))
		return PTR_ERR(u);
	ip = (struct ec_eoe_ip *)u->data;
	if (p->which & EC_EOE_MAC)
		memcpy(ip->mac, p->mac, sizeof(ip->mac));
	if (p->which & EC_EOE_IP)
		memcpy(ip->ip, p->ip, sizeof(ip->ip));
	if (p->which & EC_EOE_MASK)
		memcpy(ip->mask, p->mask, sizeof(ip->mask));
	if (p->which & EC_EOE_GATEWAY)
		memcpy(ip->gateway, p->gateway, sizeof(ip->gateway));
	if (p->which & EC_EOE_DNS)
		memcpy(ip->dns, p->dns, sizeof(ip->dns));
	if (p->which & EC_EOE_HOSTNAME)
		memcpy(ip->name, p->name, sizeof(ip->name));
	ip->which |= p->which;
	return 0;
}

/**
 * ec_config_flag() - value of a flag
 * @c: configuration
 * @key: its name
 *
 * Context: The slave's worker, or as ec_config_status().
 * Return: value; 0 when it was not set.
 */
s32 ec_config_flag(const struct ec_config *c, const char *key)
{
	const struct ec_config_flag *flag;

	list_for_each_entry(flag, &c->flags, list)
		if (!strcmp(flag->key, key))
			return flag->value;
	return 0;
}

/**
 * ec_config_changed() - is what a SyncManager has in a domain still what it has?
 * @c: configuration
 * @f: one of its FMMUs
 *
 * The application has the offsets, so the layout of registered entries must not change.
 *
 * Context: Process, lock of the configuration held.
 * Return: true: bytes or direction were changed after the first entry was
 * registered.
 */
bool ec_config_changed(const struct ec_config *c, const struct ec_config_fmmu *f)
{
	const struct ec_config_sm *sm = &c->sm[f->sm];

	ec_wanted_assert_stays(c->wanted);
	return sm->dir != f->dir || ec_pdo_list_bytes(&sm->pdos) != f->size;
}

/* The mapping of @sm in @d; the first call adds it. */
static struct ec_config_fmmu *map_sm(struct ec_config *c, u8 sm, struct ec_domain *d)
{
	struct ec_config_fmmu *f;
	unsigned int i;
	int ret;

	lockdep_assert_held(c->wanted->lock);
	for (i = 0; i < c->n_fmmus; i++)
		if (c->fmmus[i].domain == d && c->fmmus[i].sm == sm)
			return &c->fmmus[i];
	if (!c->sm[sm].dir)
		return ERR_PTR(-EINVAL);
	if (c->n_fmmus >= EC_MAX_FMMU ||
	    ec_pdo_list_bytes(&c->sm[sm].pdos) > EC_MAX_SM_BYTES)
		return ERR_PTR(-EOVERFLOW);
	f = &c->fmmus[c->n_fmmus];
	f->domain = d;
	f->sm = sm;
	f->dir = c->sm[sm].dir;
	f->size = ec_pdo_list_bytes(&c->sm[sm].pdos);
	f->offset = d->size;
	f->logical = d->size;
	ret = ec_domain_add(d, c, c->n_fmmus);
	if (ret)
		return ERR_PTR(ret);
	d->size += f->size;
	c->n_fmmus++;
	return f;
}

/**
 * ec_config_reg_entry() - put the SyncManager with an entry into a domain
 * @c: configuration
 * @index: object
 * @sub: subindex
 * @d: domain
 * @offset: result: byte in the domain
 * @bit: result: bit in that byte; NULL: the entry must be byte-aligned
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENOENT when the entry is not mapped; -EINVAL when its SyncManager
 * has no direction; -EOVERFLOW when all FMMUs are used or SyncManager or domain
 * are too large; -EBUSY as ec_config_changed(); -EFAULT the entry is not byte-aligned
 * and @bit is NULL; -ENOMEM.
 */
int ec_config_reg_entry(struct ec_config *c, u16 index, u8 sub, struct ec_domain *d,
			u32 *offset, u32 *bit)
{
	unsigned int sm, p, e;

	lockdep_assert_held(c->wanted->lock);
	for (sm = 0; sm < EC_MAX_SM; sm++)
		for (p = 0; p < c->sm[sm].pdos.n; p++) {
			const struct ec_pdo *pdo = &c->sm[sm].pdos.pdos[p];

			for (e = 0; e < pdo->n_entries; e++)
				if (pdo->entries[e].index == index && pdo->entries[e].sub == sub)
					return ec_config_reg_entry_pos(c, sm, p, e, d, offset, bit);
		}
	return -ENOENT;
}

/**
 * ec_config_reg_entry_pos() - the same, by SyncManager, PDO and entry position
 * @c: configuration
 * @sm: SyncManager
 * @pdo_pos: PDO in it
 * @entry_pos: entry in that
 * @d: domain
 * @offset: result
 * @bit: result
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: as ec_config_reg_entry(), -EINVAL for a wrong @sm.
 */
int ec_config_reg_entry_pos(struct ec_config *c, u8 sm, u32 pdo_pos, u32 entry_pos,
			    struct ec_domain *d, u32 *offset, u32 *bit)
{
	const struct ec_pdo_list *l;
	struct ec_config_fmmu *f;
	u32 i, bits = 0;

	lockdep_assert_held(c->wanted->lock);
	if (sm >= EC_MAX_SM)
		return -EINVAL;
	l = &c->sm[sm].pdos;
	if (pdo_pos >= l->n || entry_pos >= l->pdos[pdo_pos].n_entries)
		return -ENOENT;
	for (i = 0; i < pdo_pos; i++)
		bits += ec_pdo_bits(&l->pdos[i]);
	for (i = 0; i < entry_pos; i++)
		bits += l->pdos[pdo_pos].entries[i].bits;
	/* first, so that nothing is left behind */
	if (!bit && bits % 8)
		return -EFAULT;
	f = map_sm(c, sm, d);
	if (IS_ERR(f))
		return PTR_ERR(f);
	if (ec_config_changed(c, f))
		return -EBUSY;
	l->pdos[pdo_pos].entries[entry_pos].registered = true;
	*offset = f->offset + bits / 8;
	if (bit)
		*bit = bits % 8;
	return 0;
}
