// SPDX-License-Identifier: GPL-2.0-only
/*
 * Ports that lose their link while the monitor is busy elsewhere, with a trial or EEPROMs: they are
 * closed there and then. A PC or a switch that gets a link at one of them meanwhile would open it
 * by its first frame, and no frame of the bus would return. So would one behind a slave that gets
 * its power back: its ports are open then.
 */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../carry/xfer.h"
#include "../link/links.h"
#include "graph.h"
#include "ports.h"
#include "ports_lost.h"
#include "slave.h"

#define LOOK_NS	(100 * NSEC_PER_MSEC)	/* between two looks; a link takes longer to come */

/* Is a slave behind this port? Of one that a scan has just found this is not known yet. */
static bool is_used(const struct ec_slave *s, unsigned int port, bool found)
{
	if (found)
		return ec_slave_port_type(s, port) >= 2;
	return port != s->graph.upstream && s->graph.at[port];
}

/* The loop control with those ports closed behind which a slave may be, but no link. */
static u8 without_lost(const struct ec_slave *s, u16 dl, bool found)
{
	u8 open = ec_graph_open_ports(dl), loops = s->ports.loops;
	unsigned int p;

	for (p = 1; p < EC_MAX_PORT; p++)
		if (is_used(s, p, found) && !(open & BIT(p)))
			loops = ec_loops_with(loops, p, EC_LOOP_CLOSED);
	return loops;
}

/* Slaves with a port that is open as long as it has a link */
static bool is_watched(const struct ec_slave *s, bool found)
{
	unsigned int p;
	u8 loop;

	for (p = 1; p < EC_MAX_PORT; p++) {
		loop = s->ports.loops >> 2 * p & 3;
		if (is_used(s, p, found) && (loop == EC_LOOP_AUTO_CLOSE ||
					     (found && loop == EC_LOOP_AUTO)))
			return !READ_ONCE(s->reply.silent);
	}
	return false;
}

/* @listed of the slaves are in the list of the bus. */
static void close_them(struct ec_bus *bus, struct ec_slave **list, struct ec_dg *dg, u8 (*v)[3],
		       unsigned int n, unsigned int listed)
{
	unsigned int i, k = 0;

	for (i = 0; i < n; i++) {
		u16 dl = get_unaligned_le16(v[i]);

		if (dg[i].err || dg[i].wkc != 1)
			continue;
		list[i]->dl_seen = dl;
		v[k][2] = without_lost(list[i], dl, i >= listed);
		if (v[k][2] != list[i]->ports.loops)
			list[k++] = list[i];
	}
	for (i = 0; i < k; i++)
		dg[i] = EC_FPWR(list[i]->station, EC_REG_DL_LOOPS, 1, &v[i][2]);
	if (k)
		ec_xfer(bus->links, dg, k);
	for (i = 0; i < k; i++)
		if (!dg[i].err && dg[i].wkc == 1)
			list[i]->ports.loops = v[i][2];
		else
			list[i]->ports.unsure = true;
}

static bool look_is_due(struct ec_bus *bus)
{
	u64 now = ktime_get_ns();

	if (!ec_ports_are_guarded(bus) || now - bus->lost_look_ns < LOOK_NS)
		return false;
	bus->lost_look_ns = now;
	return true;
}

/* Those that are watched, the ones of the list first. Return: how many; @listed: of the list */
static unsigned int watched(struct ec_bus *bus, struct ec_slave **list, unsigned int *listed)
{
	unsigned int n = 0, i;

	ec_for_each_slave(s, bus)
		if (is_watched(s, false))
			list[n++] = s;
	*listed = n;
	for (i = 0; i < bus->n_found; i++)
		if (is_watched(bus->found[i], true))
			list[n++] = bus->found[i];
	return n;
}

static void close_lost(struct ec_bus *bus)
{
	unsigned int most = bus->n_slaves + bus->n_found, n, listed, i;
	struct ec_slave **list;
	struct ec_dg *dg;
	u8 (*v)[3];

	list = kvcalloc(most, sizeof(*list), GFP_KERNEL);
	dg = kvcalloc(most, sizeof(*dg), GFP_KERNEL);
	v = kvcalloc(most, sizeof(*v), GFP_KERNEL);
	if (most && list && dg && v) {
		n = watched(bus, list, &listed);
		for (i = 0; i < n; i++)
			dg[i] = EC_FPRD(list[i]->station, EC_REG_DL_STATUS, 2, v[i]);
		if (n)
			ec_xfer(bus->links, dg, n);
		close_them(bus, list, dg, v, n, listed);
	}
	kvfree(list);
	kvfree(dg);
	kvfree(v);
}

/**
 * ec_ports_close_lost() - close ports in use that have lost their link, every 100 ms
 * @bus: bus
 * @irq: IRQ field of a datagram that has passed all slaves just now; nothing is done unless it
 *	shows the DL event
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_ports_close_lost(struct ec_bus *bus, u16 irq)
{
	if (irq & EC_ECAT_EVENT_DL && look_is_due(bus))
		close_lost(bus);
}

/**
 * ec_ports_look_for_lost() - the same in work that has no such datagram
 * @bus: bus
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_ports_look_for_lost(struct ec_bus *bus)
{
	struct ec_dg dg;
	u8 any;

	if (!look_is_due(bus))
		return;
	dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, &any);
	/* those that were just found do not show events */
	if (bus->n_found || (!ec_xfer(bus->links, &dg, 1) && dg.irq & EC_ECAT_EVENT_DL))
		close_lost(bus);
}

/**
 * ec_ports_watch_found() - slaves that a scan has found, until it lists them
 * @bus: bus
 * @found: slaves with their registers, which stay until the next call; NULL: none any more
 * @n: how many
 *
 * Process data reach them already, and reading their EEPROMs takes long. What they have lost
 * between being let in and now is closed at once.
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_ports_watch_found(struct ec_bus *bus, struct ec_slave **found, unsigned int n)
{
	unsigned int i;

	bus->found = found;
	bus->n_found = n;
	if (!ec_ports_are_guarded(bus))
		return;
	for (i = 0; i < n; i++) {
		if (is_watched(found[i], true) &&
		    without_lost(found[i], found[i]->dl_status, true) != found[i]->ports.loops) {
			close_lost(bus);
			return;
		}
	}
}
