// SPDX-License-Identifier: GPL-2.0-only
/*
 * The card of the backup device may have a link although no driver receives there: frames of the
 * main device leave the last slave for it and do not return. Slaves still execute them: so the
 * master closes that port, until the device is attached again.
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

/* Nothing of it returns, unless the last datagram does. */
static bool returns_with(struct ec_bus *bus, struct ec_slave *s, u8 loops)
{
	u8 any;
	struct ec_dg dg[CLOSES + 1];
	unsigned int i;

	for (i = 0; i < CLOSES; i++)
		dg[i] = EC_FPWR(s->station, EC_REG_DL_LOOPS, 1, &loops);
	dg[i] = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &any);
	for (i = 0; i <= CLOSES; i++)
		dg[i].last = true;
	ec_xfer_train(bus->links, dg, CLOSES + 1);
	s->ports.unsure |= dg[CLOSES - 1].err || dg[CLOSES - 1].wkc != 1;
	return !dg[CLOSES].err;
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
	u64 now = ktime_get_ns();
	struct ec_slave *s;
	unsigned int port;

	if (l->only || READ_ONCE(l->link[EC_BACKUP].dev) || !READ_ONCE(l->link[EC_MAIN].dev) ||
	    bus->exit.device || (bus->exit.tried_ns && now - bus->exit.tried_ns < AGAIN_NS))
		return false;
	bus->exit.tried_ns = now;
	s = find_exit(bus, &port);
	if (!s || !port || s->ports.fixed)
		return false;
	if (!returns_with(bus, s, ec_loops_with(s->ports.loops, port, EC_LOOP_CLOSED))) {
		returns_with(bus, s, s->ports.loops);
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
 * ec_ring_exit_look() - may the port be open again?
 * @bus: bus
 *
 * Context: The monitor thread.
 */
void ec_ring_exit_look(struct ec_bus *bus)
{
	if (bus->exit.device && READ_ONCE(bus->links->link[EC_BACKUP].dev))
		bus->exit.device = 0;
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
