// SPDX-License-Identifier: GPL-2.0-only
/*
 * Where a hot connect group is on the bus. The members are the slaves from the head on, in the
 * order of the ring, but for those of a group that is connected behind one of them.
 */
#include "../bus/graph.h"
#include "../bus/ring_place.h"
#include "../bus/slave.h"
#include "config.h"
#include "group.h"

/* Slaves of no group before place @end of the list. */
static u32 count_plain(const struct ec_bus *bus, u32 end)
{
	u32 i, n = 0;

	for (i = 0; i < min(end, bus->n_slaves); i++)
		n += !ec_setup_of(bus->slaves[i])->group;
	return n;
}

/* Is a place in the list perhaps not that in the closed ring? */
static bool counts_open(const struct ec_bus *bus)
{
	const struct ec_ring_places *p = &bus->places;

	return p->open || (p->n && !p->sure);
}

/* Slaves of no group are missing at the break of a ring: how many others are before that one? */
static int count_open(const struct ec_wanted *w, u32 at, u32 left)
{
	const struct ec_bus *bus = w->bus;
	u32 place = count_plain(bus, at) + left;
	u32 front = count_plain(bus, bus->places.front), n = count_plain(bus, bus->n_slaves);
	int i = ec_ring_places_count(place, front, n, w->n_places);

	/* it is closed, or about to be, and the list is not that of the closed ring */
	if (!bus->places.open)
		i = -EAGAIN;
	/* if none is missing there, another one is */
	else if (ec_ring_places_cut(bus))
		i = place < front || n >= w->n_places ? (int)place : -EAGAIN;
	/* one that counts may be of a group whose head is absent */
	if (place >= front && (w->unsure || bus->places.partial))
		i = -EAGAIN;
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
	if (at < bus->n_slaves && counts_open(bus) &&
	    (!alias || at < bus->places.front)) {
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

/* Behind the break of a ring a slave hangs nowhere: that it was marked is enough. */
static bool hangs_behind(const struct ec_slave *s, const struct ec_slave *head)
{
	const struct ec_ring_places *p = &s->bus->places;

	if (p->open && s->position >= p->front && head->position < p->front)
		return true;
	while (s && s != head)
		s = ec_graph_parent(s);
	return s;
}

/* In an open ring the way from one to the next may be the other one: those that run run on. */
static bool all_run(const struct ec_group *g, struct ec_slave **found)
{
	unsigned int k;

	if (!g->wanted->active || !g->wanted->bus->places.open || !g->n_members)
		return false;
	for (k = 0; k < g->n_members; k++) {
		found[k] = g->members[k]->slave;
		if (!found[k] || READ_ONCE(found[k]->stop.gone) ||
		    ec_config_of(found[k]) != g->members[k])
			return false;
	}
	return true;
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
	if (g->at && ec_group_neighbor(g->at->slave, g->port) != head)
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
	if (s->info.vendor != c->vendor || s->info.product != c->product)
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

/* Always true. */
static bool group_is_found(struct ec_group *g, const struct ec_slave *head)
{
	g->head = head->device;
	g->position = head->position;
	g->cause = EC_CAUSE_NONE;
	g->why[0] = '\0';
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
	if (all_run(g, found))
		return group_is_found(g, found[0]);
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
	return group_is_found(g, head);
}
