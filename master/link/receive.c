// SPDX-License-Identifier: GPL-2.0-only
/* Received frames: the slot that each belongs to. */
#include <linux/export.h>
#include <linux/rcupdate.h>
#include "capture.h"
#include "device.h"
#include "links.h"
#include "same.h"

/* Does the reply carry the same datagrams as the frame that was sent, and no more? */
static __always_inline bool same(struct ec_slot *slot, const u8 *reply, size_t len, u16 *touched)
{
	struct ec_frame_iter ri;

	/* the iterator only reads; it has no const form */
	return !ec_frame_iter_init(&ri, (u8 *)reply, len) &&
	       ec_slot_same(slot, &ri, touched) && !ri.more && ri.p == ri.end;
}

/* Enter the state FILL of the slot that awaits the copy of a link. */
static __always_inline enum ec_match hold_slot(struct ec_slot *slot, u32 seq, u8 side,
					       const u8 *data, size_t len, u16 *touched)
{
	if (!ec_slot_hold(slot, EC_SLOT_SENT, seq))
		/* a cancelled frame; otherwise a second copy of a reply */
		return atomic_read(&slot->state) == EC_SLOT_QUARANTINE ? EC_MATCH_LATE :
									 EC_MATCH_UNMATCHED;
	if (ec_slot_awaits(slot, side) && len >= slot->eth_len - EC_ETH_HDR &&
	    same(slot, data, len, touched))
		return EC_MATCH_DONE;
	ec_slot_release(slot, EC_SLOT_SENT);
	return EC_MATCH_UNMATCHED;
}

/* Fill the slot of a master with two links. Return: @last: the slot is DONE. */
static __always_inline enum ec_match fill_copy(const struct ec_link *by, struct ec_slot *slot,
					       u32 seq, u8 side, const u8 *data, size_t len,
					       bool keep, bool *last)
{
	u16 touched = 0;
	enum ec_match what = hold_slot(slot, seq, side, data, len, &touched);

	if (what != EC_MATCH_DONE)
		return what;
	if (side != by->side)
		slot->crossed |= BIT(side);
	*last = ec_slot_take(slot, side, data, keep, !touched);
	return what;
}

/* The devices may deliver the copies of a frame at the same time, and neither may be lost. */
static noinline enum ec_match fill_locked(struct ec_slots *s, const struct ec_link *by,
					  struct ec_slot *slot, u32 seq, u8 side, const u8 *data,
					  size_t len)
{
	void (*done)(struct ec_slot *slot);
	enum ec_match what;
	unsigned long flags;
	bool last = false;

	raw_spin_lock_irqsave(&s->both, flags);
	done = slot->done;
	what = fill_copy(by, slot, seq, side, data, len, READ_ONCE(by->keep) && !done, &last);
	raw_spin_unlock_irqrestore(&s->both, flags);
	if (last && done)
		done(slot);
	return what;
}

/* Does the thread that delivers this frame for the cycle deliver the other copy as well? */
static __always_inline bool is_alone(const struct ec_slots *s, const struct ec_link *by,
				     const struct ec_slot *slot)
{
	return READ_ONCE(by->keep) && READ_ONCE(s->one_thread) && !slot->done;
}

/*
 * The copy of a frame with one datagram, as the cycle has them, whose address slaves do not count:
 * same() in few steps. It stays in the memory of the device. Return: false: nothing was changed.
 */
static __always_inline bool fill_plain(const struct ec_link *by, struct ec_slot *slot, u32 seq,
				       u8 side, const u8 *data, size_t len)
{
	const u8 *sent = ec_slot_body(slot) + EC_FRAME_HDR, *got = data + EC_FRAME_HDR;
	unsigned int body, n;

	if (!ec_slot_hold(slot, EC_SLOT_SENT, seq))
		return false;
	body = slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	n = body - EC_DGRAM_OVERHEAD;
	if (!ec_slot_awaits(slot, side) || len < body + EC_FRAME_HDR ||
	    get_unaligned_le16(data) != (EC_FRAME_TYPE_DGRAM << 12 | body) ||
	    get_unaligned_le16(sent + 6) != n ||
	    (get_unaligned_le64(sent) ^ get_unaligned_le64(got)) &
	    (EC_SAME_HEADER | (u64)EC_DGRAM_MORE << 48)) {
		ec_slot_release(slot, EC_SLOT_SENT);
		return false;
	}
	if (side != by->side)
		slot->crossed |= BIT(side);
	ec_slot_take(slot, side, data, true,
		     !(get_unaligned_le16(got + 8) | get_unaligned_le16(got + EC_DGRAM_HDR + n)));
	return true;
}

static noinline enum ec_match fill_two(struct ec_slots *s, const struct ec_link *by,
				       struct ec_slot *slot, const u8 *src, const u8 *data,
				       size_t len)
{
	u32 seq = s->numbered ? get_unaligned_le32(src + 2) : READ_ONCE(slot->seq);
	bool last;

	if (is_alone(s, by, slot))
		return fill_copy(by, slot, seq, src[1], data, len, true, &last);
	return fill_locked(s, by, slot, seq, src[1], data, len);
}

/*
 * Fill the slot of a master with one link. A reply to the cycle may stay in the memory of the
 * device, see struct ec_link.keep: the cycle owner takes it before it leaves the links.
 */
static __always_inline enum ec_match fill_slot(const struct ec_link *by, struct ec_slot *slot,
					       u32 seq, u8 side, const u8 *data, size_t len)
{
	enum ec_match what = hold_slot(slot, seq, side, data, len, NULL);
	void (*done)(struct ec_slot *slot);

	if (what != EC_MATCH_DONE)
		return what;
	/* read before the slot may be used for another frame */
	done = slot->done;
	slot->back = slot->sides;
	if (READ_ONCE(by->keep) && !done) {
		slot->reply = data;
		ec_slot_release(slot, EC_SLOT_DONE);
		return what;
	}
	slot->reply = slot->copy[EC_MAIN];
	slot->got[EC_MAIN] = slot->reply;
	memcpy(slot->copy[EC_MAIN] + EC_FRAME_HDR, data + EC_FRAME_HDR,
	       slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR);
	ec_slot_release(slot, EC_SLOT_DONE);
	if (done)
		done(slot);
	return what;
}

/* Find the slot that a frame belongs to, and fill it. */
static __always_inline enum ec_match match(struct ec_slots *s, const struct ec_link *by,
					   const u8 *src, const u8 *data, size_t len)
{
	u32 seq = get_unaligned_le32(src + 2);
	struct ec_slot *slot;

	if (len < EC_FRAME_HDR + EC_DGRAM_OVERHEAD)
		return EC_MATCH_UNMATCHED;
	slot = &s->slot[data[EC_FRAME_HDR + 1]];
	if (!s->numbered)
		seq = READ_ONCE(slot->seq);
	/* first: a frame of an earlier use must not hold the slot */
	if (READ_ONCE(slot->seq) != seq)
		return atomic_read(&slot->state) == EC_SLOT_SENT ? EC_MATCH_LATE :
								   EC_MATCH_UNMATCHED;
	if (likely(!s->copies))
		return fill_slot(by, slot, seq, src[1], data, len);
	if (likely(is_alone(s, by, slot) && fill_plain(by, slot, seq, src[1], data, len)))
		return EC_MATCH_DONE;
	return fill_two(s, by, slot, src, data, len);
}

static __always_inline enum ec_match receive(struct ec_link *link, const u8 *src,
					     const u8 *data, size_t len)
{
	struct ec_links *l = link->links;
	enum ec_match what;

	atomic64_inc(&link->stats.rx_frames);
	atomic64_add(len + EC_ETH_HDR, &link->stats.rx_bytes);
	if (unlikely(READ_ONCE(l->base->debug) >= 2))
		ec_link_trace(link, "received", data, len);
	if (unlikely(l->capture) && !ec_capture_received(l->capture, src, data, len))
		atomic64_inc(&link->stats.not_captured);
	what = match(&l->slots, link, src, data, len);
	if (unlikely(what == EC_MATCH_LATE))
		atomic64_inc(&link->stats.late);
	else if (unlikely(what == EC_MATCH_UNMATCHED))
		atomic64_inc(&link->stats.unmatched);
	return what;
}

/* a copy, so that the usual one needs nothing of it */
static noinline void receive_traced(struct ec_link *link, const u8 *src, const u8 *data, size_t len)
{
	u8 index = len >= EC_FRAME_HDR + EC_DGRAM_OVERHEAD ? data[EC_FRAME_HDR + 1] : 0;
	enum ec_match what = receive(link, src, data, len);

	trace_ec_frame_received(link->links->base->index, link->side, index,
				get_unaligned_le32(src + 2), len + EC_ETH_HDR, what);
}

/**
 * ecdev_receive() - deliver a received EtherCAT frame
 * @dev: device
 * @src: source MAC address
 * @data: what follows the EtherType; not changed
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_receive(struct ecdev *dev, const u8 *src, const u8 *data, size_t len)
{
	struct ec_link *link = rcu_dereference(dev->link);

	if (!link)
		return;
	if (trace_ec_frame_received_enabled())
		receive_traced(link, src, data, len);
	else
		receive(link, src, data, len);
}
EXPORT_SYMBOL_GPL(ecdev_receive);

/**
 * ecdev_awaits() - are replies to acyclic frames awaited?
 * @dev: device
 *
 * A device without interrupts polls for them while no cycle runs. A frame counts from
 * before it is sent until its reply is received or it is lost.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether they are.
 */
bool ecdev_awaits(struct ecdev *dev)
{
	const struct ec_link *link;
	bool ret;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	ret = link && atomic_read(&link->acyclic);
	rcu_read_unlock();
	return ret;
}
EXPORT_SYMBOL_GPL(ecdev_awaits);

/**
 * ecdev_in_cycle() - does a cycle own the bus access?
 * @dev: device
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false without a master.
 */
bool ecdev_in_cycle(struct ecdev *dev)
{
	struct ec_link *link;
	bool ret;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	ret = link && ec_access_is_cyclic(&link->links->access);
	rcu_read_unlock();
	return ret;
}
EXPORT_SYMBOL_GPL(ecdev_in_cycle);

/**
 * ecdev_foreign() - count a received frame that is not EtherCAT
 * @dev: device
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_foreign(struct ecdev *dev)
{
	struct ec_link *link;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	if (link)
		atomic64_inc(&link->stats.foreign);
	rcu_read_unlock();
}
EXPORT_SYMBOL_GPL(ecdev_foreign);

/**
 * ecdev_not_captured() - count a frame that capture programs did not see
 * @dev: device
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ecdev_not_captured(struct ecdev *dev)
{
	struct ec_link *link;

	rcu_read_lock();
	link = rcu_dereference(dev->link);
	if (link)
		atomic64_inc(&link->stats.not_captured);
	rcu_read_unlock();
}
EXPORT_SYMBOL_GPL(ecdev_not_captured);
