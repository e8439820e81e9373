// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "frame.h"
#include "merge.h"

/* commands whose data all slaves combine by OR */
static bool is_broadcast(u8 cmd)
{
	return cmd == EC_CMD_BRD || cmd == EC_CMD_BRW || cmd == EC_CMD_BWR;
}

/* Bits of @a that differ from what was sent, the others of @b. */
static u64 merge_bits(u64 a, u64 b, u64 sent)
{
	return b ^ ((a ^ b) & (a ^ sent));
}

/*
 * Bits that slaves of either side have changed; each bit belongs to a slave of one side. One that
 * both copies have reached, as a break has just healed, has changed both in the same way.
 */
static void merge_changed(u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	size_t i;

	for (i = 0; i + sizeof(u64) <= len; i += sizeof(u64))
		put_unaligned_le64(merge_bits(get_unaligned_le64(a + i), get_unaligned_le64(b + i),
					      get_unaligned_le64(sent + i)), a + i);
	for (; i < len; i++)
		a[i] = (u8)merge_bits(a[i], b[i], sent[i]);
}

static void merge_or(u8 *a, const u8 *b, size_t len)
{
	size_t i;

	for (i = 0; i < len; i++)
		a[i] |= b[i];
}

/* Each slave has counted the position, also one that has not processed it. */
static void merge_broadcast(u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	u16 passed = get_unaligned_le16(b + 2) - get_unaligned_le16(sent + 2);

	put_unaligned_le16(get_unaligned_le16(a + 2) + passed, a + 2);
	if (ec_cmd_reads(a[0]))
		merge_or(a + EC_DGRAM_HDR, b + EC_DGRAM_HDR, len);
}

/**
 * ec_merge_frame() - merge the copies of a frame that both ends of a ring have received
 * @a: EtherCAT header and datagrams of one copy; result
 * @b: the same of the other copy
 * @sent: the same as both were sent
 * @len: bytes of each; all have the same datagrams
 *
 * Each datagram has the working counter of both copies together, and the data of the one that
 * slaves have processed. If both were, a bit is that of the copy in which it has changed; the
 * replies to a broadcast are combined by OR, and the position has counted all slaves. The caller
 * has checked both copies against what was sent.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_merge_frame(u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	size_t at = EC_FRAME_HDR;

	while (at + EC_DGRAM_OVERHEAD <= len) {
		u16 word = get_unaligned_le16(sent + at + 6), wa, wb;
		size_t data = word & EC_DGRAM_LEN_MASK, size = EC_DGRAM_OVERHEAD + data;

		if (size > len - at)
			break;
		wa = get_unaligned_le16(a + at + EC_DGRAM_HDR + data);
		wb = get_unaligned_le16(b + at + EC_DGRAM_HDR + data);
		if (is_broadcast(sent[at]))
			merge_broadcast(a + at, b + at, sent + at, data);
		else if (wa && wb)
			merge_changed(a + at + EC_DGRAM_HDR, b + at + EC_DGRAM_HDR,
				      sent + at + EC_DGRAM_HDR, data);
		else if (wb)
			memcpy(a + at, b + at, EC_DGRAM_HDR + data);
		put_unaligned_le16(get_unaligned_le16(a + at + 8) | get_unaligned_le16(b + at + 8),
				   a + at + 8);
		put_unaligned_le16(wa + wb, a + at + EC_DGRAM_HDR + data);
		if (!(word & EC_DGRAM_MORE))
			break;
		at += size;
	}
}
