// SPDX-License-Identifier: GPL-2.0-only
#include "links.h"
#include "ring.h"

static bool has_position(u8 cmd)
{
	return cmd == EC_CMD_APRD || cmd == EC_CMD_APWR || cmd == EC_CMD_APRW;
}

/**
 * ec_ring_find_way() - ec_ring_way() in a ring
 * @l: links, several
 * @cmd: as there
 * @adp: likewise
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: as there.
 */
struct ec_ring_way ec_ring_find_way(const struct ec_links *l, u8 cmd, u16 adp)
{
	struct ec_ring_way way = { .sides = l->sides };
	u32 front;

	/* behind a break frames pass in the other direction, for which no delays are known */
	if (cmd == EC_CMD_FRMW || cmd == EC_CMD_ARMW)
		way.sides = BIT(EC_MAIN);
	if (!has_position(cmd))
		return way;
	front = READ_ONCE(l->ring.front);
	way.sides = BIT(EC_MAIN);
	if ((u16)-adp >= front) {
		way.sides = BIT(EC_BACKUP);
		way.shift = front;
	}
	return way;
}

/**
 * ec_ring_note() - has a copy returned by the link that is expected?
 * @l: links, several
 * @slot: frame of the cycle with at least one copy
 *
 * Context: The cycle owner. RT-safe: bounded, no sleep, no allocation.
 */
void ec_ring_note(struct ec_links *l, const struct ec_slot *slot)
{
	bool closed = slot->crossed;

	if (likely(closed == (READ_ONCE(l->ring.state) == EC_RING_CLOSED)) ||
	    READ_ONCE(l->ring.news))
		return;
	WRITE_ONCE(l->ring.news, true);
	if (l->ops && l->ops->event)
		l->ops->event(l);
}

/**
 * ec_ring_set() - the state of the ring, as copies of a frame have shown it
 * @l: links, several
 * @closed: a copy has returned by the other link
 * @front: slaves that the copy of the main link has passed
 *
 * Context: The monitor thread.
 * Return: whether it has changed.
 */
bool ec_ring_set(struct ec_links *l, bool closed, u32 front)
{
	struct ec_ring *r = &l->ring;
	u8 state = closed ? EC_RING_CLOSED : EC_RING_OPEN;
	bool changed = r->state != state || r->front != front;

	WRITE_ONCE(r->news, false);
	WRITE_ONCE(r->front, front);
	WRITE_ONCE(r->state, state);
	return changed;
}
