// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
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
 * @two: with memory for the copies of two links
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_slots_init(struct ec_slots *s, bool two)
{
	unsigned int i;

	s->numbered = frame_numbers;
	raw_spin_lock_init(&s->both);
	s->slot = vzalloc(array_size(EC_SLOTS, sizeof(*s->slot)));
	if (!s->slot || (two && ec_slots_reserve(s))) {
		ec_slots_exit(s);
		return -ENOMEM;
	}
	for (i = 0; i < EC_SLOTS; i++)
		s->slot[i].index = i;
	ec_slots_set_two(s, two);
	return 0;
}

/**
 * ec_slots_reserve() - allocate the memory for the copies of two links
 * @s: slots
 *
 * Context: Process. May sleep.
 * Return: 0, also if it was allocated before, or -ENOMEM.
 */
int ec_slots_reserve(struct ec_slots *s)
{
	if (!s->memory)
		s->memory = vzalloc(array_size(EC_SLOTS * EC_MAX_LINKS + 1, COPY_MAX));
	return s->memory ? 0 : -ENOMEM;
}

/**
 * ec_slots_set_two() - from now on there are two links, or one
 * @s: slots
 * @two: two, after ec_slots_reserve(); the memory stays until ec_slots_exit()
 *
 * Context: Process, while no device delivers frames and no frame is sent.
 */
void ec_slots_set_two(struct ec_slots *s, bool two)
{
	unsigned int i, side;

	s->copies = two ? s->memory : NULL;
	s->merged = two ? s->memory + EC_SLOTS * EC_MAX_LINKS * COPY_MAX : NULL;
	for (i = 0; i < EC_SLOTS; i++) {
		struct ec_slot *slot = &s->slot[i];

		for (side = 0; side < EC_MAX_LINKS; side++)
			slot->copy[side] = two ? s->copies + (i * EC_MAX_LINKS + side) * COPY_MAX :
						 ec_slot_body(slot);
	}
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
	vfree(s->memory);
	s->slot = NULL;
	s->memory = NULL;
	s->copies = NULL;
	s->merged = NULL;
}

static bool take(struct ec_slot *slot, u64 now_ns, s64 quarantine_ns)
{
	if (atomic_cmpxchg(&slot->state, EC_SLOT_FREE, EC_SLOT_BUILD) == EC_SLOT_FREE)
		return true;
	return atomic_read(&slot->state) == EC_SLOT_QUARANTINE &&
	       /* signed: another thread may have cancelled it after the caller read the clock */
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
	 * quarantine frees them. Sequence numbers still distinguish the frames.
	 */
	if (!slot && cyclic)
		slot = search(s, now_ns, 0);
	return slot;
}

/**
 * ec_slot_cancel() - stop waiting for a frame
 * @slot: slot that was armed
 * @now_ns: time; the quarantine begins now, the frame may have left late
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true when the slot is in quarantine now, false when the reply came
 * first (or is being copied at this moment).
 */
bool ec_slot_cancel(struct ec_slot *slot, u64 now_ns)
{
	/* in this state neither the sender nor the receiver of the frame uses @sent_ns */
	if (atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	ec_write64(&slot->sent_ns, now_ns);
	ec_slot_release(slot, EC_SLOT_QUARANTINE);
	return true;
}

/**
 * ec_slot_settle() - stop waiting for the missing copies of a frame
 * @slot: slot that was armed
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: one copy at least was received, the slot is DONE, and @done is not called; false:
 * the slot is unchanged.
 */
bool ec_slot_settle(struct ec_slot *slot)
{
	if (!READ_ONCE(slot->back) ||
	    atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	/* read again: the slot may have been in use for another frame until now */
	ec_slot_release(slot, slot->back ? EC_SLOT_DONE : EC_SLOT_SENT);
	return slot->back;
}

/**
 * ec_slot_disarm() - stop waiting for a frame on links that have not sent it
 * @slot: slot that was armed
 * @sides: mask of these links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: the slot is in BUILD again; false: the frame is in flight on other links, or
 * another station has sent a reply to it, which is taken, or being taken just now.
 */
bool ec_slot_disarm(struct ec_slot *slot, u8 sides)
{
	void (*done)(struct ec_slot *slot);

	if (atomic_cmpxchg(&slot->state, EC_SLOT_SENT, EC_SLOT_FILL) != EC_SLOT_SENT)
		return false;
	slot->sides &= ~sides;
	if (!slot->sides) {
		slot->back = 0;
		ec_slot_release(slot, EC_SLOT_BUILD);
		return true;
	}
	slot->back &= slot->sides;
	done = slot->done;
	if (ec_slot_complete(slot) && done)
		done(slot);
	return false;
}

/**
 * ec_slot_unkeep() - take the copies of a slot out of the memory of the devices
 * @s: slots, of two links
 * @slot: of the cycle; it may still await a copy
 *
 * Context: The cycle owner. RT-safe: bounded, no sleep, no allocation.
 */
void ec_slot_unkeep(struct ec_slots *s, struct ec_slot *slot)
{
	unsigned long flags, left;

	/* the other link may deliver its copy now */
	raw_spin_lock_irqsave(&s->both, flags);
	for (left = slot->kept; left; left &= left - 1) {
		unsigned int side = __ffs(left);

		memcpy(slot->copy[side], slot->got[side], slot->eth_len - EC_ETH_HDR);
		slot->got[side] = slot->copy[side];
	}
	slot->kept = 0;
	ec_slot_choose(slot);
	raw_spin_unlock_irqrestore(&s->both, flags);
}

/**
 * ec_slots_forget_sent() - the buffers of a device are not used any more
 * @s: slots
 *
 * Context: Process, while the links have no bus access.
 */
void ec_slots_forget_sent(struct ec_slots *s)
{
	unsigned int i;

	for (i = 0; i < EC_SLOTS; i++)
		if (s->slot[i].sent != s->slot[i].frame)
			s->slot[i].sent = NULL;
}
