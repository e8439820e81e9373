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
	ec_slot_number(s, slot, slot->frame, links, now_ns);
	ec_slot_release(slot, EC_SLOT_QUEUED);
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
