// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/mbox_encode.h"
#include "../../master/wire/emergency.h"

static void coe_header_survives_both_ways(struct kunit *test)
{
	static const u8 txpdo[2] = { 0xA5, 0x41 };
	u8 msg[2];
	struct ec_wbuf w = ec_wbuf(msg, sizeof(msg));
	struct ec_rbuf r = ec_rbuf(txpdo, sizeof(txpdo));
	struct ec_coe_hdr out;

	KUNIT_EXPECT_EQ(test, ec_coe_hdr_decode(&r, &out), 0);
	KUNIT_EXPECT_EQ(test, out.number, 0x1A5);
	KUNIT_EXPECT_EQ(test, out.service, EC_COE_TXPDO);
	ec_coe_hdr_encode(&w, EC_COE_TXPDO);
	r = ec_rbuf(msg, sizeof(msg));
	KUNIT_EXPECT_EQ(test, ec_coe_hdr_decode(&r, &out), 0);
	KUNIT_EXPECT_EQ(test, out.number, 0);
	KUNIT_EXPECT_EQ(test, out.service, EC_COE_TXPDO);
	r = ec_rbuf(msg, 1);
	KUNIT_EXPECT_EQ(test, ec_coe_hdr_decode(&r, &out), -EMSGSIZE);
}

static void coe_emergency_survives_both_ways(struct kunit *test)
{
	struct ec_coe_emergency in = { 0x8130, 0x11, { 1, 2, 3, 4, 5 } }, out;
	u8 msg[EC_COE_EMERGENCY_SIZE];

	KUNIT_EXPECT_EQ(test, ec_coe_emergency_encode(msg, sizeof(msg) - 1, &in), -EMSGSIZE);
	KUNIT_ASSERT_EQ(test, ec_coe_emergency_encode(msg, sizeof(msg), &in), 10);
	KUNIT_ASSERT_EQ(test, ec_coe_emergency_decode(msg, sizeof(msg), &out), 0);
	KUNIT_EXPECT_EQ(test, out.code, 0x8130);
	KUNIT_EXPECT_EQ(test, out.reg, 0x11);
	KUNIT_EXPECT_MEMEQ(test, out.data, in.data, 5);
	KUNIT_EXPECT_EQ(test, ec_coe_emergency_decode(msg, 9, &out), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_coe_emergency_decode(msg, 0, &out), -EMSGSIZE);
	msg[1] = 0x30;
	KUNIT_EXPECT_EQ(test, ec_coe_emergency_decode(msg, 10, &out), -ENOMSG);
}

static void coe_emergency_text_is_of_code_profile_and_group(struct kunit *test)
{
	static const struct {
		u16 code;
		u32 profile;
		const char *text;
	} e[] = {
		{ 0x7305, EC_PROFILE_DRIVE, "fault of encoder 1" },
		{ 0x7305, 0, "additional modules" },
		{ 0x2312, EC_PROFILE_DRIVE, "continuous overcurrent, motor side" },
		{ 0x2312, 401, "current, output side" },
		/* no code of drives: the group of all devices */
		{ 0x1001, EC_PROFILE_DRIVE, "generic error" },
		{ 0x0000, EC_PROFILE_DRIVE, "no error any more" },
		{ 0x8130, 0, "heartbeat missing" },
		{ 0x8131, 0, "communication" },
		{ 0xb000, 0, "unknown group" },
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(e); i++)
		KUNIT_EXPECT_STREQ(test, ec_emergency_text(e[i].code, e[i].profile), e[i].text);
}

static void coe_every_known_abort_code_has_text(struct kunit *test)
{
	static const u32 known[] = {
		0x05030000, 0x05040000, 0x05040001, 0x05040002, 0x05040003, 0x05040004,
		0x05040005, 0x06010000, 0x06010001, 0x06010002, 0x06010003, 0x06010004,
		0x06010005, 0x06010006, 0x06020000, 0x06040041, 0x06040042, 0x06040043,
		0x06040047, 0x06060000, 0x06070010, 0x06070012, 0x06070013, 0x06090011,
		0x06090030, 0x06090031, 0x06090032, 0x06090033, 0x06090036, 0x060A0023,
		0x08000000, 0x08000020, 0x08000021, 0x08000022, 0x08000023, 0x08000024,
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(known); i++) {
		KUNIT_EXPECT_NOT_NULL_MSG(test, ec_coe_abort_text(known[i]), "0x%08x", known[i]);
			KUNIT_EXPECT_NULL(test, ec_coe_abort_text(known[i] + 0x100));
	}
	KUNIT_EXPECT_NULL(test, ec_coe_abort_text(0));
	KUNIT_EXPECT_NULL(test, ec_coe_abort_text(0xFFFFFFFF));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(coe_header_survives_both_ways),
	KUNIT_CASE(coe_emergency_survives_both_ways),
	KUNIT_CASE(coe_emergency_text_is_of_code_profile_and_group),
	KUNIT_CASE(coe_every_known_abort_code_has_text),
	{}
};

static struct kunit_suite suite = { .name = "coe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
