// SPDX-License-Identifier: GPL-2.0-only
/* Which writes are not replayed. */
#include "wire_kunit.h"
#include "../../master/wire/replay.h"

static void replay_sdo_filter_covers_all_axes(struct kunit *test)
{
	u32 axis;

	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x100f), (int)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x1010), (int)EC_REPLAY_WHY_STORE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x1011), (int)EC_REPLAY_WHY_STORE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x1012), (int)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x10f1), (int)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x10f2), (int)EC_REPLAY_WHY_COMMAND);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x10ff), (int)EC_REPLAY_WHY_COMMAND);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x1100), (int)EC_REPLAY_WHY_NONE);
	for (axis = 0; axis < 8; axis++) {
		u16 at = axis * 0x800;

		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x6040 + at),
				(int)EC_REPLAY_WHY_CONTROL);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x6071 + at),
				(int)EC_REPLAY_WHY_TARGET);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x607a + at),
				(int)EC_REPLAY_WHY_TARGET);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x60c1 + at),
				(int)EC_REPLAY_WHY_TARGET);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x60ff + at),
				(int)EC_REPLAY_WHY_TARGET);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x6060 + at),
				(int)EC_REPLAY_WHY_NONE);
		KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x6083 + at),
				(int)EC_REPLAY_WHY_NONE);
	}
	/* as far from the profile area */
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0x5840), (int)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0xa040), (int)EC_REPLAY_WHY_NONE);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_sdo_why(0xffff), (int)EC_REPLAY_WHY_NONE);
}

static void replay_idn_filter_covers_commands(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(134), (int)EC_REPLAY_WHY_CONTROL);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(36), (int)EC_REPLAY_WHY_TARGET);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(47), (int)EC_REPLAY_WHY_TARGET);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(80), (int)EC_REPLAY_WHY_TARGET);
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(91), (int)EC_REPLAY_WHY_NONE);
	/* P-0-0036 is the manufacturer's */
	KUNIT_EXPECT_EQ(test, (int)ec_replay_idn_why(0x8000 | 36), (int)EC_REPLAY_WHY_NONE);
}

static void replay_register_filter_excludes_master(struct kunit *test)
{
	static const struct {
		u16 address;
		u32 size;
		bool replayed;
	} cases[] = {
		{ 0x0010, 2, false }, { 0x0040, 1, false }, { 0x0120, 2, false },
		{ 0x02ff, 2, false }, { 0x0300, 20, true }, { 0x0420, 2, true },
		{ 0x04fe, 2, true }, { 0x04ff, 2, false }, { 0x0500, 1, false },
		{ 0x0600, 16, false }, { 0x0980, 1, false }, { 0x0dff, 2, false },
		{ 0x0e00, 1, true }, { 0x0f80, 128, true }, { 0x0fff, 2, false },
		{ 0x1000, 1, false }, { 0xffff, 1024, false },
	};
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(cases); i++)
		KUNIT_EXPECT_EQ_MSG(test,
				    ec_replay_register_why(cases[i].address, cases[i].size) ==
				    EC_REPLAY_WHY_NONE, cases[i].replayed, "0x%04x, %u",
				    cases[i].address, cases[i].size);
}

static void replay_reason_always_has_text(struct kunit *test)
{
	u8 why;

	KUNIT_EXPECT_STREQ(test, ec_replay_why_text(EC_REPLAY_WHY_NONE), "");
	for (why = 1; why < EC_REPLAY_WHYS; why++)
		KUNIT_EXPECT_GT(test, strlen(ec_replay_why_text(why)), 5u);
	KUNIT_EXPECT_STREQ(test, ec_replay_why_text(EC_REPLAY_WHYS), "unknown reason");
	KUNIT_EXPECT_STREQ(test, ec_replay_why_text(255), "unknown reason");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(replay_sdo_filter_covers_all_axes),
	KUNIT_CASE(replay_idn_filter_covers_commands),
	KUNIT_CASE(replay_register_filter_excludes_master),
	KUNIT_CASE(replay_reason_always_has_text),
	{}
};

static struct kunit_suite suite = { .name = "replay", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
