// SPDX-License-Identifier: GPL-2.0-only
/*
 * Ring positions are those of the closed ring. In an open one slaves may be missing next to the
 * break: a slave behind it then has another place in the list of slaves. It is counted from the
 * far end, as long as the number of slaves of the whole ring is known. Where that contradicts what
 * is remembered of the devices, there is none: outputs must not reach another slave.
 */
#include <linux/mm.h>
#include "../link/links.h"
#include "known.h"
#include "ring_place.h"
#include "slave.h"

#define ABSENT	0xffff	/* entries of @index */
#define UNSURE	0xfffe

/**
 * ec_ring_places_exit() - free the memory
 * @p: places
 *
 * Context: Process. May sleep.
 */
void ec_ring_places_exit(struct ec_ring_places *p)
{
	kvfree(p->device);
	kvfree(p->index);
	p->device = NULL;
	p->index = NULL;
	p->n = 0;
}

/* The ring is closed: remember its devices. */
static void remember_all(struct ec_ring_places *p, struct ec_slave **slaves, unsigned int n)
{
	unsigned int i;

	if (n != p->n) {
		ec_ring_places_exit(p);
		p->device = kvcalloc(n, sizeof(*p->device), GFP_KERNEL);
		p->index = kvcalloc(n, sizeof(*p->index), GFP_KERNEL);
		if (!p->device || !p->index) {
			ec_ring_places_exit(p);
			return;
		}
		p->n = n;
	}
	for (i = 0; i < n; i++)
		p->device[i] = slaves[i]->device;
}

/* What each position has in an open ring of @n slaves: of those behind the break the last ones. */
static void place_known(const struct ec_bus *bus, struct ec_ring_places *p, unsigned int n)
{
	unsigned int i, at;

	for (i = 0; i < p->n; i++) {
		const struct ec_slave *s = ec_known_slave(bus, p->device[i]);

		p->index[i] = s ? UNSURE : ABSENT;
		if (!s)
			continue;
		at = s->position < p->front ? s->position : s->position + p->n - n;
		if (at == i)
			p->index[i] = s->position;
	}
}

/* A device that is new may have replaced one that is absent, and no other. */
static void place_new(struct ec_ring_places *p, struct ec_slave **slaves, unsigned int n)
{
	unsigned int i, at;

	for (i = 0; i < n && n <= p->n; i++) {
		at = i < p->front ? i : i + p->n - n;
		if (p->index[at] == ABSENT && slaves[i]->device > p->last)
			p->index[at] = i;
	}
}

/**
 * ec_ring_places_note() - the list of slaves has changed
 * @bus: bus
 * @slaves: its list, with their positions in it and device numbers
 * @n: entries in @slaves
 * @whole: it is that of the whole bus
 *
 * Context: The monitor thread, topo held for writing. May sleep.
 */
void ec_ring_places_note(struct ec_bus *bus, struct ec_slave **slaves, unsigned int n, bool whole)
{
	struct ec_ring_places *p = &bus->places;
	u8 state = bus->links->ring.state;

	lockdep_assert_held_write(&bus->topo);
	if (bus->links->only)
		return;
	p->open = state == EC_RING_OPEN;
	p->partial = !whole;
	p->front = min(bus->front, n);
	p->n_list = n;
	p->sure = state == EC_RING_CLOSED && whole && n && !bus->turned;
	if (p->sure) {
		remember_all(p, slaves, n);
		p->last = bus->known.last;
	} else if (p->n) {
		place_known(bus, p, n);
		/* else the list has slaves that are where the scan has not been */
		if (p->open && whole)
			place_new(p, slaves, n);
	}
}

/**
 * ec_ring_places_are_unsure() - are positions not certain although the ring is closed?
 * @bus: bus
 *
 * The bus has changed during the scan; another one makes them certain.
 *
 * Context: The monitor thread.
 * Return: whether they are not.
 */
bool ec_ring_places_are_unsure(const struct ec_bus *bus)
{
	return !bus->links->only && bus->n_slaves && !bus->turned && !bus->places.sure &&
	       bus->links->ring.state == EC_RING_CLOSED;
}

/**
 * ec_ring_places_forget() - what is absent now is absent for good
 * @bus: bus
 *
 * Context: The monitor thread, topo held for writing.
 */
void ec_ring_places_forget(struct ec_bus *bus)
{
	lockdep_assert_held_write(&bus->topo);
	ec_ring_places_exit(&bus->places);
}

/**
 * ec_ring_places_count() - count positions in an open ring that was not seen closed
 * @place: position in the closed ring
 * @front: slaves before the break
 * @n: slaves
 * @total: slaves of the closed ring, by its configurations
 *
 * Context: Any.
 * Return: the place among the @n slaves; -ENOENT: a slave that is absent; -EAGAIN: not certain: a
 * slave may be absent that is not configured.
 */
int ec_ring_places_count(u32 place, u32 front, u32 n, u32 total)
{
	if (place < front)
		return place;
	if (total < n)
		return -EAGAIN;
	if (place < front + total - n)
		return -ENOENT;
	return place - (total - n);
}

/**
 * ec_ring_places_find() - the slave at a position of the closed ring
 * @bus: bus
 * @place: that position
 * @total: slaves of the closed ring, by its configurations
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: where it is in the list, also behind its end; or as ec_ring_places_count().
 */
int ec_ring_places_find(const struct ec_bus *bus, u32 place, u32 total)
{
	const struct ec_ring_places *p = &bus->places;

	ec_bus_assert_stays(bus);
	if (p->sure || (!p->n && (!p->open || p->front >= p->n_list)))
		return min_t(u32, place, INT_MAX);
	if (!p->n && p->partial && place >= p->front)
		return -EAGAIN;
	if (!p->n)
		return ec_ring_places_count(place, p->front, p->n_list, total);
	if (place >= p->n)
		return p->n_list > p->n ? -EAGAIN : -ENOENT;
	if (p->index[place] == UNSURE)
		return -EAGAIN;
	return p->index[place] == ABSENT ? -ENOENT : p->index[place];
}

/**
 * ec_ring_places_misses() - may slaves be missing where the ring is open?
 * @bus: bus
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: whether it is open, and it has not all slaves that it had when it was closed.
 */
bool ec_ring_places_misses(const struct ec_bus *bus)
{
	ec_bus_assert_stays(bus);
	return bus->places.open && bus->places.n != bus->places.n_list;
}

/**
 * ec_ring_places_cut() - is only a cable open where the ring is open?
 * @bus: bus
 *
 * Context: Topo held, or after ec_show_begin(). Reads all positions.
 * Return: whether the slaves before and behind the break followed each other in the closed ring:
 * none is missing there.
 */
bool ec_ring_places_cut(const struct ec_bus *bus)
{
	const struct ec_ring_places *p = &bus->places;
	u32 i = 0, front = p->front;

	ec_bus_assert_stays(bus);
	if (!p->open || !p->n || p->partial)
		return false;
	while (front && i < p->n && p->device[i] != bus->slaves[front - 1]->device)
		i++;
	/* the one that has to follow, or none */
	i += !!front;
	return front < p->n_list ? i < p->n && p->device[i] == bus->slaves[front]->device :
				   i == p->n;
}

/**
 * ec_ring_places_open_between() - is the ring open between two slaves?
 * @bus: bus
 * @a: place of one in the list
 * @b: of the other one, not before it
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: whether slaves may be missing between them.
 */
bool ec_ring_places_open_between(const struct ec_bus *bus, u32 a, u32 b)
{
	ec_bus_assert_stays(bus);
	return bus->places.open && a < bus->places.front && b >= bus->places.front;
}

/**
 * ec_ring_places_of() - the position of a slave in the closed ring
 * @bus: bus
 * @index: where it is in the list
 *
 * Context: Topo held, or after ec_show_begin().
 * Return: position; behind the break of a ring that was not seen closed at least that.
 */
u32 ec_ring_places_of(const struct ec_bus *bus, u32 index)
{
	const struct ec_ring_places *p = &bus->places;

	ec_bus_assert_stays(bus);
	if (!p->open || !p->n || index < p->front || p->n < p->n_list)
		return index;
	return index + p->n - p->n_list;
}
