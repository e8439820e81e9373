// SPDX-License-Identifier: GPL-2.0-only
/*
 * Frames of several callers that leave as one: what a cyclic send may carry is limited
 * by frames, and most callers have a single short datagram.
 *
 * The frame has a sequence number of its own and a mark in its source address. Each
 * datagram keeps the index of its slot, so what comes back is dealt out by index, and no
 * slot depends on another: a caller may give up at any time. A slot takes its part only
 * where it was in the frame, between the same neighbours; when a part of a slot that
 * still waits is not as it was sent, no slot takes anything.
 */
#include <linux/atomic.h>
#include <linux/string.h>
#include "../base/once64.h"
#include "pack.h"
#include "same.h"

#define NONE	-1	/* a datagram of a slot that waits no longer */
#define END	256	/* behind the last datagram */

/**
 * ec_pack_begin() - begin a frame that several callers may share
 * @p: the frame
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_pack_begin(struct ec_pack *p)
{
	p->n = 0;
	p->len = EC_FRAME_HDR;
	p->dgrams = 0;
}

/* May it share the frame? */
static bool fits(const struct ec_pack *p, const struct ec_slot *slot,
		 const struct ec_pack_room *room)
{
	if (!p->n)
		return true;
	return p->n < EC_PACK_MAX && slot->dgrams && p->e[0].slot->dgrams &&
	       slot->links == p->e[0].slot->links &&
	       p->dgrams + slot->dgrams <= room->dgrams &&
	       p->len + slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR <= room->len;
}

/**
 * ec_pack_add() - add the frame of a caller
 * @p: the frame they share
 * @e: slot; nothing is added when its caller has given up
 * @room: what the frame may hold; the first slot always fits
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: false when it does not fit.
 */
bool ec_pack_add(struct ec_pack *p, const struct ec_queued *e, const struct ec_pack_room *room)
{
	if (!ec_slot_hold(e->slot, EC_SLOT_QUEUED, e->seq))
		return true;
	if (!fits(p, e->slot, room)) {
		ec_slot_release(e->slot, EC_SLOT_QUEUED);
		return false;
	}
	p->e[p->n++] = *e;
	p->len += e->slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	p->dgrams += e->slot->dgrams;
	return true;
}

/**
 * ec_pack_place() - note in the slots where they are in the frame
 * @s: slots
 * @p: the frame, at least one slot in it
 * @sent_ns: when it will leave (ktime)
 *
 * A frame of one slot leaves as it is.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_pack_place(struct ec_slots *s, struct ec_pack *p, u64 sent_ns)
{
	u32 seq = p->n > 1 ? atomic_inc_return(&s->seq) : 0;
	unsigned int i, at = EC_FRAME_HDR;

	for (i = 0; i < p->n; i++) {
		struct ec_slot *slot = p->e[i].slot;

		ec_write64(&slot->sent_ns, sent_ns);
		slot->pack.len = p->n > 1 ? p->len : 0;
		slot->pack.at = at;
		slot->pack.prev = p->e[i ? i - 1 : 0].slot->index;
		slot->pack.next = p->e[i + 1 < p->n ? i + 1 : i].slot->index;
		WRITE_ONCE(slot->pack.seq, seq);
		at += slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	}
}

/**
 * ec_pack_write() - write the frame
 * @p: the frame, placed
 * @buf: EC_ETH_MAX bytes
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: bytes of the Ethernet frame, at least EC_ETH_MIN.
 */
size_t ec_pack_write(const struct ec_pack *p, u8 *buf)
{
	size_t len = EC_ETH_HDR + p->len;
	struct ec_frame_buf fb;
	unsigned int i;

	if (p->n == 1) {
		len = max_t(size_t, len, EC_ETH_MIN);
		memcpy(buf, p->e[0].slot->frame, len);
		return len;
	}
	memcpy(buf, p->e[0].slot->frame, EC_ETH_HDR);
	buf[7] |= EC_PACKED;
	put_unaligned_le32(p->e[0].slot->pack.seq, buf + 8);
	ec_frame_begin(&fb, buf + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	for (i = 0; i < p->n; i++) {
		struct ec_slot *slot = p->e[i].slot;

		ec_frame_append(&fb, ec_slot_body(slot) + EC_FRAME_HDR,
				slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR, slot->last,
				slot->dgrams);
	}
	ec_frame_end(&fb);
	if (len < EC_ETH_MIN)
		memset(buf + len, 0, EC_ETH_MIN - len);
	return max_t(size_t, len, EC_ETH_MIN);
}

/**
 * ec_pack_release() - let go of the slots
 * @p: the frame
 * @state: SENT: from now on they may come back; QUEUED: the frame was not written
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_pack_release(struct ec_pack *p, enum ec_slot_state state)
{
	unsigned int i;

	for (i = 0; i < p->n; i++)
		ec_slot_release(p->e[i].slot, state);
}

/**
 * ec_pack_move() - change the state of slots that have been released
 * @p: the frame
 * @from: their state; those that have another one by now keep that
 * @to: new state
 *
 * Context: The owner of the links. RT-safe.
 */
void ec_pack_move(struct ec_pack *p, enum ec_slot_state from, enum ec_slot_state to)
{
	unsigned int i;

	for (i = 0; i < p->n; i++)
		if (ec_slot_hold(p->e[i].slot, from, p->e[i].seq))
			ec_slot_release(p->e[i].slot, to);
}

/* Hold a slot that waits for its part of the frame with sequence number @seq. */
static bool awaits(struct ec_slot *slot, u32 seq, u8 side)
{
	if (READ_ONCE(slot->pack.seq) != seq ||
	    atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	if (slot->pack.len && READ_ONCE(slot->pack.seq) == seq && ec_slot_awaits(slot, side))
		return true;
	ec_slot_release(slot, EC_SLOT_SENT);
	return false;
}

/* a reply that is looked through */
struct reply {
	const u8 *data;
	struct ec_frame_iter it;
	unsigned int len;	/* bytes behind the EtherType */
	u32 seq;
	u8 side;
	int prev;		/* index of the datagram before, NONE: none */
	int next;		/* index that has to come now, END: none, NONE: any */
	struct ec_slot *held[EC_PACK_MAX];
	unsigned int n;
};

/* Is the part of a slot that was found at @at as it was sent? Goes behind it then. */
static bool take_part(struct reply *r, struct ec_slot *slot, struct ec_frame_iter at)
{
	const struct ec_packed *pack = &slot->pack;

	if (pack->len != r->len || pack->at != at.p - r->data ||
	    (pack->prev != slot->index && pack->prev != r->prev) || !ec_slot_same(slot, &at))
		return false;
	r->it = at;
	r->next = pack->next == slot->index ? END : pack->next;
	return true;
}

/* Hold all slots that wait for the reply; false: something of it is not as it was sent. */
static bool look_through(struct ec_slots *s, struct reply *r)
{
	struct ec_dgram d;
	int more;

	for (;;) {
		struct ec_frame_iter at = r->it;
		struct ec_slot *slot;

		more = ec_frame_iter_next(&r->it, &d);
		if (more != 1)
			return !more && (r->next == NONE || r->next == END);
		if (r->next != NONE && r->next != d.idx)
			return false;
		r->next = NONE;
		slot = &s->slot[d.idx];
		if (r->n < EC_PACK_MAX && awaits(slot, r->seq, r->side)) {
			r->held[r->n++] = slot;
			if (!take_part(r, slot, at))
				return false;
		}
		r->prev = d.idx;
	}
}

/**
 * ec_pack_match() - find the slots of a received frame that callers share, fill them
 * @s: slots
 * @src: source MAC address of the frame
 * @data: what follows the EtherType
 * @len: bytes there
 * @got: result: who waits for it
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what became of the frame.
 */
enum ec_match ec_pack_match(struct ec_slots *s, const u8 *src, const u8 *data, size_t len,
			    struct ec_pack_matched *got)
{
	struct reply r = {
		.data = data, .seq = get_unaligned_le32(src + 2), .side = src[1] & ~EC_PACKED,
		.prev = NONE, .next = NONE,
	};
	struct ec_xfer *xfer;
	unsigned int i;
	bool ok;

	got->n = 0;
	/* the iterator only reads; it has no const form */
	if (ec_frame_iter_init(&r.it, (u8 *)data, len))
		return EC_MATCH_UNMATCHED;
	r.len = r.it.end - data;
	ok = look_through(s, &r);
	for (i = 0; i < r.n; i++) {
		struct ec_slot *slot = r.held[i];

		if (!ok) {
			ec_slot_release(slot, EC_SLOT_SENT);
			continue;
		}
		xfer = ec_slot_take(slot, r.side, data + slot->pack.at);
		if (xfer)
			got->xfer[got->n++] = xfer;
	}
	if (!ok)
		return EC_MATCH_UNMATCHED;
	return r.n ? EC_MATCH_DONE : EC_MATCH_LATE;
}
