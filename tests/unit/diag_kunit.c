// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/diag.h"

/* error 0x1234E800, text 0x10, five parameters: one of each kind */
static const u8 good[] = {
	0x00, 0xE8, 0x34, 0x12, 0x02, 0x05, 0x10, 0x00, 8, 7, 6, 5, 4, 3, 2, 1,
	0x06, 0x00, 0x42, 0x01,			/* UINT16 0x0142 */
	0x03, 0x10, 1, 2, 3,			/* three bytes */
	0x02, 0x20, 'a', 'b',
	0x02, 0x30, 'a', 0,
	0x00, 0x40, 0x21, 0x00,
};

static void diag_message_has_head_and_parameters(struct kunit *test)
{
	static const u8 kinds[] = {
		EC_DIAG_VALUE, EC_DIAG_BYTES, EC_DIAG_ASCII, EC_DIAG_UNICODE, EC_DIAG_TEXT_ID,
	};
	static const size_t sizes[] = { 2, 3, 2, 2, 2 };
	struct ec_diag_param p;
	struct ec_diag_msg m;
	size_t i;

	KUNIT_ASSERT_EQ(test, ec_diag_msg_decode(good, sizeof(good), &m), 0);
	KUNIT_EXPECT_EQ(test, m.code, 0x1234E800u);
	KUNIT_EXPECT_EQ(test, m.flags & 0xF, EC_DIAG_ERROR);
	KUNIT_EXPECT_EQ(test, m.text_id, 0x0010);
	KUNIT_EXPECT_EQ(test, m.time_ns, 0x0102030405060708ull);
	KUNIT_EXPECT_EQ(test, m.params, 5);
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		KUNIT_ASSERT_EQ(test, ec_diag_param_decode(&m, &p), 1);
		KUNIT_EXPECT_EQ(test, p.kind, kinds[i]);
		KUNIT_EXPECT_EQ(test, p.size, sizes[i]);
		if (!i)
			KUNIT_EXPECT_EQ(test, p.type, 0x0006);
	}
	KUNIT_EXPECT_EQ(test, ec_diag_param_decode(&m, &p), 0);
	KUNIT_EXPECT_EQ(test, ec_diag_param_decode(&m, &p), 0);
}

static void diag_message_of_zeros_is_empty(struct kunit *test)
{
	static const u8 zeros[40];
	struct ec_diag_msg m;

	KUNIT_EXPECT_EQ(test, ec_diag_msg_decode(zeros, 0, &m), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_diag_msg_decode(zeros, 3, &m), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_diag_msg_decode(zeros, sizeof(zeros), &m), -ENOMSG);
}

static void diag_message_cut_off_is_refused(struct kunit *test)
{
	struct ec_diag_param p;
	struct ec_diag_msg m;
	size_t len;
	int n, ret;

	for (len = 0; len < sizeof(good); len++) {
		ret = ec_diag_msg_decode(good, len, &m);
		KUNIT_ASSERT_EQ(test, ret, len < 2 ? -ENOMSG : len < EC_DIAG_HDR ? -EMSGSIZE : 0);
		for (n = 0; !ret; n++) {
			ret = ec_diag_param_decode(&m, &p);
			KUNIT_ASSERT_NE(test, ret, 0);
			if (ret == 1)
				KUNIT_ASSERT_LE(test, p.data + p.size - good, (long)len);
			ret = ret == 1 ? 0 : ret;
		}
		KUNIT_ASSERT_LE(test, n, 5);
	}
}

static void diag_parameter_of_unknown_size_ends_message(struct kunit *test)
{
	static const u16 bad[] = { 0x0009, 0x0FFF, 0x5001, 0xF000, 0x1FFF };
	u8 msg[64] = { 1, [5] = 255 };
	struct ec_diag_param p;
	struct ec_diag_msg m;
	size_t i;

	for (i = 0; i < ARRAY_SIZE(bad); i++) {
		put_unaligned_le16(bad[i], msg + EC_DIAG_HDR);
		KUNIT_ASSERT_EQ(test, ec_diag_msg_decode(msg, sizeof(msg), &m), 0);
		KUNIT_EXPECT_EQ(test, m.params, 255);
		KUNIT_EXPECT_EQ(test, ec_diag_param_decode(&m, &p), -EBADMSG);
		KUNIT_EXPECT_NULL(test, p.data);
		KUNIT_EXPECT_EQ(test, ec_diag_param_decode(&m, &p), 0);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(diag_message_has_head_and_parameters),
	KUNIT_CASE(diag_message_of_zeros_is_empty),
	KUNIT_CASE(diag_message_cut_off_is_refused),
	KUNIT_CASE(diag_parameter_of_unknown_size_ends_message),
	{}
};

static struct kunit_suite suite = { .name = "diag", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
