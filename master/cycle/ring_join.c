// SPDX-License-Identifier: GPL-2.0-only
/* Receive of the cycle owner in a ring: each frame has two copies. */
#include <linux/bitops.h>
#include "../wire/merge.h"
#include "ring_join.h"

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
static bool is_doubtful(const struct ec_cycle *c, struct ec_cyc_dgram *d,
			const struct ec_slot *slot, size_t at)
{
	const u8 *a = slot->got[EC_MAIN] + at, *b = slot->got[EC_BACKUP] + at;
	u16 wa = get_unaligned_le16(a + d->len), wb = get_unaligned_le16(b + d->len);
	bool same = d->of_open == c->opened && d->of_main == wa && d->of_backup == wb;

	d->of_open = c->opened;
	d->of_main = wa;
	d->of_backup = wb;
	if (!wa || !wb || likely(same))
		return false;
	return !ec_cyc_is_complete(d, wa + wb) ||
	       changes_meet(a, b, slot->frame + EC_ETH_HDR + at, d->len);
}

/* The copies of both ends of an open ring, without those datagrams that are not certain. */
static void join_open(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot,
		      bool both)
{
	struct ec_cyc_dgram *d = &c->layout.dgrams[f->first];
	size_t at = EC_FRAME_HDR + EC_DGRAM_HDR;
	u8 *to = c->links->slots.merged;
	unsigned int i;

	if (both) {
		ec_merge_frame(to, slot->got[EC_MAIN], slot->got[EC_BACKUP], ec_slot_body(slot),
			       slot->eth_len - EC_ETH_HDR);
		slot->reply = to;
	}
	for (i = 0; i < f->count; i++, d++) {
		if (!(f->queued & BIT_ULL(d->domain)))
			continue;
		if (get_unaligned_le16(slot->got[EC_BACKUP] + at + d->len))
			c->from_backup |= BIT_ULL(d->domain);
		/* as if no slave had processed it */
		if (both && unlikely(is_doubtful(c, d, slot, at)))
			put_unaligned_le16(0, to + at + d->len);
		at += d->len + EC_DGRAM_OVERHEAD;
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
 */
void ec_ring_join(struct ec_cycle *c, const struct ec_cyc_flight *f, struct ec_slot *slot)
{
	u8 processed = slot->back & ~slot->blank, crossed = processed & slot->crossed;

	if (!f->count)
		return;
	note_mute(c, slot->sides & ~slot->back);
	ec_links_note_ring(c->links, slot);
	if (unlikely(c->crossed != !!crossed)) {
		c->crossed = crossed;
		c->opened++;
	}
	if (is_power_of_2(crossed))
		slot->reply = slot->got[__ffs(crossed)];
	else if (processed & BIT(EC_BACKUP))
		join_open(c, f, slot, processed & BIT(EC_MAIN));
}
