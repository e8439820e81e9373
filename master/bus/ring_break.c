// SPDX-License-Identifier: GPL-2.0-only
#include "../base/report.h"
#include "../link/links.h"
#include "graph.h"
#include "ring_break.h"
#include "ring_exit.h"
#include "ring_heal.h"
#include "ring_place.h"
#include "slave.h"

static bool ring_is_open(const struct ec_bus *bus)
{
	return bus->links->ring.state == EC_RING_OPEN;
}

/* Where @s is in the list; @n: it is not. */
static unsigned int index_of(struct ec_slave **slaves, unsigned int n, const struct ec_slave *s)
{
	unsigned int i = 0;

	while (i < n && slaves[i] != s)
		i++;
	return i;
}

/*
 * The port at which the slave behind the break hung so far, or slaves before it that are missing
 * now. Returns whether it is known: then @at is set.
 */
static bool find_place(u32 *at, struct ec_slave **slaves, unsigned int front,
		       const struct ec_slave *next)
{
	const struct ec_slave *up;
	unsigned int i = front;

	while (i == front && (up = ec_graph_parent(next))) {
		i = index_of(slaves, front, up);
		at[1] = next->graph.parent_port;
		next = up;
	}
	at[0] = i;
	return i < front;
}

/* The port of a ring that was closed until now, from which a cable led to the backup device. */
static void note_exit(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n)
{
	u32 *at = bus->break_at;

	ec_for_each_slave(s, bus) {
		if (ec_graph_free_port(s) < 0)
			continue;
		at[0] = index_of(slaves, n, s);
		at[1] = ec_graph_free_port(s);
		/* it is lost: where it hung */
		if (at[0] == n && !find_place(at, slaves, n, s))
			at[0] = n - 1;
	}
}

/**
 * ec_ring_break_note() - the list of slaves changes: where will the ring be open?
 * @bus: bus, @front set; the graph is that of the list before
 * @slaves: list that it gets
 * @n: entries in @slaves
 *
 * The port before the break is that at which the slave behind it hung so far.
 *
 * Context: The monitor thread, topo held for writing.
 */
void ec_ring_break_note(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n)
{
	u32 *at = bus->break_at, front = min(bus->front, n), was[2] = { at[0], at[1] };
	bool open = bus->ring_told[0] == EC_RING_OPEN;

	lockdep_assert_held_write(&bus->topo);
	bus->break_was[0] = open ? at[0] : EC_EVENT_NONE;
	bus->break_was[1] = at[1];
	bus->break_was[2] = bus->ring_told[1];
	if (!ring_is_open(bus) || (front < n && find_place(at, slaves, front, slaves[front])))
		return;
	at[0] = front ? front - 1 : EC_EVENT_NONE;
	at[1] = front && open && was[0] == at[0] ? was[1] : EC_EVENT_NONE;
	if (front && front == n && bus->ring_told[0] == EC_RING_CLOSED)
		note_exit(bus, slaves, n);
}

/**
 * ec_ring_break_report() - an event and a line if the ring is not what these have said last
 * @bus: bus with its new list
 *
 * Context: The monitor thread.
 */
void ec_ring_break_report(struct ec_bus *bus)
{
	u32 state = bus->links->ring.state, slave, port, next;

	if (state < EC_RING_CLOSED || !bus->n_slaves ||
	    (bus->ring_told[0] == state &&
	     (state == EC_RING_CLOSED || bus->ring_told[1] == bus->front)))
		return;
	WRITE_ONCE(bus->ring_told[0], state);
	bus->ring_told[1] = bus->front;
	ec_ring_break_show(bus, &state, &slave, &port, &next);
	if (state == EC_RING_CLOSED)
		ec_report(bus->base, EC_EVENT_RING_CLOSED, bus->n_slaves);
	else
		ec_report(bus->base, EC_EVENT_RING_OPEN, slave, port, next);
}

/**
 * ec_ring_break_is_news() - is the ring closed or open, and no event has reported it?
 * @bus: bus
 *
 * Context: The monitor thread.
 * Return: whether it is.
 */
bool ec_ring_break_is_news(const struct ec_bus *bus)
{
	u32 state = bus->links->ring.state;

	return state >= EC_RING_CLOSED && state != bus->ring_told[0];
}

/**
 * ec_ring_break_neighbor() - the slave before the break behind which another one was
 * @s: slave of the list that is replaced now, without neighbor towards the main device
 * @port: result: port of the one before the break
 *
 * Context: The monitor thread, topo held for writing, after ec_ring_break_note().
 * Return: that slave, or NULL: the main device, or not known.
 */
struct ec_slave *ec_ring_break_neighbor(const struct ec_slave *s, u8 *port)
{
	const struct ec_bus *bus = s->bus;
	const u32 *was = bus->break_was;

	lockdep_assert_held_write(&bus->topo);
	if (bus->links->only || !s->position || s->position != was[2] || was[0] >= bus->n_slaves ||
	    was[1] >= EC_MAX_PORT)
		return NULL;
	*port = was[1];
	return bus->slaves[was[0]];
}

/**
 * ec_ring_forget() - the bus will be another ring, or none
 * @bus: bus without slaves and without a device
 * @line: it will be a line
 *
 * Context: Process. May sleep.
 */
void ec_ring_forget(struct ec_bus *bus, bool line)
{
	down_write(&bus->topo);
	ec_show_change_begin(&bus->base->show);
	WRITE_ONCE(bus->ring_told[0], EC_RING_NONE);
	bus->turned = bus->turned_told = 0;
	ec_ring_exit_forget(bus, line);
	ec_ring_heal_forget(bus);
	ec_ring_places_forget(bus);
	bus->places.open = false;
	ec_show_change_end(&bus->base->show);
	up_write(&bus->topo);
}

/**
 * ec_ring_break_show() - the state of the ring, for users
 * @bus: bus
 * @state: result: EC_RING_*
 * @slave: result: of an open ring: slave before the break, EC_EVENT_NONE: the main device
 * @port: result: its port there, EC_EVENT_NONE: not known
 * @next: result: slave behind the break, EC_EVENT_NONE: the backup device
 *
 * Context: The monitor thread, or as for ec_bus_assert_stays().
 */
void ec_ring_break_show(const struct ec_bus *bus, u32 *state, u32 *slave, u32 *port, u32 *next)
{
	u32 front = READ_ONCE(bus->front);

	*state = READ_ONCE(bus->links->ring.state);
	*slave = *port = *next = EC_EVENT_NONE;
	/* a scan begins: the place is not known before it is complete */
	if (*state >= EC_RING_CLOSED &&
	    (*state != READ_ONCE(bus->ring_told[0]) || !READ_ONCE(bus->n_slaves) ||
	     !ec_links_any_up(bus->links)))
		*state = EC_RING_UNKNOWN;
	if (*state != EC_RING_OPEN)
		return;
	*slave = bus->break_at[0];
	*port = bus->break_at[1];
	*next = front < bus->n_slaves ? front : EC_EVENT_NONE;
}
