// SPDX-License-Identifier: GPL-2.0-only
/* FoE messages typed from the tables of the specification. */
#include "wire_kunit.h"
#include "../../master/wire/foe.h"

static void vectors_foe_write_five_bytes(struct kunit *test)
{
	static const u8 wrq[] = { 0x02, 0x00, 0x78, 0x56, 0x34, 0x12, 'f', 'w' };
	static const u8 ack0[] = { 0x04, 0x00, 0x00, 0x00, 0x00, 0x00 };
	static const u8 data1[] = { 0x03, 0x00, 0x01, 0x00, 0x00, 0x00 };
	static const u8 busy[] = { 0x06, 0x00, 0x05, 0x00, 0x64, 0x00 };
	static const u8 ack1[] = { 0x04, 0x00, 0x01, 0x00, 0x00, 0x00 };
	static const u8 data2[] = { 0x03, 0x00, 0x02, 0x00, 0x00, 0x00 };
	static const u8 ack2[] = { 0x04, 0x00, 0x02, 0x00, 0x00, 0x00 };
	struct ec_foe f = {
		.write = true, .password = 0x12345678, .name = "fw", .name_len = 2, .size = 5,
	};
	u8 tx[10];

	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 8);
	KUNIT_EXPECT_MEMEQ(test, tx, wrq, 8);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, ack0, sizeof(ack0), 0), EC_MORE);
	/* 4 of 5 bytes fit */
	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 10);
	KUNIT_EXPECT_MEMEQ(test, tx, data1, 6);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, busy, sizeof(busy), 0), EC_MORE);
	KUNIT_EXPECT_TRUE(test, f.busy);
	KUNIT_EXPECT_EQ(test, f.done, 5);
	KUNIT_EXPECT_EQ(test, f.entire, 100);
	/* the same again */
	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 10);
	KUNIT_EXPECT_MEMEQ(test, tx, data1, 6);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, ack1, sizeof(ack1), 0), EC_MORE);
	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 7);
	KUNIT_EXPECT_MEMEQ(test, tx, data2, 6);
	KUNIT_EXPECT_EQ(test, f.at, 4ull);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, ack2, sizeof(ack2), 0), 0);
}

static void vectors_foe_read_two_packets(struct kunit *test)
{
	static const u8 rrq[] = { 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 'a' };
	static const u8 data1[] = { 0x03, 0x00, 0x01, 0x00, 0x00, 0x00, 1, 2, 3, 4 };
	static const u8 ack1[] = { 0x04, 0x00, 0x01, 0x00, 0x00, 0x00 };
	static const u8 data2[] = { 0x03, 0x00, 0x02, 0x00, 0x00, 0x00, 5 };
	struct ec_foe f = { .name = "a", .name_len = 1 };
	u8 tx[10];

	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 7);
	KUNIT_EXPECT_MEMEQ(test, tx, rrq, 7);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, data1, sizeof(data1), 4), EC_MORE);
	KUNIT_EXPECT_EQ(test, f.n, 4);
	KUNIT_EXPECT_FALSE(test, f.last);
	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 6);
	KUNIT_EXPECT_MEMEQ(test, tx, ack1, 6);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, data2, sizeof(data2), 4), EC_MORE);
	KUNIT_EXPECT_EQ(test, f.size, 5ull);
	KUNIT_EXPECT_TRUE(test, f.last);
}

static void vectors_foe_error_disk_full(struct kunit *test)
{
	static const u8 error[] = { 0x05, 0x00, 0x03, 0x80, 0x00, 0x00, 'f', 'u', 'l', 'l' };
	struct ec_foe f = { .write = true, .name = "a", .name_len = 1, .size = 1 };
	u8 tx[10];

	KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, sizeof(tx)), 7);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, error, sizeof(error), 0), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, f.error, (u32)EC_FOE_ERR_FULL);
	KUNIT_EXPECT_STREQ(test, f.text, "full");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_foe_write_five_bytes),
	KUNIT_CASE(vectors_foe_read_two_packets),
	KUNIT_CASE(vectors_foe_error_disk_full),
	{}
};

static struct kunit_suite suite = { .name = "vectors_foe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
