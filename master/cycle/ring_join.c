// SPDX-License-Identifier: GPL-2.0-only
/* Receive of the cycle owner in a ring: each frame has two copies. */
#include <linux/bitops.h>
#include "../base/once64.h"
#include "../wire/merge.h"
#include "ring_join.h"
#include "ring_sides.h"

static void note_move(struct ec_cycle *c)
{
	WRITE_ONCE(c->moves, c->moves + 1);
}

/* Links whose copy was missing, unless late ones show that these do return. */
static void note_mute(struct ec_cycle *c, u8 missing)
{
	u64 late = 0;
	u8 side;

	if (likely(!(missing | c->mute)))
		return;
	for (side = 0; side < EC_MAX_LINKS; side++)
		late += atomic64_read(&c->links->link[side].stats.late);
	c->mute = late == c->copies_late ? missing : 0;
	c->copies_late = late;
}

/* Have both copies changed the same word? Then a slave may have processed both. */
static bool changes_meet(const u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	size_t i, k, n;

	for (i = 0; i < len; i += n) {
		u8 x = 0, y = 0;

		n = min(len - i, sizeof(u64));
		for (k = i; k < i + n; k++) {
			x |= a[k] ^ sent[k];
			y |= b[k] ^ sent[k];
		}
		if (x && y)
			return true;
	}
	return false;
}

/*
 * May a slave have processed both copies of a datagram, as one cable has broken and another one has
 * healed? Its inputs would be joined of two moments. If each copy has passed as many slaves as that
 * of the last frame, the same ones have processed it.
 */
static bool is_doubtful(struct ec_cycle *c, struct ec_cyc_dgram *d, u16 wa, u16 wb,
			const u8 *a, const u8 *b, const u8 *sent)
{
	u64 of = (u64)c->opened << 32 | (u32)wa << 16 | wb;
	bool same = d->of == of;

	if (unlikely(!same)) {
		d->of = of;
		note_move(c);
	}
	if (!wa || !wb)
		return false;
	if (likely(same))
		return !sent;
	return !sent || !ec_cyc_is_complete(d, wa + wb) || changes_meet(a, b, sent, d->len);
}

/**
 * ec_ring_data() - a datagram of an open ring, of which the copies of both ends were processed
 * @c: active cycle
 * @f: frame, for which ec_ring_join() has returned true
 * @d: a datagram of it
 * @at: its data in the reply
 * @irq: result: with the ECAT events of all slaves
 *
 * Mostly slaves of one side only have processed it: its copy is taken unchanged.
 *
 * Context: The cycle owner, in the RCU read section of the receive. RT-safe.
 * Return: its data, with working counter; 0 of one that is not certain, as if no slave had
 * processed it.
 */
const u8 *ec_ring_data(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_cyc_dgram *d,
		       const u8 *at, u16 *irq)
{
	const struct ec_slot *slot = f->slot;
	size_t pos = at - slot->reply;
	/* in memory of the slot, or of the device until its next poll */
	u8 *a = (u8 *)slot->got[EC_MAIN] + pos;
	const u8 *b = slot->got[EC_BACKUP] + pos, *sent;
	u16 wa = get_unaligned_le16(a + d->len), wb = get_unaligned_le16(b + d->len);
	u8 *to = c->links->slots.merged + pos;
	u64 sides;

	*irq |= get_unaligned_le16(a - 2) | get_unaligned_le16(b - 2);
	if (wb)
		c->from_backup |= BIT_ULL(d->domain);
	sent = ec_slot_sent(slot);
	if (sent)
		sent += EC_ETH_HDR + pos;
	if (unlikely(is_doubtful(c, d, wa, wb, a, b, sent))) {
		put_unaligned_le16(0, to + d->len);
		return to;
	}
	if (!wb)
		return a;
	if (!wa)
		return b;
	sides = ec_read64(&d->sides);
	if (likely(sides >> 16 == ec_ring_sides_proof(c->moves, wa, wb))) {
		memcpy(a + (u16)sides, b + (u16)sides, d->len - (u16)sides);
		to = a;
	} else {
		to = ec_merge_data(to, a, b, sent, d->len, &d->cut);
	}
	put_unaligned_le16(wa + wb, to + d->len);
	return to;
}

/**
 * ec_ring_riders() - take the results of what rides in a frame of an open ring
 * @c: active cycle
 * @f: frame, for which ec_ring_join() has returned true
 * @at: riders in the reply, behind the process data
 * @end: end of the reply
 *
 * Those of both copies are merged. If it is not known any more what was sent, they get no result.
 *
 * Context: The cycle owner, in the RCU read section of the receive. RT-safe.
 */
void ec_ring_riders(struct ec_cycle *c, const struct ec_cyc_flight *f, const u8 *at, const u8 *end)
{
	const struct ec_slot *slot = f->slot;
	size_t pos = at - slot->reply, len = end - at;
	const u8 *sent = ec_slot_sent(slot);
	u8 *to = c->links->slots.merged + pos;

	if (!sent)
		return;
	ec_merge_dgrams(to, slot->got[EC_MAIN] + pos, slot->got[EC_BACKUP] + pos,
			sent + EC_ETH_HDR + pos, len);
	ec_riders_take(c->riders, &f->riding, to, to + len);
}

/*
 * A frame of which one link alone has a copy: does the backup link contribute to its domains? A
 * datagram of both sides is none any more.
 */
static void note_single(struct ec_cycle *c, const struct ec_cyc_flight *f, u8 side)
{
	struct ec_cyc_dgram *d = &c->layout.dgrams[f->first];
	const u8 *data = f->slot->got[side] + EC_FRAME_HDR + EC_DGRAM_HDR;
	unsigned int i;

	for (i = 0; i < f->count; i++, d++) {
		if (!(f->queued & BIT_ULL(d->domain)))
			continue;
		if (unlikely(ec_read64(&d->sides))) {
			ec_write64(&d->sides, 0);
			note_move(c);
		}
		if (side == EC_BACKUP && get_unaligned_le16(data + d->len))
			c->from_backup |= BIT_ULL(d->domain);
		data += d->len + EC_DGRAM_OVERHEAD;
	}
}

/**
 * ec_ring_join() - the copies of both ends of a ring: one reply
 * @c: active cycle
 * @f: frame that has returned; clock datagrams have one without domains
 * @slot: its slot, in state DONE
 *
 * A copy that has crossed has passed all slaves, also if the other one was processed by some as the
 * ring was just breaking or healing: their values would be those of two moments.
 *
 * Context: The cycle owner. RT-safe: bounded, no sleep, no allocation.
 * Return: true: both copies have data; ec_ring_data() has those of each datagram, ec_ring_riders()
 * what rides behind them.
 */
bool ec_ring_join(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot)
{
	u8 processed = slot->back & ~slot->blank, crossed = processed & slot->crossed;

	if (!f->count)
		return false;
	note_mute(c, slot->sides & ~slot->back);
	ec_links_note_ring(c->links, slot);
	if (unlikely(c->crossed != !!crossed)) {
		c->crossed = crossed;
		c->opened++;
		note_move(c);
	}
	if (unlikely(slot->sides & ~slot->back))
		note_move(c);
	if (is_power_of_2(crossed)) {
		slot->reply = slot->got[__ffs(crossed)];
		return false;
	}
	if (processed != (BIT(EC_MAIN) | BIT(EC_BACKUP))) {
		if (processed)
			note_single(c, f, processed & BIT(EC_MAIN) ? EC_MAIN : EC_BACKUP);
		return false;
	}
	slot->reply = slot->got[EC_MAIN];
	return true;
}
