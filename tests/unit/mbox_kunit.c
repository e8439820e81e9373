// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/mbox_encode.h"

static void mbox_header_survives_both_ways(struct kunit *test)
{
	struct ec_mbox_hdr in = {
		.len = 3, .address = 0x1001, .channel = 0x2A, .prio = 3,
		.type = EC_MBOX_VOE, .counter = 7,
	}, out;
	u8 msg[9] = { 0 };
	struct ec_wbuf w = ec_wbuf(msg, sizeof(msg));
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));

	ec_mbox_hdr_encode(&w, &in);
	KUNIT_EXPECT_EQ(test, ec_mbox_hdr_decode(&r, &out), 0);
	KUNIT_EXPECT_EQ(test, out.len, in.len);
	KUNIT_EXPECT_EQ(test, out.address, in.address);
	KUNIT_EXPECT_EQ(test, out.channel, in.channel);
	KUNIT_EXPECT_EQ(test, out.prio, in.prio);
	KUNIT_EXPECT_EQ(test, out.type, in.type);
	KUNIT_EXPECT_EQ(test, out.counter, in.counter);

	in.channel = 0x3F;
	in.prio = 0;
	w = ec_wbuf(msg, sizeof(msg));
	r = ec_rbuf(msg, sizeof(msg));
	ec_mbox_hdr_encode(&w, &in);
	KUNIT_EXPECT_EQ(test, msg[4], 0x3F);
	ec_mbox_hdr_decode(&r, &out);
	KUNIT_EXPECT_EQ(test, out.channel, 0x3F);
}

static void mbox_length_beyond_mailbox_is_refused(struct kunit *test)
{
	u8 msg[16] = { 11, 0, 0, 0, 0, EC_MBOX_COE };
	struct ec_mbox_hdr h;
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));

	KUNIT_EXPECT_EQ(test, ec_mbox_hdr_decode(&r, &h), -EBADMSG);
	msg[0] = 10;
	r = ec_rbuf(msg, sizeof(msg));
	KUNIT_EXPECT_EQ(test, ec_mbox_hdr_decode(&r, &h), 0);
	KUNIT_EXPECT_EQ(test, ec_rbuf_left(&r), (size_t)10);
}

static void mbox_short_header_is_refused(struct kunit *test)
{
	u8 msg[5] = { 0 };
	struct ec_mbox_hdr h;
	size_t len;

	for (len = 0; len <= sizeof(msg); len++) {
		struct ec_rbuf r = ec_rbuf(msg, len);

		KUNIT_EXPECT_EQ(test, ec_mbox_hdr_decode(&r, &h), -EMSGSIZE);
	}
}

static void mbox_counter_skips_zero(struct kunit *test)
{
	u8 c = 0;
	int i;

	for (i = 0; i < 20; i++) {
		c = ec_mbox_next_counter(c);
		KUNIT_EXPECT_EQ(test, c, i % 7 + 1);
	}
	KUNIT_EXPECT_EQ(test, ec_mbox_next_counter(255), 1);
}

static void mbox_error_reply_survives_both_ways(struct kunit *test)
{
	u8 msg[EC_MBOX_ERR_BODY];
	struct ec_wbuf w = ec_wbuf(msg, sizeof(msg));
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));
	u16 detail;

	ec_mbox_error_encode(&w, EC_MBOX_ERR_SIZE);
	KUNIT_EXPECT_EQ(test, ec_mbox_error_decode(&r, &detail), 0);
	KUNIT_EXPECT_EQ(test, detail, EC_MBOX_ERR_SIZE);

	r = ec_rbuf(msg, 3);
	KUNIT_EXPECT_EQ(test, ec_mbox_error_decode(&r, &detail), -EMSGSIZE);
	msg[0] = 2;
	r = ec_rbuf(msg, 4);
	KUNIT_EXPECT_EQ(test, ec_mbox_error_decode(&r, &detail), -EBADMSG);
}

static void mbox_every_error_has_text_and_errno(struct kunit *test)
{
	u16 i;

	for (i = 1; i <= 9; i++) {
		KUNIT_EXPECT_STRNEQ(test, ec_mbox_error_text(i), "unknown mailbox error");
		KUNIT_EXPECT_LT(test, ec_mbox_error_errno(i), 0);
		/* the errno leads back to the code */
		KUNIT_EXPECT_EQ(test, ec_mbox_errno_detail(ec_mbox_error_errno(i)), i);
	}
	KUNIT_EXPECT_STREQ(test, ec_mbox_error_text(0), "unknown mailbox error");
	KUNIT_EXPECT_STREQ(test, ec_mbox_error_text(10), "unknown mailbox error");
	KUNIT_EXPECT_EQ(test, ec_mbox_error_errno(2), -EPFNOSUPPORT);
	KUNIT_EXPECT_EQ(test, ec_mbox_error_errno(0xFFFF), -ECOMM);
	KUNIT_EXPECT_EQ(test, ec_mbox_errno_detail(-ECOMM), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(mbox_header_survives_both_ways),
	KUNIT_CASE(mbox_length_beyond_mailbox_is_refused),
	KUNIT_CASE(mbox_short_header_is_refused),
	KUNIT_CASE(mbox_counter_skips_zero),
	KUNIT_CASE(mbox_error_reply_survives_both_ways),
	KUNIT_CASE(mbox_every_error_has_text_and_errno),
	{}
};

static struct kunit_suite suite = { .name = "mbox", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
