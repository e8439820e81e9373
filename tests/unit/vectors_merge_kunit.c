// SPDX-License-Identifier: GPL-2.0-only
/* Copies of a frame at both ends of a broken ring, typed from the rules of each command. */
#include "wire_kunit.h"
#include "../../master/wire/merge.h"

/*
 * BRD of 0x0130: 2 slaves in PREOP on one side, one in OP on the other. LRW of 10 bytes: the first
 * one is of a slave of one side, the last one of the other.
 */
static void vectors_merge_both_sides_of_break(struct kunit *test)
{
	static const u8 sent[] = {
		0x24, 0x10,
		7, 5, 0, 0, 0x30, 1, 2, 0x80, 0, 0, 0, 0, 0, 0,
		12, 5, 0, 0, 0, 1, 10, 0, 0, 0, 0x10, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0, 0,
	};
	static const u8 first[] = {
		0x24, 0x10,
		7, 5, 2, 0, 0x30, 1, 2, 0x80, 0, 0, 2, 0, 2, 0,
		12, 5, 0, 0, 0, 1, 10, 0, 4, 0, 0x7f, 1, 2, 3, 4, 5, 6, 7, 8, 9, 3, 0,
	};
	static const u8 backup[] = {
		0x24, 0x10,
		7, 5, 1, 0, 0x30, 1, 2, 0x80, 0, 0, 8, 0, 1, 0,
		12, 5, 0, 0, 0, 1, 10, 0, 0, 0, 0x10, 1, 2, 3, 4, 5, 6, 7, 8, 0xee, 3, 0,
	};
	static const u8 want[] = {
		0x24, 0x10,
		7, 5, 3, 0, 0x30, 1, 2, 0x80, 0, 0, 10, 0, 3, 0,
		12, 5, 0, 0, 0, 1, 10, 0, 4, 0, 0x7f, 1, 2, 3, 4, 5, 6, 7, 8, 0xee, 6, 0,
	};
	u8 to[sizeof(first)];

	ec_merge_dgrams(to, first + 2, backup + 2, sent + 2, sizeof(to) - 2);
	KUNIT_EXPECT_MEMEQ(test, to, want + 2, sizeof(want) - 2);
	/* the second one alone */
	ec_merge_dgrams(to, first + 16, backup + 16, sent + 16, sizeof(to) - 16);
	KUNIT_EXPECT_MEMEQ(test, to, want + 16, sizeof(want) - 16);
}

/* 72 bytes of an LRW: the first one is of a slave of one side, two are of slaves of the other. */
static void vectors_merge_data_of_both_sides(struct kunit *test)
{
	static const u8 sent[72] = { [0] = 0x10, [35] = 0x20, [71] = 0x30 };
	static const u8 first[72] = { [0] = 0x7f, [35] = 0x20, [71] = 0x30 };
	static const u8 backup[72] = { [0] = 0x10, [35] = 0x21, [71] = 0xee };
	static const u8 want[72] = { [0] = 0x7f, [35] = 0x21, [71] = 0xee };
	u8 copy[72], to[72], *got;
	u16 cut = 0;

	memcpy(copy, first, sizeof(copy));
	got = ec_merge_data(to, copy, backup, sent, sizeof(to), &cut);
	KUNIT_EXPECT_PTR_EQ(test, got, &to[0]);
	KUNIT_EXPECT_MEMEQ(test, got, want, sizeof(want));
	/* the bytes up to it are of the first copy, the others of the second */
	KUNIT_EXPECT_TRUE(test, cut > 0 && cut <= 35);
	memcpy(copy, first, sizeof(copy));
	got = ec_merge_data(to, copy, backup, sent, sizeof(to), &cut);
	KUNIT_EXPECT_PTR_EQ(test, got, &copy[0]);
	KUNIT_EXPECT_MEMEQ(test, got, want, sizeof(want));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_merge_both_sides_of_break),
	KUNIT_CASE(vectors_merge_data_of_both_sides),
	{}
};

static struct kunit_suite suite = { .name = "vectors_merge", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
