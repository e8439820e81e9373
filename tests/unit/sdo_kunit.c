// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../devices/sim/sdo_server.h"
#include "../../master/wire/sdo.h"

static u8 tx[1500], rx[1500], obj[4096], got[4096], srv_buf[4096];

/* Object dictionary of the tests: one object, 0x2000:1 (or 0x2000 whole). */
static struct {
	size_t len;
	u32 abort;
	int writes;
	bool complete;
} od;

static u32 od_read(void *ctx, u16 index, u8 sub, bool complete, u8 *buf, size_t cap, size_t *len)
{
	od.complete = complete;
	if (index != 0x2000)
		return EC_ABORT_NO_OBJECT;
	if (sub != 1 && !complete)
		return EC_ABORT_NO_SUB;
	if (od.abort)
		return od.abort;
	if (od.len <= cap)
		memcpy(buf, obj, od.len);
	*len = od.len;
	return 0;
}

static u32 od_write(void *ctx, u16 index, u8 sub, bool complete, const u8 *data, size_t len)
{
	od.complete = complete;
	if (index != 0x2000)
		return EC_ABORT_NO_OBJECT;
	if (od.abort)
		return od.abort;
	memcpy(obj, data, len);
	od.len = len;
	od.writes++;
	return 0;
}

static const struct ec_sdo_srv_ops ops = { od_read, od_write };
static struct ec_sdo_srv srv;

static void fill(u8 *p, size_t n, u32 x)
{
	while (n--) {
		x = x * 1103515245 + 12345;
		*p++ = (u8)(x >> 16);
	}
}

static int sdo_init(struct kunit *test)
{
	memset(&od, 0, sizeof(od));
	ec_sdo_srv_init(&srv, &ops, NULL, srv_buf, sizeof(srv_buf));
	return 0;
}

/* Whole transfers between our client and our server. */
static int upload(struct ec_sdo *u, size_t mbox)
{
	int ret, len;

	do {
		len = ec_sdo_tx(u, tx, sizeof(tx));
		if (len < 0)
			return len;
		len = ec_sdo_srv_handle(&srv, tx, len, rx, mbox);
		if (len <= 0)
			return -EPIPE;
		ret = ec_sdo_rx(u, rx, len);
	} while (ret == EC_MORE);
	return ret;
}

static int download(struct ec_sdo *d, size_t mbox)
{
	int ret, len;

	do {
		len = ec_sdo_tx(d, tx, sizeof(tx));
		if (len < 0)
			return len;
		if ((size_t)len > mbox)
			return -E2BIG;
		len = ec_sdo_srv_handle(&srv, tx, len, rx, mbox);
		if (len <= 0)
			return -EPIPE;
		ret = ec_sdo_rx(d, rx, len);
	} while (ret == EC_MORE);
	return ret;
}

static const size_t sizes[] = {
	0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 17, 18, 19, 30, 64, 100, 112, 113, 119, 120,
	121, 128, 1000, 4096,
};
static const size_t mboxes[] = { 10, 11, 16, 17, 24, 58, 122, 250, 1480 };

static void sdo_objects_of_every_size_are_read(struct kunit *test)
{
	struct ec_sdo u;
	size_t i, j;
	int ca;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		for (j = 0; j < ARRAY_SIZE(mboxes); j++) {
			for (ca = 0; ca < 2; ca++) {
				fill(obj, sizes[i], (u32)(i + j));
				memset(got, 0xEE, sizeof(got));
				od.len = sizes[i];
				ec_sdo_upload_init(&u, 0x2000, 1, ca, got, sizeof(got));
				KUNIT_ASSERT_EQ_MSG(test, upload(&u, mboxes[j]), 0,
						    "%zu bytes, mailbox %zu", sizes[i], mboxes[j]);
				KUNIT_ASSERT_EQ(test, u.size, sizes[i]);
				KUNIT_ASSERT_EQ(test, u.total, sizes[i]);
				KUNIT_ASSERT_MEMEQ(test, got, obj, sizes[i]);
				KUNIT_ASSERT_EQ(test, od.complete, (bool)ca);
				KUNIT_ASSERT_EQ(test, (int)u.state, (int)EC_SDO_DONE);
			}
		}
	}
}

static void sdo_objects_of_every_size_are_written(struct kunit *test)
{
	struct ec_sdo d;
	size_t i, j;
	int ca;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		for (j = 0; j < ARRAY_SIZE(mboxes); j++) {
			for (ca = 0; ca < 2; ca++) {
				fill(got, sizes[i], (u32)(i + j));
				memset(obj, 0xEE, sizeof(obj));
				od.writes = 0;
				ec_sdo_download_init(&d, 0x2000, 1, ca, got, sizes[i], mboxes[j]);
				KUNIT_ASSERT_EQ_MSG(test, download(&d, mboxes[j]), 0,
						    "%zu bytes, mailbox %zu", sizes[i], mboxes[j]);
				KUNIT_ASSERT_EQ(test, d.sent, sizes[i]);
				KUNIT_ASSERT_EQ(test, od.len, sizes[i]);
				KUNIT_ASSERT_EQ(test, od.writes, 1);
				KUNIT_ASSERT_MEMEQ(test, got, obj, sizes[i]);
			}
		}
	}
}

static void sdo_abort_of_slave_ends_transfer(struct kunit *test)
{
	struct ec_sdo u;
	struct ec_sdo d;

	ec_sdo_upload_init(&u, 0x2001, 1, false, got, 4);
	KUNIT_EXPECT_EQ(test, upload(&u, 128), -EIO);
	KUNIT_EXPECT_EQ(test, u.abort, EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_FALSE(test, u.send_abort);
	KUNIT_EXPECT_EQ(test, ec_sdo_tx(&u, tx, sizeof(tx)), -EINVAL);

	od.abort = EC_ABORT_READ_ONLY;
	ec_sdo_download_init(&d, 0x2000, 1, false, obj, 100, 24);
	KUNIT_EXPECT_EQ(test, download(&d, 24), -EIO);
	KUNIT_EXPECT_EQ(test, d.abort, EC_ABORT_READ_ONLY);
	KUNIT_EXPECT_FALSE(test, d.send_abort);
}

static void sdo_abort_sent_as_response_ends_transfer(struct kunit *test)
{
	static const u8 abort[] = { 0x00, 0x30, 0x80, 0x00, 0x20, 0x01, 0x11, 0x00, 0x09, 0x06 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 4);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, abort, sizeof(abort)), -EIO);
	KUNIT_EXPECT_EQ(test, u.abort, EC_ABORT_NO_SUB);
}

static void sdo_answers_to_other_questions_are_stale(struct kunit *test)
{
	static const u8 other_index[] = { 0x00, 0x30, 0x4F, 0x01, 0x20, 0x01, 9, 0, 0, 0 };
	static const u8 other_sub[] = { 0x00, 0x30, 0x4F, 0x00, 0x20, 0x02, 9, 0, 0, 0 };
	static const u8 written[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 segment[] = { 0x00, 0x30, 0x01, 1, 2, 3, 4, 5, 6, 7 };
	static const u8 emergency[] = { 0x00, 0x10, 0, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 sdoinfo[] = { 0x00, 0x80, 0x02, 0, 0, 0, 1, 0 };
	static const u8 old_abort[] = { 0x00, 0x20, 0x80, 0x01, 0x20, 0x01, 0, 0, 4, 5 };
	static const u8 good[] = { 0x00, 0x30, 0x4F, 0x00, 0x20, 0x01, 5, 0, 0, 0 };
	struct ec_sdo u;
	struct ec_sdo d;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 4);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, other_index, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, other_sub, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, written, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, segment, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, emergency, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, sdoinfo, 8), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, old_abort, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, good, 10), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)1);
	KUNIT_EXPECT_EQ(test, got[0], 5);

	ec_sdo_download_init(&d, 0x2000, 1, false, got, 4, 128);
	ec_sdo_tx(&d, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, good, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, emergency, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, old_abort, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, written, 10), 0);
}

static void sdo_late_answer_between_segments_is_stale(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 8, 0, 0, 0 };
	static const u8 late[] = { 0x00, 0x30, 0x43, 0x18, 0x10, 0x01, 9, 0, 0, 0 };
	static const u8 seg[] = { 0x00, 0x30, 0x01, 1, 2, 3, 4, 5, 6, 7, 8 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, 10), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, late, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, 11), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)8);
}

static void sdo_another_command_between_segments_is_answered_with_abort(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 8, 0, 0, 0 };
	static const u8 again[] = { 0x00, 0x30, 0x43, 0x00, 0x20, 0x01, 9, 0, 0, 0 };
	static const u8 ack[] = { 0x00, 0x30, 0x20, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 ok[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 other[] = { 0x00, 0x30, 0x60, 0x01, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 other_up[] = { 0x00, 0x30, 0x43, 0x01, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 request[] = { 0x00, 0x20, 0x20, 0, 0, 0, 0, 0, 0, 0 };
	const u8 *bad[] = { again, ack };
	struct ec_sdo u;
	struct ec_sdo d;
	size_t i;

	for (i = 0; i < ARRAY_SIZE(bad); i++) {
		ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
		KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, first, 10), EC_MORE);
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, bad[i], 10), -EPROTO);
		KUNIT_EXPECT_TRUE(test, u.send_abort);
		KUNIT_EXPECT_EQ(test, u.abort, EC_ABORT_COMMAND);
		KUNIT_EXPECT_EQ(test, u.size, (size_t)0);
	}

	ec_sdo_download_init(&d, 0x2000, 1, false, got, 64, 24);
	ec_sdo_tx(&d, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, other, 10), EC_STALE);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&d, ok, 6), EC_MORE);
	ec_sdo_tx(&d, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, other, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, other_up, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, request, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, ok, 10), -EPROTO);
	KUNIT_EXPECT_TRUE(test, d.send_abort);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, ok, 10), -EINVAL);
}

static void sdo_complete_access_may_be_answered_with_other_subindex(struct kunit *test)
{
	u8 resp[] = { 0x00, 0x30, 0x51, 0x00, 0x20, 0x00, 2, 0, 0, 0, 'a', 'b' };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, true, got, 64);
	resp[5] = 2;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, resp, sizeof(resp)), EC_STALE);
	resp[5] = 0;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, resp, sizeof(resp)), 0);
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, resp, sizeof(resp)), EC_STALE);
}

static void sdo_wrong_toggle_bit_is_answered_with_abort(struct kunit *test)
{
	static const u8 want[] = { 0x00, 0x20, 0x80, 0x00, 0x20, 0x01, 0x00, 0x00, 0x03, 0x05 };
	struct ec_sdo u;
	struct ec_sdo d;
	int len;

	od.len = 100;
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, sizeof(got));
	len = ec_sdo_tx(&u, tx, sizeof(tx));
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&u, rx, len), EC_MORE);
	len = ec_sdo_tx(&u, tx, sizeof(tx));
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	rx[2] ^= 0x10;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, rx, len), -EPROTO);
	KUNIT_EXPECT_TRUE(test, u.send_abort);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, tx, sizeof(tx)), 10);
	KUNIT_EXPECT_MEMEQ(test, tx, want, 10);
	KUNIT_EXPECT_FALSE(test, u.send_abort);
	KUNIT_EXPECT_EQ(test, ec_sdo_tx(&u, tx, sizeof(tx)), -EINVAL);
	/* and the server forgets the transfer */
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, want, 10, rx, 24), 0);
	KUNIT_EXPECT_EQ(test, (int)srv.state, (int)EC_SDO_SRV_IDLE);

	ec_sdo_download_init(&d, 0x2000, 1, false, got, 100, 24);
	len = ec_sdo_tx(&d, tx, sizeof(tx));
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&d, rx, len), EC_MORE);
	len = ec_sdo_tx(&d, tx, sizeof(tx));
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	rx[2] ^= 0x10;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, rx, len), -EPROTO);
	KUNIT_EXPECT_TRUE(test, d.send_abort);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, tx, sizeof(tx)), 10);
	KUNIT_EXPECT_MEMEQ(test, tx, want, 10);
}

static void sdo_server_aborts_on_wrong_toggle_bit(struct kunit *test)
{
	static const u8 up[] = { 0x00, 0x20, 0x40, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 seg[] = { 0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 down[] = { 0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 20, 0, 0, 0 };
	static const u8 dseg[] = { 0x00, 0x20, 0x10, 1, 2, 3, 4, 5, 6, 7 };
	static const u8 want[] = { 0x00, 0x20, 0x80, 0x00, 0x20, 0x01, 0x00, 0x00, 0x03, 0x05 };

	od.len = 100;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, up, 10, rx, 24), 24);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, seg, 10, rx, 24), 10);
	KUNIT_EXPECT_MEMEQ(test, rx, want, 10);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, down, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, dseg, 10, rx, 24), 10);
	KUNIT_EXPECT_MEMEQ(test, rx, want, 10);
	KUNIT_EXPECT_EQ(test, od.writes, 0);
}

static void sdo_segment_without_transfer_is_aborted(struct kunit *test)
{
	static const u8 seg[] = { 0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 seg2[] = { 0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 up[] = { 0x00, 0x20, 0x40, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 dseg[] = { 0x00, 0x20, 0x01, 1, 2, 3, 4, 5, 6, 7 };

	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, seg, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_COMMAND);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, dseg, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
	KUNIT_EXPECT_EQ(test, od.writes, 0);

	/* nor behind the end of one */
	od.len = 14;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, up, 10, rx, 24), 24);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, seg, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
	od.len = 15;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, up, 10, rx, 24), 24);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, seg, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x0D);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, seg2, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
	/* nor one of the other direction */
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, up, 10, rx, 12), 12);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, dseg, 4, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
	KUNIT_EXPECT_EQ(test, od.writes, 0);
}

static void sdo_segments_must_make_up_announced_size(struct kunit *test)
{
	static const u8 down[] = { 0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 8, 0, 0, 0 };
	static const u8 last7[] = { 0x00, 0x20, 0x01, 1, 2, 3, 4, 5, 6, 7 };
	static const u8 nine[] = { 0x00, 0x20, 0x00, 1, 2, 3, 4, 5, 6, 7, 8, 9 };

	ec_sdo_srv_handle(&srv, down, 10, rx, 24);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, last7, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_TOO_SHORT);
	ec_sdo_srv_handle(&srv, down, 10, rx, 24);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, nine, 12, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_TOO_LONG);
	KUNIT_EXPECT_EQ(test, od.writes, 0);
}

static void sdo_object_too_large_for_server_is_refused(struct kunit *test)
{
	static const u8 down[] = { 0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 0xFF, 0xFF, 0xFF, 0xFF };

	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, down, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_MEMORY);
	od.len = sizeof(srv_buf) + 1;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv,
			(const u8 *)"\0\x20\x40\0\x20\1\0\0\0", 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_INTERNAL);
}

static void sdo_object_larger_than_buffer_is_aborted(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 100, 0, 0, 0, 1, 2 };
	static const u8 whole[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 5, 0, 0, 0, 1, 2, 3, 4, 5 };
	static const u8 exp[] = { 0x00, 0x30, 0x43, 0x00, 0x20, 0x01, 1, 2, 3, 4 };
	static const u8 want[] = { 0x00, 0x20, 0x80, 0x00, 0x20, 0x01, 0x05, 0x00, 0x04, 0x05 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 99);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, u.total, (size_t)100);
	KUNIT_EXPECT_TRUE(test, u.send_abort);
	KUNIT_EXPECT_EQ(test, (int)u.state, (int)EC_SDO_ABORT);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, tx, sizeof(tx)), 10);
	KUNIT_EXPECT_MEMEQ(test, tx, want, 10);

	/* the slave has nothing left to send: no abort */
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 4);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, whole, sizeof(whole)), -ENOBUFS);
	KUNIT_EXPECT_FALSE(test, u.send_abort);
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 2);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, exp, sizeof(exp)), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, u.total, (size_t)4);
	KUNIT_EXPECT_FALSE(test, u.send_abort);
}

static void sdo_more_segments_than_announced_stop_at_buffer(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 4, 0, 0, 0 };
	u8 seg[10] = { 0x00, 0x30, 0x00, 1, 2, 3, 4, 5, 6, 7 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 20);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, 10), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, 10), EC_MORE);
	seg[2] = 0x10;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, 10), EC_MORE);
	seg[2] = 0x00;
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, 10), -ENOBUFS);
	KUNIT_EXPECT_TRUE(test, u.send_abort);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)14);
}

static void sdo_fewer_bytes_than_announced_are_accepted(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 64, 0, 0, 0, 'a', 'b' };
	static const u8 seg[] = { 0x00, 0x30, 0x09, 'c', 'd', 'e', 0, 0, 0, 0 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, sizeof(seg)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)5);
	KUNIT_EXPECT_EQ(test, u.total, (size_t)64);
	KUNIT_EXPECT_MEMEQ(test, got, "abcde", 5);
}

static void sdo_padding_behind_complete_object_is_dropped(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 2, 0, 0, 0, 'a', 'b', 0, 0 };
	static const u8 empty[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 2);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)2);

	ec_sdo_upload_init(&u, 0x2000, 1, false, NULL, 0);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, empty, sizeof(empty)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)0);
}

static void sdo_segments_without_padding_are_understood(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 3, 0, 0, 0 };
	static const u8 bare[] = { 0x00, 0x30, 0x09, 'a', 'b', 'c' };
	static const u8 unset[] = { 0x00, 0x30, 0x01, 'a', 'b', 'c' };
	struct ec_sdo u;
	int i;

	for (i = 0; i < 2; i++) {
		ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
		ec_sdo_tx(&u, tx, sizeof(tx));
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), EC_MORE);
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, i ? bare : unset, 6), 0);
		KUNIT_EXPECT_EQ(test, u.size, (size_t)3);
	}
}

static void sdo_unused_count_of_long_segment_is_ignored(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 8, 0, 0, 0 };
	static const u8 seg[] = { 0x00, 0x30, 0x0F, 1, 2, 3, 4, 5, 6, 7, 8 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, sizeof(seg)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)8);
}

static void sdo_empty_segments_do_not_go_on_for_ever(struct kunit *test)
{
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 8, 0, 0, 0 };
	static const u8 seg[] = { 0x00, 0x30, 0x0E, 0, 0, 0, 0, 0, 0, 0 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, first, sizeof(first)), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, seg, sizeof(seg)), -EPROTO);
	KUNIT_EXPECT_TRUE(test, u.send_abort);
}

static void sdo_expedited_data_without_size_fills_buffer(struct kunit *test)
{
	static const u8 exp[] = { 0x00, 0x30, 0x42, 0x00, 0x20, 0x01, 1, 2, 3, 4 };
	struct ec_sdo u;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, exp, sizeof(exp)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)4);
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 1);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, exp, sizeof(exp)), 0);
	KUNIT_EXPECT_EQ(test, u.size, (size_t)1);
	/* without room it is too large, of whatever size */
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 0);
	ec_sdo_tx(&u, tx, sizeof(tx));
	KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, exp, sizeof(exp)), -ENOBUFS);
}

static void sdo_short_messages_are_refused_at_every_length(struct kunit *test)
{
	static const u8 exp[] = { 0x00, 0x30, 0x43, 0x00, 0x20, 0x01, 1, 2, 3, 4 };
	static const u8 norm[] = { 0x00, 0x30, 0x41, 0x00, 0x20, 0x01, 1, 0, 0, 0 };
	static const u8 done[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01 };
	struct ec_sdo u;
	struct ec_sdo d;
	size_t len;

	for (len = 0; len < 10; len++) {
		ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
		ec_sdo_tx(&u, tx, sizeof(tx));
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, exp, len), -EMSGSIZE);
		ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
		ec_sdo_tx(&u, tx, sizeof(tx));
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&u, norm, len), -EMSGSIZE);
		KUNIT_EXPECT_FALSE(test, u.send_abort);
	}
	for (len = 0; len < 6; len++) {
		ec_sdo_download_init(&d, 0x2000, 1, false, got, 4, 64);
		ec_sdo_tx(&d, tx, sizeof(tx));
		KUNIT_EXPECT_EQ(test, ec_sdo_rx(&d, done, len), -EMSGSIZE);
	}
	/* and by the server */
	for (len = 0; len < 10; len++)
		KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv,
				(const u8 *)"\0\x20\x40\0\x20\1\0\0\0", len, rx, 24), -EMSGSIZE);
}

static void sdo_buffers_too_small_are_refused(struct kunit *test)
{
	struct ec_sdo u;
	struct ec_sdo d;

	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 64);
	KUNIT_EXPECT_EQ(test, ec_sdo_tx(&u, tx, 9), -EMSGSIZE);
	ec_sdo_download_init(&d, 0x2000, 1, false, got, 64, 9);
	KUNIT_EXPECT_EQ(test, ec_sdo_tx(&d, tx, sizeof(tx)), -EMSGSIZE);
	ec_sdo_download_init(&d, 0x2000, 1, false, got, 64, 128);
	KUNIT_EXPECT_EQ(test, ec_sdo_tx(&d, tx, 9), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, tx, 10, rx, 9), -EINVAL);
}

static void sdo_message_can_be_sent_again(struct kunit *test)
{
	struct ec_sdo d;
	u8 first[24];
	int len;

	fill(got, 100, 1);
	ec_sdo_download_init(&d, 0x2000, 1, false, got, 100, 24);
	len = ec_sdo_tx(&d, tx, sizeof(tx));
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	ec_sdo_rx(&d, rx, len);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, first, sizeof(first)), 24);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, tx, sizeof(tx)), 24);
	KUNIT_EXPECT_MEMEQ(test, tx, first, 24);
}

static void sdo_new_request_ends_old_transfer_in_server(struct kunit *test)
{
	static const u8 seg[] = { 0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0 };
	struct ec_sdo u;
	int len;

	od.len = 100;
	ec_sdo_upload_init(&u, 0x2000, 1, false, got, 100);
	len = ec_sdo_tx(&u, tx, sizeof(tx));
	ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	od.len = 4;
	len = ec_sdo_srv_handle(&srv, tx, len, rx, 24);
	KUNIT_EXPECT_EQ(test, len, 10);
	KUNIT_EXPECT_EQ(test, rx[2], 0x43);
	ec_sdo_srv_handle(&srv, seg, 10, rx, 24);
	KUNIT_EXPECT_EQ(test, rx[2], 0x80);
}

static void sdo_server_refuses_unknown_commands(struct kunit *test)
{
	u8 req[10] = { 0x00, 0x20, 0xA0, 0x00, 0x20, 0x01, 0, 0, 0, 0 };

	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, req, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_COMMAND);
	req[1] = 0x30;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, req, 10, rx, 24), -ENOMSG);
	req[1] = 0x20;
	req[2] = 0x50;	/* complete access from subindex 2 */
	req[5] = 2;
	KUNIT_EXPECT_EQ(test, ec_sdo_srv_handle(&srv, req, 10, rx, 24), 10);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(rx + 6), EC_ABORT_NO_SUB);
}

/* Given up: a slave in the middle of segments gets an abort, another one nothing. */
static void sdo_cancel(struct kunit *test)
{
	static const u8 first[] = { 0, 0x30, 0x41, 0x00, 0x20, 0, 8, 0, 0, 0 };
	u8 data[8], tx[16];
	struct ec_sdo s;

	ec_sdo_upload_init(&s, 0x2000, 0, false, data, sizeof(data));
	ec_sdo_cancel(&s);
	KUNIT_EXPECT_FALSE(test, s.send_abort);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&s, tx, sizeof(tx)), EC_SDO_MSG);
	ec_sdo_cancel(&s);
	KUNIT_EXPECT_FALSE(test, s.send_abort);
	KUNIT_ASSERT_EQ(test, ec_sdo_rx(&s, first, sizeof(first)), EC_MORE);
	ec_sdo_cancel(&s);
	KUNIT_ASSERT_TRUE(test, s.send_abort);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&s, tx, sizeof(tx)), EC_SDO_MSG);
	KUNIT_EXPECT_EQ(test, tx[2], 0x80);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(tx + 3), 0x2000);
	KUNIT_EXPECT_EQ(test, get_unaligned_le32(tx + 6), EC_ABORT_TIMEOUT);
	ec_sdo_cancel(&s);
	KUNIT_EXPECT_FALSE(test, s.send_abort);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sdo_objects_of_every_size_are_read),
	KUNIT_CASE(sdo_objects_of_every_size_are_written),
	KUNIT_CASE(sdo_abort_of_slave_ends_transfer),
	KUNIT_CASE(sdo_abort_sent_as_response_ends_transfer),
	KUNIT_CASE(sdo_answers_to_other_questions_are_stale),
	KUNIT_CASE(sdo_late_answer_between_segments_is_stale),
	KUNIT_CASE(sdo_another_command_between_segments_is_answered_with_abort),
	KUNIT_CASE(sdo_complete_access_may_be_answered_with_other_subindex),
	KUNIT_CASE(sdo_wrong_toggle_bit_is_answered_with_abort),
	KUNIT_CASE(sdo_server_aborts_on_wrong_toggle_bit),
	KUNIT_CASE(sdo_segment_without_transfer_is_aborted),
	KUNIT_CASE(sdo_segments_must_make_up_announced_size),
	KUNIT_CASE(sdo_object_too_large_for_server_is_refused),
	KUNIT_CASE(sdo_object_larger_than_buffer_is_aborted),
	KUNIT_CASE(sdo_more_segments_than_announced_stop_at_buffer),
	KUNIT_CASE(sdo_fewer_bytes_than_announced_are_accepted),
	KUNIT_CASE(sdo_padding_behind_complete_object_is_dropped),
	KUNIT_CASE(sdo_segments_without_padding_are_understood),
	KUNIT_CASE(sdo_unused_count_of_long_segment_is_ignored),
	KUNIT_CASE(sdo_empty_segments_do_not_go_on_for_ever),
	KUNIT_CASE(sdo_expedited_data_without_size_fills_buffer),
	KUNIT_CASE(sdo_short_messages_are_refused_at_every_length),
	KUNIT_CASE(sdo_buffers_too_small_are_refused),
	KUNIT_CASE(sdo_message_can_be_sent_again),
	KUNIT_CASE(sdo_new_request_ends_old_transfer_in_server),
	KUNIT_CASE(sdo_server_refuses_unknown_commands),
	KUNIT_CASE(sdo_cancel),
	{}
};

static struct kunit_suite suite = { .name = "sdo", .init = sdo_init, .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
