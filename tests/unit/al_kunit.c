// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/app.h"

static const u8 states[] = { EC_AL_INIT, EC_AL_PREOP, EC_AL_BOOT, EC_AL_SAFEOP, EC_AL_OP };

static void al_states_have_names(struct kunit *test)
{
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(1), "INIT");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(2), "PREOP");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(3), "BOOT");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(4), "SAFEOP");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(8), "OP");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(0x14), "SAFEOP");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(0), "???");
	KUNIT_EXPECT_STREQ(test, ec_al_state_name(0x0C), "???");
}

static void al_only_five_values_are_states(struct kunit *test)
{
	int i, n = 0;

	for (i = 0; i < 256; i++)
		n += ec_al_state_valid((u8)i);
	KUNIT_EXPECT_EQ(test, n, 5);
	KUNIT_EXPECT_FALSE(test, ec_al_state_valid(EC_AL_OP | 0x10));
}

static void al_transitions_follow_table(struct kunit *test)
{
	/* rows: from, columns: to, in the order INIT PREOP BOOT SAFEOP OP */
	static const char * const table[] = {
		"yyy..", "yy.y.", "y.y..", "yy.yy", "yy.yy",
	};
	int i, j;

	for (i = 0; i < 5; i++)
		for (j = 0; j < 5; j++)
			KUNIT_EXPECT_EQ_MSG(test, ec_app_al_legal(states[i], states[j]),
					    table[i][j] == 'y', "%s to %s",
					    ec_al_state_name(states[i]),
					    ec_al_state_name(states[j]));
	KUNIT_EXPECT_FALSE(test, ec_app_al_legal(EC_AL_OP, 5));
	KUNIT_EXPECT_FALSE(test, ec_app_al_legal(0, EC_AL_INIT));
}

static void al_transitions_have_default_time_limits(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_INIT, EC_AL_PREOP), 3000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_INIT, EC_AL_BOOT), 3000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_PREOP, EC_AL_SAFEOP), 10000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_SAFEOP, EC_AL_OP), 10000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_OP, EC_AL_SAFEOP), 200u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_OP, EC_AL_PREOP), 5000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_SAFEOP, EC_AL_INIT), 5000u);
	KUNIT_EXPECT_EQ(test, ec_al_timeout_ms(EC_AL_BOOT, EC_AL_INIT), 10000u);
}

static void al_every_known_status_code_has_text(struct kunit *test)
{
	static const u16 known[] = {
		0x0000, 0x0001, 0x0002, 0x0003, 0x0004, 0x0006, 0x0007, 0x000E, 0x0011, 0x0012,
		0x0013, 0x0014, 0x0015, 0x0016, 0x0017, 0x0018, 0x0019, 0x001A, 0x001B, 0x001C,
		0x001D, 0x001E, 0x001F, 0x0020, 0x0021, 0x0022, 0x0023, 0x0024, 0x0025, 0x0026,
		0x0027, 0x0028, 0x0029, 0x002A, 0x002B, 0x002C, 0x002D, 0x002E, 0x0030, 0x0031,
		0x0032, 0x0033, 0x0034, 0x0035, 0x0036, 0x0037, 0x0041, 0x0042, 0x0043, 0x0044,
		0x0045, 0x004F, 0x0050, 0x0051, 0x0052, 0x0060, 0x0061, 0x0070, 0x0080, 0x0081,
		0x0082, 0x0083, 0x00F0,
	};
	u32 i, j = 0, code;

	for (code = 0; code <= 0xFFFF; code++) {
		const char *text = ec_al_code_text((u16)code);
		bool listed = j < ARRAY_SIZE(known) && known[j] == code;

		KUNIT_ASSERT_NOT_NULL(test, text);
		if (listed)
			j++;
		KUNIT_ASSERT_EQ_MSG(test, listed,
				    strcmp(text, "unknown AL status code") &&
				    strcmp(text, "vendor specific AL status code"),
				    "code 0x%04x: %s", code, text);
	}
	for (i = 1; i < ARRAY_SIZE(known); i++)
		KUNIT_EXPECT_STRNEQ(test, ec_al_code_text(known[i - 1]),
				    ec_al_code_text(known[i]));
	KUNIT_EXPECT_STREQ(test, ec_al_code_text(0x0005), "unknown AL status code");
	KUNIT_EXPECT_STREQ(test, ec_al_code_text(0x8001), "vendor specific AL status code");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(al_states_have_names),
	KUNIT_CASE(al_only_five_values_are_states),
	KUNIT_CASE(al_transitions_follow_table),
	KUNIT_CASE(al_transitions_have_default_time_limits),
	KUNIT_CASE(al_every_known_status_code_has_text),
	{}
};

static struct kunit_suite suite = { .name = "al", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
