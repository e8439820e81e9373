// SPDX-License-Identifier: GPL-2.0-only
#include <linux/ktime.h>
#include "../base/report.h"
#include "../carry/dg.h"
#include "../link/device.h"
#include "../link/links.h"
#include "graph.h"
#include "known.h"
#include "ring_ends.h"
#include "scan_int.h"

#define NOISE_NS	40	/* of receive times */
#define TURNED_NS	(500 * NSEC_PER_MSEC)	/* all scans have to find it for so long */

static void exchange_ends(struct ec_bus *bus)
{
	struct ec_event_more more = { .detail = NULL };
	struct ec_links *l = bus->links;
	char name[EC_UAPI_STRING];

	if (!ec_device_exchange(l))
		return;
	more.detail = ec_links_name(l, EC_MAIN, name, sizeof(name));
	ec_report_more(bus->base, EC_EVENT_RING_EXCHANGED, EC_EVENT_NO_SLAVE, &more, l->exchanged);
}

/**
 * ec_ring_ends_fit() - is the main device at port 0 of the first slave of a closed ring?
 * @bus: bus
 * @dg: a broadcast, with its result
 *
 * The slaves process the copy that arrives there. If that is the copy of the backup device, the
 * links exchange their devices.
 *
 * Context: The monitor thread.
 * Return: false: it was not, so the copies say nothing of positions.
 */
bool ec_ring_ends_fit(struct ec_bus *bus, const struct ec_dg *dg)
{
	if (dg->crossed != (BIT(EC_MAIN) | BIT(EC_BACKUP)) || dg->side_back[EC_MAIN] ||
	    !dg->side_back[EC_BACKUP])
		return true;
	exchange_ends(bus);
	return false;
}

static bool is_read(const struct scan *sc, unsigned int i)
{
	const struct regs *r = &sc->regs[i];

	return r->there && !r->gone && !r->partial &&
	       READ_ONCE(sc->slaves[i]->note.error) != EC_SLAVE_SCAN_FAILED;
}

static u8 open_ports(const struct scan *sc, unsigned int i)
{
	return ec_graph_open_ports(get_unaligned_le16(sc->regs[i].dl));
}

/* Port 0 leads towards the main device. At the first slave behind the break it is closed. */
static bool is_contrary(const struct scan *sc, unsigned int i)
{
	return is_read(sc, i) && (open_ports(sc, i) & BIT(0)) == (i == sc->front ? BIT(0) : 0);
}

enum way {
	UNKNOWN,	/* without receive times, or the frame turned here */
	BY_PORT_0,
	BY_ANOTHER,
};

/* By which port did the frame arrive first? */
static enum way way_in(const struct scan *sc, unsigned int i)
{
	const u8 *recv = sc->regs[i].recv;
	u8 open = open_ports(sc, i);
	unsigned int p, later = 0;

	if (!is_read(sc, i) || !(ec_slave_features(sc->slaves[i]) & EC_FEAT_DC) || !(open & BIT(0)))
		return UNKNOWN;
	for (p = 1; p < EC_MAX_PORT; p++) {
		s32 after = get_unaligned_le32(recv + 4 * p) - get_unaligned_le32(recv);

		if (open & BIT(p) && after < -NOISE_NS)
			return BY_ANOTHER;
		later += open & BIT(p) && after > NOISE_NS;
	}
	return later && later == hweight8(open) - 1 ? BY_PORT_0 : UNKNOWN;
}

/* From the main device frames arrive by port 0, from the backup device by another one. */
static bool came_contrary(const struct scan *sc, unsigned int i)
{
	return way_in(sc, i) == (i < sc->front ? BY_ANOTHER : BY_PORT_0);
}

static bool came_right(const struct scan *sc, unsigned int i)
{
	return way_in(sc, i) == (i < sc->front ? BY_PORT_0 : BY_ANOTHER);
}

/* Is the first slave of each end contrary, and no other? Then frames came to all from there. */
static bool ends_are_exchanged(const struct scan *sc)
{
	unsigned int i;

	for (i = 0; i < sc->n; i++)
		if (is_contrary(sc, i) != (!i || i == sc->front) || came_right(sc, i))
			return false;
	return true;
}

/* A scan may have read a ring whose cables are cut and healed meanwhile, as may the next one. */
static bool turned_stays(const struct scan *sc, u32 at)
{
	struct ec_bus *bus = sc->bus;

	if (sc->turned_before != at)
		bus->turned_ns = ktime_get_ns();
	bus->turned_seen = at;
	return !sc->turned || ktime_get_ns() - bus->turned_ns >= TURNED_NS;
}

/**
 * ec_ring_ends_judge() - are the slaves of an open ring reached by port 0 from the main device?
 * @sc: scan that was proved; @turned is set to a slave that is the wrong way round
 *
 * If all of them are reached from the backup device by it, the links exchange their devices.
 *
 * Context: The monitor thread.
 * Return: 0; -EAGAIN: they have: positions are others now; or more scans are to confirm a slave
 * that is the wrong way round.
 */
int ec_ring_ends_judge(struct scan *sc)
{
	unsigned int i;

	/* the ring changes, or has shown all in one piece */
	if (ec_scan_is_partial(sc) || !sc->calm || sc->bus->links->ring.state != EC_RING_OPEN)
		return 0;
	/* one that is the wrong way round may look like exchanged devices */
	if (sc->bus->turned)
		return 0;
	if (ends_are_exchanged(sc)) {
		exchange_ends(sc->bus);
		return -EAGAIN;
	}
	for (i = 0; i < sc->n && !is_contrary(sc, i) && !came_contrary(sc, i); i++)
		;
	if (i < sc->n)
		sc->turned = sc->slaves[i];
	return turned_stays(sc, i) ? 0 : -EAGAIN;
}

/**
 * ec_ring_ends_note() - remember a slave that is the wrong way round
 * @sc: scan whose result is the list of the bus; device numbers are given
 * @slaves: this list
 * @n: entries in @slaves
 *
 * In a closed ring the copy of the backup device is processed by such slaves, which are counted
 * last. In an open one it may not be seen, so what is known remains.
 *
 * Context: The monitor thread, topo held for writing.
 */
void ec_ring_ends_note(const struct scan *sc, struct ec_slave **slaves, unsigned int n)
{
	struct ec_bus *bus = sc->bus;

	lockdep_assert_held_write(&bus->topo);
	if (ec_scan_is_partial(sc) || !sc->calm || !n)
		return;
	if (bus->links->ring.state == EC_RING_CLOSED)
		bus->turned = sc->front < n ? slaves[sc->front]->device : 0;
	else if (sc->turned)
		bus->turned = sc->turned->device;
}

/**
 * ec_ring_ends_turned() - the slave that is connected the wrong way round
 * @bus: bus
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: that slave, or NULL.
 */
struct ec_slave *ec_ring_ends_turned(const struct ec_bus *bus)
{
	ec_bus_assert_stays(bus);
	return bus->turned ? ec_known_slave(bus, bus->turned) : NULL;
}

/**
 * ec_ring_ends_branch() - a branch by which frames of the main device do not pass the whole ring
 * @bus: bus
 * @port: result: its port
 *
 * Frames pass the ports of a slave in the order 0, 3, 1, 2. A branch behind the port of the ring is
 * reached by the backup device only; one that leads back to the same slave leads frames back to the
 * device that has sent them. Both show as ports by which frames leave, without a known slave.
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: slave with the branch, or NULL: there is none.
 */
struct ec_slave *ec_ring_ends_branch(const struct ec_bus *bus, unsigned int *port)
{
	struct ec_slave *first = NULL;
	unsigned int free = 0, p;

	ec_bus_assert_stays(bus);
	ec_for_each_slave(s, bus) {
		if (s->position >= READ_ONCE(bus->front))
			break;
		for (p = 1; p < EC_MAX_PORT; p++)
			free += ec_graph_is_open(s, p) && !s->graph.at[p];
		if (free && !first) {
			first = s;
			*port = ec_graph_free_port(s);
		}
	}
	/* that of a closed ring leads to the backup device */
	return free > (READ_ONCE(bus->links->ring.state) == EC_RING_CLOSED) ? first : NULL;
}

/**
 * ec_ring_ends_report() - an event and a line if a slave is the wrong way round
 * @bus: bus with its new list
 *
 * Context: The monitor thread.
 */
void ec_ring_ends_report(struct ec_bus *bus)
{
	struct ec_slave *s;

	if (bus->turned == bus->turned_told)
		return;
	bus->turned_told = bus->turned;
	down_read(&bus->topo);
	s = ec_ring_ends_turned(bus);
	if (s)
		ec_slave_report(s, EC_EVENT_RING_TURNED);
	up_read(&bus->topo);
}
