// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/buf.h"

static void buf_fields_are_read_in_little_endian_order(struct kunit *test)
{
	static const u8 in[] = { 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08,
				 0x09, 0x0A, 0x0B, 0x0C, 0x0D, 0x0E, 0x0F };
	struct ec_rbuf r = ec_rbuf(in, sizeof(in));

	KUNIT_EXPECT_EQ(test, ec_rbuf_u8(&r), 0x01);
	KUNIT_EXPECT_EQ(test, ec_rbuf_le16(&r), 0x0302);
	KUNIT_EXPECT_EQ(test, ec_rbuf_le32(&r), 0x07060504u);
	KUNIT_EXPECT_EQ(test, ec_rbuf_le64(&r), 0x0F0E0D0C0B0A0908ull);
	KUNIT_EXPECT_FALSE(test, r.bad);
	KUNIT_EXPECT_EQ(test, ec_rbuf_left(&r), (size_t)0);
}

static void buf_short_read_gives_zero_and_sticks(struct kunit *test)
{
	static const u8 in[] = { 0xAA, 0xBB, 0xCC };
	struct ec_rbuf r = ec_rbuf(in, sizeof(in));

	KUNIT_EXPECT_EQ(test, ec_rbuf_le32(&r), 0u);
	KUNIT_EXPECT_TRUE(test, r.bad);
	KUNIT_EXPECT_EQ(test, ec_rbuf_u8(&r), 0);
	KUNIT_EXPECT_TRUE(test, r.bad);
}

static void buf_taking_more_than_is_left_returns_null(struct kunit *test)
{
	static const u8 in[4];
	struct ec_rbuf r = ec_rbuf(in, sizeof(in));

	KUNIT_EXPECT_NOT_NULL(test, ec_rbuf_take(&r, 4));
	KUNIT_EXPECT_NOT_NULL(test, ec_rbuf_take(&r, 0));
	KUNIT_EXPECT_NULL(test, ec_rbuf_take(&r, 1));
}

static void buf_enormous_length_is_refused(struct kunit *test)
{
	static const u8 in[4];
	struct ec_rbuf r = ec_rbuf(in, sizeof(in));
	u8 out[4];
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));

	KUNIT_EXPECT_NULL(test, ec_rbuf_take(&r, (size_t)-1));
	KUNIT_EXPECT_NULL(test, ec_wbuf_take(&w, (size_t)-1));
}

static void buf_fields_are_written_in_little_endian_order(struct kunit *test)
{
	static const u8 want[] = { 0x01, 0x03, 0x02, 0x07, 0x06, 0x05, 0x04,
				   0x0F, 0x0E, 0x0D, 0x0C, 0x0B, 0x0A, 0x09, 0x08, 0xEE, 0x00, 0x00 };
	u8 out[sizeof(want)];
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));

	memset(out, 0x55, sizeof(out));
	ec_wbuf_u8(&w, 0x01);
	ec_wbuf_le16(&w, 0x0203);
	ec_wbuf_le32(&w, 0x04050607);
	ec_wbuf_le64(&w, 0x08090A0B0C0D0E0Full);
	ec_wbuf_bytes(&w, "\xEE", 1);
	ec_wbuf_zero(&w, 2);
	KUNIT_EXPECT_FALSE(test, w.bad);
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

static void buf_write_that_does_not_fit_leaves_buffer_alone(struct kunit *test)
{
	u8 out[4] = { 1, 2, 3, 4 };
	struct ec_wbuf w = ec_wbuf(out, 3);

	ec_wbuf_le32(&w, 0xFFFFFFFF);
	KUNIT_EXPECT_TRUE(test, w.bad);
	ec_wbuf_u8(&w, 0xFF);
	KUNIT_EXPECT_EQ(test, out[0], 1);
	KUNIT_EXPECT_EQ(test, out[3], 4);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(buf_fields_are_read_in_little_endian_order),
	KUNIT_CASE(buf_short_read_gives_zero_and_sticks),
	KUNIT_CASE(buf_taking_more_than_is_left_returns_null),
	KUNIT_CASE(buf_enormous_length_is_refused),
	KUNIT_CASE(buf_fields_are_written_in_little_endian_order),
	KUNIT_CASE(buf_write_that_does_not_fit_leaves_buffer_alone),
	{}
};

static struct kunit_suite suite = { .name = "buf", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
