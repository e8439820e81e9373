// SPDX-License-Identifier: GPL-2.0-only
/*
 * In an open ring the list of slaves says which of them are behind the break, and the layout where
 * the inputs of each are. Mostly these are in the order of the slaves: then up to a place they are
 * those of the main link, from there on those of the backup link.
 *
 * The cycle uses the place as long as the working counters prove it. No slave adds more than all
 * its FMMUs do. The copy of the main link has passed the first slaves of the ring, that of the
 * backup link the last ones. If one has the working counter of all slaves before the break, and the
 * other one that of all behind it, each slave has processed the copy from which its inputs are
 * taken. A slave could be on the other side only after its cables were pulled, and plugged in
 * there: its working counter was missing meanwhile, see @moves.
 */
#include "../base/once64.h"
#include "../bus/slave.h"
#include "../config/config.h"
#include "../config/domain.h"
#include "cycle.h"
#include "ring_sides.h"

#define MOST_US	10000	/* of a cycle: a cable is not plugged in so fast */

/** struct side - what slaves of one side do with a datagram */
struct side {
	/** @wkc: they add to its working counter */
	u32 wkc;
	/** @begin: of their inputs in it, bytes */
	u32 begin;
	/** @end: of these */
	u32 end;
};

/* What the slave of a configuration adds to the working counter; its inputs are added to @side. */
static u32 add_config(const struct ec_config *s, const struct ec_domain *dom,
		      const struct ec_cyc_dgram *d, struct side *side)
{
	u32 start = d->logical - dom->offset;
	bool out = false, in = false;
	unsigned int i;

	for (i = 0; i < s->n_fmmus; i++) {
		const struct ec_config_fmmu *f = &s->fmmus[i];
		u32 from = max(f->logical, start), to = min(f->logical + f->size, start + d->len);

		if (f->domain != dom || from >= to)
			continue;
		if (f->dir == EC_CFG_DIR_OUTPUT) {
			out = true;
			continue;
		}
		in = true;
		side->begin = min(side->begin, from - start);
		side->end = max(side->end, to - start);
	}
	switch (d->cmd) {
	case EC_CMD_LRW:
		return 2 * out + in;
	case EC_CMD_LWR:
		return out;
	default:
		return in;
	}
}

/* Both sides of a datagram. */
static void find_sides(const struct ec_cycle *c, const struct ec_domain *dom,
		       const struct ec_cyc_dgram *d, struct side *sides)
{
	unsigned int side;

	lockdep_assert_held(c->wanted->lock);
	for (side = 0; side < EC_MAX_LINKS; side++)
		sides[side] = (struct side){ .begin = d->len };
	ec_for_each_config(s, c->wanted) {
		if (!s->slave)
			continue;
		side = s->slave->position < c->wanted->bus->front ? EC_MAIN : EC_BACKUP;
		sides[side].wkc += add_config(s, dom, d, &sides[side]);
	}
}

static void publish(struct ec_cycle *c, u16 moves)
{
	struct side sides[EC_MAX_LINKS], *a = &sides[EC_MAIN], *b = &sides[EC_BACKUP];
	unsigned int i;

	down_read(&c->wanted->bus->topo);
	ec_for_each_domain(dom, c->wanted) {
		for (i = 0; i < c->layout.n_dgrams; i++) {
			struct ec_cyc_dgram *d = &c->layout.dgrams[i];
			u64 known = 0;

			if (d->domain != dom->index)
				continue;
			find_sides(c, dom, d, sides);
			if (a->wkc && b->wkc && a->wkc + b->wkc <= U16_MAX && a->end <= b->begin)
				known = ec_ring_sides_proof(moves, a->wkc, b->wkc) << 16 | b->begin;
			ec_write64(&d->sides, known);
		}
	}
	up_read(&c->wanted->bus->topo);
}

/* Without frames no working counter shows that a slave has changed its side. */
static void forget_sides(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->layout.n_dgrams; i++)
		ec_write64(&c->layout.dgrams[i].sides, 0);
}

/**
 * ec_ring_sides_look() - find out on which side of a break the data of each datagram are
 * @c: active cycle
 * @scanned: the slaves are those of the last scan
 *
 * That is known when two looks in a row find nothing that has changed, until one finds a change.
 *
 * Context: The monitor thread, lock of the configuration held. May sleep.
 */
void ec_ring_sides_look(struct ec_cycle *c, bool scanned)
{
	const struct ec_bus *bus = c->wanted->bus;
	struct ec_links *l = c->links;
	struct ec_ring_look *look = &c->ring_look, now = {
		.moves = READ_ONCE(c->moves), .changes = atomic_read(&bus->changes),
		.steady = !l->only && scanned && READ_ONCE(l->ring.state) == EC_RING_OPEN &&
			  bus->front == l->ring.front && !READ_ONCE(l->ring.news) &&
			  ec_access_is_cyclic(&l->access) &&
			  ec_access_interval_us(&l->access) <= MOST_US,
	};

	lockdep_assert_held(c->wanted->lock);
	if (l->only)
		return;
	if (now.steady && look->steady && now.moves == look->moves &&
	    now.changes == look->changes) {
		if (!look->known)
			publish(c, now.moves);
		now.known = true;
	} else if (look->known) {
		forget_sides(c);
	}
	*look = now;
}
