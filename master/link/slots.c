// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/etherdevice.h>
#include <linux/ktime.h>
#include <linux/module.h>
#include <linux/vmalloc.h>
#include "../base/once64.h"
#include "slots.h"

#define COPY_MAX	(EC_ETH_MAX - EC_ETH_HDR)	/* what follows the EtherType */

static bool frame_numbers = true;
module_param(frame_numbers, bool, 0444);
MODULE_PARM_DESC(frame_numbers, "Number the frames in their source MAC address (Y)");

/**
 * ec_slots_init() - allocate the slots
 * @s: zeroed structure
 * @backup: with memory for the copies of a second link
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_slots_init(struct ec_slots *s, bool backup)
{
	unsigned int i;

	s->numbered = frame_numbers;
	s->slot = vzalloc(array_size(EC_SLOTS, sizeof(*s->slot)));
	s->backup = backup ? vzalloc(array_size(EC_SLOTS, COPY_MAX)) : NULL;
	if (!s->slot || (backup && !s->backup)) {
		ec_slots_exit(s);
		return -ENOMEM;
	}
	for (i = 0; i < EC_SLOTS; i++) {
		s->slot[i].index = i;
		s->slot[i].backup = backup ? s->backup + i * COPY_MAX : NULL;
	}
	return 0;
}

/**
 * ec_slots_exit() - free the slots; no frame may be delivered any more
 * @s: slots
 *
 * Context: Process. May sleep.
 */
void ec_slots_exit(struct ec_slots *s)
{
	vfree(s->slot);
	vfree(s->backup);
	s->slot = NULL;
	s->backup = NULL;
}

static bool take(struct ec_slot *slot, u64 now_ns, s64 quarantine_ns)
{
	if (atomic_cmpxchg(&slot->state, EC_SLOT_FREE, EC_SLOT_BUILD) == EC_SLOT_FREE)
		return true;
	return atomic_read(&slot->state) == EC_SLOT_QUARANTINE &&
	       /* another may have cancelled it after the caller looked at the clock */
	       (s64)(now_ns - ec_read64(&slot->sent_ns)) > quarantine_ns &&
	       atomic_cmpxchg(&slot->state, EC_SLOT_QUARANTINE, EC_SLOT_BUILD) ==
	       EC_SLOT_QUARANTINE;
}

static struct ec_slot *search(struct ec_slots *s, u64 now_ns, s64 quarantine_ns)
{
	unsigned int i, start = atomic_inc_return(&s->hint);

	for (i = 0; i < EC_SLOTS; i++) {
		struct ec_slot *slot = &s->slot[(start + i) % EC_SLOTS];

		if (take(slot, now_ns, quarantine_ns))
			return ec_slot_taken(slot);
	}
	return NULL;
}

/**
 * ec_slot_search() - ec_slot_get() when the next slot is in use
 * @s: slots
 * @cyclic: as there
 * @now_ns: as there
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: as there.
 */
struct ec_slot *ec_slot_search(struct ec_slots *s, bool cyclic, u64 now_ns)
{
	struct ec_slot *slot = search(s, now_ns, EC_QUARANTINE_NS);

	/*
	 * While all frames are lost the cycle uses up slots faster than the
	 * quarantine frees them; sequence numbers distinguish the frames, too.
	 */
	if (!slot && cyclic)
		slot = search(s, now_ns, 0);
	return slot;
}

/**
 * ec_slot_wait() - take a slot that is not for the cycle
 * @s: slots
 *
 * The place at the link's gate is the caller's; a slot of a lost frame may still be
 * in quarantine.
 *
 * Context: Process. May sleep.
 * Return: the slot in state BUILD, or NULL.
 */
struct ec_slot *ec_slot_wait(struct ec_slots *s)
{
	struct ec_slot *slot;
	unsigned int i;

	for (i = 0; i < 100; i++) {
		slot = search(s, ktime_get_ns(), EC_QUARANTINE_NS);
		if (slot)
			return slot;
		/* a quarantine ends by time */
		usleep_range(300, 500);
	}
	return NULL;
}

/**
 * ec_slot_cancel() - stop waiting for a frame
 * @slot: slot that was armed or queued
 * @now_ns: time; the quarantine begins now, the frame may have left late
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true when the slot is in quarantine now, false when the reply came
 * first (or is being copied at this moment).
 */
bool ec_slot_cancel(struct ec_slot *slot, u64 now_ns)
{
	/* in this state neither the sender nor the receiver of the frame uses @sent_ns */
	if (atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT &&
	    atomic_cmpxchg(&slot->state, EC_SLOT_QUEUED, EC_SLOT_FILL) != EC_SLOT_QUEUED)
		return false;
	ec_write64(&slot->sent_ns, now_ns);
	ec_slot_release(slot, EC_SLOT_QUARANTINE);
	return true;
}

/**
 * ec_slot_disarm() - take back a frame that was armed and not sent
 * @slot: slot
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: it is in BUILD again; false: another station has sent its reply meanwhile,
 * which is taken, or being taken just now.
 */
bool ec_slot_disarm(struct ec_slot *slot)
{
	return atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_BUILD) == EC_SLOT_SENT ||
	       atomic_cmpxchg(&slot->state, EC_SLOT_QUEUED, EC_SLOT_BUILD) == EC_SLOT_QUEUED;
}

/*
 * The source address is locally administered: slaves set that bit, too. It carries the side,
 * which a link writes when it sends, and the sequence number. Without numbers each frame leaves
 * alone: one that callers share is recognized by its number.
 */
static __always_inline void number(struct ec_slots *s, struct ec_slot *slot, u8 *f, u8 links,
				    u64 now_ns)
{
	WRITE_ONCE(slot->seq, atomic_inc_return(&s->seq));
	ec_write64(&slot->sent_ns, now_ns);
	slot->links = links;
	slot->back = 0;
	slot->pack.len = 0;
	eth_broadcast_addr(f);
	f[6] = 0x02;
	f[7] = 0;
	put_unaligned_le32(s->numbered ? slot->seq : 0, f + 8);
	if (!s->numbered)
		slot->dgrams = 0;
	f[12] = EC_ETHERTYPE >> 8;
	f[13] = EC_ETHERTYPE & 0xff;
	if (slot->eth_len < EC_ETH_MIN)
		memset(f + slot->eth_len, 0, EC_ETH_MIN - slot->eth_len);
}

/* Keep the headers of the datagrams, with which the reply is compared. */
static __always_inline void note(struct ec_slot *slot, const u8 *frame)
{
	unsigned int at = EC_ETH_HDR + EC_FRAME_HDR;
	u16 len;

	do {
		memcpy(slot->frame + at, frame + at, EC_DGRAM_HDR);
		len = get_unaligned_le16(frame + at + 6);
		at += EC_DGRAM_OVERHEAD + (len & EC_DGRAM_LEN_MASK);
		/* the device may have written there, too */
	} while (len & EC_DGRAM_MORE && at + EC_DGRAM_OVERHEAD <= slot->eth_len);
}

/**
 * ec_slot_arm() - write the Ethernet header and expect the reply from now on
 * @s: slots
 * @slot: in state BUILD, datagrams complete, @eth_len set
 * @frame: where its frame was built; of one that is not in the slot only headers are kept there
 * @links: mask of the links on which it is sent
 * @now_ns: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_slot_arm(struct ec_slots *s, struct ec_slot *slot, u8 *frame, u8 links, u64 now_ns)
{
	if (frame != slot->frame)
		note(slot, frame);
	number(s, slot, frame, links, now_ns);
	ec_slot_release(slot, EC_SLOT_SENT);
}

/**
 * ec_slot_queue() - write the Ethernet header; the frame leaves with the cycle
 * @s: slots
 * @slot: in state BUILD, datagrams complete, @eth_len set
 * @links: mask of the links on which it is sent
 * @now_ns: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_slot_queue(struct ec_slots *s, struct ec_slot *slot, u8 links, u64 now_ns)
{
	number(s, slot, slot->frame, links, now_ns);
	ec_slot_release(slot, EC_SLOT_QUEUED);
}

/**
 * ec_slot_hold() - enter the state FILL, so that no other thread changes the slot
 * @slot: slot, perhaps of another caller by now
 * @state: state in which it has to be
 * @seq: sequence number that it has to have
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: the caller ends it by ec_slot_release(); false: the slot is as it was.
 */
bool ec_slot_hold(struct ec_slot *slot, enum ec_slot_state state, u32 seq)
{
	if (atomic_cmpxchg(&slot->state, state, EC_SLOT_FILL) != state)
		return false;
	/* it may have been given up and be in use again since; now it stays */
	if (READ_ONCE(slot->seq) == seq)
		return true;
	ec_slot_release(slot, state);
	return false;
}

/**
 * ec_slot_take() - take the copy of a link, and leave the state FILL
 * @slot: slot that awaits it
 * @side: number of the link
 * @data: datagrams, compared with what was sent
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: who waits, with the last copy; NULL: the cycle, or a copy is still to come.
 */
struct ec_xfer *ec_slot_take(struct ec_slot *slot, u8 side, const u8 *data)
{
	u8 *to = side ? slot->backup : ec_slot_body(slot);
	struct ec_xfer *xfer = slot->xfer;

	slot->reply = ec_slot_body(slot);
	memcpy(to + EC_FRAME_HDR, data, slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR);
	/* in a shared frame another caller's datagrams follow, here they end */
	if (slot->pack.len)
		ec_frame_ends_at(to + EC_FRAME_HDR + slot->last);
	slot->back |= BIT(side);
	if (slot->back != slot->links) {
		ec_slot_release(slot, EC_SLOT_SENT);
		return NULL;
	}
	ec_slot_release(slot, EC_SLOT_DONE);
	return xfer;
}

/* commands whose address each slave counts up */
#define COUNTED (BIT(EC_CMD_APRD) | BIT(EC_CMD_APWR) | BIT(EC_CMD_APRW) | BIT(EC_CMD_BRD) | \
		 BIT(EC_CMD_BWR) | BIT(EC_CMD_BRW) | BIT(EC_CMD_ARMW))
/* Command, index, address and length; the other bits of its 8 bytes are the slaves'. */
static bool same_header(const u8 *sent, const u8 *got)
{
	bool counted = sent[0] < 32 && BIT(sent[0]) & COUNTED;
	u64 ours = (u64)EC_DGRAM_LEN_MASK << 48 | (counted ? 0xffff0000ffff : 0xffffffffffff);

	return !((get_unaligned_le64(sent) ^ get_unaligned_le64(got)) & ours);
}

static __always_inline bool same_dgrams(struct ec_slot *slot, struct ec_frame_iter *reply)
{
	const u8 *sent = ec_slot_body(slot) + EC_FRAME_HDR;
	size_t left = slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	u16 len;

	do {
		size_t replied = reply->end - reply->p, size;

		if (left < EC_DGRAM_OVERHEAD || replied < EC_DGRAM_OVERHEAD || !reply->more ||
		    !same_header(sent, reply->p))
			return false;
		len = get_unaligned_le16(sent + 6);
		size = EC_DGRAM_OVERHEAD + (len & EC_DGRAM_LEN_MASK);
		if (left < size || replied < size)
			return false;
		reply->more = get_unaligned_le16(reply->p + 6) & EC_DGRAM_MORE;
		reply->p += size;
		sent += size;
		left -= size;
	} while (len & EC_DGRAM_MORE);
	return true;
}

/**
 * ec_slot_same() - check that a reply carries the datagrams of a slot
 * @slot: slot in state FILL
 * @reply: the reply, at the first of them; afterwards behind the last one
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it does.
 */
bool ec_slot_same(struct ec_slot *slot, struct ec_frame_iter *reply)
{
	return same_dgrams(slot, reply);
}

/* Does the reply carry the same datagrams as the frame that was sent, and no more? */
static __always_inline bool same(struct ec_slot *slot, u8 *reply, size_t len)
{
	struct ec_frame_iter ri;

	return !ec_frame_iter_init(&ri, reply, len) && same_dgrams(slot, &ri) &&
	       !ri.more && ri.p == ri.end;
}

static struct ec_matched nothing(enum ec_match what)
{
	return (struct ec_matched){ .what = what };
}

/**
 * ec_slots_match() - find the slot a received frame belongs to and fill it
 * @s: slots
 * @src: source MAC address of the frame, which callers do not share
 * @data: what follows the EtherType
 * @len: bytes there
 * @keep: a reply to the cycle may stay where it is: the cycle owner takes it in this call
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: what became of the frame, and who waits for it.
 */
struct ec_matched ec_slots_match(struct ec_slots *s, const u8 *src, const u8 *data, size_t len,
				 bool keep)
{
	u32 seq = get_unaligned_le32(src + 2);
	struct ec_slot *slot;
	enum ec_slot_state state;
	u8 side = src[1];

	if (len < EC_FRAME_HDR + EC_DGRAM_OVERHEAD)
		return nothing(EC_MATCH_UNMATCHED);
	slot = &s->slot[data[EC_FRAME_HDR + 1]];
	if (!s->numbered)
		seq = READ_ONCE(slot->seq);
	/* first: a frame of an earlier use must not hold the slot */
	if (READ_ONCE(slot->seq) != seq) {
		state = atomic_read(&slot->state);
		return nothing(state == EC_SLOT_SENT || state == EC_SLOT_QUEUED ?
			       EC_MATCH_LATE : EC_MATCH_UNMATCHED);
	}
	if (!ec_slot_hold(slot, EC_SLOT_SENT, seq))
		return nothing(EC_MATCH_LATE);
	if (!ec_slot_awaits(slot, side)) {
		ec_slot_release(slot, EC_SLOT_SENT);
		return nothing(EC_MATCH_LATE);
	}
	/* the iterator only reads; it has no const form */
	if (len < slot->eth_len - EC_ETH_HDR || !same(slot, (u8 *)data, len)) {
		ec_slot_release(slot, EC_SLOT_SENT);
		return nothing(EC_MATCH_UNMATCHED);
	}
	if (keep && !slot->xfer && slot->links == BIT(side)) {
		slot->reply = data;
		ec_slot_release(slot, EC_SLOT_DONE);
		return nothing(EC_MATCH_DONE);
	}
	return (struct ec_matched){ EC_MATCH_DONE,
				    ec_slot_take(slot, side, data + EC_FRAME_HDR) };
}
