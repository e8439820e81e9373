// SPDX-License-Identifier: GPL-2.0-only
/*
 * Bytes typed from the tables of the specifications, never from our own
 * encoders: whatever codec and test agree on wrongly is caught here.
 */
#include "wire_kunit.h"
#include "../../devices/sim/esc_page.h"
#include "../../devices/sim/mbox_encode.h"
#include "../../master/wire/frame.h"
#include "../../master/wire/sdo.h"
#include "../../master/wire/sii.h"

static u8 out[128];

static void vectors_broadcast_read_of_al_status(struct kunit *test)
{
	/* length 14, type 1; BRD, index 5, address 0:0x0130, 2 bytes, IRQ 0, data, counter */
	static const u8 want[] = {
		0x0E, 0x10,
		0x07, 0x05, 0x00, 0x00, 0x30, 0x01, 0x02, 0x00, 0x00, 0x00,
		0x00, 0x00, 0x00, 0x00,
	};
	struct ec_frame_buf f;

	ec_frame_begin(&f, out, sizeof(out));
	memset(ec_frame_add(&f, EC_CMD_BRD, 5, 0, 0x0130, 2), 0, 2);
	KUNIT_EXPECT_EQ(test, ec_frame_end(&f), sizeof(want));
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

/* BRD 0x0130 and LRD 0x01000010 of frames of their own, put together by hand */
static void vectors_two_frames_put_together(struct kunit *test)
{
	static const u8 brd[] = { 7, 5, 0, 0, 0x30, 1, 2, 0, 0, 0, 0x11, 0x22, 0, 0 };
	static const u8 lrd[] = { 10, 6, 0x10, 0, 0, 1, 1, 0, 0, 0, 0x33, 0, 0 };
	static const u8 want[] = {
		0x1B, 0x10,
		7, 5, 0, 0, 0x30, 1, 2, 0x80, 0, 0, 0x11, 0x22, 0, 0,
		10, 6, 0x10, 0, 0, 1, 1, 0, 0, 0, 0x33, 0, 0,
	};
	u8 out[sizeof(want)];
	struct ec_frame_buf f;

	ec_frame_begin(&f, out, sizeof(out));
	KUNIT_ASSERT_TRUE(test, ec_frame_append(&f, brd, sizeof(brd), 0, 1));
	KUNIT_ASSERT_TRUE(test, ec_frame_append(&f, lrd, sizeof(lrd), 0, 1));
	KUNIT_EXPECT_FALSE(test, ec_frame_append(&f, lrd, sizeof(lrd), 0, 1));
	KUNIT_EXPECT_EQ(test, ec_frame_end(&f), sizeof(want));
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

static void vectors_two_datagrams_in_one_frame(struct kunit *test)
{
	/* FPWR 0x03E9:0x0120 = 2 with "more"; LRD 0x01000010, 1 byte */
	static const u8 want[] = {
		0x1B, 0x10,
		0x05, 0x80, 0xE9, 0x03, 0x20, 0x01, 0x02, 0x80, 0x00, 0x00,
		0x02, 0x00, 0x00, 0x00,
		0x0A, 0x80, 0x10, 0x00, 0x00, 0x01, 0x01, 0x00, 0x00, 0x00,
		0x00, 0x00, 0x00,
	};
	struct ec_frame_buf f;
	u8 *p;

	ec_frame_begin(&f, out, sizeof(out));
	p = ec_frame_add(&f, EC_CMD_FPWR, 0x80, 0x03E9, 0x0120, 2);
	put_unaligned_le16(2, p);
	*ec_frame_add(&f, EC_CMD_LRD, 0x80, 0x0010, 0x0100, 1) = 0;
	KUNIT_EXPECT_EQ(test, ec_frame_end(&f), sizeof(want));
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

static void vectors_returned_datagram_with_all_marks(struct kunit *test)
{
	/* APRD at position 1 (0xFFFF, passed two slaves), circulating, IRQ 0x0004, counter 1 */
	u8 in[] = {
		0x0D, 0x10,
		0x01, 0x22, 0x01, 0x00, 0x34, 0x12, 0x01, 0x40, 0x04, 0x00,
		0x5A, 0x01, 0x00,
	};
	struct ec_frame_iter it;
	struct ec_dgram d;

	KUNIT_ASSERT_EQ(test, ec_frame_iter_init(&it, in, sizeof(in)), 0);
	KUNIT_ASSERT_EQ(test, ec_frame_iter_next(&it, &d), 1);
	KUNIT_EXPECT_EQ(test, d.cmd, 1);
	KUNIT_EXPECT_EQ(test, d.idx, 0x22);
	KUNIT_EXPECT_EQ(test, d.adp, 1);
	KUNIT_EXPECT_EQ(test, d.ado, 0x1234);
	KUNIT_EXPECT_EQ(test, d.len, 1);
	KUNIT_EXPECT_TRUE(test, d.circulating);
	KUNIT_EXPECT_FALSE(test, d.more);
	KUNIT_EXPECT_EQ(test, d.irq, 4);
	KUNIT_EXPECT_EQ(test, d.data[0], 0x5A);
	KUNIT_EXPECT_EQ(test, ec_dgram_wkc(&d), 1);
}

static void vectors_fmmu_for_two_output_bits(struct kunit *test)
{
	/* logical 0x00010000, 1 byte, bits 2 to 3 -> physical 0x0F00 bit 0, write, on */
	static const u8 want[] = {
		0x00, 0x00, 0x01, 0x00, 0x01, 0x00, 0x02, 0x03,
		0x00, 0x0F, 0x00, 0x02, 0x01, 0x00, 0x00, 0x00,
	};
	struct ec_fmmu f = {
		.logical = 0x00010000, .len = 1, .lbit_start = 2, .lbit_stop = 3,
		.phys = 0x0F00, .pbit = 0, .type = EC_FMMU_WRITE, .enable = true,
	};

	ec_fmmu_encode(&f, out);
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 2u);
}

static void vectors_fmmu_for_inputs(struct kunit *test)
{
	static const u8 in[] = {
		0x78, 0x56, 0x34, 0x12, 0x06, 0x00, 0x00, 0x07,
		0x80, 0x11, 0x00, 0x01, 0x01, 0x00, 0x00, 0x00,
	};
	struct ec_fmmu f;

	ec_fmmu_decode(&f, in);
	KUNIT_EXPECT_EQ(test, f.logical, 0x12345678u);
	KUNIT_EXPECT_EQ(test, f.len, 6);
	KUNIT_EXPECT_EQ(test, f.phys, 0x1180);
	KUNIT_EXPECT_EQ(test, f.type, EC_FMMU_READ);
	KUNIT_EXPECT_EQ(test, ec_fmmu_bits(&f), 48u);
}

static void vectors_mailbox_sync_manager(struct kunit *test)
{
	/* SM0 at 0x1000, 128 bytes, mailbox, written by the master, PDI interrupt, on */
	static const u8 want[] = { 0x00, 0x10, 0x80, 0x00, 0x26, 0x00, 0x01, 0x00 };
	struct ec_sm sm = {
		.start = 0x1000, .len = 128,
		.control = EC_SM_MODE_MAILBOX | EC_SM_DIR_WRITE | EC_SM_PDI_IRQ,
		.activate = EC_SM_ACT_ENABLE,
	};

	ec_sm_encode(&sm, out);
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

static void vectors_process_data_sync_manager(struct kunit *test)
{
	/* SM2 at 0x1100, 8 bytes, three buffers, written by the master, PDI interrupt, watchdog */
	static const u8 want[] = { 0x00, 0x11, 0x08, 0x00, 0x64, 0x00, 0x01, 0x00 };
	struct ec_sm sm = {
		.start = 0x1100, .len = 8,
		.control = EC_SM_MODE_BUFFERED | EC_SM_DIR_WRITE | EC_SM_PDI_IRQ | EC_SM_WATCHDOG,
		.activate = EC_SM_ACT_ENABLE,
	};

	ec_sm_encode(&sm, out);
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
}

static void vectors_full_mailbox_as_its_page_shows_it(struct kunit *test)
{
	/* SM1 at 0x1080, 128 bytes, mailbox, read by the master; written, full; repeat */
	static const u8 in[] = { 0x80, 0x10, 0x80, 0x00, 0x22, 0x09, 0x03, 0x02 };
	struct ec_sm sm;

	ec_sm_decode(&sm, in);
	KUNIT_EXPECT_EQ(test, sm.start, 0x1080);
	KUNIT_EXPECT_EQ(test, sm.len, 128);
	KUNIT_EXPECT_EQ(test, sm.control, EC_SM_MODE_MAILBOX | EC_SM_PDI_IRQ);
	KUNIT_EXPECT_EQ(test, sm.status, EC_SM_ST_WRITE_EVENT | EC_SM_ST_FULL);
	KUNIT_EXPECT_EQ(test, sm.activate, EC_SM_ACT_ENABLE | EC_SM_ACT_REPEAT);
	KUNIT_EXPECT_EQ(test, sm.pdi, EC_SM_PDI_REPEAT_ACK);
}

static void vectors_bits_across_bytes(struct kunit *test)
{
	/* bits 6 to 13 of ...: 0b11 below, 0b010010 above */
	static const u8 in[] = { 0xC5, 0x12, 0xFF };
	u8 to[] = { 0xFF, 0xFF, 0x00 };

	ec_bits_copy(to, 3, in, 6, 8);
	KUNIT_EXPECT_EQ(test, to[0], 0x5F);	/* 0x4B << 3, low three kept */
	KUNIT_EXPECT_EQ(test, to[1], 0xFA);
	KUNIT_EXPECT_EQ(test, to[2], 0x00);
}

static void vectors_sii_checksums(struct kunit *test)
{
	static const struct {
		u8 in[14];
		u8 crc;
	} v[] = {
		{ { 0 }, 0x30 },
		{ { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 0x0A, 0x0B, 0x0C, 0x0D }, 0xE0 },
		{ { 0x00, 0x0D }, 0x46 },
		{ { 0x04, 0x01, 0, 0, 0, 0, 0x0F }, 0xD8 },
		{ { 0x05, 0x0E, 0x03, 0x06, 0x10, 0x27 }, 0xD7 },
		{ { 0x80, 0x06, 0x00, 0x44, 0x64 }, 0xF3 },
		{ { 0x80, 0x02, 0x00, 0x6E, 0xFF, 0x00, 0xFF }, 0xB6 },
	};
	size_t i;

	for (i = 0; i < ARRAY_SIZE(v); i++)
		KUNIT_EXPECT_EQ(test, ec_sii_crc(v[i].in), v[i].crc);
}

static void vectors_sii_image_typed_by_hand(struct kunit *test)
{
	static u8 img[256] = {
		[0x00] = 0x05, 0x0E, 0x03, 0x06, 0x10, 0x27,
		[0x0E] = 0xD7,
		[0x10] = 0x37, 0x13, 0x00, 0x00, 0x56, 0x34, 0x12, 0x00, 0x01,
		[0x30] = 0x00, 0x10, 0x80, 0x00, 0x80, 0x10, 0x80, 0x00, 0x04, 0x00,
		[0x7C] = 0x0F, 0x00, 0x01, 0x00,
		/* strings: 1, "AB" */
		[0x80] = 0x0A, 0x00, 0x02, 0x00, 0x01, 0x02, 'A', 'B',
		/* SyncManager 0 */
		[0x88] = 0x29, 0x00, 0x04, 0x00, 0x00, 0x10, 0x80, 0x00, 0x26, 0x00, 0x01, 0x01,
		/* TxPDO 0x1A00, 1 entry, SM3, name 1: 0x6000:01, 16 bit, UNSIGNED16 */
		[0x94] = 0x32, 0x00, 0x08, 0x00,
			 0x00, 0x1A, 0x01, 0x03, 0x00, 0x01, 0x00, 0x00,
			 0x00, 0x60, 0x01, 0x01, 0x06, 0x10, 0x00, 0x00,
		[0xA8] = 0xFF, 0xFF,
	};
	struct ec_sii_info info;
	struct ec_sii_sm sm;
	struct ec_sii_pdo_iter it;
	struct ec_sii_pdo pdo;
	struct ec_sii_pdo_entry e;
	char s[4];

	KUNIT_ASSERT_EQ(test, ec_sii_decode_info(img, sizeof(img), &info), 0);
	KUNIT_EXPECT_TRUE(test, info.checksum_ok);
	KUNIT_EXPECT_EQ(test, info.vendor, 0x1337u);
	KUNIT_EXPECT_EQ(test, info.product, 0x00123456u);
	KUNIT_EXPECT_EQ(test, info.revision, 1u);
	KUNIT_EXPECT_EQ(test, info.std.rx_offset, 0x1000);
	KUNIT_EXPECT_EQ(test, info.std.rx_size, 128);
	KUNIT_EXPECT_EQ(test, info.std.tx_offset, 0x1080);
	KUNIT_EXPECT_EQ(test, info.protocols, 4);
	KUNIT_EXPECT_EQ(test, info.size_kbit, 16u);
	KUNIT_EXPECT_EQ(test, ec_sii_string(img, sizeof(img), 1, s, sizeof(s)), 2);
	KUNIT_EXPECT_STREQ(test, s, "AB");
	KUNIT_ASSERT_EQ(test, ec_sii_decode_sms(img, sizeof(img), &sm, 1), 1);
	KUNIT_EXPECT_EQ(test, sm.control, 0x26);
	ec_sii_pdo_iter_init(&it, img, sizeof(img), 50);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_iter_next(&it, &pdo), 1);
	KUNIT_EXPECT_EQ(test, pdo.index, 0x1A00);
	KUNIT_EXPECT_EQ(test, pdo.sm, 3);
	KUNIT_ASSERT_EQ(test, ec_sii_pdo_entry(&pdo, 0, &e), 0);
	KUNIT_EXPECT_EQ(test, e.index, 0x6000);
	KUNIT_EXPECT_EQ(test, e.sub, 1);
	KUNIT_EXPECT_EQ(test, e.type, 6);
	KUNIT_EXPECT_EQ(test, e.bits, 16);
	KUNIT_EXPECT_EQ(test, ec_sii_used(img, sizeof(img)), (size_t)0xAA);
}

static void vectors_mailbox_headers(struct kunit *test)
{
	/* 10 bytes of CoE, counter 1 */
	static const u8 coe[] = { 0x0A, 0x00, 0x00, 0x00, 0x00, 0x13 };
	/* 4 bytes of error reply from station 0x03E9, priority 3, counter 7 */
	static const u8 err[] = { 0x04, 0x00, 0xE9, 0x03, 0xC0, 0x70, 0x01, 0x00, 0x02, 0x00 };
	struct ec_mbox_hdr h = { .len = 10, .type = EC_MBOX_COE, .counter = 1 };
	struct ec_wbuf w = ec_wbuf(out, sizeof(out));
	struct ec_rbuf r = ec_rbuf(err, sizeof(err));
	u16 detail;

	ec_mbox_hdr_encode(&w, &h);
	KUNIT_EXPECT_MEMEQ(test, out, coe, sizeof(coe));
	KUNIT_ASSERT_EQ(test, ec_mbox_hdr_decode(&r, &h), 0);
	KUNIT_EXPECT_EQ(test, h.address, 0x03E9);
	KUNIT_EXPECT_EQ(test, h.prio, 3);
	KUNIT_EXPECT_EQ(test, h.type, EC_MBOX_ERR);
	KUNIT_EXPECT_EQ(test, h.counter, 7);
	KUNIT_ASSERT_EQ(test, ec_mbox_error_decode(&r, &detail), 0);
	KUNIT_EXPECT_EQ(test, detail, EC_MBOX_ERR_PROTOCOL);
	w = ec_wbuf(out, sizeof(out));
	ec_mbox_error_encode(&w, EC_MBOX_ERR_PROTOCOL);
	KUNIT_EXPECT_MEMEQ(test, out, err + 6, 4);
}

static void vectors_expedited_upload(struct kunit *test)
{
	static const u8 req[] = { 0x00, 0x20, 0x40, 0x18, 0x10, 0x01, 0, 0, 0, 0 };
	static const u8 resp[] = { 0x00, 0x30, 0x43, 0x18, 0x10, 0x01, 0x37, 0x13, 0x00, 0x00 };
	static const u8 one[] = { 0x00, 0x30, 0x4F, 0x18, 0x10, 0x00, 0x04, 0x00, 0x00, 0x00 };
	static const u8 sizeless[] = {
		0x00, 0x30, 0x40, 0x18, 0x10, 0x00, 0x00, 0x00, 0x00, 0x00, 'a', 'b', 'c', 'd',
	};
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x1018, 1, false, out, 8);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, out + 16, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out + 16, req, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, resp, 10), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)4);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(out), 0x1337u);
	ec_sdo_upload_init(&u, 0x1018, 0, false, out, 8);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, one, 10), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)1);
	/* neither expedited nor with a size: what is there is all of it */
	ec_sdo_upload_init(&u, 0x1018, 0, false, out, 8);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, sizeless, 14), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)4);
	KUNIT_EXPECT_MEMEQ(test, out, "abcd", 4);
}

static void vectors_expedited_downloads_of_1_to_4_bytes(struct kunit *test)
{
	static const u8 cmd[] = { 0x2F, 0x2B, 0x27, 0x23 };
	static const u8 resp[] = { 0x00, 0x30, 0x60, 0x12, 0x1C, 0x00, 0, 0, 0, 0 };
	u8 want[] = { 0x00, 0x20, 0, 0x12, 0x1C, 0x00, 0, 0, 0, 0 };
	struct ec_sdo d;
	size_t i;

	for (i = 0; i < 4; i++) {
		want[2] = cmd[i];
		want[6 + i] = (u8)(0xA1 + i);
		ec_sdo_download_init(&d, 0x1C12, 0, false, (const u8 *)"\xA1\xA2\xA3\xA4",
				     i + 1, 122);
		KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out, sizeof(out)), 10);
		KUNIT_EXPECT_MEMEQ(test, out, want, 10);
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, resp, 10), 0);
	}
}

static void vectors_complete_access_download(struct kunit *test)
{
	/* 0x1C13 = { 1, 0x1A00 }: count, pad byte, one index */
	static const u8 data[] = { 0x01, 0x00, 0x00, 0x1A };
	static const u8 want[] = {
		0x00, 0x20, 0x31, 0x13, 0x1C, 0x00, 0x04, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x1A,
	};
	static const u8 resp[] = { 0x00, 0x30, 0x70, 0x13, 0x1C, 0x00, 0, 0, 0, 0 };
	struct ec_sdo d;

	ec_sdo_download_init(&d, 0x1C13, 0, true, data, sizeof(data), 122);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out, sizeof(out)), (int)sizeof(want));
	KUNIT_EXPECT_MEMEQ(test, out, want, sizeof(want));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, resp, 10), 0);
}

static void vectors_segmented_upload(struct kunit *test)
{
	/* "segmented!" out of a slave with a mailbox of 16 bytes: nothing, 7, 3 */
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 0x0A, 0x00, 0x00, 0x00 };
	static const u8 seg0[] = { 0x00, 0x30, 0x00, 's', 'e', 'g', 'm', 'e', 'n', 't' };
	static const u8 seg1[] = { 0x00, 0x30, 0x19, 'e', 'd', '!', 0, 0, 0, 0 };
	static const u8 req0[] = { 0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 req1[] = { 0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x1008, 0, false, out, 32);
	ec_sdo_tx(&u, out + 32, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, first, 10), EC_MORE);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, out + 32, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out + 32, req0, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, seg0, 10), EC_MORE);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, out + 32, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out + 32, req1, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, seg1, 10), 0);
	KUNIT_ASSERT_EQ(test, u.size, (size_t)10);
	KUNIT_EXPECT_MEMEQ(test, out, "segmented!", 10);
}

static void vectors_segmented_download(struct kunit *test)
{
	/* 13 bytes into a mailbox of 18: 2 with the request, then 9, then 2 padded to 7 */
	static const u8 first[] = {
		0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 0x0D, 0x00, 0x00, 0x00, 's', 'e',
	};
	static const u8 seg0[] = { 0x00, 0x20, 0x00, 'g', 'm', 'e', 'n', 't', 'e', 'd', '!', '!' };
	static const u8 seg1[] = { 0x00, 0x20, 0x1B, '.', '.', 0, 0, 0, 0, 0 };
	static const u8 ok[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 ack0[] = { 0x00, 0x30, 0x20, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 ack1[] = { 0x00, 0x30, 0x30, 0, 0, 0, 0, 0, 0, 0 };
	struct ec_sdo d;

	ec_sdo_download_init(&d, 0x2000, 1, false, (const u8 *)"segmented!!..", 13, 12);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out, sizeof(out)), 12);
	KUNIT_EXPECT_MEMEQ(test, out, first, 12);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&d, ok, 10), EC_MORE);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out, sizeof(out)), 12);
	KUNIT_EXPECT_MEMEQ(test, out, seg0, 12);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&d, ack0, 10), EC_MORE);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out, sizeof(out)), 10);
	KUNIT_EXPECT_MEMEQ(test, out, seg1, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&d, ack1, 10), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_broadcast_read_of_al_status),
	KUNIT_CASE(vectors_two_datagrams_in_one_frame),
	KUNIT_CASE(vectors_two_frames_put_together),
	KUNIT_CASE(vectors_returned_datagram_with_all_marks),
	KUNIT_CASE(vectors_fmmu_for_two_output_bits),
	KUNIT_CASE(vectors_fmmu_for_inputs),
	KUNIT_CASE(vectors_mailbox_sync_manager),
	KUNIT_CASE(vectors_process_data_sync_manager),
	KUNIT_CASE(vectors_full_mailbox_as_its_page_shows_it),
	KUNIT_CASE(vectors_bits_across_bytes),
	KUNIT_CASE(vectors_sii_checksums),
	KUNIT_CASE(vectors_sii_image_typed_by_hand),
	KUNIT_CASE(vectors_mailbox_headers),
	KUNIT_CASE(vectors_expedited_upload),
	KUNIT_CASE(vectors_expedited_downloads_of_1_to_4_bytes),
	KUNIT_CASE(vectors_complete_access_download),
	KUNIT_CASE(vectors_segmented_upload),
	KUNIT_CASE(vectors_segmented_download),
	{}
};

static struct kunit_suite suite = { .name = "vectors", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
