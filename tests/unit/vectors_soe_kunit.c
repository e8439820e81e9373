// SPDX-License-Identifier: GPL-2.0-only
/* SoE and VoE messages typed from the tables of the specification. */
#include "wire_kunit.h"
#include "../../devices/sim/codes.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"

static void vectors_soe_read_s_0_0015_of_drive_2(struct kunit *test)
{
	static const u8 req[] = { 0x41, 0x40, 0x0F, 0x00 };
	static const u8 resp[] = { 0x42, 0x40, 0x0F, 0x00, 0x07, 0x00 };
	static const u8 error[] = { 0x52, 0x40, 0x0F, 0x00, 0x0A, 0x80 };
	u8 out[8], value[2] = { 0 };
	struct ec_soe_access a = {
		.drive = 2, .elements = EC_SOE_VALUE, .idn = 15, .data = value, .cap = 2,
	};

	KUNIT_ASSERT_EQ(test, ec_soe_tx(&a, out, sizeof(out)), 4);
	KUNIT_EXPECT_MEMEQ(test, out, req, 4);
	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, resp, sizeof(resp)), 0);
	KUNIT_EXPECT_EQ(test, a.size, (size_t)2);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(value), 7);
	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, error, sizeof(error)), -EIO);
	KUNIT_EXPECT_EQ(test, a.error, EC_SOE_ERR_DRIVE);
}

static void vectors_soe_notification_and_emergency(struct kunit *test)
{
	static const u8 notification[] = { 0x25, 0x01, 0x94, 0x00, 0x03, 0x00 };
	static const u8 emergency[] = { 0x06, 0x00, 0x00, 0x00, 1, 2, 3, 4, 5 };
	static const u8 response[] = { 0x42, 0x40, 0x0F, 0x00, 0x07, 0x00 };

	KUNIT_EXPECT_TRUE(test, ec_soe_is_unasked(notification, sizeof(notification)));
	KUNIT_EXPECT_TRUE(test, ec_soe_is_unasked(emergency, sizeof(emergency)));
	KUNIT_EXPECT_FALSE(test, ec_soe_is_unasked(response, sizeof(response)));
	KUNIT_EXPECT_FALSE(test, ec_soe_is_unasked(notification, 0));
}

static void vectors_soe_write_p_0_0150(struct kunit *test)
{
	static const u8 req[] = { 0x03, 0x40, 0x96, 0x80, 0x34, 0x12 };
	static const u8 resp[] = { 0x04, 0x40, 0x96, 0x80 };
	static const u8 error[] = { 0x14, 0x40, 0x96, 0x80, 0x05, 0x70 };
	u8 out[8], value[2] = { 0x34, 0x12 };
	struct ec_soe_access a = {
		.write = true, .elements = EC_SOE_VALUE, .idn = 0x8096, .data = value, .size = 2,
	};

	KUNIT_ASSERT_EQ(test, ec_soe_tx(&a, out, sizeof(out)), 6);
	KUNIT_EXPECT_MEMEQ(test, out, req, 6);
	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, resp, sizeof(resp)), 0);
	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, error, sizeof(error)), -EIO);
	KUNIT_EXPECT_EQ(test, a.error, EC_SOE_ERR_PROTECTED);
}

static void vectors_soe_fragments_and_flags_of_header(struct kunit *test)
{
	/* read response of drive 7, incomplete, 3 fragments left */
	static const u8 msg[] = { 0xEA, 0x42, 0x03, 0x00 };
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));
	struct ec_soe_hdr h;

	KUNIT_ASSERT_EQ(test, ec_soe_hdr_decode(&r, &h), 0);
	KUNIT_EXPECT_EQ(test, h.opcode, EC_SOE_READ_RESP);
	KUNIT_EXPECT_TRUE(test, h.incomplete);
	KUNIT_EXPECT_FALSE(test, h.error);
	KUNIT_EXPECT_EQ(test, h.drive, 7);
	KUNIT_EXPECT_EQ(test, h.elements, EC_SOE_VALUE | EC_SOE_NAME);
	KUNIT_EXPECT_EQ(test, h.idn, 3);
}

static void vectors_soe_vendor_message(struct kunit *test)
{
	static const u8 msg[] = { 0xAD, 0xDE, 0xEF, 0xBE, 0x34, 0x12, 'x' };
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));
	u8 out[EC_VOE_HDR];
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));
	struct ec_voe_hdr h;

	KUNIT_ASSERT_EQ(test, ec_voe_hdr_decode(&r, &h), 0);
	KUNIT_EXPECT_EQ(test, h.vendor, 0xBEEFDEADu);
	KUNIT_EXPECT_EQ(test, h.type, 0x1234);
	KUNIT_EXPECT_EQ(test, *r.p, 'x');
	ec_voe_hdr_encode(&w, &h);
	KUNIT_EXPECT_MEMEQ(test, out, msg, EC_VOE_HDR);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_soe_read_s_0_0015_of_drive_2),
	KUNIT_CASE(vectors_soe_notification_and_emergency),
	KUNIT_CASE(vectors_soe_write_p_0_0150),
	KUNIT_CASE(vectors_soe_fragments_and_flags_of_header),
	KUNIT_CASE(vectors_soe_vendor_message),
	{}
};

static struct kunit_suite suite = { .name = "vectors_soe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
