// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "../base/report.h"
#include "../bus/border.h"
#include "../bus/ports.h"
#include "../config/group.h"
#include "session_groups.h"
#include "session_slave.h"

/**
 * ec_session_mark() - note which slaves belong to hot connect groups
 * @s: session
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_mark(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	down_read(&s->sessions->bus->topo);
	ec_groups_mark(&s->wanted);
	up_read(&s->sessions->bus->topo);
}

/* Each change of an active session once */
static void report_group(const struct ec_session *s, struct ec_group *g)
{
	const struct ec_event_more more = {
		.name = g->name, .detail = g->cause == EC_CAUSE_NONE ? NULL : g->why,
	};

	if (!s->wanted.active || g->logged == g->cause)
		return;
	ec_report_more(s->sessions->base, EC_EVENT_GROUP, g->position, &more, g->index, g->cause,
		       g->mandatory, g->n_members);
	g->logged = g->cause;
}

/**
 * ec_session_report_groups() - report which groups are not on the bus
 * @s: session that has just been activated
 *
 * Context: Process, session lock held.
 */
void ec_session_report_groups(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_for_each_group(g, &s->wanted)
		report_group(s, g);
}

/* A running session keeps the slave that a member has; @slave: with a reference, or NULL. */
static void settle(struct ec_session *s, struct ec_config *c, struct ec_slave *slave)
{
	if (c->slave && s->wanted.active)
		ec_slave_unref(slave);
	else
		ec_session_exchange(s, c, slave);
}

static void attach_group(struct ec_session *s, struct ec_group *g)
{
	struct ec_slave **found = kvcalloc(g->n_members + 1, sizeof(*found), GFP_KERNEL);
	unsigned int k;
	bool whole;

	/* nothing changes until the next scan */
	if (!found)
		return;
	down_read(&s->sessions->bus->topo);
	whole = ec_group_find(g, found);
	for (k = 0; whole && k < g->n_members; k++)
		ec_slave_ref(found[k]);
	up_read(&s->sessions->bus->topo);
	report_group(s, g);
	for (k = 0; k < g->n_members; k++)
		settle(s, g->members[k], whole ? found[k] : NULL);
	kvfree(found);
}

static u8 fast_ports(const struct ec_wanted *w, const struct ec_config *at)
{
	u8 ports = 0;

	ec_for_each_group(g, w)
		if (g->fast && g->at == at)
			ports |= BIT(g->port);
	return ports;
}

static struct ec_border_sign sign_of(const struct ec_group *g)
{
	const struct ec_config *head = g->n_members ? g->members[0] : NULL;

	return (struct ec_border_sign){
		.device = g->at ? g->at->slave->device : 0, .port = g->port, .by = g->by,
		.value = g->value, .vendor = head ? head->vendor : 0,
		.product = head ? head->product : 0,
		.serial = head ? ec_config_flag(head, EC_FLAG_SERIAL) : 0,
	};
}

/**
 * ec_session_set_borders() - pass on which groups are expected behind ports
 * @s: session, not the candidate
 *
 * Context: Process, session lock held. May sleep.
 * Return: 0, or -ENOMEM: what was expected before still is.
 */
int ec_session_set_borders(struct ec_session *s)
{
	struct ec_border_sign *signs = NULL;
	bool waiting = false;
	unsigned int n = 0;

	lockdep_assert_held(s->wanted.lock);
	if (s->wanted.n_groups) {
		signs = kvcalloc(s->wanted.n_groups, sizeof(*signs), GFP_KERNEL);
		if (!signs)
			return -ENOMEM;
	}
	ec_for_each_group(g, &s->wanted) {
		if (g->at && !g->at->slave)
			waiting = true;
		else
			signs[n++] = sign_of(g);
	}
	ec_border_set(s->sessions->bus, signs, n, waiting);
	return 0;
}

/**
 * ec_session_attach_groups() - connect the members of groups that are on the bus with their slaves
 * @s: session, after ec_session_mark()
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_session_attach_groups(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_for_each_group(g, &s->wanted)
		attach_group(s, g);
	ec_for_each_group(g, &s->wanted)
		if (g->fast && g->at->slave && ec_session_owns(g->at))
			ec_ports_set_fast(g->at->slave, fast_ports(&s->wanted, g->at));
	/* without memory the next scan tries it again */
	if (s->wanted.active)
		ec_session_set_borders(s);
}

/**
 * ec_session_drop_groups() - free the hot connect groups
 * @s: session
 *
 * Context: Process, session lock held.
 */
void ec_session_drop_groups(struct ec_session *s)
{
	lockdep_assert_held(s->wanted.lock);
	ec_for_each_group(g, &s->wanted)
		ec_group_free(g);
	s->wanted.n_groups = 0;
}

/**
 * ec_session_find_member() - the slave that a member of a group is now
 * @s: session
 * @g: group
 * @member: 0: the head; it need not have a configuration
 *
 * Context: Process, session lock held. May sleep.
 * Return: slave with a reference, or NULL.
 */
struct ec_slave *ec_session_find_member(struct ec_session *s, const struct ec_group *g,
					unsigned int member)
{
	struct ec_bus *bus = s->sessions->bus;
	struct ec_slave *found = NULL;

	lockdep_assert_held(s->wanted.lock);
	down_read(&bus->topo);
	ec_groups_mark(&s->wanted);
	ec_for_each_slave(x, bus)
		if (!found && ec_setup_of(x)->group == g->index + 1 && !member--)
			found = ec_slave_ref(x);
	up_read(&bus->topo);
	return found;
}
