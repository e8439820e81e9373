// SPDX-License-Identifier: GPL-2.0-only OR BSD-2-Clause
#include "frame.h"
#include "merge.h"

#define MERGE_PIECE	(4 * sizeof(u64))	/* compared at once */

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

/* Are two pieces alike? */
static bool is_piece_unchanged(const u8 *a, const u8 *b)
{
	u64 other = 0;
	size_t i;

	for (i = 0; i < MERGE_PIECE; i += sizeof(u64))
		other |= get_unaligned_le64(a + i) ^ get_unaligned_le64(b + i);
	return !other;
}

/* the bits in which 4 words differ */
static inline u64 other_bits(const u8 *a, const u8 *b)
{
	u64 other = get_unaligned_le64(a) ^ get_unaligned_le64(b);

	other |= get_unaligned_le64(a + 8) ^ get_unaligned_le64(b + 8);
	other |= get_unaligned_le64(a + 16) ^ get_unaligned_le64(b + 16);
	return other | (get_unaligned_le64(a + 24) ^ get_unaligned_le64(b + 24));
}

/* Are @len bytes alike? Mostly they are. */
static bool is_unchanged(const u8 *a, const u8 *b, size_t len)
{
	size_t i, pieces = len & ~(size_t)63;

	for (i = 0; i < pieces; i += 64)
		if (other_bits(a + i, b + i) | other_bits(a + i + 32, b + i + 32))
			return false;
	for (; i + sizeof(u64) <= len; i += sizeof(u64))
		if (get_unaligned_le64(a + i) != get_unaligned_le64(b + i))
			return false;
	for (; i < len; i++)
		if (a[i] != b[i])
			return false;
	return true;
}

/*
 * Bits that slaves of either side have changed; each bit belongs to a slave of one side. One that
 * both copies have reached, as a break has just healed, has changed both in the same way. Mostly a
 * piece belongs to one side. Return: end of the last piece that has changed in @a.
 */
static size_t merge_changed(u8 *to, const u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	size_t i, j, end = 0;

	memcpy(to, b, len);
	for (i = 0; i + MERGE_PIECE <= len; i += MERGE_PIECE) {
		if (is_piece_unchanged(a + i, sent + i))
			continue;
		for (j = i; j < i + MERGE_PIECE; j += sizeof(u64))
			put_unaligned_le64(merge_bits(get_unaligned_le64(a + j),
						      get_unaligned_le64(b + j),
						      get_unaligned_le64(sent + j)), to + j);
		end = j;
	}
	for (; i < len; i++) {
		if (a[i] == sent[i])
			continue;
		to[i] = (u8)merge_bits(a[i], b[i], sent[i]);
		end = len;
	}
	return end;
}

/**
 * ec_merge_data() - merge the data of one datagram that slaves at both ends have processed
 * @to: memory for the result; none of the others
 * @a: data of one copy; the result may be written there
 * @b: data of the other copy
 * @sent: data as both were sent
 * @len: bytes of each
 * @cut: bytes that belong to @a, of the last time, and now: mostly the slaves have their
 *	data in the order in which they are connected. Then the rest is @b, and nothing has to be
 *	merged. Any value is right
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: the result: @to or @a.
 */
u8 *ec_merge_data(u8 *to, u8 *a, const u8 *b, const u8 *sent, size_t len, u16 *cut)
{
	size_t at = *cut;

	if (at > len || !is_unchanged(a + at, sent + at, len - at) || !is_unchanged(b, sent, at)) {
		*cut = merge_changed(to, a, b, sent, len);
		return to;
	}
	memcpy(a + at, b + at, len - at);
	return a;
}

static void merge_or(u8 *to, const u8 *a, const u8 *b, size_t len)
{
	size_t i;

	for (i = 0; i < len; i++)
		to[i] = a[i] | b[i];
}

/* Each slave has counted the position, also one that has not processed it. */
static void merge_broadcast(u8 *to, const u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	u16 passed = get_unaligned_le16(b + 2) - get_unaligned_le16(sent + 2);

	memcpy(to, a, EC_DGRAM_HDR + len);
	put_unaligned_le16(get_unaligned_le16(a + 2) + passed, to + 2);
	if (ec_cmd_reads(a[0]))
		merge_or(to + EC_DGRAM_HDR, a + EC_DGRAM_HDR, b + EC_DGRAM_HDR, len);
}

/* one datagram; returns both working counters together */
static u16 merge_dgram(u8 *to, const u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	u16 wa = get_unaligned_le16(a + EC_DGRAM_HDR + len);
	u16 wb = get_unaligned_le16(b + EC_DGRAM_HDR + len);

	if (is_broadcast(sent[0])) {
		merge_broadcast(to, a, b, sent, len);
	} else if (wa && wb) {
		memcpy(to, a, EC_DGRAM_HDR);
		merge_changed(to + EC_DGRAM_HDR, a + EC_DGRAM_HDR, b + EC_DGRAM_HDR,
			      sent + EC_DGRAM_HDR, len);
	} else {
		memcpy(to, wb ? b : a, EC_DGRAM_HDR + len);
	}
	put_unaligned_le16(get_unaligned_le16(a + 8) | get_unaligned_le16(b + 8), to + 8);
	return wa + wb;
}

/**
 * ec_merge_dgrams() - merge datagrams of a frame that both ends of a ring have received
 * @to: result; none of the others
 * @a: last datagrams of one copy, or all
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
void ec_merge_dgrams(u8 *to, const u8 *a, const u8 *b, const u8 *sent, size_t len)
{
	size_t at = 0;

	while (at + EC_DGRAM_OVERHEAD <= len) {
		u16 word = get_unaligned_le16(sent + at + 6), wkc;
		size_t data = word & EC_DGRAM_LEN_MASK, size = EC_DGRAM_OVERHEAD + data;

		if (size > len - at)
			break;
		wkc = merge_dgram(to + at, a + at, b + at, sent + at, data);
		put_unaligned_le16(wkc, to + at + EC_DGRAM_HDR + data);
		if (!(word & EC_DGRAM_MORE))
			break;
		at += size;
	}
}
