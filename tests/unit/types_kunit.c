// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../tool/data_types.h"

static void types_table_is_sorted_and_names_are_unique(struct kunit *test)
{
	unsigned int i, j;

	for (i = 1; i < ec_types_count; i++)
		KUNIT_EXPECT_LT(test, ec_types[i - 1].code, ec_types[i].code);
	for (i = 0; i < ec_types_count; i++)
		for (j = 0; j < i; j++)
			KUNIT_EXPECT_STRNEQ(test, ec_types[i].name, ec_types[j].name);
}

static void types_every_type_is_found_by_code_and_name(struct kunit *test)
{
	unsigned int i;

	for (i = 0; i < ec_types_count; i++) {
		KUNIT_EXPECT_PTR_EQ(test, ec_type_by_code(ec_types[i].code), &ec_types[i]);
		KUNIT_EXPECT_PTR_EQ(test, ec_type_by_name(ec_types[i].name), &ec_types[i]);
	}
	KUNIT_EXPECT_NULL(test, ec_type_by_code(0));
	KUNIT_EXPECT_NULL(test, ec_type_by_code(0x0800));
	KUNIT_EXPECT_NULL(test, ec_type_by_code(0xFFFA));
}

static void types_names_of_command_line_have_their_codes(struct kunit *test)
{
	static const struct {
		const char *name;
		u16 code;
		u16 bits;
	} want[] = {
		{ "bool", 0x0001, 1 }, { "int8", 0x0002, 8 }, { "int16", 0x0003, 16 },
		{ "int32", 0x0004, 32 }, { "int64", 0x0015, 64 }, { "uint8", 0x0005, 8 },
		{ "uint16", 0x0006, 16 }, { "uint32", 0x0007, 32 }, { "uint64", 0x001B, 64 },
		{ "float", 0x0008, 32 }, { "double", 0x0011, 64 }, { "string", 0x0009, 0 },
		{ "octet_string", 0x000A, 0 }, { "unicode_string", 0x000B, 0 },
		{ "sm8", 0xFFFB, 8 }, { "sm64", 0xFFFE, 64 }, { "raw", 0xFFFF, 0 },
		{ "int24", 0x0010, 24 }, { "uint24", 0x0016, 24 }, { "uint56", 0x001A, 56 },
		{ "UINT8", 0x0005, 8 }, { "u16", 0x0006, 16 }, { "I32", 0x0004, 32 },
		{ "f32", 0x0008, 32 }, { "f64", 0x0011, 64 }, { "UDINT", 0x0007, 32 },
		{ "REAL32", 0x0008, 32 }, { "hex", 0xFFFF, 0 }, { "BOOLEAN", 0x0001, 1 },
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(want); i++) {
		const struct ec_type *t = ec_type_by_name(want[i].name);

		KUNIT_ASSERT_NOT_NULL_MSG(test, t, "%s", want[i].name);
		KUNIT_EXPECT_EQ_MSG(test, t->code, want[i].code, "%s", want[i].name);
		KUNIT_EXPECT_EQ_MSG(test, t->bits, want[i].bits, "%s", want[i].name);
	}
}

static void types_unknown_names_are_not_found(struct kunit *test)
{
	KUNIT_EXPECT_NULL(test, ec_type_by_name(""));
	KUNIT_EXPECT_NULL(test, ec_type_by_name("uint"  "7"));
	KUNIT_EXPECT_NULL(test, ec_type_by_name("uint160"));
	KUNIT_EXPECT_NULL(test, ec_type_by_name("uint1"));
	KUNIT_EXPECT_NULL(test, ec_type_by_name(" uint8"));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(types_table_is_sorted_and_names_are_unique),
	KUNIT_CASE(types_every_type_is_found_by_code_and_name),
	KUNIT_CASE(types_names_of_command_line_have_their_codes),
	KUNIT_CASE(types_unknown_names_are_not_found),
	{}
};

static struct kunit_suite suite = { .name = "types", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
