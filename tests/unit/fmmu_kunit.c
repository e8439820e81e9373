// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/esc_page.h"

static void fmmu_page_survives_both_ways(struct kunit *test)
{
	struct ec_fmmu in = {
		.logical = 0x00010203, .len = 5, .lbit_start = 3, .lbit_stop = 6,
		.phys = 0x1180, .pbit = 2, .type = EC_FMMU_WRITE, .enable = true,
	}, out;
	u8 page[EC_FMMU_PAGE];

	ec_fmmu_encode(&in, page);
	ec_fmmu_decode(&out, page);
	KUNIT_EXPECT_EQ(test, out.logical, in.logical);
	KUNIT_EXPECT_EQ(test, out.len, in.len);
	KUNIT_EXPECT_EQ(test, out.lbit_start, in.lbit_start);
	KUNIT_EXPECT_EQ(test, out.lbit_stop, in.lbit_stop);
	KUNIT_EXPECT_EQ(test, out.phys, in.phys);
	KUNIT_EXPECT_EQ(test, out.pbit, in.pbit);
	KUNIT_EXPECT_EQ(test, out.type, in.type);
	KUNIT_EXPECT_EQ(test, out.enable, in.enable);
}

static void fmmu_reserved_bits_of_page_are_ignored(struct kunit *test)
{
	struct ec_fmmu f;
	u8 page[EC_FMMU_PAGE];

	memset(page, 0xFF, sizeof(page));
	ec_fmmu_decode(&f, page);
	KUNIT_EXPECT_EQ(test, f.lbit_start, 7);
	KUNIT_EXPECT_EQ(test, f.lbit_stop, 7);
	KUNIT_EXPECT_EQ(test, f.pbit, 7);
	KUNIT_EXPECT_EQ(test, f.type, 3);
	KUNIT_EXPECT_TRUE(test, f.enable);
	page[12] = 0xFE;
	ec_fmmu_decode(&f, page);
	KUNIT_EXPECT_FALSE(test, f.enable);
}

static void fmmu_mapped_bits_are_counted(struct kunit *test)
{
	struct ec_fmmu f = { .len = 1, .lbit_start = 0, .lbit_stop = 7 };

	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 8u);
	f.lbit_start = 4;
	f.lbit_stop = 4;
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 1u);
	f.lbit_stop = 3;
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 0u);
	f.len = 2;
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 8u);
	f.len = 0;
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 0u);
	f = (struct ec_fmmu){ .len = 0xFFFF, .lbit_stop = 7 };
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 8u * 0xFFFF);
}

static void fmmu_sync_manager_page_survives_both_ways(struct kunit *test)
{
	struct ec_sm in = { 0x1000, 128, 0x26, 0x08, 0x01, 0x00 }, out;
	u8 page[EC_SM_PAGE];

	ec_sm_encode(&in, page);
	ec_sm_decode(&out, page);
	KUNIT_EXPECT_EQ(test, out.start, 0x1000);
	KUNIT_EXPECT_EQ(test, out.len, 128);
	KUNIT_EXPECT_EQ(test, out.control, 0x26);
	KUNIT_EXPECT_EQ(test, out.status, 0x08);
	KUNIT_EXPECT_EQ(test, out.activate, 0x01);
	KUNIT_EXPECT_EQ(test, out.pdi, 0x00);
}

/* The plainest way to do it, as judge. */
static void copy_slowly(u8 *dst, u32 d, const u8 *src, u32 s, u32 bits)
{
	for (; bits; bits--, d++, s++) {
		dst[d / 8] &= (u8)~(1 << d % 8);
		dst[d / 8] |= (u8)((src[s / 8] >> s % 8 & 1) << d % 8);
	}
}

static void fmmu_bit_copies_touch_their_bits_only(struct kunit *test)
{
	u8 src[8], got[8], want[8];
	u32 d, s, n, i, x = 1;

	for (i = 0; i < sizeof(src); i++) {
		x = x * 1103515245 + 12345;
		src[i] = (u8)(x >> 16);
	}
	for (d = 0; d < 16; d++) {
		for (s = 0; s < 16; s++) {
			for (n = 0; n <= 40; n++) {
				memset(got, n & 1 ? 0xFF : 0, sizeof(got));
				memcpy(want, got, sizeof(got));
				ec_bits_copy(got, d, src, s, n);
				copy_slowly(want, d, src, s, n);
				KUNIT_ASSERT_MEMEQ(test, got, want, sizeof(got));
			}
		}
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(fmmu_page_survives_both_ways),
	KUNIT_CASE(fmmu_reserved_bits_of_page_are_ignored),
	KUNIT_CASE(fmmu_mapped_bits_are_counted),
	KUNIT_CASE(fmmu_sync_manager_page_survives_both_ways),
	KUNIT_CASE(fmmu_bit_copies_touch_their_bits_only),
	{}
};

static struct kunit_suite suite = { .name = "fmmu", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
