/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Frame slots. The datagram index names the slot of the frame, so at most 256
 * frames are on their way. A slot's life:
 *
 *   FREE -> BUILD -> SENT -> FILL -> DONE -> FREE
 *                      \-> QUARANTINE -> (20 ms) -> BUILD
 *
 * SENT to FILL (reply) and SENT to QUARANTINE (timeout, cancel) are one atomic
 * change each: the first wins. A frame is in FILL, and then in SENT again, also while
 * it is copied into one that it shares with others, see pack.c.
 */
#ifndef EC_SLOTS_H
#define EC_SLOTS_H

#include <linux/atomic.h>
#include <linux/types.h>
#include "../base/limits.h"
#include "../wire/frame.h"

struct ec_xfer;

enum ec_slot_state {
	EC_SLOT_FREE,
	EC_SLOT_BUILD,
	EC_SLOT_SENT,
	EC_SLOT_FILL,
	EC_SLOT_DONE,
	EC_SLOT_QUARANTINE,
};

/**
 * struct ec_packed - where the datagrams of a slot are in a frame it shares with others
 * @seq: sequence number of that frame
 * @len: bytes of that frame behind the EtherType, 0: the slot has a frame of its own
 * @at: offset of the slot's datagrams there
 * @prev: index of the slot before it, its own: it is the first one
 * @next: index of the slot behind it, its own: it is the last one
 */
struct ec_packed {
	u32 seq;
	u16 len;
	u16 at;
	u8 prev;
	u8 next;
};

/**
 * struct ec_slot - one frame
 * @state: enum ec_slot_state
 * @index: datagram index, immutable
 * @seq: sequence number in the source MAC address
 * @left: sequence number of the last frame that waits for no turn any more
 * @sent_ns: when it was sent (ktime)
 * @xfer: who waits for it, NULL: the cycle
 * @clock: one of ec_xfer_clock()
 * @dgrams: its datagrams, 0: it never shares a frame
 * @last: offset of the last one from the first one
 * @pack: how it shares a frame
 * @eth_len: bytes of the Ethernet frame without padding and FCS
 * @frame: Ethernet frame; becomes the reply in state DONE
 */
struct ec_slot {
	atomic_t state;
	u8 index;
	u32 seq;
	u32 left;
	aligned_u64 sent_ns;
	struct ec_xfer *xfer;
	bool clock;
	u8 dgrams;
	u16 last;
	struct ec_packed pack;
	u16 eth_len;
	u8 frame[EC_ETH_MAX];
};

/* a slot in a queue; only meant as long as it has this sequence number */
struct ec_queued {
	struct ec_slot *slot;
	u32 seq;
	bool urgent;
};

/**
 * struct ec_slots - all slots of one master
 * @slot: the slots
 * @hint: where to look for a free one
 * @seq: sequence number of the last frame
 */
struct ec_slots {
	struct ec_slot *slot;
	atomic_t hint;
	atomic_t seq;
};

enum ec_match {
	EC_MATCH_DONE,		/* taken */
	EC_MATCH_LATE,		/* of an earlier use of the slot */
	EC_MATCH_UNMATCHED,	/* nothing of this kind is out, or mangled */
};

/**
 * struct ec_matched - callers whose frames have come back
 * @n: how many; the cycle counts as none
 * @xfer: the callers; their slots may be in use by others already
 */
struct ec_matched {
	unsigned int n;
	struct ec_xfer *xfer[EC_PACK_MAX];
};

int ec_slots_init(struct ec_slots *s);
void ec_slots_exit(struct ec_slots *s);
struct ec_slot *ec_slot_get(struct ec_slots *s, bool cyclic, u64 now_ns);
struct ec_slot *ec_slot_wait(struct ec_slots *s);
void ec_slot_put(struct ec_slots *s, struct ec_slot *slot);
bool ec_slot_cancel(struct ec_slot *slot, u64 now_ns);
void ec_slot_disarm(struct ec_slot *slot, u64 now_ns);
void ec_slot_arm(struct ec_slots *s, struct ec_slot *slot, u8 side, u64 now_ns);
enum ec_match ec_slots_match(struct ec_slots *s, const u8 *src, const u8 *data,
			     size_t len, struct ec_matched *got);
bool ec_slot_same(struct ec_slot *slot, struct ec_frame_iter *reply);

/* Of the slots that share a frame one counts what becomes of it. */
static inline bool ec_slot_leads(const struct ec_slot *slot)
{
	return !slot->pack.len || slot->pack.prev == slot->index;
}

static inline u8 *ec_slot_body(struct ec_slot *slot)
{
	return slot->frame + EC_ETH_HDR;
}

#endif
