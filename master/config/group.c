// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ctype.h>
#include <linux/err.h>
#include <linux/nospec.h>
#include <linux/slab.h>
#include "../base/grow.h"
#include "../base/limits.h"
#include "config.h"
#include "group.h"

static bool group_is_same(const struct ec_group *g, const struct ec_ioc_group *what)
{
	u32 at = g->at ? g->at->index : EC_UAPI_NONE32;

	return g->by == what->by && g->value == what->value && at == what->at &&
	       g->port == what->port && g->mandatory == !!(what->flags & EC_GROUP_FLAG_MANDATORY) &&
	       g->fast == !!(what->flags & EC_GROUP_FLAG_FAST);
}

/* Is the head of this group known by the same? */
static bool has_sign_of(const struct ec_group *g, const struct ec_ioc_group *what)
{
	u32 at = g->at ? g->at->index : EC_UAPI_NONE32;

	if (g->by != what->by)
		return false;
	return what->by == EC_GROUP_BY_PORT ? at == what->at && g->port == what->port :
					      g->value == what->value;
}

/**
 * ec_group_is_name() - may a group or unit have this name?
 * @name: EC_UAPI_STRING bytes
 *
 * Names are for messages and files: letters first, so that they are no numbers.
 *
 * Context: Any.
 * Return: true: a letter, then letters, digits, '_', '-', '.', and a zero.
 */
bool ec_group_is_name(const char *name)
{
	size_t len = strnlen(name, EC_UAPI_STRING), i;

	if (!len || len == EC_UAPI_STRING || !isalpha(name[0]))
		return false;
	for (i = 1; i < len; i++)
		if (!isalnum(name[i]) && name[i] != '_' && name[i] != '-' && name[i] != '.')
			return false;
	return true;
}

static bool is_possible(const struct ec_wanted *w, const struct ec_ioc_group *what)
{
	if (what->at != EC_UAPI_NONE32 && (what->at >= w->n_configs || what->port >= EC_MAX_PORT ||
					   !what->port))
		return false;
	if (what->at == EC_UAPI_NONE32 && (what->port || what->flags & EC_GROUP_FLAG_FAST))
		return false;
	if (what->by == EC_GROUP_BY_PORT)
		return what->at != EC_UAPI_NONE32 && !what->value;
	return (what->by == EC_GROUP_BY_ALIAS || what->by == EC_GROUP_BY_ID) && what->value;
}

/**
 * ec_group_create() - find or make a hot connect group
 * @w: what an application configures
 * @what: from the application; its name has a zero at the end
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: group, or ERR_PTR: -EINVAL no name, or neither alias, identification nor port; -EEXIST
 * another group has the name or is known by the same; -ENOSPC beyond EC_MAX_GROUPS; -ENOMEM;
 * -EDQUOT as ec_budget_charge().
 */
struct ec_group *ec_group_create(struct ec_wanted *w, const struct ec_ioc_group *what)
{
	struct ec_group *g;
	int ret;

	lockdep_assert_held(w->lock);
	if (!ec_group_is_name(what->name) || !is_possible(w, what))
		return ERR_PTR(-EINVAL);
	ec_for_each_group(x, w) {
		if (!strcmp(x->name, what->name))
			return group_is_same(x, what) ? x : ERR_PTR(-EEXIST);
		if (has_sign_of(x, what))
			return ERR_PTR(-EEXIST);
	}
	if (w->n_groups >= EC_MAX_GROUPS)
		return ERR_PTR(-ENOSPC);
	ret = ec_budget_charge(&w->budget, sizeof(*g));
	if (ret)
		return ERR_PTR(ret);
	g = kzalloc(sizeof(*g), GFP_KERNEL_ACCOUNT);
	if (!g) {
		ec_budget_release(&w->budget, sizeof(*g));
		return ERR_PTR(-ENOMEM);
	}
	*g = (struct ec_group){
		.wanted = w, .index = w->n_groups, .by = what->by, .value = what->value,
		.at = what->at == EC_UAPI_NONE32 ? NULL :
		      w->configs[array_index_nospec(what->at, w->n_configs)],
		.port = what->port,
		.mandatory = what->flags & EC_GROUP_FLAG_MANDATORY,
		.fast = what->flags & EC_GROUP_FLAG_FAST, .cause = EC_CAUSE_NO_GROUP,
	};
	strscpy(g->name, what->name, sizeof(g->name));
	w->groups[w->n_groups++] = g;
	return g;
}

/**
 * ec_group_free() - free a group
 * @g: group whose members are freed
 *
 * Context: Process.
 */
void ec_group_free(struct ec_group *g)
{
	kvfree(g->members);
	kfree(g);
}

/**
 * ec_group_config() - find or make the configuration of a member
 * @g: group
 * @member: 0: the head, then in the order of the ring
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process, lock of the session held. May sleep.
 * Return: configuration, or ERR_PTR: -ENOENT it exists with another identity; -EINVAL the member
 * before it has none; -ENOMEM; or as ec_config_create().
 */
struct ec_config *ec_group_config(struct ec_group *g, u16 member, u32 vendor, u32 product)
{
	struct ec_config *c, **p;

	lockdep_assert_held(g->wanted->lock);
	if (member < g->n_members) {
		c = g->members[array_index_nospec(member, g->n_members)];
		return c->vendor == vendor && c->product == product ? c : ERR_PTR(-ENOENT);
	}
	if (member > g->n_members)
		return ERR_PTR(-EINVAL);
	p = ec_grow(g->members, g->n_members, sizeof(*p));
	if (!p)
		return ERR_PTR(-ENOMEM);
	g->members = p;
	c = ec_config_create(g->wanted, 0, member, vendor, product);
	if (IS_ERR(c))
		return c;
	c->group = g;
	scnprintf(c->name, sizeof(c->name), "%s:%u", g->name, member);
	p[g->n_members++] = c;
	return c;
}

/**
 * ec_group_drop() - remove the member that was added last
 * @c: its configuration
 *
 * ec_config_drop() follows.
 *
 * Context: Process, lock of the session held.
 */
void ec_group_drop(struct ec_config *c)
{
	lockdep_assert_held(c->wanted->lock);
	c->group->n_members--;
}

/**
 * ec_groups_wait() - is a group connected that is not used because of one of its slaves?
 * @w: what an application configures
 *
 * The slave may leave BOOT, or a host may come, without another slave in the list.
 *
 * Context: Process, lock of the session held.
 * Return: whether there is one.
 */
bool ec_groups_wait(const struct ec_wanted *w)
{
	lockdep_assert_held(w->lock);
	ec_for_each_group(g, w)
		if (g->cause == EC_CAUSE_GROUP)
			return true;
	return false;
}

/**
 * ec_group_differs() - are groups of two sessions not the same?
 * @a: one
 * @b: the other
 *
 * Context: Process, lock of the sessions held.
 * Return: whether they differ.
 */
bool ec_group_differs(const struct ec_group *a, const struct ec_group *b)
{
	const struct ec_ioc_group what = {
		.by = b->by, .value = b->value, .port = b->port,
		.at = b->at ? b->at->index : EC_UAPI_NONE32,
		.flags = (b->mandatory ? EC_GROUP_FLAG_MANDATORY : 0) |
			 (b->fast ? EC_GROUP_FLAG_FAST : 0),
	};

	lockdep_assert_held(a->wanted->lock);
	return strcmp(a->name, b->name) || a->n_members != b->n_members || !group_is_same(a, &what);
}
