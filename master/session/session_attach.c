// SPDX-License-Identifier: GPL-2.0-only
/* Configurations and their slaves. */
#include "../bus/find.h"
#include "../config/group.h"
#include "../config/replay.h"
#include "../config/why.h"
#include "session_attach.h"
#include "session_units.h"
#include "session_groups.h"
#include "session_slave.h"

/**
 * ec_session_find() - the slave that a new configuration would have
 * @s: session
 * @i: alias, position and identity
 *
 * Context: Process, session lock held. May sleep.
 * Return: slave with a reference, or NULL.
 */
struct ec_slave *ec_session_find(struct ec_session *s, const struct ec_ioc_slave_config *i)
{
	struct ec_bus *bus = s->sessions->bus;
	struct ec_slave *slave;
	u32 place, alias_at;

	lockdep_assert_held(s->wanted.lock);
	down_read(&bus->topo);
	if (s->wanted.n_groups) {
		ec_groups_mark(&s->wanted);
		place = ec_groups_place(&s->wanted, i->alias, i->position, &alias_at);
		slave = place < bus->n_slaves ? bus->slaves[place] : NULL;
	} else {
		slave = ec_find_slave_at(bus, i->alias, i->position,
					 max(s->wanted.n_places, i->alias ? 0 : i->position + 1u));
	}
	if (slave && slave->info.vendor == i->vendor_id &&
	    slave->info.product == i->product_code && !READ_ONCE(slave->stop.gone))
		ec_slave_ref(slave);
	else
		slave = NULL;
	up_read(&bus->topo);
	return slave;
}

/* Reasons name the lost slave even when another one is at its position. */
static void note_loss(struct ec_config *c)
{
	ec_slave_lost_text(c->slave, c->lost.text, sizeof(c->lost.text));
	c->lost.seen_ns = c->slave->lost.seen_ns;
	c->lost.at = c->slave->lost.at;
	c->lost.station = c->slave->station;
	c->lost.serial = c->slave->info.serial;
	c->lost.list = READ_ONCE(c->wanted->bus->lists);
}

/* The slave at the place of @c, with a reference, if it is what @c expects */
static struct ec_slave *find_at_place(const struct ec_session *s, const struct ec_config *c)
{
	struct ec_bus *bus = s->sessions->bus;
	struct ec_slave *x = NULL;
	int i;

	down_read(&bus->topo);
	i = ec_config_index(c);
	if (i >= 0 && i < bus->n_slaves)
		x = bus->slaves[i];
	if (x && (x->info.vendor != c->vendor || x->info.product != c->product ||
		  READ_ONCE(x->stop.gone)))
		x = NULL;
	if (x)
		ec_slave_ref(x);
	up_read(&bus->topo);
	return x;
}

/* Connect a configuration of a session that is not active with the slave at its place. */
static void attach_one(struct ec_session *s, struct ec_config *c)
{
	lockdep_assert_held(s->wanted.lock);
	if (!c->group)
		ec_session_exchange(s, c, find_at_place(s, c));
}

/* The device that @c had: it has kept its station address, or has a serial number. */
static struct ec_slave *find_same(const struct ec_session *s, const struct ec_config *c)
{
	struct ec_bus *bus = s->sessions->bus;
	struct ec_slave *found = NULL;

	down_read(&bus->topo);
	ec_for_each_slave(x, bus) {
		if (found || x->info.vendor != c->vendor || x->info.product != c->product ||
		    x->info.serial != c->lost.serial || READ_ONCE(x->stop.gone) || ec_config_of(x))
			continue;
		if (x->station == c->lost.station || x->info.serial)
			found = ec_slave_ref(x);
	}
	up_read(&bus->topo);
	return found;
}

/* The slave at the place of @c, if it was not on the bus when @c lost its own. */
static struct ec_slave *find_new(const struct ec_session *s, const struct ec_config *c)
{
	struct ec_slave *x = find_at_place(s, c);

	if (!x || x->found >= c->lost.list || ec_config_of(x))
		return x;
	ec_slave_unref(x);
	return NULL;
}

/* Has another configuration lost an identical slave, so that only the place decides? */
static bool has_alike(const struct ec_session *s, const struct ec_config *c)
{
	ec_for_each_config(x, &s->wanted)
		if (x != c && x->lost.waits && x->vendor == c->vendor && x->product == c->product)
			return true;
	return false;
}

/* Slaves of hot connect groups are found by the group. */
static bool may_take(const struct ec_config *c)
{
	return !c->slave && !c->group;
}

static void detach_lost(struct ec_session *s)
{
	ec_for_each_config(c, &s->wanted) {
		if (!c->slave || !READ_ONCE(c->slave->stop.gone))
			continue;
		note_loss(c);
		ec_session_detach(c);
	}
}

static void locate(struct ec_session *s)
{
	ec_session_mark(s);
	s->wanted.n_places = 0;
	/* all of them, before a place is looked for */
	ec_for_each_config(c, &s->wanted)
		if (!c->group && !c->alias)
			s->wanted.n_places = max(s->wanted.n_places, c->position + 1u);
	ec_for_each_config(c, &s->wanted)
		ec_config_locate(c);
}

/*
 * An active session keeps a slave while it is connected: when another one upstream is disconnected
 * its position changes, but it must not get outputs of another slave. A lost slave is attached
 * again at any position, or a new one at its place is used instead. A slave that was connected all
 * the time never gets the outputs of another one.
 */
static void reattach(struct ec_session *s)
{
	struct ec_slave *slave;
	unsigned int alike = 0;

	detach_lost(s);
	ec_for_each_config(c, &s->wanted) {
		slave = may_take(c) && c->lost.text[0] ? find_same(s, c) : NULL;
		if (slave)
			ec_session_give(s, c, slave);
	}
	locate(s);
	ec_for_each_config(c, &s->wanted)
		c->lost.waits = may_take(c) && c->lost.text[0];
	ec_for_each_config(c, &s->wanted) {
		slave = may_take(c) ? find_new(s, c) : NULL;
		if (slave && ec_session_give(s, c, slave) && c->lost.waits)
			alike += has_alike(s, c);
	}
	if (alike)
		ec_warn(s->sessions,
			"%u of identical slaves that were disconnected attached by position or alias: same serial number, station address not kept; check the cables\n",
			alike);
}

/* Configurations that have to get another slave lose theirs first: these may be exchanged. */
static void attach_again(struct ec_session *s)
{
	struct ec_slave *slave;

	locate(s);
	ec_for_each_config(c, &s->wanted) {
		if (!c->slave || c->group)
			continue;
		slave = find_at_place(s, c);
		if (slave != c->slave)
			ec_session_detach(c);
		if (slave)
			ec_slave_unref(slave);
	}
	ec_for_each_config(c, &s->wanted)
		attach_one(s, c);
}

/* Does the number of its configurations say where slaves behind a break are? */
static bool counts_for_it(const struct ec_session *s)
{
	const struct ec_ring_places *p = &s->sessions->bus->places;
	bool counts;

	down_read(&s->sessions->bus->topo);
	counts = p->open && !p->n && p->front < p->n_list && s->wanted.n_places >= p->n_list;
	up_read(&s->sessions->bus->topo);
	return counts;
}

/**
 * ec_session_settle_places() - let slaves be attached only where their position is certain
 * @s: session that is about to be activated
 *
 * In an open ring a slave may be missing where it is open: then others are not at the place in
 * the list that their position says.
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_settle_places(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	if (s->sessions->links->only || s == s->sessions->candidate)
		return;
	s->wanted.certain = true;
	/* they may have got theirs where it was not */
	ec_for_each_config(c, &s->wanted)
		if (c->group && READ_ONCE(s->sessions->links->ring.state) == EC_RING_OPEN)
			ec_session_detach(c);
	attach_again(s);
	ec_session_attach_groups(s);
	if (counts_for_it(s))
		ec_warn(s->sessions,
			"the ring is open and was not seen closed: positions behind the break are counted for a ring of %u slaves, as configured; check that none is missing\n",
			s->wanted.n_places);
}

/**
 * ec_session_begin_active() - prepare the configurations for slaves that get lost
 * @s: session that has just been activated
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_begin_active(struct ec_session *s)
{
	struct ec_bus *bus = s->sessions->bus;
	const struct ec_slave *first;

	lockdep_assert_held(s->wanted.lock);
	down_read(&bus->topo);
	ec_for_each_config(c, &s->wanted) {
		/*
		 * Slaves found before now do not replace a missing one. One whose position is not
		 * certain may get it when the ring closes.
		 */
		c->lost.list = ec_config_index(c) == -EAGAIN ? 0 : bus->lists + 1;
		if (!c->alias || c->alias_at >= bus->n_slaves)
			continue;
		first = bus->slaves[c->alias_at];
		if (first->alias == c->alias && first->alias_first)
			ec_warn_each(s->sessions, c->index + 1,
				     "configuration %s: alias %u is not unique; slave %u, the first one, is used\n",
				     c->name, c->alias, first->position);
	}
	up_read(&bus->topo);
}

/**
 * ec_session_configure() - find or make the configuration of a slave
 * @s: session
 * @alias: alias or 0
 * @position: position
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process, session lock held. May sleep.
 * Return: configuration, or ERR_PTR: -ENOENT when it exists with another identity, or as
 * ec_config_create().
 */
struct ec_config *ec_session_configure(struct ec_session *s, u16 alias, u16 position, u32 vendor,
				       u32 product)
{
	struct ec_config *c = ec_config_find(&s->wanted, alias, position, vendor, product);
	int ret;

	lockdep_assert_held(s->wanted.lock);
	if (c)
		return c;
	c = ec_config_create(&s->wanted, alias, position, vendor, product);
	if (IS_ERR(c))
		return c;
	ec_session_mark(s);
	ec_config_locate(c);
	/* so many slaves are not connected: those behind the break are others than before */
	if (!s->sessions->links->only && s->wanted.n_places > READ_ONCE(s->sessions->bus->n_slaves))
		attach_again(s);
	else
		attach_one(s, c);
	ret = ec_config_begin(c);
	if (!ret) {
		ec_replay_adopt(c);
		return c;
	}
	ec_session_detach(c);
	ec_config_drop(c);
	return ERR_PTR(ret);
}

/**
 * ec_session_attach_all() - attach the slaves that are on the bus now
 * @s: session
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_attach_all(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	if (s->wanted.active) {
		reattach(s);
	} else {
		locate(s);
		ec_for_each_config(c, &s->wanted)
			attach_one(s, c);
	}
	ec_session_attach_groups(s);
}

/**
 * ec_session_configure_member() - find or make the configuration of a member of a group
 * @s: session; active: only to find it
 * @g: group
 * @member: 0: the head
 * @vendor: expected vendor id
 * @product: expected product code
 *
 * Context: Process, session lock held. May sleep.
 * Return: configuration, or ERR_PTR as ec_group_config() or ec_config_begin().
 */
struct ec_config *ec_session_configure_member(struct ec_session *s, struct ec_group *g, u16 member,
					      u32 vendor, u32 product)
{
	unsigned int n = g->n_members;
	struct ec_config *c;
	int ret;

	lockdep_assert_held(s->wanted.lock);
	c = ec_group_config(g, member, vendor, product);
	if (IS_ERR(c) || g->n_members == n)
		return c;
	ec_session_attach_all(s);
	ret = ec_config_begin(c);
	if (!ret) {
		ec_replay_adopt(c);
		return c;
	}
	ec_session_detach(c);
	ec_group_drop(c);
	ec_config_drop(c);
	return ERR_PTR(ret);
}

/**
 * ec_session_attach() - after a scan: attach slaves to configurations again
 * @ss: sessions of a master
 *
 * Context: Process. May sleep.
 */
void ec_session_attach(struct ec_sessions *ss)
{
	ec_sessions_lock(ss);
	if (ss->session)
		ec_session_attach_all(ss->session);
	if (ss->candidate)
		locate(ss->candidate);
	ec_sessions_unlock(ss);
}

/* An active session requests OP for its slaves, even after a tool has requested another state. */
static bool wanted_in_op(const struct ec_session *session, const struct ec_slave *s)
{
	const struct ec_config *c = ec_config_of(s);

	return session && session->wanted.active && !session->ending &&
	       (c ? ec_session_goal(session, c) == EC_AL_OP : s == session->raised);
}

static void session_attach_try_again(const struct ec_session *session, struct ec_slave *s)
{
	bool op = wanted_in_op(session, s) && READ_ONCE(s->note.error) != EC_SLAVE_SCAN_FAILED;

	if (ec_slave_forgive(s))
		WRITE_ONCE(s->work.reconfigure, true);
	else if (!op || READ_ONCE(s->al.requested) == EC_AL_OP)
		return;
	if (op)
		ec_slave_request(s, EC_AL_OP);
	else
		ec_slave_kick(s);
}

/**
 * ec_session_again() - try to configure slaves again that have failed
 * @work: of struct ec_sessions
 *
 * Context: The service queue. May sleep.
 */
void ec_session_again(struct work_struct *work)
{
	struct ec_sessions *ss = container_of(work, struct ec_sessions, again);

	mutex_lock(&ss->lock);
	down_read(&ss->bus->topo);
	ec_for_each_slave(s, ss->bus)
		session_attach_try_again(ss->session, s);
	up_read(&ss->bus->topo);
	mutex_unlock(&ss->lock);
}

/**
 * ec_session_try_again() - queue ec_session_again()
 * @ss: sessions of a master
 *
 * It does not wait for the lock of the sessions: its holder may wait for a frame that the
 * caller, a cycle, would carry.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_session_try_again(struct ec_sessions *ss)
{
	queue_work(ss->service, &ss->again);
}
