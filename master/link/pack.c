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

#define NOBODY	-1	/* a datagram of a slot that waits no longer */
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

static void let_go(struct ec_slot *slot)
{
	atomic_set_release(&slot->state, EC_SLOT_SENT);
}

/* Hold a slot whose frame waits, so that its caller cannot give it up meanwhile. */
static bool hold(struct ec_slot *slot, u32 seq)
{
	if (atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	if (READ_ONCE(slot->seq) == seq)
		return true;
	let_go(slot);
	return false;
}

/* May it share the frame? */
static bool fits(const struct ec_pack *p, const struct ec_slot *slot,
		 const struct ec_pack_room *room)
{
	if (!p->n)
		return true;
	return p->n < EC_PACK_MAX && slot->dgrams && p->e[0].slot->dgrams &&
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
	if (!hold(e->slot, e->seq))
		return true;
	if (!fits(p, e->slot, room)) {
		let_go(e->slot);
		return false;
	}
	p->e[p->n++] = *e;
	p->len += e->slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	p->dgrams += e->slot->dgrams;
	return true;
}

/* The slots learn where they are in the frame. */
static void locate(struct ec_slots *s, struct ec_pack *p, u8 *src)
{
	u32 seq = atomic_inc_return(&s->seq);
	unsigned int i, at = EC_FRAME_HDR;

	src[1] |= EC_PACKED;
	put_unaligned_le32(seq, src + 2);
	for (i = 0; i < p->n; i++) {
		struct ec_slot *slot = p->e[i].slot;

		slot->pack.len = p->len;
		slot->pack.at = at;
		slot->pack.prev = p->e[i ? i - 1 : 0].slot->index;
		slot->pack.next = p->e[i + 1 < p->n ? i + 1 : i].slot->index;
		WRITE_ONCE(slot->pack.seq, seq);
		at += slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	}
}

/* The frame of a caller as it is. */
static void write_one(struct ec_slot *slot, u8 *buf, u64 sent_ns)
{
	slot->pack.len = 0;
	ec_write64(&slot->sent_ns, sent_ns);
	memcpy(buf, slot->frame, max_t(size_t, slot->eth_len, EC_ETH_MIN));
}

/**
 * ec_pack_write() - write the frame
 * @s: slots
 * @p: the frame, at least one slot in it
 * @buf: EC_ETH_MAX bytes
 * @sent_ns: when it will leave (ktime)
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: bytes of the Ethernet frame, at least EC_ETH_MIN.
 */
size_t ec_pack_write(struct ec_slots *s, struct ec_pack *p, u8 *buf, u64 sent_ns)
{
	size_t len = EC_ETH_HDR + p->len;
	struct ec_frame_buf fb;
	unsigned int i;

	if (p->n == 1) {
		write_one(p->e[0].slot, buf, sent_ns);
		return max_t(size_t, len, EC_ETH_MIN);
	}
	memcpy(buf, p->e[0].slot->frame, EC_ETH_HDR);
	ec_frame_begin(&fb, buf + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	for (i = 0; i < p->n; i++) {
		struct ec_slot *slot = p->e[i].slot;

		ec_write64(&slot->sent_ns, sent_ns);
		ec_frame_append(&fb, ec_slot_body(slot) + EC_FRAME_HDR,
				slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR, slot->last,
				slot->dgrams);
	}
	ec_frame_end(&fb);
	locate(s, p, buf + 6);
	if (len < EC_ETH_MIN)
		memset(buf + len, 0, EC_ETH_MIN - len);
	return max_t(size_t, len, EC_ETH_MIN);
}

/**
 * ec_pack_release() - let go of the slots: from now on they may come back
 * @p: the frame
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_pack_release(struct ec_pack *p)
{
	unsigned int i;

	for (i = 0; i < p->n; i++)
		let_go(p->e[i].slot);
}

/* Hold a slot that waits for its part of the frame with sequence number @seq. */
static bool awaits(struct ec_slot *slot, u32 seq)
{
	if (READ_ONCE(slot->pack.seq) != seq ||
	    atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	if (slot->pack.len && READ_ONCE(slot->pack.seq) == seq)
		return true;
	let_go(slot);
	return false;
}

/* a reply that is looked through */
struct reply {
	const u8 *data;
	struct ec_frame_iter it;
	unsigned int len;	/* bytes behind the EtherType */
	int prev;		/* index of the datagram before, NOBODY: none */
	int next;		/* index that has to come now, END: none, NOBODY: any */
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
static bool look_through(struct ec_slots *s, struct reply *r, u32 seq)
{
	struct ec_dgram d;
	int more;

	for (;;) {
		struct ec_frame_iter at = r->it;
		struct ec_slot *slot;

		more = ec_frame_iter_next(&r->it, &d);
		if (more != 1)
			return !more && (r->next == NOBODY || r->next == END);
		if (r->next != NOBODY && r->next != d.idx)
			return false;
		r->next = NOBODY;
		slot = &s->slot[d.idx];
		if (r->n < EC_PACK_MAX && awaits(slot, seq)) {
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
 * @seq: sequence number of the frame
 * @data: what follows the EtherType
 * @len: bytes there
 * @got: who waits for it; @n is 0 yet
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what became of the frame.
 */
enum ec_match ec_pack_match(struct ec_slots *s, u32 seq, const u8 *data, size_t len,
			    struct ec_matched *got)
{
	struct reply r = { .data = data, .prev = NOBODY, .next = NOBODY };
	unsigned int i;
	bool ok;

	/* the iterator only reads; it has no const form */
	if (ec_frame_iter_init(&r.it, (u8 *)data, len))
		return EC_MATCH_UNMATCHED;
	r.len = r.it.end - data;
	ok = look_through(s, &r, seq);
	for (i = 0; i < r.n; i++) {
		struct ec_slot *slot = r.held[i];

		if (!ok) {
			let_go(slot);
			continue;
		}
		memcpy(ec_slot_body(slot) + EC_FRAME_HDR, data + slot->pack.at,
		       slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR);
		if (slot->xfer)
			got->xfer[got->n++] = slot->xfer;
		atomic_set_release(&slot->state, EC_SLOT_DONE);
	}
	if (!ok)
		return EC_MATCH_UNMATCHED;
	return r.n ? EC_MATCH_DONE : EC_MATCH_LATE;
}
