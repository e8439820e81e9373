/* SPDX-License-Identifier: GPL-2.0-only */
/* Is a reply that of a frame? */
#ifndef EC_SAME_H
#define EC_SAME_H

#include <linux/bits.h>
#include "../wire/frame.h"
#include "slots.h"

/* commands whose address each slave counts up */
#define EC_SAME_COUNTED	(BIT(EC_CMD_APRD) | BIT(EC_CMD_APWR) | BIT(EC_CMD_APRW) | \
			 BIT(EC_CMD_BRD) | BIT(EC_CMD_BWR) | BIT(EC_CMD_BRW) | BIT(EC_CMD_ARMW))
#define EC_SAME_ADDRESS	((u64)0xffff << 16)	/* which they count */
/* the other bits are the slaves' */
#define EC_SAME_HEADER	((u64)EC_DGRAM_LEN_MASK << 48 | 0xffffffffffff)

/* Command, index, address and length. */
static __always_inline bool ec_same_header(const u8 *sent, const u8 *got)
{
	u64 other = (get_unaligned_le64(sent) ^ get_unaligned_le64(got)) & EC_SAME_HEADER;

	return !other || (!(other & ~EC_SAME_ADDRESS) && sent[0] < 32 &&
			  BIT(sent[0]) & EC_SAME_COUNTED);
}

/* What slaves count in a datagram, and their events. */
static __always_inline u16 ec_same_touched(const u8 *sent, const u8 *got, u16 len)
{
	return get_unaligned_le16(got + EC_DGRAM_HDR + len) | get_unaligned_le16(got + 8) |
	       (get_unaligned_le16(sent + 2) ^ get_unaligned_le16(got + 2));
}

/**
 * ec_slot_same() - check that a reply carries the datagrams of a slot
 * @slot: slot in state FILL
 * @reply: the reply, at the first of them; afterwards behind the last one
 * @touched: NULL, or result: not 0 if a slave has processed or counted a datagram
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it does.
 */
static __always_inline bool ec_slot_same(struct ec_slot *slot, struct ec_frame_iter *reply,
					 u16 *touched)
{
	const u8 *sent = ec_slot_body(slot) + EC_FRAME_HDR;
	size_t left = slot->eth_len - EC_ETH_HDR - EC_FRAME_HDR;
	u16 len;

	do {
		size_t replied = reply->end - reply->p, size;

		if (left < EC_DGRAM_OVERHEAD || replied < EC_DGRAM_OVERHEAD || !reply->more ||
		    !ec_same_header(sent, reply->p))
			return false;
		len = get_unaligned_le16(sent + 6);
		size = EC_DGRAM_OVERHEAD + (len & EC_DGRAM_LEN_MASK);
		if (left < size || replied < size)
			return false;
		if (touched)
			*touched |= ec_same_touched(sent, reply->p, size - EC_DGRAM_OVERHEAD);
		reply->more = get_unaligned_le16(reply->p + 6) & EC_DGRAM_MORE;
		reply->p += size;
		sent += size;
		left -= size;
	} while (len & EC_DGRAM_MORE);
	return true;
}

#endif
