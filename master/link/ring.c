// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bits.h>
#include "../wire/frame.h"
#include "ring.h"
#include "slots.h"

static bool has_position(u8 cmd)
{
	return cmd == EC_CMD_APRD || cmd == EC_CMD_APWR || cmd == EC_CMD_APRW;
}

/**
 * ec_ring_find_way() - ec_ring_way() in a ring
 * @r: ring
 * @cmd: as there
 * @adp: likewise
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: as there.
 */
struct ec_ring_way ec_ring_find_way(const struct ec_ring *r, u8 cmd, u16 adp)
{
	struct ec_ring_way way = { .sides = BIT(EC_MAIN) | BIT(EC_BACKUP) };
	u32 front;

	/* behind a break frames pass in the other direction, for which no delays are known */
	if (cmd == EC_CMD_FRMW || cmd == EC_CMD_ARMW)
		way.sides = BIT(EC_MAIN);
	if (!has_position(cmd))
		return way;
	front = READ_ONCE(r->front);
	way.sides = BIT(EC_MAIN);
	if ((u16)-adp >= front) {
		way.sides = BIT(EC_BACKUP);
		way.shift = front;
	}
	return way;
}

/**
 * ec_ring_note() - has a copy returned by the link that is expected?
 * @r: ring
 * @slot: frame of the cycle with at least one copy
 *
 * Context: The cycle owner. RT-safe: bounded, no sleep, no allocation.
 * Return: whether the monitor has to look: it has not, for the first time.
 */
bool ec_ring_note(struct ec_ring *r, const struct ec_slot *slot)
{
	bool closed = slot->crossed;

	if (likely(closed == (READ_ONCE(r->state) == EC_RING_CLOSED)) || READ_ONCE(r->news) ||
	    READ_ONCE(r->measured))
		return false;
	WRITE_ONCE(r->news, true);
	return true;
}

/**
 * ec_ring_set() - the state of the ring, as copies of a frame have shown it
 * @r: ring
 * @closed: a copy has returned by the other link
 * @front: slaves that the copy of the main link has passed
 *
 * Context: The monitor thread.
 */
void ec_ring_set(struct ec_ring *r, bool closed, u32 front)
{
	WRITE_ONCE(r->news, false);
	WRITE_ONCE(r->front, front);
	WRITE_ONCE(r->state, closed ? EC_RING_CLOSED : EC_RING_OPEN);
}
