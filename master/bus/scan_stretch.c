// SPDX-License-Identifier: GPL-2.0-only
/*
 * What a scan has found differs from the list of the bus in some places. Between two slaves that
 * are where they were, each such place is a stretch of its own.
 */
#include <linux/slab.h>
#include "scan_int.h"
#include "scan_stretch.h"

#define NOWHERE	U16_MAX

/* two numbers for each slave */
struct order {
	u16 *at;	/* where the scan has found a slave of the list */
	u16 *rank;	/* of a known slave that was found: its number among these, in the list */
};

static void fill_order(const struct scan *sc, struct order *o)
{
	const struct ec_bus *bus = sc->bus;
	unsigned int i, rank = 0;

	memset(o->at, 0xff, bus->n_slaves * sizeof(*o->at));
	for (i = 0; i < sc->n; i++)
		if (ec_scan_is_known(sc, sc->slaves[i]))
			o->at[sc->slaves[i]->position] = i;
	for (i = 0; i < bus->n_slaves; i++)
		if (o->at[i] != NOWHERE)
			o->rank[o->at[i]] = rank++;
}

static void stretch_add(struct scan *sc, struct stretch t, unsigned int old_end,
			unsigned int new_end)
{
	t.n_old = old_end - t.old;
	t.n_new = new_end - t.new;
	if (t.n_old || t.n_new)
		sc->stretch[sc->n_stretches++] = t;
}

/*
 * A known slave separates two stretches if the same known ones are before it as in the list. One
 * that was moved, and those between its places, are in one stretch.
 */
static void separate(struct scan *sc, const struct order *o)
{
	unsigned int i, seen = 0, begin = 0, highest = 0;
	struct stretch t = { 0 };

	for (i = 0; i < sc->n; i++) {
		const struct ec_slave *s = sc->slaves[i];

		if (!ec_scan_is_known(sc, s))
			continue;
		highest = max_t(unsigned int, highest, o->rank[i]);
		if (highest != seen++)
			continue;
		/* the slaves since @begin are those of the list, in some order */
		if (begin == highest) {
			stretch_add(sc, t, s->position, i);
			t = (struct stretch){ .old = s->position + 1, .new = i + 1 };
		}
		begin = seen;
	}
	stretch_add(sc, t, sc->bus->n_slaves, sc->n);
}

/**
 * ec_scan_stretches() - find where the bus is not as in its list
 * @sc: scan that has read everything
 *
 * Context: The monitor thread.
 * Return: 0 or -ENOMEM.
 */
int ec_scan_stretches(struct scan *sc)
{
	struct order o = {
		.at = kvcalloc(sc->bus->n_slaves + 1, sizeof(*o.at), GFP_KERNEL),
		.rank = kvcalloc(sc->n + 1, sizeof(*o.rank), GFP_KERNEL),
	};
	int ret = o.at && o.rank ? 0 : -ENOMEM;

	if (!ret) {
		fill_order(sc, &o);
		separate(sc, &o);
	}
	kvfree(o.at);
	kvfree(o.rank);
	return ret;
}
