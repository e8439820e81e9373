// SPDX-License-Identifier: GPL-2.0-only
/* What the monitor asks before a scan: the number of slaves, and whether ports have changed. */
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/slab.h>
#include "../base/limits.h"
#include "../base/report.h"
#include "../link/links.h"
#include "../carry/xfer.h"
#include "ring_ends.h"
#include "scan_count.h"
#include "scan_int.h"

#define TRIES		2	/* to count */
#define PROBE_NS	NSEC_PER_SEC	/* between probes of a mute link */

/**
 * ec_scan_count() - count the slaves
 * @bus: bus
 *
 * Context: Process. Waits for bus traffic.
 * Return: slaves that a frame passes; negative: as ec_xfer().
 */
int ec_scan_count(struct ec_bus *bus)
{
	u8 type[1] = { 0 };
	struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, type);
	bool seen = false;
	int ret = 0, try;

	/* a copy that is lost once says nothing of the ring */
	for (try = 0; try < TRIES && !ret && !seen; try++) {
		ret = ec_xfer(bus->links, &dg, 1);
		seen = !ret && ec_scan_see_ring(bus, &dg, try + 1 == TRIES);
	}
	return ret ?: dg.back;
}

/**
 * ec_scan_count_again() - are the slaves still as many as when a scan began?
 * @sc: scan
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: 1: they are, on each side of a break of a ring; 0: they are not; negative: as ec_xfer().
 */
int ec_scan_count_again(const struct scan *sc)
{
	int count = ec_scan_count(sc->bus);

	return count < 0 ? count :
	       count == sc->n && READ_ONCE(sc->bus->links->ring.front) == sc->front;
}

static bool came(const struct ec_dg *dg, unsigned int side)
{
	return dg->side_wkc[side] != EC_DG_NO_COPY;
}

/* Has one copy crossed and the other one returned? Then a cable has opened or closed meanwhile. */
static bool is_torn(const struct ec_dg *dg)
{
	unsigned int side;

	for (side = 0; side < EC_MAX_LINKS && dg->crossed; side++)
		if (came(dg, side) && !(dg->crossed & BIT(side)))
			return true;
	return false;
}

/* A link whose copies never return although it is up is not used until one does. */
static void note_copies(struct ec_bus *bus, const struct ec_dg *dg)
{
	struct ec_link *link;

	ec_links_for_each(bus->links, link) {
		/* one that has crossed was received by the other device */
		if (came(dg, link->side) || dg->crossed)
			ec_link_hears(link);
		else if (ec_link_is_up(link) && ec_link_missed(link))
			ec_warn(bus,
				"%s link up, but no frame returns: not used until one does; check that its cable leads to a slave of the ring, without a switch\n",
				link->side ? "backup" : "main");
	}
}

/* Has a mute link a slave again? The next look sends on both links. */
static void probe(struct ec_bus *bus)
{
	u64 now = ktime_get_ns();
	struct ec_link *link;
	u8 type[1];

	if (now - bus->probe_ns < PROBE_NS)
		return;
	bus->probe_ns = now;
	ec_links_for_each(bus->links, link) {
		struct ec_dg dg = EC_DG(EC_CMD_BRD, 0, EC_REG_TYPE, 1, type);

		if (!READ_ONCE(link->mute) || ec_xfer_probe(bus->links, &dg, link->side))
			continue;
		ec_link_hears(link);
		WRITE_ONCE(bus->links->ring.news, true);
	}
}

/**
 * ec_scan_look_at_mute() - probe a mute link of a ring
 * @bus: bus
 *
 * Context: The monitor thread. Waits for bus traffic.
 */
void ec_scan_look_at_mute(struct ec_bus *bus)
{
	if (!READ_ONCE(bus->links->only))
		probe(bus);
}

/**
 * ec_scan_see_ring() - take the state of the ring from the copies of a broadcast
 * @bus: bus
 * @dg: the broadcast, with its result
 * @last: a copy that is missing although its link is up is lost behind a device that does not
 *	answer, not only this time
 *
 * Context: The monitor thread.
 * Return: false: a copy is missing, so the number of slaves is not known.
 */
bool ec_scan_see_ring(struct ec_bus *bus, const struct ec_dg *dg, bool last)
{
	struct ec_links *l = bus->links;
	const struct ec_link *link;

	if (READ_ONCE(l->only))
		return true;
	ec_links_for_each(l, link)
		if (!came(dg, link->side) && !last && !READ_ONCE(link->mute) && ec_link_is_up(link))
			return false;
	if (is_torn(dg) && !last)
		return false;
	if (READ_ONCE(l->ring.measured) && came(dg, EC_MAIN) &&
	    dg->side_back[EC_MAIN] == bus->n_slaves)
		return true;
	/* the copy that the slaves of a closed ring have processed is missing */
	if (dg->crossed && !dg->back)
		return false;
	if (!ec_ring_ends_fit(bus, dg))
		return false;
	/* nothing returns from a port that is closed to measure delays */
	if (!READ_ONCE(l->ring.measured))
		note_copies(bus, dg);
	ec_ring_set(&l->ring, dg->crossed, came(dg, EC_MAIN) ? dg->side_back[EC_MAIN] : 0);
	return true;
}

/* Has a slave other ports than the list says, or has one shown an event without such a reason? */
static bool is_other(struct ec_slave *s, u16 dl, u16 *reason)
{
	u16 before = s->dl_seen ?: s->dl_status;

	/* its PDI came or went */
	*reason |= (dl ^ before) & ~EC_SCAN_PORTS;
	s->dl_seen = dl;
	return (dl ^ s->dl_status) & EC_SCAN_PORTS;
}

/**
 * ec_scan_worth() - read all ports: is a scan worth it?
 * @bus: bus
 * @event: a slave has shown the event of its DL status
 *
 * Reads the DL status of all, which clears the events.
 *
 * Context: The monitor thread. Waits for bus traffic.
 * Return: whether ports have changed, or the event has no other reason.
 */
bool ec_scan_worth(struct ec_bus *bus, bool event)
{
	struct ec_dg *dg = kvcalloc(bus->n_slaves + 1, sizeof(*dg), GFP_KERNEL);
	u8 (*dl)[2] = kvcalloc(bus->n_slaves + 1, sizeof(*dl), GFP_KERNEL);
	bool other = !dg || !dl;
	unsigned int n = 0;
	u16 reason = 0;

	if (!other) {
		ec_for_each_slave(s, bus) {
			dg[n] = EC_FPRD(s->station, EC_REG_DL_STATUS, 2, dl[n]);
			n++;
		}
		ec_xfer(bus->links, dg, n);
		ec_for_each_slave(s, bus) {
			const struct ec_dg *d = &dg[s->position];

			if (!d->err && d->wkc == 1)
				other |= is_other(s, get_unaligned_le16(dl[s->position]), &reason);
		}
	}
	kvfree(dg);
	kvfree(dl);
	return other || (event && !reason);
}

/**
 * ec_scan_limit() - how many slaves a scan accepts
 *
 * A broken or hostile slave can change a frame, but the master allocates at most a part
 * of the memory of the computer.
 *
 * Context: Any.
 * Return: slaves.
 */
unsigned int ec_scan_limit(void)
{
	u64 bytes = (u64)totalram_pages() << PAGE_SHIFT;

	return clamp_t(u64, div_u64(bytes, EC_SLAVES_RAM * EC_SLAVE_BYTES), EC_MIN_SLAVES,
		       EC_MAX_SLAVES);
}
