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

	ec_merge_frame(to, first, backup, sent, sizeof(to));
	KUNIT_EXPECT_MEMEQ(test, to, want, sizeof(want));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_merge_both_sides_of_break),
	{}
};

static struct kunit_suite suite = { .name = "vectors_merge", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
