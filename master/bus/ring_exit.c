// SPDX-License-Identifier: GPL-2.0-only
/*
 * The card of the backup device may have a link although no driver receives there: frames of the
 * main device leave the last slave for it and do not return. Slaves still execute them: so the
 * master closes that port, until the device is attached again. The same when the master is
 * configured to do without a backup device: then until the link is lost.
 */
#include <linux/ktime.h>
#include "../base/report.h"
#include "../carry/xfer.h"
#include "../link/links.h"
#include "graph.h"
#include "ring_exit.h"
#include "slave.h"

#define CLOSES		3	/* writes that close the port: each may be lost */
#define AGAIN_NS	NSEC_PER_SEC	/* between attempts */

/* The last slave by whose port frames leave although no slave is behind it. */
static struct ec_slave *find_exit(const struct ec_bus *bus, unsigned int *port)
{
	struct ec_slave *found = NULL;

	ec_for_each_slave(s, bus)
		if (ec_graph_free_port(s) >= 0)
			found = s;
	if (found)
		*port = ec_graph_free_port(found);
	return found;
}

/*
 * Nothing of it returns, unless the last datagram does. @unsure: set if the write may have failed;
 * NULL: of no interest.
 */
static bool returns_with(struct ec_bus *bus, u16 station, u8 loops, bool *unsure)
{
	u8 any;
	struct ec_dg dg[CLOSES + 1];
	unsigned int i;

	for (i = 0; i < CLOSES; i++)
		dg[i] = EC_FPWR(station, EC_REG_DL_LOOPS, 1, &loops);
	dg[i] = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &any);
	for (i = 0; i <= CLOSES; i++)
		dg[i].last = true;
	ec_xfer_train(bus->links, dg, CLOSES + 1);
	if (unsure)
		*unsure |= dg[CLOSES - 1].err || dg[CLOSES - 1].wkc != 1;
	return !dg[CLOSES].err;
}

static bool try_is_due(struct ec_ring_exit *exit)
{
	u64 now = ktime_get_ns();

	if (exit->tried_ns && now - exit->tried_ns < AGAIN_NS)
		return false;
	exit->tried_ns = now;
	return true;
}

/**
 * ec_ring_exit_note() - the list is about to be forgotten: keep what closes the exit of a ring
 * @bus: bus, still with its slaves
 *
 * Context: The monitor thread.
 */
void ec_ring_exit_note(struct ec_bus *bus)
{
	struct ec_ring_exit *exit = &bus->exit;
	unsigned int port = exit->port;
	struct ec_slave *found = NULL;

	if (bus->links->only || !bus->n_slaves)
		return;
	exit->station = 0;
	ec_for_each_slave(s, bus)
		if (exit->device == s->device)
			found = s;
	exit->closed = found;
	found = found ?: find_exit(bus, &port);
	/* with exchanged devices the backup device is at the first slave */
	if (!found || !port || found->ports.fixed || bus->links->exchanged)
		return;
	exit->port = port;
	exit->station = found->station;
	exit->open = ec_loops_with(found->ports.loops, port, EC_LOOP_AUTO);
}

/**
 * ec_ring_exit_forget() - the bus will be another ring, or a line
 * @bus: bus without slaves and without a device
 * @line: a line: its last slave may have to be closed
 *
 * Context: Process.
 */
void ec_ring_exit_forget(struct ec_bus *bus, bool line)
{
	if (line)
		bus->exit.device = bus->exit.tried_ns = 0;
	else
		bus->exit = (struct ec_ring_exit){};
}

/* No slave is known, but they still execute what passes them. */
static bool close_line(struct ec_bus *bus)
{
	struct ec_ring_exit *exit = &bus->exit;
	u8 closed = ec_loops_with(exit->open, exit->port, EC_LOOP_CLOSED);

	if (!exit->station || exit->closed || !try_is_due(exit))
		return false;
	exit->closed = returns_with(bus, exit->station, closed, NULL);
	if (!exit->closed)
		returns_with(bus, exit->station, exit->open, NULL);
	return exit->closed;
}

/* The port is closed as long as it has its link. */
static void look_at_line(struct ec_bus *bus)
{
	struct ec_ring_exit *exit = &bus->exit;
	u64 before = exit->device;

	if (!bus->n_slaves)
		return;
	exit->device = 0;
	ec_for_each_slave(s, bus)
		if (exit->closed && s->dl_status & EC_DLS_LINK(exit->port) &&
		    s->ports.loops == ec_loops_with(exit->open, exit->port, EC_LOOP_CLOSED)) {
			exit->device = s->device;
			if (exit->device != before)
				ec_slave_warn(s, "port %u closed: its card keeps the link without the master; it is opened when that link is lost\n",
					      exit->port);
		}
	if (!exit->device)
		*exit = (struct ec_ring_exit){};
}

/**
 * ec_ring_exit_close() - no frame returns: close the port towards an absent backup device
 * @bus: bus, with the slaves that it had
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether frames return.
 */
bool ec_ring_exit_close(struct ec_bus *bus)
{
	const struct ec_links *l = bus->links;
	struct ec_slave *s;
	unsigned int port;

	if (l->only)
		return close_line(bus);
	if (READ_ONCE(l->link[EC_BACKUP].dev) || !READ_ONCE(l->link[EC_MAIN].dev) ||
	    bus->exit.device || !try_is_due(&bus->exit))
		return false;
	s = find_exit(bus, &port);
	if (!s || !port || s->ports.fixed)
		return false;
	if (!returns_with(bus, s->station, ec_loops_with(s->ports.loops, port, EC_LOOP_CLOSED),
			  &s->ports.unsure)) {
		returns_with(bus, s->station, s->ports.loops, &s->ports.unsure);
		return false;
	}
	s->ports.loops = ec_loops_with(s->ports.loops, port, EC_LOOP_CLOSED);
	bus->exit.device = s->device;
	bus->exit.port = port;
	ec_slave_warn(s,
		      "port %u closed: its link is up, but the backup device there is absent; it is opened when the device is attached\n",
		      port);
	return true;
}

/**
 * ec_ring_exit_is_closed() - has the master closed such a port?
 * @bus: bus
 *
 * Context: The monitor thread.
 * Return: whether it has, and the port is not to be opened.
 */
bool ec_ring_exit_is_closed(const struct ec_bus *bus)
{
	return bus->exit.device || bus->exit.closed;
}

/**
 * ec_ring_exit_look() - may the port be open again?
 * @bus: bus
 *
 * Context: The monitor thread.
 */
void ec_ring_exit_look(struct ec_bus *bus)
{
	if (bus->exit.device && READ_ONCE(bus->links->link[EC_BACKUP].dev))
		bus->exit = (struct ec_ring_exit){};
	if (bus->exit.station && bus->links->only)
		look_at_line(bus);
}

/**
 * ec_ring_exit_loops() - loop control of a slave, with the port that has to stay closed
 * @s: slave of the list
 * @loops: without it
 *
 * Context: The monitor thread.
 * Return: value for register 0x0101.
 */
u8 ec_ring_exit_loops(const struct ec_slave *s, u8 loops)
{
	const struct ec_ring_exit *exit = &s->bus->exit;

	if (likely(!exit->device) || exit->device != s->device)
		return loops;
	return ec_loops_with(loops, exit->port, EC_LOOP_CLOSED);
}
