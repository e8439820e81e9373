// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/frame.h"

static u8 buf[1600];

static void frame_built_frame_is_read_back(struct kunit *test)
{
	struct ec_frame_buf f;
	struct ec_frame_iter it;
	struct ec_dgram d;
	u8 *a, *b;
	size_t len;

	ec_frame_begin(&f, buf, sizeof(buf));
	a = ec_frame_add(&f, EC_CMD_FPRD, 7, 0x03E9, 0x0130, 6);
	b = ec_frame_add(&f, EC_CMD_LRW, 7, 0x5678, 0x1234, 3);
	KUNIT_ASSERT_NOT_NULL(test, a);
	KUNIT_ASSERT_NOT_NULL(test, b);
	memset(a, 0, 6);
	memcpy(b, "abc", 3);
	len = ec_frame_end(&f);
	KUNIT_EXPECT_EQ(test, len, (size_t)(2 + 12 + 6 + 12 + 3));
	KUNIT_EXPECT_EQ(test, f.count, 2u);

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, buf, len), 0);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, d.cmd, EC_CMD_FPRD);
	KUNIT_EXPECT_EQ(test, d.adp, 0x03E9);
	KUNIT_EXPECT_EQ(test, d.ado, 0x0130);
	KUNIT_EXPECT_EQ(test, d.len, 6);
	KUNIT_EXPECT_TRUE(test, d.more);
	KUNIT_EXPECT_EQ(test, ec_dgram_wkc(&d), 0);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, ec_dgram_logical(&d), 0x12345678u);
	KUNIT_EXPECT_FALSE(test, d.more);
	KUNIT_EXPECT_MEMEQ(test, d.data, "abc", 3);
	ec_dgram_set_wkc(&d, 3);
	KUNIT_EXPECT_EQ(test, ec_dgram_wkc(&d), 3);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 0);
}

static void frame_padding_behind_datagrams_is_ignored(struct kunit *test)
{
	struct ec_frame_buf f;
	struct ec_frame_iter it;
	struct ec_dgram d;

	memset(buf, 0xEE, sizeof(buf));
	ec_frame_begin(&f, buf, sizeof(buf));
	ec_frame_add(&f, EC_CMD_BRD, 0, 0, 0, 1);
	ec_frame_end(&f);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, buf, 46), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 0);
}

static void frame_of_another_type_is_refused(struct kunit *test)
{
	u8 in[16] = { 14, 0x40 };
	struct ec_frame_iter it;

	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), -EPROTONOSUPPORT);
}

static void frame_length_beyond_frame_is_refused(struct kunit *test)
{
	u8 in[16] = { 15, 0x10 };
	struct ec_frame_iter it;

	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), -EBADMSG);
	in[0] = 14;
	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	in[0] = 11;	/* too little for one datagram */
	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, 13), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_init(&it, in, 0), -EBADMSG);
}

static void frame_datagram_length_beyond_frame_is_refused(struct kunit *test)
{
	u8 in[16] = { 14, 0x10, EC_CMD_BRD, 0, 0, 0, 0, 0, 3, 0 };
	struct ec_frame_iter it;
	struct ec_dgram d;

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), -EBADMSG);
	in[8] = 2;
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 1);
}

static void frame_more_bit_without_another_datagram_is_refused(struct kunit *test)
{
	u8 in[30] = { 12, 0x10, EC_CMD_BRD };
	struct ec_frame_iter it;
	struct ec_dgram d;

	in[9] = 0x80;	/* more, but nothing follows */
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), -EBADMSG);

	/*
	 * No more, but the length says otherwise: masters in the field write
	 * such frames. The datagram counts, the walk must come to an end.
	 */
	in[9] = 0;
	in[0] = 13;
	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_LE(test, ec_frame_iter_next(&it, &d), 0);
}

static void frame_takes_1498_bytes_and_no_more(struct kunit *test)
{
	struct ec_frame_buf f;

	ec_frame_begin(&f, buf, sizeof(buf));
	KUNIT_EXPECT_NOT_NULL(test, ec_frame_add(&f, EC_CMD_LRW, 0, 0, 0, EC_DGRAM_DATA_MAX));
	KUNIT_EXPECT_NULL(test, ec_frame_add(&f, EC_CMD_NOP, 0, 0, 0, 0));
	KUNIT_EXPECT_EQ(test, ec_frame_end(&f), (size_t)1500);

	ec_frame_begin(&f, buf, sizeof(buf));
	KUNIT_EXPECT_NULL(test, ec_frame_add(&f, EC_CMD_LRW, 0, 0, 0, EC_DGRAM_DATA_MAX + 1));
	ec_frame_begin(&f, buf, 20);
	KUNIT_EXPECT_NULL(test, ec_frame_add(&f, EC_CMD_LRW, 0, 0, 0, 7));
	KUNIT_EXPECT_NOT_NULL(test, ec_frame_add(&f, EC_CMD_LRW, 0, 0, 0, 6));
	ec_frame_begin(&f, buf, 1);
	KUNIT_EXPECT_NULL(test, ec_frame_add(&f, EC_CMD_NOP, 0, 0, 0, 0));
}

static void frame_refused_datagram_leaves_no_more_bit(struct kunit *test)
{
	struct ec_frame_buf f;

	ec_frame_begin(&f, buf, 2 + 12 + 2 + 11);
	KUNIT_ASSERT_NOT_NULL(test, ec_frame_add(&f, EC_CMD_BRD, 0, 0, 0, 2));
	KUNIT_ASSERT_NULL(test, ec_frame_add(&f, EC_CMD_BRD, 0, 0, 0, 0));
	KUNIT_EXPECT_EQ(test, buf[2 + 7], 0);
}

static void frame_datagrams_of_two_frames_make_one(struct kunit *test)
{
	struct ec_frame_buf f, other;
	struct ec_frame_iter it;
	static u8 two[64];
	struct ec_dgram d;
	size_t len;

	ec_frame_begin(&other, two, sizeof(two));
	memset(ec_frame_add(&other, EC_CMD_FPRD, 8, 0x1001, 0x0130, 2), 0, 2);
	memset(ec_frame_add(&other, EC_CMD_FPWR, 8, 0x1002, 0x0800, 5), 9, 5);
	len = ec_frame_end(&other) - EC_FRAME_HDR;

	ec_frame_begin(&f, buf, EC_FRAME_HDR + 2 * len);
	KUNIT_ASSERT_TRUE(test, ec_frame_append(&f, two + EC_FRAME_HDR, len, 14, 2));
	KUNIT_ASSERT_TRUE(test, ec_frame_append(&f, two + EC_FRAME_HDR, len, 14, 2));
	/* full; and a last datagram that is not in it */
	KUNIT_EXPECT_FALSE(test, ec_frame_append(&f, two + EC_FRAME_HDR, 13, 0, 1));
	ec_frame_begin(&other, two, sizeof(two));
	KUNIT_EXPECT_FALSE(test, ec_frame_append(&other, buf + EC_FRAME_HDR, 13, 2, 1));
	KUNIT_EXPECT_EQ(test, f.count, 4u);
	KUNIT_EXPECT_EQ(test, ec_frame_end(&f), EC_FRAME_HDR + 2 * len);

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, buf, EC_FRAME_HDR + 2 * len), 0);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_TRUE(test, d.more);
	KUNIT_EXPECT_EQ(test, d.data[4], 9);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, d.adp, 0x1001);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_FALSE(test, d.more);
	KUNIT_EXPECT_EQ(test, ec_frame_iter_next(&it, &d), 0);
}

static void frame_wire_time_counts_preamble_padding_and_gap(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_frame_wire_ns(14 + 2 + 12 + 1), 6720u);
	KUNIT_EXPECT_EQ(test, ec_frame_wire_ns(60), 6720u);
	KUNIT_EXPECT_EQ(test, ec_frame_wire_ns(14 + 2 + 12 + 100), 12160u);
	KUNIT_EXPECT_EQ(test, ec_frame_wire_ns(1514), 123040u);
}

static void frame_commands_have_known_directions(struct kunit *test)
{
	KUNIT_EXPECT_TRUE(test, ec_cmd_reads(EC_CMD_LRW));
	KUNIT_EXPECT_TRUE(test, ec_cmd_writes(EC_CMD_LRW));
	KUNIT_EXPECT_FALSE(test, ec_cmd_reads(EC_CMD_FPWR));
	KUNIT_EXPECT_FALSE(test, ec_cmd_writes(EC_CMD_BRD));
	KUNIT_EXPECT_FALSE(test, ec_cmd_reads(200));
	KUNIT_EXPECT_FALSE(test, ec_cmd_writes(200));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(frame_built_frame_is_read_back),
	KUNIT_CASE(frame_padding_behind_datagrams_is_ignored),
	KUNIT_CASE(frame_of_another_type_is_refused),
	KUNIT_CASE(frame_length_beyond_frame_is_refused),
	KUNIT_CASE(frame_datagram_length_beyond_frame_is_refused),
	KUNIT_CASE(frame_more_bit_without_another_datagram_is_refused),
	KUNIT_CASE(frame_takes_1498_bytes_and_no_more),
	KUNIT_CASE(frame_refused_datagram_leaves_no_more_bit),
	KUNIT_CASE(frame_datagrams_of_two_frames_make_one),
	KUNIT_CASE(frame_wire_time_counts_preamble_padding_and_gap),
	KUNIT_CASE(frame_commands_have_known_directions),
	{}
};

static struct kunit_suite suite = { .name = "frame", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
