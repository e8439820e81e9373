// SPDX-License-Identifier: GPL-2.0-only
/*
 * Which slaves belong to which hot connect group. The head is what has its alias or
 * identification, or what is at its port. What hangs behind the head belongs to it as well.
 *
 * In a ring all slaves up to the other end hang behind each other. There a group has as many
 * slaves as members, and those behind them are of the group, or of none, before its head. In an
 * open ring the slave behind the break hangs nowhere: what it is attached to says to which group
 * it belongs, or, if no slave is missing, the slave before the break. Otherwise positions behind
 * the break are not certain as long as it looks like a member of a group without head.
 */
#include "../bus/graph.h"
#include "../bus/ring_place.h"
#include "../bus/slave.h"
#include "../link/links.h"
#include "config.h"
#include "group.h"

/* The slave before the break of an open ring, of whose place nothing is lost; NULL: not known. */
static struct ec_slave *before_break(const struct ec_bus *bus)
{
	u32 at = bus->break_at[0];

	return bus->places.open && at < bus->places.front && at < bus->n_slaves ? bus->slaves[at] :
	       NULL;
}

static bool hangs_nowhere(const struct ec_slave *s)
{
	const struct ec_ring_places *p = &s->bus->places;

	return p->open && s->position == p->front && !ec_graph_parent(s);
}

/* May slaves be missing where the ring is open? */
static bool may_miss(const struct ec_bus *bus)
{
	return bus->places.open && !ec_ring_places_cut(bus);
}

/**
 * ec_group_neighbor() - the slave at a port, also if that is where a ring is open
 * @s: slave of the list
 * @port: its port
 *
 * Context: Process, topo held.
 * Return: slave, or NULL: there is none, or it is not certain.
 */
struct ec_slave *ec_group_neighbor(const struct ec_slave *s, unsigned int port)
{
	struct ec_bus *bus = s->bus;

	lockdep_assert_held(&bus->topo);
	if (s->graph.at[port] || s != before_break(bus) || port != bus->break_at[1] ||
	    bus->places.front >= bus->n_slaves || may_miss(bus))
		return s->graph.at[port];
	return bus->slaves[bus->places.front];
}

/* Before an activation a slave may be attached in an open ring whose position is not certain. */
static bool is_kept(const struct ec_wanted *w)
{
	return w->active || !w->bus->places.open;
}

/*
 * The slave at whose port a group is known: that of its configuration, or the one which this means.
 * It is found in the pass that marks, before the slaves behind it.
 */
static void begin_group(struct ec_group *g)
{
	g->seen = 0;
	g->begun = false;
	g->outer = NULL;
	g->host = g->at && is_kept(g->wanted) ? g->at->slave : NULL;
	g->left = g->at ? g->at->position : 0;
	g->counts = g->at && !g->at->alias;
}

static bool is_what_it_expects(const struct ec_config *c, const struct ec_slave *s)
{
	return s->info.vendor == c->vendor && s->info.product == c->product;
}

/* Is @s, a slave of no group, at the place of the host? */
static bool is_at_place(struct ec_group *g, const struct ec_slave *s)
{
	g->counts |= s->alias == g->at->alias;
	return g->counts && !g->left--;
}

/* Does its place in the list not say which slave it is? Then only its alias does. */
static bool is_shifted(const struct ec_group *g, const struct ec_slave *s)
{
	return s->position >= s->bus->places.front && may_miss(s->bus) &&
	       !(g->at->alias && s->alias == g->at->alias && !g->at->position);
}

/* Is @s the host of @g? It was marked. */
static void look_for_host(struct ec_group *g, const struct ec_slave *s)
{
	const struct ec_config *at = g->at;
	u8 mark = ec_setup_of(s)->group;
	bool found;

	if (!at || g->host)
		return;
	if (at->group)
		found = mark == at->group->index + 1 && at->group->seen == at->position + 1u;
	else
		found = !mark && is_at_place(g, s) && !is_shifted(g, s);
	if (found && is_what_it_expects(at, s))
		g->host = s;
}

/* Is @s behind the break, and attached to the head of @g? */
static bool is_attached_head(const struct ec_group *g, const struct ec_slave *s)
{
	return g->wanted->active && g->n_members && hangs_nowhere(s) &&
	       ec_config_of(s) == g->members[0];
}

/* Is @s a head of @g, whether it may be used or not? */
static bool is_head(const struct ec_group *g, const struct ec_slave *s)
{
	switch (g->by) {
	case EC_GROUP_BY_ALIAS:
		return s->alias == g->value;
	case EC_GROUP_BY_ID:
		return s->identification == g->value;
	default:
		return is_attached_head(g, s) ||
		       (g->host && ec_group_neighbor(g->host, g->port) == s);
	}
}

/* The group of which @s is a head. Alias and identification count more than its port. */
static struct ec_group *headed_by(const struct ec_wanted *w, const struct ec_slave *s)
{
	struct ec_group *at_port = NULL;

	ec_for_each_group(g, w) {
		if (!is_head(g, s))
			continue;
		if (g->by != EC_GROUP_BY_PORT)
			return g;
		at_port = g;
	}
	return at_port;
}

/* The slaves between the ends of a ring; of an open one up to the break. */
static void mark_path(const struct ec_bus *bus)
{
	const struct ec_slave *end[2] = { before_break(bus), NULL };
	unsigned int i;

	ec_for_each_slave(s, bus) {
		ec_setup_of(s)->in_path = false;
		if (ec_graph_free_port(s) >= 0)
			end[1] = s;
	}
	for (i = 0; i < ARRAY_SIZE(end) && !bus->links->only; i++)
		for (; end[i]; end[i] = ec_graph_parent(end[i]))
			ec_setup_of(end[i])->in_path = true;
}

static struct ec_group *group_of(const struct ec_wanted *w, const struct ec_slave *s)
{
	u8 mark = ec_setup_of(s)->group;

	return mark ? w->groups[mark - 1] : NULL;
}

/* Are the slaves from @s on what the last members of @g are, its head not being one of them? */
static bool looks_like_rest(const struct ec_group *g, const struct ec_slave *s)
{
	const struct ec_bus *bus = s->bus;
	unsigned int from, k;

	for (from = g->by == EC_GROUP_BY_PORT ? 0 : 1; from < g->n_members; from++) {
		for (k = from; k < g->n_members; k++) {
			unsigned int i = s->position + k - from;

			if (i >= bus->n_slaves ||
			    !is_what_it_expects(g->members[k], bus->slaves[i]))
				break;
		}
		if (k == g->n_members)
			return true;
	}
	return false;
}

/* Is its head connected, and behind the break as well if it was not passed so far? */
static bool has_head(const struct ec_group *g)
{
	if (g->begun)
		return g->seen >= g->n_members;
	if (g->by == EC_GROUP_BY_PORT)
		return g->host && g->host != before_break(g->wanted->bus);
	ec_for_each_slave(s, g->wanted->bus)
		if (is_head(g, s))
			return true;
	return false;
}

/* A slave behind the break that runs stays what it is. */
static bool is_attached(const struct ec_wanted *w, const struct ec_slave *s)
{
	const struct ec_config *c = ec_config_of(s);

	return w->active && w->bus->places.open && s->position >= w->bus->places.front &&
	       ec_setup_of(s)->in_path && c && c->wanted == w;
}

/* The group of an attached slave, if it is not its head: around that is none. */
static struct ec_group *attached_group(const struct ec_slave *s)
{
	const struct ec_config *c = ec_config_of(s);

	if (!c->group || !c->position)
		return NULL;
	c->group->seen = c->position;
	c->group->begun = true;
	return c->group;
}

/* The group of the first slave behind a break; @head: it is a head. */
static struct ec_group *behind_break(struct ec_wanted *w, const struct ec_slave *s, bool head)
{
	const struct ec_slave *up = before_break(w->bus);
	bool cut = !may_miss(w->bus);

	if (head || (cut && w->bus->break_at[1] < EC_MAX_PORT))
		return cut && up ? group_of(w, up) : NULL;
	ec_for_each_group(g, w)
		/* only a cable is open, and its port not known */
		if (!cut || (up && g->by == EC_GROUP_BY_PORT && g->host == up))
			w->unsure |= !has_head(g) && looks_like_rest(g, s);
	return cut && up ? group_of(w, up) : NULL;
}

/* The group in which @s is found, unless it is the @head of one. */
static struct ec_group *inherited(struct ec_wanted *w, const struct ec_slave *s, bool head)
{
	const struct ec_slave *up = ec_graph_parent(s);
	struct ec_group *g;

	if (is_attached(w, s))
		return attached_group(s);
	g = up ? group_of(w, up) : hangs_nowhere(s) ? behind_break(w, s, head) : NULL;
	/* @outer was begun before its group: this ends */
	while (g && ec_setup_of(s)->in_path && g->seen >= g->n_members)
		g = g->outer;
	return g;
}

static void mark_slave(struct ec_wanted *w, const struct ec_slave *s)
{
	struct ec_setup *setup = ec_setup_of(s);
	struct ec_group *head = headed_by(w, s), *outer, *g;

	outer = inherited(w, s, head);
	g = head ?: outer;
	setup->heads = head;
	setup->group = g ? g->index + 1 : 0;
	if (head)
		head->seen = 0;
	if (head && !head->begun && outer != head)
		head->outer = outer;
	if (g) {
		g->begun = true;
		g->seen++;
	}
	ec_for_each_group(x, w)
		look_for_host(x, s);
}

/**
 * ec_groups_mark() - note which slaves belong to hot connect groups
 * @w: what an application configures
 *
 * A slave belongs to the group of the nearest head towards the main device; in a ring only as many
 * as the group has members. These slaves do not count for the ring positions of other
 * configurations.
 *
 * Context: Process, lock of the session and topo held.
 */
void ec_groups_mark(struct ec_wanted *w)
{
	lockdep_assert_held(w->lock);
	lockdep_assert_held(&w->bus->topo);
	w->unsure = false;
	if (!w->n_groups)
		return;
	mark_path(w->bus);
	ec_for_each_group(g, w)
		begin_group(g);
	/* a slave is behind its parent in the order of the ring */
	ec_for_each_slave(s, w->bus)
		mark_slave(w, s);
	ec_for_each_group(g, w) {
		if (g->by == EC_GROUP_BY_PORT && !g->host && !g->at->group)
			w->unsure |= may_miss(w->bus);
		g->host = NULL;
	}
}
