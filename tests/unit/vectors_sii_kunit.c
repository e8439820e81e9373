// SPDX-License-Identifier: GPL-2.0-only
/* An EEPROM image typed from the tables of the specification, both ways. */
#include "wire_kunit.h"
#include "../../devices/sim/sii_build.h"

static const u8 image[] = {
	/* PDI control 0x0E05, config 0x0603, impulse 100 us, alias 0, checksum */
	[0x00] = 0x05, 0x0E, 0x03, 0x06, 0x10, 0x27,
	[0x0E] = 0xD7, 0x00,
	/* vendor, product, revision, serial */
	[0x10] = 0x37, 0x13, 0x00, 0x00, 0x56, 0x34, 0x12, 0x00,
		 0x01, 0x00, 0x00, 0x00, 0x4E, 0x61, 0xBC, 0x00,
	/* mailboxes in BOOT and above, CoE and FoE */
	[0x28] = 0x00, 0x10, 0x00, 0x02, 0x00, 0x12, 0x00, 0x02,
	[0x30] = 0x00, 0x10, 0x80, 0x00, 0x80, 0x10, 0x80, 0x00, 0x0C, 0x00,
	/* 16 KiBit, version 1 */
	[0x7C] = 0x0F, 0x00, 0x01, 0x00,
	/* strings: "Drive", "DC" */
	[0x80] = 0x0A, 0x00, 0x05, 0x00,
		 0x02, 0x05, 'D', 'r', 'i', 'v', 'e', 0x02, 'D', 'C',
	/* general: coupler-like, -2000 mA, MII and two E-bus ports */
	[0x8E] = 0x1E, 0x00, 0x10, 0x00,
		 0x01, 0x00, 0x01, 0x01, 0x00, 0x2F, 0x01, 0x00,
		 0x00, 0x01, 0x00, 0x0C, 0x30, 0xF8, 0x02, 0x00,
		 0x31, 0x03, 0x24, 0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
	/* FMMUs: outputs, inputs, mailbox state, one byte of padding */
	[0xB2] = 0x28, 0x00, 0x02, 0x00, 0x01, 0x02, 0x03, 0xFF,
	/* SM2: 0x1100, length from the PDOs, buffered outputs with watchdog */
	[0xBA] = 0x29, 0x00, 0x04, 0x00,
		 0x00, 0x11, 0x00, 0x00, 0x64, 0x00, 0x09, 0x03,
	/* RxPDO 0x1600 in SM2: 0x6040:00 UINT16, a gap of 4 bits */
	[0xC6] = 0x33, 0x00, 0x0C, 0x00,
		 0x00, 0x16, 0x02, 0x02, 0x00, 0x01, 0x11, 0x00,
		 0x40, 0x60, 0x00, 0x00, 0x06, 0x10, 0x00, 0x00,
		 0x00, 0x00, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00,
	/* clocks: 0x0730, SYNC0 4 ms shifted 1000, SYNC1 -1, shifted 2 */
	[0xE2] = 0x3C, 0x00, 0x0C, 0x00,
		 0x00, 0x09, 0x3D, 0x00, 0xE8, 0x03, 0x00, 0x00,
		 0x02, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0x30, 0x07,
		 0x01, 0x00, 0x02, 0x00, 0x00, 0x00, 0x00, 0x00,
	[0xFE] = 0xFF, 0xFF,
};

static void vectors_sii_fixed_area(struct kunit *test)
{
	struct ec_sii_info i;

	KUNIT_ASSERT_EQ(test, ec_sii_decode_info(image, sizeof(image), &i), 0);
	KUNIT_EXPECT_TRUE(test, i.checksum_ok);
	KUNIT_EXPECT_EQ(test, i.pdi_control, 0x0E05);
	KUNIT_EXPECT_EQ(test, i.pdi_config, 0x0603);
	KUNIT_EXPECT_EQ(test, i.sync_impulse, 10000);
	KUNIT_EXPECT_EQ(test, i.serial, 12345678u);
	KUNIT_EXPECT_EQ(test, i.boot.rx_offset, 0x1000);
	KUNIT_EXPECT_EQ(test, i.boot.rx_size, 512);
	KUNIT_EXPECT_EQ(test, i.boot.tx_offset, 0x1200);
	KUNIT_EXPECT_EQ(test, i.boot.tx_size, 512);
	KUNIT_EXPECT_EQ(test, i.std.tx_size, 128);
	KUNIT_EXPECT_EQ(test, i.protocols, EC_SII_PROTO_COE | EC_SII_PROTO_FOE);
	KUNIT_EXPECT_EQ(test, i.version, 1);
}

static void vectors_sii_general_category(struct kunit *test)
{
	struct ec_sii_general g;
	char s[8];

	KUNIT_ASSERT_EQ(test, ec_sii_decode_general(image, sizeof(image), &g), 0);
	KUNIT_EXPECT_EQ(test, g.group, 1);
	KUNIT_EXPECT_EQ(test, g.image, 0);
	KUNIT_EXPECT_EQ(test, g.order, 1);
	KUNIT_EXPECT_EQ(test, g.name, 1);
	KUNIT_EXPECT_EQ(test, g.coe, 0x2F);
	KUNIT_EXPECT_EQ(test, g.foe, 1);
	KUNIT_EXPECT_EQ(test, g.eoe, 0);
	KUNIT_EXPECT_EQ(test, g.soe_channels, 0);
	KUNIT_EXPECT_EQ(test, g.ds402_channels, 1);
	KUNIT_EXPECT_EQ(test, g.flags, EC_SII_FLAG_MBOX_DLL | EC_SII_FLAG_ID_AL);
	KUNIT_EXPECT_EQ(test, g.current_ma, -2000);
	KUNIT_EXPECT_EQ(test, g.group_name, 2);
	KUNIT_EXPECT_EQ(test, g.ports, 0x0331);
	KUNIT_EXPECT_EQ(test, g.id_address, 0x0124);
	KUNIT_EXPECT_EQ(test, ec_sii_string(image, sizeof(image), g.name, s, sizeof(s)), 5);
	KUNIT_EXPECT_STREQ(test, s, "Drive");
}

static void vectors_sii_fmmus_and_sync_managers(struct kunit *test)
{
	struct ec_sii_iter it;
	struct ec_sii_cat cat;
	struct ec_sii_sm sm;

	ec_sii_iter_init(&it, image, sizeof(image));
	while (ec_sii_iter_next(&it, &cat) == 1 && cat.type != EC_SII_CAT_FMMU)
		;
	KUNIT_ASSERT_EQ(test, cat.type, EC_SII_CAT_FMMU);
	KUNIT_ASSERT_EQ(test, cat.bytes, (size_t)4);
	KUNIT_EXPECT_EQ(test, cat.data[0], EC_SII_FMMU_OUTPUTS);
	KUNIT_EXPECT_EQ(test, cat.data[1], EC_SII_FMMU_INPUTS);
	KUNIT_EXPECT_EQ(test, cat.data[2], EC_SII_FMMU_SM_STATUS);
	KUNIT_ASSERT_EQ(test, ec_sii_decode_sms(image, sizeof(image), &sm, 1), 1);
	KUNIT_EXPECT_EQ(test, sm.start, 0x1100);
	KUNIT_EXPECT_EQ(test, sm.len, 0);
	KUNIT_EXPECT_EQ(test, sm.control, 0x64);
	KUNIT_EXPECT_EQ(test, sm.enable, EC_SII_SM_ENABLE | EC_SII_SM_OP_ONLY);
	KUNIT_EXPECT_EQ(test, sm.type, EC_SII_SM_OUTPUTS);
}

static void vectors_sii_pdos_with_gap(struct kunit *test)
{
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	struct ec_sii_pdo_entry e;

	ec_sii_pdo_iter_init(&it, image, sizeof(image), EC_SII_CAT_RXPDO);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1600);
	KUNIT_EXPECT_EQ(test, pdo.entries, 2);
	KUNIT_EXPECT_EQ(test, pdo.sm, 2);
	KUNIT_EXPECT_EQ(test, pdo.flags, 0x11);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_entry(&pdo, 0, &e), 0);
	KUNIT_EXPECT_EQ(test, e.index, 0x6040);
	KUNIT_EXPECT_EQ(test, e.type, 6);
	KUNIT_EXPECT_EQ(test, e.bits, 16);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_entry(&pdo, 1, &e), 0);
	KUNIT_EXPECT_EQ(test, e.index, 0);
	KUNIT_EXPECT_EQ(test, e.bits, 4);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 0);
	ec_sii_pdo_iter_init(&it, image, sizeof(image), EC_SII_CAT_TXPDO);
	KUNIT_EXPECT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 0);
}

static void vectors_sii_clock_modes(struct kunit *test)
{
	struct ec_sii_dc dc;

	KUNIT_ASSERT_EQ(test, ec_sii_decode_dcs(image, sizeof(image), &dc, 1), 1);
	KUNIT_EXPECT_EQ(test, dc.cycle0_ns, 4000000u);
	KUNIT_EXPECT_EQ(test, dc.shift0_ns, 1000u);
	KUNIT_EXPECT_EQ(test, dc.shift1_ns, 2u);
	KUNIT_EXPECT_EQ(test, dc.factor1, -1);
	KUNIT_EXPECT_EQ(test, dc.assign, 0x0730);
	KUNIT_EXPECT_EQ(test, dc.factor0, 1);
	KUNIT_EXPECT_EQ(test, dc.name, 2);
	KUNIT_EXPECT_EQ(test, dc.desc, 0);
}

/* fixed area first, then header by header, up to the end marker */
static void vectors_sii_image_read_piece_by_piece(struct kunit *test)
{
	int have = 0, need;

	while ((need = ec_sii_needed(image, (size_t)have)) > 0) {
		KUNIT_ASSERT_GT(test, need, have);
		KUNIT_ASSERT_LE(test, (size_t)need, sizeof(image));
		have = need;
	}
	KUNIT_EXPECT_EQ(test, need, 0);
	KUNIT_EXPECT_EQ(test, have, (int)sizeof(image));
	KUNIT_EXPECT_EQ(test, ec_sii_used(image, sizeof(image)), sizeof(image));
}

/* word 0x003E, the number of entries of a PDO, the end marker, nothing at all */
static void vectors_sii_flaws_of_image(struct kunit *test)
{
	static u8 img[sizeof(image)];
	struct ec_sii_flaw f;

	memcpy(img, image, sizeof(img));
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, sizeof(img), &f), EC_SII_FLAW_NONE);
	KUNIT_EXPECT_EQ(test, f.declared, (size_t)2048);
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, 0xFE, &f), EC_SII_FLAW_NO_END);
	img[0xCC] = 3;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, sizeof(img), &f), EC_SII_FLAW_ENTRY);
	KUNIT_EXPECT_EQ(test, f.offset, (size_t)0xC6);
	KUNIT_EXPECT_EQ(test, f.type, EC_SII_CAT_RXPDO);
	img[0x7C] = 0;
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, sizeof(img), &f), EC_SII_FLAW_BEYOND);
	KUNIT_EXPECT_EQ(test, f.end, (size_t)0xFE);
	memset(img, 0xFF, sizeof(img));
	KUNIT_EXPECT_EQ(test, ec_sii_check(img, sizeof(img), &f), EC_SII_FLAW_BLANK);
}

static void vectors_sii_same_image_built(struct kunit *test)
{
	static const struct ec_sii_info info = {
		.pdi_control = 0x0E05, .pdi_config = 0x0603, .sync_impulse = 10000,
		.vendor = 0x1337, .product = 0x123456, .revision = 1, .serial = 12345678,
		.boot = { 0x1000, 512, 0x1200, 512 }, .std = { 0x1000, 128, 0x1080, 128 },
		.protocols = 0x0C, .size_kbit = 16,
	};
	struct ec_sii_general g = {
		.coe = 0x2F, .foe = 1, .ds402_channels = 1, .flags = 0x0C,
		.current_ma = -2000, .ports = 0x0331, .id_address = 0x0124,
	};
	static const struct ec_sii_sm sm = { 0x1100, 0, 0x64, 0, 9, 3 };
	static const struct ec_sii_pdo pdo = { 0x1600, 2, 2, 0, 1, 0x11, NULL };
	static const struct ec_sii_pdo_entry entries[] = {
		{ 0x6040, 0, 0, 6, 16, 0 }, { 0, 0, 0, 0, 4, 0 },
	};
	static const struct ec_sii_dc dc = { 4000000, 1000, 2, -1, 0x0730, 1, 2, 0 };
	struct ec_sii_builder b;
	static u8 buf[512];

	memset(buf, 0x55, sizeof(buf));
	ec_sii_build_begin(&b, buf, sizeof(buf), &info);
	g.group = g.order = g.name = ec_sii_build_string(&b, "Drive");
	g.group_name = ec_sii_build_string(&b, "DC");
	ec_sii_build_general(&b, &g);
	ec_sii_build_fmmus(&b, (const u8 *)"\1\2\3", 3);
	ec_sii_build_sms(&b, &sm, 1);
	ec_sii_build_pdo(&b, EC_SII_CAT_RXPDO, &pdo, entries);
	ec_sii_build_dcs(&b, &dc, 1);
	KUNIT_ASSERT_EQ(test, ec_sii_build_end(&b), (int)sizeof(image));
	KUNIT_EXPECT_MEMEQ(test, buf, image, sizeof(image));
	KUNIT_EXPECT_EQ(test, buf[sizeof(image)], 0xFF);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_sii_fixed_area),
	KUNIT_CASE(vectors_sii_general_category),
	KUNIT_CASE(vectors_sii_fmmus_and_sync_managers),
	KUNIT_CASE(vectors_sii_pdos_with_gap),
	KUNIT_CASE(vectors_sii_clock_modes),
	KUNIT_CASE(vectors_sii_image_read_piece_by_piece),
	KUNIT_CASE(vectors_sii_flaws_of_image),
	KUNIT_CASE(vectors_sii_same_image_built),
	{}
};

static struct kunit_suite suite = { .name = "vectors_sii", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
