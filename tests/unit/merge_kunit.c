// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/frame.h"
#include "../../master/wire/merge.h"

/* a frame as sent, and the copies that both ends of a ring have received */
static u8 sent[300], a[300], b[300], to[300];
static size_t len;
static u8 *at[4][4];	/* data of each datagram: as sent, in both copies, in the result */
static u16 bytes[4];

/* FPRD, BRD, LRW, LRD */
static void merge_build(void)
{
	static const u8 cmds[4] = { EC_CMD_FPRD, EC_CMD_BRD, EC_CMD_LRW, EC_CMD_LRD };
	struct ec_frame_buf f;
	unsigned int i;

	ec_frame_begin(&f, sent, sizeof(sent));
	for (i = 0; i < 4; i++) {
		bytes[i] = i < 2 ? 2 : 75;
		at[0][i] = ec_frame_add(&f, cmds[i], 9, 0, 0x0130, bytes[i]);
		memset(at[0][i], i < 2 ? 0 : 0xa5, bytes[i]);
	}
	len = ec_frame_end(&f);
	memcpy(a, sent, len);
	memcpy(b, sent, len);
	for (i = 0; i < 4; i++) {
		at[1][i] = a + (at[0][i] - sent);
		at[2][i] = b + (at[0][i] - sent);
		at[3][i] = to + (at[0][i] - sent);
	}
}

static void processed(unsigned int copy, unsigned int i, u16 wkc)
{
	put_unaligned_le16(wkc, at[copy][i] + bytes[i]);
}

/* the first @n bytes of the datagrams */
static void merge_first(size_t n)
{
	ec_merge_dgrams(to + EC_FRAME_HDR, a + EC_FRAME_HDR, b + EC_FRAME_HDR,
			sent + EC_FRAME_HDR, n);
}

static void merge(void)
{
	merge_first(len - EC_FRAME_HDR);
}

static u16 merged(unsigned int i)
{
	return get_unaligned_le16(at[3][i] + bytes[i]);
}

static void merge_processed_copy_is_taken(struct kunit *test)
{
	merge_build();
	memcpy(at[2][0], "\x08\x00", 2);
	processed(2, 0, 1);
	memcpy(at[1][3], "0123456789a", 11);
	processed(1, 3, 1);
	merge();
	KUNIT_EXPECT_MEMEQ(test, at[3][0], "\x08\x00", 2);
	KUNIT_EXPECT_EQ(test, merged(0), 1);
	KUNIT_EXPECT_MEMEQ(test, at[3][3], "0123456789a", 11);
	KUNIT_EXPECT_EQ(test, merged(3), 1);
	KUNIT_EXPECT_EQ(test, merged(2), 0);
	KUNIT_EXPECT_MEMEQ(test, at[3][2], at[0][2], 11);
}

static void merge_broadcast_counts_both_sides(struct kunit *test)
{
	merge_build();
	put_unaligned_le16(3, at[1][1] - EC_DGRAM_HDR + 2);
	at[1][1][0] = 0x02;
	processed(1, 1, 3);
	put_unaligned_le16(5, at[2][1] - EC_DGRAM_HDR + 2);
	at[2][1][0] = 0x08;
	processed(2, 1, 4);
	put_unaligned_le16(4, at[2][1] - 2);	/* events */
	merge();
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(at[3][1] - EC_DGRAM_HDR + 2), 8);
	KUNIT_EXPECT_EQ(test, at[3][1][0], 0x0a);
	KUNIT_EXPECT_EQ(test, merged(1), 7);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(at[3][1] - 2), 4);
}

/* Bits of one byte from slaves of both sides, and a byte behind the last word of 8. */
static void merge_bits_are_of_their_side(struct kunit *test)
{
	merge_build();
	at[1][2][0] = 0xaa;	/* low half */
	at[2][2][0] = 0x55;	/* high half */
	at[1][2][1] = 0x11;
	at[2][2][10] = 0x22;
	at[2][2][40] = 0x33;	/* a piece that one side has changed, and one of the other */
	at[1][2][64] = 0x44;
	at[1][2][74] = 0x66;	/* behind the last piece */
	at[2][2][73] = 0x77;
	processed(1, 2, 3);
	processed(2, 2, 6);
	merge();
	KUNIT_EXPECT_EQ(test, merged(2), 9);
	KUNIT_EXPECT_EQ(test, at[3][2][1], 0x11);
	KUNIT_EXPECT_EQ(test, at[3][2][10], 0x22);
	KUNIT_EXPECT_EQ(test, at[3][2][2], 0xa5);
	KUNIT_EXPECT_EQ(test, at[3][2][40], 0x33);
	KUNIT_EXPECT_EQ(test, at[3][2][64], 0x44);
	KUNIT_EXPECT_EQ(test, at[3][2][73], 0x77);
	KUNIT_EXPECT_EQ(test, at[3][2][74], 0x66);
}

/* A slave that both copies have reached has written the same. */
static void merge_same_change_of_both_sides_stays(struct kunit *test)
{
	merge_build();
	memset(at[1][3], 0x3c, 11);
	memset(at[2][3], 0x3c, 11);
	processed(1, 3, 2);
	processed(2, 3, 1);
	merge();
	KUNIT_EXPECT_EQ(test, at[3][3][0], 0x3c);
	KUNIT_EXPECT_EQ(test, at[3][3][10], 0x3c);
}

/* Lengths that do not fit into the frame end the merge. */
static void merge_length_beyond_frame_ends_it(struct kunit *test)
{
	merge_build();
	put_unaligned_le16(0x7ff | EC_DGRAM_MORE, at[0][1] - EC_DGRAM_HDR + 6);
	processed(2, 0, 1);
	merge();
	KUNIT_EXPECT_EQ(test, merged(0), 1);
	merge_first(3);
	KUNIT_EXPECT_EQ(test, merged(0), 1);
}

/* What belongs to one copy is known from the last time, or wrong; or the copies alternate. */
static void merge_any_cut_is_right(struct kunit *test)
{
	unsigned int guess, apart, i;
	u8 right[75], copy[75], *got;
	u16 cut;

	for (apart = 0; apart < 2; apart++) {
		merge_build();
		for (i = 0; i < 75; i += 6)
			at[apart || i < 36 ? 1 : 2][2][i] = i;
		for (i = 3; apart && i < 75; i += 6)
			at[2][2][i] = i;
		for (i = 0; i < 75; i++)
			right[i] = at[1][2][i] != 0xa5 ? at[1][2][i] : at[2][2][i];
		for (guess = 0; guess <= 76; guess++) {
			cut = guess;
			memcpy(copy, at[1][2], 75);
			got = ec_merge_data(at[3][2], copy, at[2][2], at[0][2], 75, &cut);
			KUNIT_ASSERT_MEMEQ(test, got, right, 75);
			i = cut;
			memcpy(copy, at[1][2], 75);
			memset(at[3][2], 0, 75);
			got = ec_merge_data(at[3][2], copy, at[2][2], at[0][2], 75, &cut);
			KUNIT_ASSERT_MEMEQ(test, got, right, 75);
			KUNIT_ASSERT_EQ(test, cut, i);
			KUNIT_ASSERT_PTR_EQ(test, got, apart ? at[3][2] : copy);
		}
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(merge_processed_copy_is_taken),
	KUNIT_CASE(merge_broadcast_counts_both_sides),
	KUNIT_CASE(merge_bits_are_of_their_side),
	KUNIT_CASE(merge_same_change_of_both_sides_stays),
	KUNIT_CASE(merge_length_beyond_frame_ends_it),
	KUNIT_CASE(merge_any_cut_is_right),
	{}
};

static struct kunit_suite suite = { .name = "merge", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
