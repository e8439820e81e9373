// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/sii_build.h"

static u8 img[EC_SII_MAX_SIZE];
static int used;	/* bytes of img, end marker included */

static const struct ec_sii_info info = {
	.pdi_control = 0x0E05, .pdi_config = 0x0603, .sync_impulse = 10000, .alias = 0x1234,
	.vendor = 0x1337, .product = 0x12345678, .revision = 0x00020001, .serial = 42,
	.boot = { 0x1000, 256, 0x1100, 256 }, .std = { 0x1000, 128, 0x1080, 128 },
	.protocols = EC_SII_PROTO_COE | EC_SII_PROTO_FOE,
};

static const struct ec_sii_sm sms[] = {
	{ 0x1000, 128, 0x26, 0, 1, 1 }, { 0x1080, 128, 0x22, 0, 1, 2 },
	{ 0x1100, 0, 0x64, 0, 1, 3 }, { 0x1180, 0, 0x20, 0, 9, 4 },
};

static const struct ec_sii_pdo_entry entries[] = {
	{ 0x6000, 1, 2, 0x06, 16, 0 }, { 0, 0, 0, 0, 8, 0 }, { 0x6000, 2, 0, 0x01, 1, 0 },
};

/* A whole device, as the tests of the good path want it. */
static int build(struct kunit *test)
{
	static const u8 fmmus[] = { 1, 2, 3 };
	static const struct ec_sii_dc dcs[] = {
		{ .assign = 0x0300, .factor0 = 1, .name = 1 },
		{ .cycle0_ns = 1000000, .shift0_ns = 5, .shift1_ns = 6, .factor1 = -2,
		  .assign = 0x0730, .factor0 = -1, .name = 2, .desc = 1 },
	};
	struct ec_sii_general g = {
		.coe = EC_SII_COE_SDO | EC_SII_COE_COMPLETE, .foe = 1,
		.flags = EC_SII_FLAG_MBOX_DLL, .current_ma = -2000, .ports = 0x0011,
		.id_address = 0x0120, .soe_channels = 3, .ds402_channels = 4,
	};
	struct ec_sii_pdo pdo = { .index = 0x1A00, .entries = 3, .sm = 3, .sync = 1 };
	struct ec_sii_builder b;

	ec_sii_build_begin(&b, img, 2048, &info);
	g.name = ec_sii_build_string(&b, "Demo slave");
	g.order = ec_sii_build_string(&b, "DS-1");
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, ""), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, NULL), 0);
	g.group = ec_sii_build_string(&b, "K\xE4se\x01\x80");
	ec_sii_build_general(&b, &g);
	ec_sii_build_fmmus(&b, fmmus, ARRAY_SIZE(fmmus));
	ec_sii_build_sms(&b, sms, ARRAY_SIZE(sms));
	pdo.name = 1;
	ec_sii_build_pdo(&b, EC_SII_CAT_TXPDO, &pdo, entries);
	pdo.index = 0x1A01;
	pdo.entries = 0;
	pdo.sm = EC_SII_PDO_NO_SM;
	ec_sii_build_pdo(&b, EC_SII_CAT_TXPDO, &pdo, NULL);
	pdo.index = 0x1600;
	pdo.entries = 1;
	ec_sii_build_pdo(&b, EC_SII_CAT_RXPDO, &pdo, entries);
	ec_sii_build_dcs(&b, dcs, ARRAY_SIZE(dcs));
	ec_sii_build_category(&b, 0x0801, "xyz", 3);
	used = ec_sii_build_end(&b);
	return used;
}

static int sii_init(struct kunit *test)
{
	memset(img, 0, sizeof(img));
	return build(test) > 0 ? 0 : -EINVAL;
}

/* A blank fixed area and whatever categories a test writes behind it. */
static size_t raw(const u16 *words, size_t n)
{
	size_t i;

	memset(img, 0, sizeof(img));
	for (i = 0; i < n; i++)
		put_unaligned_le16(words[i], img + EC_SII_FIXED_SIZE + 2 * i);
	return EC_SII_FIXED_SIZE + 2 * n;
}

static void sii_fixed_area_is_read_back(struct kunit *test)
{
	struct ec_sii_info i;

	KUNIT_ASSERT_EQ(test, ec_sii_decode_info(img, 2048, &i), 0);
	KUNIT_EXPECT_TRUE(test, i.checksum_ok);
	KUNIT_EXPECT_EQ(test, i.pdi_control, 0x0E05);
	KUNIT_EXPECT_EQ(test, i.alias, 0x1234);
	KUNIT_EXPECT_EQ(test, i.vendor, 0x1337u);
	KUNIT_EXPECT_EQ(test, i.product, 0x12345678u);
	KUNIT_EXPECT_EQ(test, i.revision, 0x00020001u);
	KUNIT_EXPECT_EQ(test, i.serial, 42u);
	KUNIT_EXPECT_EQ(test, i.boot.tx_offset, 0x1100);
	KUNIT_EXPECT_EQ(test, i.std.rx_size, 128);
	KUNIT_EXPECT_EQ(test, i.std.tx_offset, 0x1080);
	KUNIT_EXPECT_EQ(test, i.protocols, 0x000C);
	KUNIT_EXPECT_EQ(test, i.size_kbit, 16u);
	KUNIT_EXPECT_EQ(test, i.version, 1);
	KUNIT_EXPECT_EQ(test, ec_sii_decode_info(img, 128, &i), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_decode_info(img, 127, &i), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_sii_decode_info(img, 0, &i), -EMSGSIZE);
}

static void sii_wrong_checksum_is_reported(struct kunit *test)
{
	struct ec_sii_info i;

	img[8] ^= 1;
	KUNIT_ASSERT_EQ(test, ec_sii_decode_info(img, 2048, &i), 0);
	KUNIT_EXPECT_FALSE(test, i.checksum_ok);
	KUNIT_EXPECT_NE(test, i.checksum, i.checksum_calc);
	KUNIT_EXPECT_EQ(test, i.vendor, 0x1337u);
}

static void sii_categories_come_in_order_written(struct kunit *test)
{
	static const u16 types[] = { 10, 30, 40, 41, 50, 51, 60, 0x0801 };
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t i;

	ec_sii_iter_init(&it, img, 2048);
	for (i = 0; i < ARRAY_SIZE(types); i++) {
		KUNIT_ASSERT_EQ(test, ec_sii_iter_next(&it, &cat), 1);
		KUNIT_EXPECT_EQ(test, cat.type, types[i]);
		KUNIT_EXPECT_EQ(test, cat.bytes, (size_t)cat.words * 2);
		KUNIT_EXPECT_PTR_EQ(test, cat.data, img + cat.offset + 4);
	}
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 0);
	KUNIT_EXPECT_EQ(test, it.pos + 2, (size_t)used);
}

static void sii_strings_are_found_and_made_printable(struct kunit *test)
{
	char s[32];

	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 1, s, sizeof(s)), 10);
	KUNIT_EXPECT_STREQ(test, s, "Demo slave");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 2, s, sizeof(s)), 4);
	KUNIT_EXPECT_STREQ(test, s, "DS-1");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 3, s, sizeof(s)), 7);
	KUNIT_EXPECT_STREQ(test, s, "K\xC3\xA4se??");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 0, s, sizeof(s)), 0);
	KUNIT_EXPECT_STREQ(test, s, "");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 4, s, sizeof(s)), -ENOENT);
	KUNIT_EXPECT_STREQ(test, s, "");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 1, s, 0), -EINVAL);
}

static void sii_only_printable_characters_come_out(struct kunit *test)
{
	/* the bytes on both sides of every limit */
	static const u8 in[] = { 0x1F, 0x20, 0x7E, 0x7F, 0x80, 0x9F, 0xA0, 0xBF, 0xC0, 0xFF, 0, 0 };
	u8 cat[14] = { 1, 12 };
	char s[32];

	raw((const u16[]){ 10, 7, 0, 0, 0, 0, 0, 0, 0, 0xFFFF }, 10);
	memcpy(cat + 2, in, sizeof(in));
	memcpy(img + EC_SII_FIXED_SIZE + 4, cat, sizeof(cat));
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 256, 1, s, sizeof(s)), 14);
	KUNIT_EXPECT_STREQ(test, s, "? ~???\xC2\xA0\xC2\xBF\xC3\x80\xC3\xBF");
}

static void sii_strings_may_be_built_late(struct kunit *test)
{
	struct ec_sii_general g = { 0 };
	struct ec_sii_builder b;
	struct ec_sii_sm sm[2];
	char s[8];

	ec_sii_build_begin(&b, img, 512, &info);
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, "a"), 1);
	ec_sii_build_general(&b, &g);
	ec_sii_build_sms(&b, sms, 1);
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, "b"), 2);
	ec_sii_build_sms(&b, sms + 1, 1);
	KUNIT_EXPECT_GT(test, ec_sii_build_end(&b), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 512, 2, s, sizeof(s)), 1);
	KUNIT_EXPECT_STREQ(test, s, "b");
	KUNIT_EXPECT_EQ(test, ec_sii_decode_sms(img, 512, sm, 2), 2);
	KUNIT_EXPECT_MEMEQ(test, sm, sms, sizeof(sm));
}

static void sii_string_is_cut_between_characters(struct kunit *test)
{
	char s[8];

	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 1, s, 5), 4);
	KUNIT_EXPECT_STREQ(test, s, "Demo");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 3, s, 4), 3);
	KUNIT_EXPECT_STREQ(test, s, "K\xC3\xA4");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 3, s, 3), 1);
	KUNIT_EXPECT_STREQ(test, s, "K");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, 2048, 3, s, 1), 0);
	KUNIT_EXPECT_STREQ(test, s, "");
}

static void sii_string_categories_count_as_one(struct kunit *test)
{
	static const u16 w[] = {
		10, 3, 0x0102, 0x0141, 0x0042,		/* "A", "B" */
		40, 0,
		10, 2, 0x0201, 0x4443, 0xFFFF,		/* "CD" */
	};
	size_t len = raw(w, ARRAY_SIZE(w));
	char s[8];

	KUNIT_EXPECT_EQ(test, ec_sii_string(img, len, 2, s, sizeof(s)), 1);
	KUNIT_EXPECT_STREQ(test, s, "B");
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, len, 3, s, sizeof(s)), 2);
	KUNIT_EXPECT_STREQ(test, s, "CD");
}

static void sii_string_longer_than_its_category_is_refused(struct kunit *test)
{
	static const u16 w[] = { 10, 2, 0x0902, 0x4141, 0xFFFF };
	size_t len = raw(w, ARRAY_SIZE(w));
	char s[8];

	KUNIT_EXPECT_EQ(test, ec_sii_string(img, len, 1, s, sizeof(s)), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, len, 2, s, sizeof(s)), -EBADMSG);
	KUNIT_EXPECT_STREQ(test, s, "");
}

static void sii_general_category_is_read_back(struct kunit *test)
{
	struct ec_sii_general g;

	KUNIT_ASSERT_EQ(test, ec_sii_decode_general(img, 2048, &g), 0);
	KUNIT_EXPECT_EQ(test, g.name, 1);
	KUNIT_EXPECT_EQ(test, g.order, 2);
	KUNIT_EXPECT_EQ(test, g.group, 3);
	KUNIT_EXPECT_EQ(test, g.coe, 0x21);
	KUNIT_EXPECT_EQ(test, g.foe, 1);
	KUNIT_EXPECT_EQ(test, g.soe_channels, 3);
	KUNIT_EXPECT_EQ(test, g.ds402_channels, 4);
	KUNIT_EXPECT_EQ(test, g.flags, 0x04);
	KUNIT_EXPECT_EQ(test, g.current_ma, -2000);
	KUNIT_EXPECT_EQ(test, g.ports, 0x0011);
	KUNIT_EXPECT_EQ(test, g.id_address, 0x0120);
}

static void sii_short_general_category_is_accepted_from_18_bytes(struct kunit *test)
{
	u16 w[] = { 30, 9, 0, 0x0500, 0, 0, 0, 0, 0, 0, 0x0033, 0xFFFF };
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_general g;

	KUNIT_EXPECT_EQ(test, ec_sii_decode_general(img, len, &g), 0);
	KUNIT_EXPECT_EQ(test, g.name, 5);
	KUNIT_EXPECT_EQ(test, g.ports, 0x0033);
	KUNIT_EXPECT_EQ(test, g.id_address, 0);
	w[1] = 8;
	w[10] = 0xFFFF;
	len = raw(w, ARRAY_SIZE(w));
	KUNIT_EXPECT_EQ(test, ec_sii_decode_general(img, len, &g), -EBADMSG);
}

static void sii_missing_general_category_leaves_zeros(struct kunit *test)
{
	static const u16 w[] = { 0xFFFF };
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_general g;

	memset(&g, 0xFF, sizeof(g));
	KUNIT_EXPECT_EQ(test, ec_sii_decode_general(img, len, &g), -ENOENT);
	KUNIT_EXPECT_EQ(test, g.name, 0);
}

static void sii_fmmus_sync_managers_and_dc_modes_are_read_back(struct kunit *test)
{
	struct ec_sii_sm sm[8];
	struct ec_sii_dc dc[4];
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	/* three, and the padding of the category */
	ec_sii_iter_init(&it, img, 2048);
	while (ec_sii_iter_next(&it, &cat) == 1 && cat.type != EC_SII_CAT_FMMU)
		;
	KUNIT_ASSERT_EQ(test, cat.type, EC_SII_CAT_FMMU);
	KUNIT_ASSERT_EQ(test, cat.bytes, (size_t)4);
	KUNIT_EXPECT_MEMEQ(test, cat.data, "\1\2\3\xFF", 4);

	KUNIT_ASSERT_EQ(test, ec_sii_decode_sms(img, 2048, sm, 8), 4);
	KUNIT_EXPECT_MEMEQ(test, sm, sms, sizeof(sms));
	KUNIT_EXPECT_EQ(test, ec_sii_decode_sms(img, 2048, sm, 3), 3);

	KUNIT_ASSERT_EQ(test, ec_sii_decode_dcs(img, 2048, dc, 4), 2);
	KUNIT_EXPECT_EQ(test, dc[0].assign, 0x0300);
	KUNIT_EXPECT_EQ(test, dc[1].cycle0_ns, 1000000u);
	KUNIT_EXPECT_EQ(test, dc[1].shift0_ns, 5u);
	KUNIT_EXPECT_EQ(test, dc[1].shift1_ns, 6u);
	KUNIT_EXPECT_EQ(test, dc[1].factor1, -2);
	KUNIT_EXPECT_EQ(test, dc[1].factor0, -1);
	KUNIT_EXPECT_EQ(test, dc[1].name, 2);
	KUNIT_EXPECT_EQ(test, dc[1].desc, 1);
	KUNIT_EXPECT_EQ(test, ec_sii_decode_dcs(img, 2048, dc, 1), 1);
}

static void sii_pdos_are_read_back_by_direction(struct kunit *test)
{
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo_entry e;
	struct ec_sii_pdo pdo;
	unsigned int i;

	ec_sii_pdo_iter_init(&it, img, 2048, EC_SII_CAT_TXPDO);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1A00);
	KUNIT_EXPECT_EQ(test, pdo.sm, 3);
	KUNIT_EXPECT_EQ(test, pdo.sync, 1);
	KUNIT_EXPECT_EQ(test, pdo.name, 1);
	KUNIT_ASSERT_EQ(test, pdo.entries, 3);
	for (i = 0; i < 3; i++) {
		KUNIT_ASSERT_EQ(test, ec_sii_pdo_entry(&pdo, i, &e), 0);
		KUNIT_EXPECT_EQ(test, e.index, entries[i].index);
		KUNIT_EXPECT_EQ(test, e.sub, entries[i].sub);
		KUNIT_EXPECT_EQ(test, e.name, entries[i].name);
		KUNIT_EXPECT_EQ(test, e.type, entries[i].type);
		KUNIT_EXPECT_EQ(test, e.bits, entries[i].bits);
	}
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_entry(&pdo, 3, &e), -ENOENT);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1A01);
	KUNIT_EXPECT_EQ(test, pdo.entries, 0);
	KUNIT_EXPECT_EQ(test, pdo.sm, EC_SII_PDO_NO_SM);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 0);

	ec_sii_pdo_iter_init(&it, img, 2048, EC_SII_CAT_RXPDO);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1600);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 0);
}

static void sii_pdos_of_split_categories_are_appended(struct kunit *test)
{
	static const u16 w[] = {
		50, 4, 0x1A00, 0, 0, 0,
		51, 4, 0x1600, 0, 0, 0,
		50, 10, 0x1A01, 0, 0, 0, 0, 0, 0, 0, 0, 0,	/* and padding */
		0xFFFF,
	};
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;

	ec_sii_pdo_iter_init(&it, img, len, EC_SII_CAT_TXPDO);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1A00);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1A01);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 0);
}

static void sii_pdo_entries_beyond_category_are_refused(struct kunit *test)
{
	static const u16 w[] = {
		50, 12, 0x1A00, 0, 0, 0, 0x1A01, 2, 0, 0, 0x6000, 1, 0, 0, 0xFFFF,
	};
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;

	ec_sii_pdo_iter_init(&it, img, len, EC_SII_CAT_TXPDO);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), -EBADMSG);
}

static void sii_category_beyond_image_ends_walk(struct kunit *test)
{
	static const u16 w[] = { 40, 1, 0x0201, 41, 5, 0, 0, 0, 0 };
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	ec_sii_iter_init(&it, img, len);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 1);
	KUNIT_EXPECT_EQ(test, cat.bytes, (size_t)2);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -EBADMSG);
	/* what came before is kept */
	KUNIT_EXPECT_EQ(test, ec_sii_used(img, len), (size_t)(EC_SII_FIXED_SIZE + 6));
}

static void sii_image_without_end_marker_is_reported(struct kunit *test)
{
	static const u16 w[] = { 40, 1, 0x0201, 41 };
	size_t len = raw(w, ARRAY_SIZE(w));
	struct ec_sii_iter it;
	struct ec_sii_cat cat;

	ec_sii_iter_init(&it, img, len);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 1);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -ENODATA);
	ec_sii_iter_init(&it, img, len - 2);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 1);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -ENODATA);
	ec_sii_iter_init(&it, img, 0);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -ENODATA);
}

static void sii_endless_categories_are_bounded(struct kunit *test)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t i;
	int n = 0, ret;

	memset(img, 0, sizeof(img));
	for (i = EC_SII_FIXED_SIZE; i < sizeof(img); i += 4)
		put_unaligned_le16(41, img + i);
	ec_sii_iter_init(&it, img, sizeof(img));
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1)
		n++;
	KUNIT_EXPECT_EQ(test, ret, -E2BIG);
	KUNIT_EXPECT_EQ(test, n, EC_SII_MAX_CATS);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, 4096), 0);
}

static void sii_image_of_zeros_ends_early(struct kunit *test)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t have = 8;
	int need, ret, n = 0;

	memset(img, 0, sizeof(img));
	ec_sii_iter_init(&it, img, sizeof(img));
	while ((ret = ec_sii_iter_next(&it, &cat)) == 1)
		n++;
	KUNIT_EXPECT_EQ(test, ret, -ENODATA);
	KUNIT_EXPECT_EQ(test, n, 8);
	while ((need = ec_sii_needed(img, have)) > 0) {
		KUNIT_ASSERT_GT(test, (size_t)need, have);
		have = ((size_t)need + 7) & ~(size_t)7;
	}
	KUNIT_EXPECT_LE(test, have, (size_t)192);
	KUNIT_EXPECT_LE(test, ec_sii_used(img, have), have);
}

static void sii_image_of_ones_ends_at_once(struct kunit *test)
{
	struct ec_sii_info i;

	memset(img, 0xFF, sizeof(img));
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, 0), 128);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, 128), 130);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, 130), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_used(img, 130), (size_t)130);
	KUNIT_EXPECT_EQ(test, ec_sii_decode_info(img, 130, &i), 0);
	KUNIT_EXPECT_FALSE(test, i.checksum_ok);
	KUNIT_EXPECT_EQ(test, i.size_kbit, 65536u);
}

static void sii_scan_by_4_or_8_bytes_reads_no_more_than_it_needs(struct kunit *test)
{
	size_t step, have;
	int need;

	for (step = 4; step <= 8; step += 4) {
		for (have = 0; (need = ec_sii_needed(img, have)) > 0;) {
			KUNIT_ASSERT_GT(test, (size_t)need, have);
			KUNIT_ASSERT_LE(test, need, used);
			while (have < (size_t)need)
				have += step;
		}
		KUNIT_EXPECT_GE(test, have, (size_t)used);
		KUNIT_EXPECT_LT(test, have, (size_t)used + step);
		KUNIT_EXPECT_EQ(test, ec_sii_used(img, have), (size_t)used);
	}
}

static void sii_prefix_needs_more_bytes_until_end_marker(struct kunit *test)
{
	size_t have;

	for (have = 0; have < (size_t)used; have++) {
		KUNIT_ASSERT_GT(test, ec_sii_needed(img, have), (int)have);
		KUNIT_ASSERT_LE(test, ec_sii_used(img, have), have);
	}
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, have), 0);
}

static void sii_garbage_category_ends_walk(struct kunit *test)
{
	static const u16 w[] = { 40, 1, 0x0201, 0x1234, 0xF000 };
	size_t len = raw(w, ARRAY_SIZE(w));

	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, len), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_used(img, len), (size_t)(EC_SII_FIXED_SIZE + 6));
	/* a large EEPROM may have such a category */
	put_unaligned_le16(0x01FF, img + 2 * EC_SII_W_SIZE);
	put_unaligned_le16(0x7000, img + EC_SII_FIXED_SIZE + 8);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, len),
			(int)(EC_SII_FIXED_SIZE + 6 + 4 + 2 * 0x7000 + 2));
}

static void sii_nothing_lies_behind_512_kib(struct kunit *test)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	size_t i;

	/* four categories, the end of the last one is the end of the image */
	memset(img, 0, sizeof(img));
	put_unaligned_le16(0xFFFF, img + 2 * EC_SII_W_SIZE);
	for (i = EC_SII_FIXED_SIZE; i < sizeof(img); i += 4 + 2 * 0xFFEE) {
		put_unaligned_le16(41, img + i);
		put_unaligned_le16(0xFFEE, img + i + 2);
	}
	KUNIT_ASSERT_EQ(test, i, sizeof(img));
	ec_sii_iter_init(&it, img, sizeof(img));
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), 1);
	KUNIT_EXPECT_EQ(test, ec_sii_iter_next(&it, &cat), -ENODATA);
	/* the first three are read, the fourth has no room for an end marker */
	i = EC_SII_FIXED_SIZE + 2 * (4 + 2 * 0xFFEE);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, i + 4), (int)i + 4 + 2 * 0xFFEE + 2);
	i += 4 + 2 * 0xFFEE;
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, i + 4), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_needed(img, sizeof(img)), 0);
}

static void sii_every_flaw_is_found(struct kunit *test)
{
	static const u16 beyond[] = { 40, 1, 0x0201, 0xFFFF };
	static const u16 large[] = { 40, 1, 0x0201, 0x1234, 0xF000 };
	static const u16 string[] = { EC_SII_CAT_STRINGS, 1, 0xFF01, 0xFFFF };
	static const u16 pdo[] = { EC_SII_CAT_TXPDO, 4, 0x1A00, 1, 0, 0, 0xFFFF };
	static const u16 good[] = { EC_SII_CAT_TXPDO, 4, 0x1A00, 0, 0, 0, 0xFFFF };
	struct ec_sii_flaw f;
	size_t len;

	memset(img, 0xFF, sizeof(img));
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, 130, &f), EC_SII_FLAW_BLANK);
	KUNIT_EXPECT_EQ(test, f.type, 0xFF);
	memset(img, 0, sizeof(img));
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, 192, &f), EC_SII_FLAW_BLANK);
	KUNIT_EXPECT_EQ(test, f.type, 0);
	len = raw(beyond, ARRAY_SIZE(beyond));
	img[20] = 1;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len, &f), EC_SII_FLAW_BEYOND);
	KUNIT_EXPECT_EQ(test, f.end, len - 2);
	KUNIT_EXPECT_EQ(test, f.declared, (size_t)128);
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len - 2, &f), EC_SII_FLAW_NO_END);
	len = raw(large, ARRAY_SIZE(large));
	img[20] = 1;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len, &f), EC_SII_FLAW_LARGE);
	KUNIT_EXPECT_EQ(test, f.type, 0x1234);
	KUNIT_EXPECT_EQ(test, f.bytes, (size_t)0x1E000);
	len = raw(string, ARRAY_SIZE(string));
	img[2 * EC_SII_W_SIZE] = 7;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len, &f), EC_SII_FLAW_ENTRY);
	KUNIT_EXPECT_EQ(test, f.offset, (size_t)EC_SII_FIXED_SIZE);
	len = raw(pdo, ARRAY_SIZE(pdo));
	img[2 * EC_SII_W_SIZE] = 7;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len, &f), EC_SII_FLAW_ENTRY);
	len = raw(good, ARRAY_SIZE(good));
	img[2 * EC_SII_W_SIZE] = 7;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, len, &f), EC_SII_FLAW_NONE);
}

static void sii_builder_reports_full_buffer(struct kunit *test)
{
	struct ec_sii_builder b;
	struct ec_sii_general g = { .name = 1 };
	size_t cap;

	for (cap = 0; cap < 200; cap++) {
		memset(img, 0xEE, sizeof(img));
		ec_sii_build_begin(&b, img, cap, &info);
		ec_sii_build_string(&b, "abc");
		ec_sii_build_general(&b, &g);
		KUNIT_EXPECT_EQ(test, ec_sii_build_end(&b), cap < 176 ? -ENOSPC : 176);
		KUNIT_EXPECT_EQ(test, img[cap], 0xEE);
	}
}

static void sii_too_many_or_too_long_strings_are_refused(struct kunit *test)
{
	static char text[300];
	struct ec_sii_builder b;
	int i;

	memset(text, 'x', 256);
	ec_sii_build_begin(&b, img, 8192, &info);
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, text), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_build_end(&b), -ENOSPC);

	ec_sii_build_begin(&b, img, 8192, &info);
	for (i = 1; i <= 255; i++)
		KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, "y"), i);
	KUNIT_EXPECT_FALSE(test, b.bad);
	KUNIT_EXPECT_EQ(test, ec_sii_build_string(&b, "y"), 0);
	KUNIT_EXPECT_EQ(test, ec_sii_build_end(&b), -ENOSPC);
}

static void sii_rest_of_built_image_is_blank(struct kunit *test)
{
	int i;

	for (i = used; i < 2048; i++)
		KUNIT_ASSERT_EQ(test, img[i], 0xFF);
	KUNIT_EXPECT_EQ(test, img[2048], 0);
}

/* Three places say whether there is a mailbox; one function has the answer. */
static void sii_mailbox_is_settled_from_three_places(struct kunit *test)
{
	static const struct ec_sii_mbox words = { 0x1000, 128, 0x1080, 128 }, none = { 0 };
	static const struct ec_sii_mbox other = { 0x1000, 256, 0x1100, 256 };
	static const struct {
		const char *what;
		struct ec_sii_mbox words;
		u16 protocols, pdi;
		unsigned int n;	/* of @sms */
		struct ec_sii_mbox used;
		enum ec_sii_mbox_doubt doubt;
	} t[] = {
		{ "all agree", words, 4, 5, 4, words, EC_SII_MBOX_SURE },
		{ "no category 41", words, 4, 5, 0, words, EC_SII_MBOX_SURE },
		{ "no protocol", words, 0, 5, 4, words, EC_SII_MBOX_NO_PROTOCOL },
		{ "no protocol, no category 41", words, 0, 5, 0, words, EC_SII_MBOX_NO_PROTOCOL },
		{ "no words", none, 4, 5, 4, words, EC_SII_MBOX_NO_WORDS },
		{ "half of the words", { 0x1000, 128, 0, 0 }, 4, 5, 4, words,
		  EC_SII_MBOX_NO_WORDS },
		{ "only category 41", none, 0, 5, 4, words, EC_SII_MBOX_NO_PROTOCOL },
		{ "other words", other, 4, 5, 4, other, EC_SII_MBOX_DIFFERS },
		{ "only protocols", none, 4, 5, 0, none, EC_SII_MBOX_NONE },
		{ "SM0 alone", none, 4, 5, 1, none, EC_SII_MBOX_NONE },
		{ "none", none, 0, 5, 0, none, EC_SII_MBOX_SURE },
		{ "device emulation", words, 0, 0x0380, 4, none, EC_SII_MBOX_SURE },
		{ "device emulation, protocols", words, 4, 0x0380, 4, words, EC_SII_MBOX_SURE },
	};
	unsigned int i;

	for (i = 0; i < ARRAY_SIZE(t); i++) {
		struct ec_sii_info v = {
			.std = t[i].words, .protocols = t[i].protocols, .pdi_control = t[i].pdi,
		};

		KUNIT_EXPECT_EQ_MSG(test, ec_sii_settle_mbox(&v, sms, t[i].n), t[i].doubt, "%s",
				    t[i].what);
		KUNIT_EXPECT_EQ_MSG(test, memcmp(&v.std, &t[i].used, sizeof(v.std)), 0, "%s",
				    t[i].what);
	}
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sii_fixed_area_is_read_back),
	KUNIT_CASE(sii_wrong_checksum_is_reported),
	KUNIT_CASE(sii_categories_come_in_order_written),
	KUNIT_CASE(sii_strings_are_found_and_made_printable),
	KUNIT_CASE(sii_only_printable_characters_come_out),
	KUNIT_CASE(sii_strings_may_be_built_late),
	KUNIT_CASE(sii_string_is_cut_between_characters),
	KUNIT_CASE(sii_string_categories_count_as_one),
	KUNIT_CASE(sii_string_longer_than_its_category_is_refused),
	KUNIT_CASE(sii_general_category_is_read_back),
	KUNIT_CASE(sii_short_general_category_is_accepted_from_18_bytes),
	KUNIT_CASE(sii_missing_general_category_leaves_zeros),
	KUNIT_CASE(sii_fmmus_sync_managers_and_dc_modes_are_read_back),
	KUNIT_CASE(sii_pdos_are_read_back_by_direction),
	KUNIT_CASE(sii_pdos_of_split_categories_are_appended),
	KUNIT_CASE(sii_pdo_entries_beyond_category_are_refused),
	KUNIT_CASE(sii_category_beyond_image_ends_walk),
	KUNIT_CASE(sii_image_without_end_marker_is_reported),
	KUNIT_CASE(sii_endless_categories_are_bounded),
	KUNIT_CASE(sii_image_of_zeros_ends_early),
	KUNIT_CASE(sii_image_of_ones_ends_at_once),
	KUNIT_CASE(sii_scan_by_4_or_8_bytes_reads_no_more_than_it_needs),
	KUNIT_CASE(sii_prefix_needs_more_bytes_until_end_marker),
	KUNIT_CASE(sii_garbage_category_ends_walk),
	KUNIT_CASE(sii_nothing_lies_behind_512_kib),
	KUNIT_CASE(sii_every_flaw_is_found),
	KUNIT_CASE(sii_mailbox_is_settled_from_three_places),
	KUNIT_CASE(sii_builder_reports_full_buffer),
	KUNIT_CASE(sii_too_many_or_too_long_strings_are_refused),
	KUNIT_CASE(sii_rest_of_built_image_is_blank),
	{}
};

static struct kunit_suite suite = { .name = "sii", .init = sii_init, .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
