// SPDX-License-Identifier: GPL-2.0-only
#include <linux/nospec.h>
#include <linux/slab.h>
#include "absent.h"
#include "known.h"
#include "ring_place.h"
#include "slave.h"

#define NOWHERE	U64_MAX	/* root of a slave of whose place nothing is known */

/* Where does the way to @l break? As for what was lost with it, or later. */
static u64 find_root(const struct ec_bus *bus, const struct ec_lost *l, unsigned int n_slaves,
		     u8 *port)
{
	const struct ec_lost *up = l;
	unsigned int i;

	for (i = 0; up && i <= bus->known.n_lost; i++) {
		bool found = up->rooted == bus->lists;
		u64 root = found ? up->root : up->up;
		const struct ec_slave *s = ec_known_slave(bus, root);

		*port = found ? up->root_port : up->up_port;
		if (root == NOWHERE || (!root && n_slaves))
			return NOWHERE;
		/* another slave is connected there */
		if (s && (*port >= EC_MAX_PORT || s->graph.at[*port]))
			return NOWHERE;
		if (s || !root)
			return root;
		up = ec_known_lost(bus, root);
	}
	return NOWHERE;
}

/* Is it known where the way to it breaks, and is it of interest? */
static bool absent_root(struct ec_bus *bus, struct ec_lost *l, unsigned int n_slaves)
{
	lockdep_assert_held_write(&bus->topo);
	l->rooted = 0;
	if (l->forgotten || !(l->vendor || l->product))
		return false;
	l->root = find_root(bus, l, n_slaves, &l->root_port);
	/* for those that were lost with it */
	l->rooted = bus->lists;
	return l->root != NOWHERE;
}

/* The entry of its port; NULL: there are too many. */
static struct ec_absent *absent_entry_of(struct ec_known *k, const struct ec_lost *l)
{
	struct ec_absent *a;

	for (a = k->absent; a < k->absent + k->n_absent; a++)
		if (a->up == l->root && a->port == l->root_port)
			return a;
	if (k->n_absent >= EC_MAX_ABSENT)
		return NULL;
	*a = (struct ec_absent){
		.up = l->root, .port = l->root_port, .first = U16_MAX, .seen_ns = l->seen_ns,
	};
	k->n_absent++;
	return a;
}

static void absent_add(struct ec_known *k, const struct ec_lost *l)
{
	struct ec_absent *a = absent_entry_of(k, l);

	if (!a)
		return;
	a->n++;
	a->last = max(a->last, l->position);
	a->seen_ns = min(a->seen_ns, l->seen_ns);
	if (l->position < a->first) {
		a->first = l->position;
		strscpy(a->label, l->label, sizeof(a->label));
	}
}

/**
 * ec_absent_update() - list the absent slaves by port
 * @bus: bus; the slaves of the new list have their numbers and their places in the graph
 * @n_slaves: of the new list
 *
 * A port behind which another slave is now has none. Without memory nothing is listed.
 *
 * Context: The monitor thread, topo held for writing, after ec_show_change_begin(). May sleep.
 */
void ec_absent_update(struct ec_bus *bus, unsigned int n_slaves)
{
	struct ec_known *k = &bus->known;
	struct ec_lost *l;

	lockdep_assert_held_write(&bus->topo);
	k->n_absent = 0;
	if (list_empty(&k->oldest))
		return;
	k->absent = k->absent ?: kcalloc(EC_MAX_ABSENT, sizeof(*k->absent), GFP_KERNEL);
	if (!k->absent)
		return;
	list_for_each_entry(l, &k->oldest, age)
		if (absent_root(bus, l, n_slaves))
			absent_add(k, l);
}

/**
 * ec_absent_forget() - slaves that are absent now are absent for good
 * @bus: bus
 *
 * Their numbers are kept.
 *
 * Context: The monitor thread. May sleep.
 */
void ec_absent_forget(struct ec_bus *bus)
{
	struct ec_lost *l;

	down_write(&bus->topo);
	ec_show_change_begin(&bus->base->show);
	list_for_each_entry(l, &bus->known.oldest, age)
		l->forgotten = true;
	bus->known.n_absent = 0;
	ec_ring_places_forget(bus);
	ec_show_change_end(&bus->base->show);
	up_write(&bus->topo);
}

/**
 * ec_absent_get() - absent slaves behind a port
 * @bus: bus
 * @index: of the port, from 0
 * @a: result; without slaves behind the last one
 *
 * Context: Topo held, or after ec_show_begin().
 */
void ec_absent_get(const struct ec_bus *bus, unsigned int index, struct ec_absent *a)
{
	ec_bus_assert_stays(bus);
	*a = (struct ec_absent){ 0 };
	if (index < bus->known.n_absent)
		*a = bus->known.absent[array_index_nospec(index, bus->known.n_absent)];
}
