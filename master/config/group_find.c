// SPDX-License-Identifier: GPL-2.0-only
/*
 * Where a hot connect group is on the bus. The head is what has its alias or identification, or
 * what is at its port; the members are the slaves from the head on, in the order of the ring, but
 * for those of a group that is connected behind one of them.
 */
#include "../bus/graph.h"
#include "../bus/ring_place.h"
#include "../bus/slave.h"
#include "config.h"
#include "group.h"

/*
 * The slave at whose port a group is known: that of its configuration, or the one which this means.
 * It is found in the pass that marks, before the slaves behind it.
 */
static void begin_host(struct ec_group *g)
{
	g->seen = 0;
	g->host = g->at ? g->at->slave : NULL;
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
		found = !mark && is_at_place(g, s);
	if (found && is_what_it_expects(at, s))
		g->host = s;
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
		return g->host && g->host->graph.at[g->port] == s;
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

static void mark_slave(struct ec_wanted *w, const struct ec_slave *s)
{
	const struct ec_slave *up = ec_graph_parent(s);
	struct ec_setup *setup = ec_setup_of(s);
	struct ec_group *head = headed_by(w, s);

	setup->heads = head;
	setup->group = head ? head->index + 1 : up ? ec_setup_of(up)->group : 0;
	if (head)
		head->seen = 0;
	if (setup->group)
		w->groups[setup->group - 1]->seen++;
	ec_for_each_group(g, w)
		look_for_host(g, s);
}

/**
 * ec_groups_mark() - note which slaves belong to hot connect groups
 * @w: what an application configures
 *
 * A slave belongs to the group of the nearest head towards the main device. These slaves do not
 * count for the ring positions of other configurations.
 *
 * Context: Process, lock of the session and topo held.
 */
void ec_groups_mark(struct ec_wanted *w)
{
	lockdep_assert_held(w->lock);
	lockdep_assert_held(&w->bus->topo);
	if (!w->n_groups)
		return;
	ec_for_each_group(g, w)
		begin_host(g);
	/* a slave is behind its parent in the order of the ring */
	ec_for_each_slave(s, w->bus)
		mark_slave(w, s);
	ec_for_each_group(g, w)
		g->host = NULL;
}

/* Slaves of no group before place @end of the list. */
static u32 count_plain(const struct ec_bus *bus, u32 end)
{
	u32 i, n = 0;

	for (i = 0; i < min(end, bus->n_slaves); i++)
		n += !ec_setup_of(bus->slaves[i])->group;
	return n;
}

/* Slaves of no group are missing at the break of a ring: how many others are before that one? */
static int count_open(const struct ec_wanted *w, u32 at, u32 left)
{
	const struct ec_bus *bus = w->bus;
	u32 place = count_plain(bus, at) + left;
	int i = ec_ring_places_count(place, count_plain(bus, bus->places.front),
				     count_plain(bus, bus->n_slaves), w->n_places);

	return i == -EAGAIN && !w->certain ? (int)place : i;
}

/**
 * ec_groups_place() - the ring position that alias and offset mean between hot connect groups
 * @w: what an application configures, with groups; they are marked
 * @alias: alias of a slave of no group, 0: @position counts from the main device on
 * @position: slaves of no group after that one
 * @alias_at: result: ring position of the first one with @alias; the number of slaves: none has
 *
 * Slaves of groups do not count: they come and go.
 *
 * Context: Process, lock of the session and topo held.
 * Return: ring position, also behind the end of the ring; U32_MAX less the error of
 * ec_ring_places_count(): in an open ring the slave is absent, or its position not certain.
 */
u32 ec_groups_place(const struct ec_wanted *w, u16 alias, u16 position, u32 *alias_at)
{
	const struct ec_bus *bus = w->bus;
	u32 at = 0, left = position;

	lockdep_assert_held(w->lock);
	lockdep_assert_held(&bus->topo);
	while (alias && at < bus->n_slaves &&
	       (bus->slaves[at]->alias != alias || ec_setup_of(bus->slaves[at])->group))
		at++;
	*alias_at = at;
	if (at < bus->n_slaves && ec_ring_places_misses(bus) && at < bus->places.front) {
		int i = count_open(w, at, left);

		if (i < 0)
			return U32_MAX + i;
		left = i;
		at = 0;
	}
	for (; at < bus->n_slaves; at++)
		if (!ec_setup_of(bus->slaves[at])->group && !left--)
			return at;
	return bus->n_slaves + left;
}

static bool is_member(const struct ec_group *g, const struct ec_slave *s)
{
	return ec_setup_of(s)->group == g->index + 1;
}

static bool hangs_behind(const struct ec_slave *s, const struct ec_slave *head)
{
	while (s && s != head)
		s = ec_graph_parent(s);
	return s;
}

static bool no(struct ec_group *g, u32 pos, const char *fmt, ...) __printf(3, 4);

/* The group cannot be used: because of the slave at @pos. Always false. */
static bool no(struct ec_group *g, u32 pos, const char *fmt, ...)
{
	va_list args;

	va_start(args, fmt);
	vscnprintf(g->why, sizeof(g->why), fmt, args);
	va_end(args);
	g->position = pos;
	g->cause = pos == EC_UAPI_NONE16 ? EC_CAUSE_NO_GROUP : EC_CAUSE_GROUP;
	return false;
}

static bool find_none(struct ec_group *g)
{
	if (g->by == EC_GROUP_BY_ALIAS)
		return no(g, EC_UAPI_NONE16, "no slave has alias %u", g->value);
	if (g->by == EC_GROUP_BY_ID)
		return no(g, EC_UAPI_NONE16, "no slave has identification %u", g->value);
	if (!g->at->slave)
		return no(g, EC_UAPI_NONE16, "slave %s is absent", g->at->name);
	return no(g, EC_UAPI_NONE16, "no slave at port %u of slave %u", g->port,
		  g->at->slave->position);
}

/* The head: of two that are alike none, but for one that is in use. */
static struct ec_slave *find_head(struct ec_group *g)
{
	const struct ec_slave *used = g->n_members ? g->members[0]->slave : NULL;
	struct ec_slave *head = NULL, *second = NULL;

	ec_for_each_slave(s, g->wanted->bus) {
		if (!is_member(g, s) || !ec_setup_of(s)->heads)
			continue;
		if (s == used)
			return s;
		second = second ?: head ? s : NULL;
		head = head ?: s;
	}
	if (!head) {
		find_none(g);
		return NULL;
	}
	if (!second)
		return head;
	no(g, second->position, "slaves %u and %u have the same %s %u: change one of them",
	   head->position, second->position,
	   g->by == EC_GROUP_BY_ALIAS ? "alias" : "identification", g->value);
	return NULL;
}

static bool check_place(struct ec_group *g, const struct ec_slave *head)
{
	if (g->at && !g->at->slave)
		return no(g, head->position, "slave %s is absent, at whose port %u it has to be",
			  g->at->name, g->port);
	if (g->at && g->at->slave->graph.at[g->port] != head)
		return no(g, head->position, "slave %u is not at port %u of slave %u: connect it there",
			  head->position, g->port, g->at->slave->position);
	if (head->graph.upstream)
		return no(g, head->position,
			  "slave %u is connected by its port %u: connect port 0 (IN) towards the main device",
			  head->position, head->graph.upstream);
	return true;
}

static bool check_member(struct ec_group *g, const struct ec_config *c, struct ec_slave *s)
{
	u32 serial = ec_config_flag(c, EC_FLAG_SERIAL), pos = s->position;
	const struct ec_config *has = ec_config_of(s);

	if (READ_ONCE(s->note.error) == EC_SLAVE_SCAN_FAILED)
		return no(g, pos, "slave %u could not be read: see 'ethercat why'", pos);
	if (!is_what_it_expects(c, s))
		return no(g, pos, "slave %u is 0x%08x/0x%08x, member %u is 0x%08x/0x%08x", pos,
			  s->info.vendor, s->info.product, c->position, c->vendor, c->product);
	if (serial && serial != s->info.serial)
		return no(g, pos, "slave %u has serial number 0x%08x, member %u has 0x%08x", pos,
			  s->info.serial, c->position, serial);
	if ((READ_ONCE(s->al.status) & EC_AL_STATE_MASK) == EC_AL_BOOT)
		return no(g, pos, "slave %u is in BOOT: 'ethercat states -p %u PREOP' ends that",
			  pos, pos);
	if (has && has->wanted == g->wanted && has != c)
		return no(g, pos, "slave %u has configuration %s", pos, has->name);
	return true;
}

/**
 * ec_group_find() - find the slaves of a hot connect group
 * @g: group; @head, @position, @cause and @why are set
 * @found: result, one for each member; no references
 *
 * All members are on the bus, or none may be used.
 *
 * Context: Process, lock of the session and topo held, after ec_groups_mark().
 * Return: whether they are on the bus.
 */
bool ec_group_find(struct ec_group *g, struct ec_slave **found)
{
	struct ec_bus *bus = g->wanted->bus;
	struct ec_slave *head;
	unsigned int pos, k;

	lockdep_assert_held(g->wanted->lock);
	lockdep_assert_held(&bus->topo);
	g->head = 0;
	head = find_head(g);
	if (!head || !check_place(g, head))
		return false;
	pos = head->position;
	for (k = 0; k < g->n_members; k++, pos++) {
		while (pos < bus->n_slaves && !is_member(g, bus->slaves[pos]))
			pos++;
		if (pos >= bus->n_slaves || !hangs_behind(bus->slaves[pos], head))
			return no(g, head->position,
				  "member %u (0x%08x/0x%08x) is not behind slave %u", k,
				  g->members[k]->vendor, g->members[k]->product, head->position);
		if (!check_member(g, g->members[k], bus->slaves[pos]))
			return false;
		found[k] = bus->slaves[pos];
	}
	g->head = head->device;
	g->position = head->position;
	g->cause = EC_CAUSE_NONE;
	g->why[0] = '\0';
	return true;
}
