// SPDX-License-Identifier: GPL-2.0-only
/* Which clocks are behind the break of a ring, for the cycle. */
#include "../bus/graph.h"
#include "../link/links.h"
#include "dc_behind.h"

/* A clock behind the break that is set: @station if it is one, since that has its rate. */
static const struct ec_slave *one_behind(const struct ec_bus *bus, u16 station)
{
	const struct ec_slave *first = NULL;

	ec_for_each_slave(s, bus) {
		if (!ec_graph_is_reversed(s) || !ec_clock_is_set(s))
			continue;
		if (s->station == station)
			return s;
		first = first ?: s;
	}
	return first;
}

/* The reference clock if it is behind the break, else another one. */
static const struct ec_slave *find_behind(const struct ec_dc *dc)
{
	if (READ_ONCE(dc->links->ring.state) != EC_RING_OPEN || !READ_ONCE(dc->ref_station) ||
	    !dc->ref || !ec_clock_is_set(dc->ref))
		return NULL;
	return ec_graph_is_reversed(dc->ref) ? dc->ref : one_behind(dc->bus, dc->behind.station);
}

/**
 * ec_dc_look_behind() - note which clocks are behind the break of a ring
 * @dc: clocks
 * @shift: how much later frames of the backup link reach the clocks there, which were set with it,
 *	ns; NULL: these clocks show it
 *
 * Context: The monitor after a scan, and the worker when clocks were set. May sleep.
 */
void ec_dc_look_behind(struct ec_dc *dc, const s32 *shift)
{
	struct ec_dc_behind *b = &dc->behind;
	const struct ec_slave *s;
	u32 delay, front, slaves;
	u16 station;
	bool ref;

	if (dc->links->only)
		return;
	down_write(&dc->bus->topo);
	s = find_behind(dc);
	front = dc->bus->front;
	slaves = dc->bus->n_slaves;
	station = s ? s->station : 0;
	delay = s ? ec_clock_of(s)->delay : 0;
	ref = s && s == dc->ref;
	if (b->station != station || b->delay != delay || b->front != front || b->ref != ref ||
	    b->slaves != slaves || shift) {
		/* bit 0: the cycle uses none of it; pairs with ec_ring_clock_wanted() */
		WRITE_ONCE(b->number, b->number + 1);
		/* before what follows */
		smp_wmb();
		WRITE_ONCE(b->delay, delay);
		WRITE_ONCE(b->ref, ref);
		WRITE_ONCE(b->front, front);
		WRITE_ONCE(b->slaves, slaves);
		WRITE_ONCE(b->given, shift);
		WRITE_ONCE(b->shift, shift ? *shift : 0);
		WRITE_ONCE(b->station, station);
		/* it begins again when it has seen the number */
		smp_store_release(&b->number, b->number + 1);
	}
	up_write(&dc->bus->topo);
}
