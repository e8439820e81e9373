/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Frame slots. The datagram index names the slot of the frame, so at most 256
 * frames are in flight. A slot's life:
 *
 *   FREE -> BUILD -> SENT -> FILL -> DONE -> FREE
 *
 * In FILL the content of a slot belongs to one thread, which takes a reply or cancels the frame.
 * The change to FILL is atomic: the first thread wins. A cancelled slot goes through QUARANTINE,
 * and may be used again after 20 ms.
 *
 * A mask says on which links a frame is sent. Its slot is DONE when the copy of each link is
 * received, or when no more copies are expected. In a closed ring the copy of one link returns by
 * the other one, and only one of the two has been processed by the slaves.
 */
#ifndef EC_SLOTS_H
#define EC_SLOTS_H

#include <linux/atomic.h>
#include <linux/etherdevice.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include "../base/limits.h"
#include "../base/once64.h"
#include "../wire/frame.h"

enum ec_slot_state {
	EC_SLOT_FREE,
	EC_SLOT_BUILD,
	EC_SLOT_SENT,
	EC_SLOT_FILL,
	EC_SLOT_DONE,
	EC_SLOT_QUARANTINE,
};

/** struct ec_slot - one frame */
struct ec_slot {
	/** @state: enum ec_slot_state */
	atomic_t state;
	/** @index: datagram index, immutable */
	u8 index;
	/** @sides: mask of the links on which it is sent */
	u8 sides;
	/** @back: mask of the links whose copy is received */
	u8 back;
	/** @crossed: of these, the copies that came in by another link: the ring is closed */
	u8 crossed;
	/** @blank: of these, the copies that no slave has processed; they are not kept */
	u8 blank;
	/** @kept: of these, the copies that are in the memory of the device */
	u8 kept;
	/** @eth_len: bytes of the Ethernet frame without padding and FCS */
	u16 eth_len;
	/** @seq: sequence number in the source MAC address */
	u32 seq;
	/** @sent_ns: when it was sent, or cancelled (ktime) */
	aligned_u64 sent_ns;
	/**
	 * @done: called in state DONE with the last copy, in any context: it owns the slot from
	 * then on; RT-safe. NULL: the owner polls @state
	 */
	void (*done)(struct ec_slot *slot);
	/** @user: for @done */
	void *user;
	/**
	 * @reply: in state DONE: received bytes behind the EtherType; in @copy, or for the cycle
	 * in the memory of the device, see struct ec_link.keep
	 */
	const u8 *reply;
	/**
	 * @got: the same of each link that has returned a copy; if that is blank, what was sent
	 * may stand for it
	 */
	const u8 *got[EC_MAX_LINKS];
	/**
	 * @copy: memory for the copy of each link, behind the EtherType; with one link that of
	 * @frame
	 */
	u8 *copy[EC_MAX_LINKS];
	/**
	 * @sent: with two links: where the sent Ethernet frame is: @frame, or a buffer of a device,
	 * see ec_slot_sent()
	 */
	const u8 *sent;
	/**
	 * @frame: the sent Ethernet frame, or only headers of its datagrams, see ec_slot_arm();
	 * with one link the received copy overwrites it
	 */
	u8 frame[EC_ETH_MAX];
};

/** struct ec_slots - all slots of one master */
struct ec_slots {
	/** @slot: the slots */
	struct ec_slot *slot;
	/** @memory: of @copies and @merged, NULL: there was no second link so far */
	u8 *memory;
	/** @copies: memory of the copies with a second link, else NULL */
	u8 *copies;
	/** @merged: likewise, for the cycle: a frame that both links have returned, in one */
	u8 *merged;
	/** @both: with a second link: both may receive their copies of a frame at the same time */
	raw_spinlock_t both;
	/** @one_thread: the thread that polls both links for the cycle delivers all frames */
	bool one_thread;
	/** @hint: where the search for a free slot begins */
	atomic_t hint;
	/** @seq: sequence number of the last frame */
	atomic_t seq;
	/** @numbered: the source address of each frame has its sequence number */
	bool numbered;
};

enum ec_match {
	EC_MATCH_DONE,		/* taken */
	EC_MATCH_LATE,		/* of a cancelled frame, or an earlier use of the slot */
	EC_MATCH_UNMATCHED,	/* mangled, or matches no frame in flight */
};

int ec_slots_init(struct ec_slots *s, bool two);
int ec_slots_reserve(struct ec_slots *s);
void ec_slots_set_two(struct ec_slots *s, bool two);
void ec_slots_exit(struct ec_slots *s);
struct ec_slot *ec_slot_search(struct ec_slots *s, bool cyclic, u64 now_ns);
bool ec_slot_cancel(struct ec_slot *slot, u64 now_ns);
bool ec_slot_settle(struct ec_slot *slot);
bool ec_slot_disarm(struct ec_slot *slot, u8 sides);
void ec_slot_unkeep(struct ec_slots *s, struct ec_slot *slot);
void ec_slots_forget_sent(struct ec_slots *s);

/* initial values of a slot that was just taken */
static inline struct ec_slot *ec_slot_taken(struct ec_slot *slot)
{
	slot->done = NULL;
	slot->sides = 0;
	slot->back = 0;
	slot->crossed = 0;
	slot->blank = 0;
	slot->kept = 0;
	return slot;
}

/**
 * ec_slot_get() - take a free slot
 * @s: slots
 * @cyclic: for the cycle or the monitor: without a free slot one in quarantine is taken
 * @now_ns: time, to release slots from quarantine
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the slot in state BUILD, or NULL when none is free.
 */
static inline struct ec_slot *ec_slot_get(struct ec_slots *s, bool cyclic, u64 now_ns)
{
	struct ec_slot *slot = &s->slot[(u32)atomic_inc_return(&s->hint) % EC_SLOTS];

	/* mostly the next one is free */
	if (likely(atomic_cmpxchg(&slot->state, EC_SLOT_FREE, EC_SLOT_BUILD) == EC_SLOT_FREE))
		return ec_slot_taken(slot);
	return ec_slot_search(s, cyclic, now_ns);
}

/* end of the state FILL */
static inline void ec_slot_release(struct ec_slot *slot, enum ec_slot_state state)
{
	atomic_set_release(&slot->state, state);
}

/**
 * ec_slot_hold() - enter the state FILL, so that no other thread changes the slot
 * @slot: slot, perhaps of another caller by now
 * @state: state in which it has to be
 * @seq: sequence number that it has to have
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: the slot is in FILL, ec_slot_release() must follow; false: it is unchanged.
 */
static inline bool ec_slot_hold(struct ec_slot *slot, enum ec_slot_state state, u32 seq)
{
	if (atomic_cmpxchg(&slot->state, state, EC_SLOT_FILL) != state)
		return false;
	/* it may have been in use for another frame until now; in FILL it stays */
	if (READ_ONCE(slot->seq) == seq)
		return true;
	ec_slot_release(slot, state);
	return false;
}

/**
 * ec_slot_put() - release a slot
 * @slot: in state BUILD or DONE; free afterwards, but first in quarantine when a copy may still
 *	come
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
static inline void ec_slot_put(struct ec_slot *slot)
{
	ec_slot_release(slot, slot->back == slot->sides ? EC_SLOT_FREE : EC_SLOT_QUARANTINE);
}

/**
 * ec_slot_awaits() - is the copy of a link still awaited?
 * @slot: slot in state FILL
 * @side: number of the link
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
static inline bool ec_slot_awaits(const struct ec_slot *slot, u8 side)
{
	return side < EC_MAX_LINKS && slot->sides & ~slot->back & BIT(side);
}

/* The reply is the copy of the first link that has one, best one that slaves have processed. */
static __always_inline void ec_slot_choose(struct ec_slot *slot)
{
	u8 copies = (slot->back & ~slot->blank) ?: slot->back;

	if (copies)
		slot->reply = slot->got[copies & BIT(0) ? 0 : 1];
}

/* Leave the state FILL: with the last copy the slot is DONE. */
static __always_inline bool ec_slot_complete(struct ec_slot *slot)
{
	bool complete = slot->back == slot->sides;

	ec_slot_choose(slot);
	ec_slot_release(slot, complete ? EC_SLOT_DONE : EC_SLOT_SENT);
	return complete;
}

/**
 * ec_slot_take() - take the copy of one of two links, and leave the state FILL
 * @slot: slot that awaits it
 * @side: number of the link
 * @data: received bytes behind the EtherType, compared with what was sent
 * @keep: @data stay until the cycle owner has taken them, or calls ec_slot_unkeep()
 * @blank: no slave has processed or counted a datagram: the copy of one end of a closed ring
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it was the last copy: @done is to be called.
 */
static __always_inline bool ec_slot_take(struct ec_slot *slot, u8 side, const u8 *data,
					 bool keep, bool blank)
{
	if (slot->sides == BIT(side))
		blank = false;
	if (blank)
		WRITE_ONCE(slot->blank, slot->blank | BIT(side));
	if (keep) {
		slot->got[side] = data;
		slot->kept |= BIT(side);
	} else if (blank && slot->sent == slot->frame) {
		slot->got[side] = slot->frame + EC_ETH_HDR;
	} else {
		slot->got[side] = slot->copy[side];
		memcpy(slot->copy[side] + EC_FRAME_HDR, data + EC_FRAME_HDR,
		       slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR);
	}
	/* the cycle owner reads it at any time */
	WRITE_ONCE(slot->back, slot->back | BIT(side));
	return ec_slot_complete(slot);
}

/* bytes of the frame on the wire, without FCS */
static inline size_t ec_slot_padded(const struct ec_slot *slot)
{
	return max_t(size_t, slot->eth_len, EC_ETH_MIN);
}

static inline u8 *ec_slot_body(struct ec_slot *slot)
{
	return slot->frame + EC_ETH_HDR;
}

/**
 * ec_slot_sent() - the frame of a slot that was sent on two links
 * @slot: slot in state DONE
 *
 * A buffer of a device may have been used again: then it has another number.
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: the Ethernet frame, or NULL.
 */
static inline const u8 *ec_slot_sent(const struct ec_slot *slot)
{
	const u8 *sent = slot->sent;

	if (sent == slot->frame || (sent && get_unaligned_le32(sent + 8) == slot->seq))
		return sent;
	return NULL;
}

/*
 * The source address is locally administered; slaves set that bit anyway. It carries the side,
 * which a link writes when it sends, and the sequence number.
 */
static __always_inline void ec_slot_number(struct ec_slots *s, struct ec_slot *slot, u8 *f,
					   u8 sides, u64 now_ns)
{
	WRITE_ONCE(slot->seq, atomic_inc_return(&s->seq));
	ec_write64(&slot->sent_ns, now_ns);
	slot->sides = sides;
	eth_broadcast_addr(f);
	f[6] = 0x02;
	f[7] = 0;
	put_unaligned_le32(s->numbered ? slot->seq : 0, f + 8);
	f[12] = EC_ETHERTYPE >> 8;
	f[13] = EC_ETHERTYPE & 0xff;
	if (slot->eth_len < EC_ETH_MIN)
		memset(f + slot->eth_len, 0, EC_ETH_MIN - slot->eth_len);
}

/* Keep the headers of the datagrams, with which the reply is compared. */
static __always_inline void ec_slot_note(struct ec_slot *slot, const u8 *frame)
{
	unsigned int at = EC_ETH_HDR + EC_FRAME_HDR;
	u16 len;

	do {
		memcpy(slot->frame + at, frame + at, EC_DGRAM_HDR);
		len = get_unaligned_le16(frame + at + 6);
		at += EC_DGRAM_OVERHEAD + (len & EC_DGRAM_LEN_MASK);
		/* a device may have written to its buffer: stay within the frame */
	} while (len & EC_DGRAM_MORE && at + EC_DGRAM_OVERHEAD <= slot->eth_len);
}

/**
 * ec_slot_arm() - write the Ethernet header and expect the reply from now on
 * @s: slots
 * @slot: in state BUILD, datagrams complete, @eth_len set
 * @frame: where its frame was built; of one that is not in the slot only headers are kept there
 * @sides: mask of the links on which it is sent
 * @now_ns: time
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
static __always_inline void ec_slot_arm(struct ec_slots *s, struct ec_slot *slot, u8 *frame,
					u8 sides, u64 now_ns)
{
	if (frame != slot->frame)
		ec_slot_note(slot, frame);
	ec_slot_number(s, slot, frame, sides, now_ns);
	ec_slot_release(slot, EC_SLOT_SENT);
}

#endif
