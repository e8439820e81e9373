// SPDX-License-Identifier: GPL-2.0-only
/* FoE: messages and the master's side of a transfer. */
#include "wire_kunit.h"
#include "../../master/wire/foe.h"

#define CAP	16	/* ten bytes of data in a message */

static struct ec_foe write_of(u64 size)
{
	return (struct ec_foe){ .write = true, .name = "fw", .name_len = 2, .size = size };
}

static struct ec_foe read_of(void)
{
	return (struct ec_foe){ .name = "fw", .name_len = 2, .password = 0x12345678 };
}

/* a message of the slave: opcode, number, so many bytes */
static int slave(struct ec_foe *f, u8 opcode, u32 number, size_t n)
{
	u8 msg[EC_FOE_HDR + 32] = { opcode };

	put_unaligned_le32(number, msg + 2);
	memset(msg + EC_FOE_HDR, 'x', n);
	return ec_foe_rx(f, msg, EC_FOE_HDR + n, CAP - EC_FOE_HDR);
}

/* bytes typed from the table of the protocol */
static void foe_messages_match_protocol_table(struct kunit *test)
{
	struct ec_foe r = read_of(), w = write_of(3);
	u8 tx[CAP];

	KUNIT_EXPECT_EQ(test, ec_foe_tx(&r, tx, CAP), 8);
	KUNIT_EXPECT_MEMEQ(test, tx, "\1\0\x78\x56\x34\x12" "fw", 8);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, CAP), 8);
	KUNIT_EXPECT_MEMEQ(test, tx, "\2\0\0\0\0\0" "fw", 8);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&w, (const u8 *)"\4\0\0\0\0\0", 6, 0), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, CAP), 9);
	KUNIT_EXPECT_MEMEQ(test, tx, "\3\0\1\0\0\0", 6);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&w, (const u8 *)"\4\0\1\0\0\0", 6, 0), 0);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&r, (const u8 *)"\3\0\1\0\0\0abc", 9, 10), EC_MORE);
	KUNIT_EXPECT_TRUE(test, r.last);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&r, tx, CAP), 6);
	KUNIT_EXPECT_MEMEQ(test, tx, "\4\0\1\0\0\0", 6);
	KUNIT_EXPECT_EQ(test, ec_foe_error_encode(tx, CAP, EC_FOE_ERR_FULL, "no room, none"), 16);
	KUNIT_EXPECT_MEMEQ(test, tx, "\5\0\3\x80\0\0no room, n", 16);
}

static void foe_read_without_room_for_data_fails(struct kunit *test)
{
	struct ec_foe r = read_of();

	KUNIT_EXPECT_EQ(test, ec_foe_rx(&r, (const u8 *)"\3\0\1\0\0\0", 6, 0), -EBADMSG);
}

/* a multiple of the packet size ends with a packet without data */
static void foe_write_ends_with_short_packet(struct kunit *test)
{
	static const u64 sizes[] = { 0, 1, 9, 10, 11, 20, 35 };
	u8 tx[CAP];
	u32 i, n;

	for (i = 0; i < ARRAY_SIZE(sizes); i++) {
		struct ec_foe f = write_of(sizes[i]);
		u64 sent = 0;
		int ret;

		KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, CAP), 8);
		ret = slave(&f, EC_FOE_ACK, 0, 0);
		for (n = 1; ret == EC_MORE; n++) {
			KUNIT_ASSERT_EQ(test, ec_foe_tx(&f, tx, CAP), EC_FOE_HDR + f.n);
			KUNIT_EXPECT_EQ(test, f.at, sent);
			sent += f.n;
			ret = slave(&f, EC_FOE_ACK, n, 0);
		}
		KUNIT_EXPECT_EQ(test, ret, 0);
		KUNIT_EXPECT_EQ(test, sent, sizes[i]);
		KUNIT_EXPECT_EQ(test, n - 1, (u32)sizes[i] / 10 + 1);
	}
}

static void foe_busy_repeats_packet(struct kunit *test)
{
	struct ec_foe w = write_of(15), r = read_of();
	u8 tx[CAP], again[CAP];

	ec_foe_tx(&w, tx, CAP);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_BUSY, 0, 0), EC_WAIT);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 0, 0), EC_MORE);
	KUNIT_EXPECT_FALSE(test, w.busy);
	memset(tx, 0, CAP);
	memset(again, 0, CAP);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, CAP), 16);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_BUSY, 0x00640032, 0), EC_MORE);
	KUNIT_EXPECT_TRUE(test, w.busy);
	KUNIT_EXPECT_EQ(test, w.done, 50);
	KUNIT_EXPECT_EQ(test, w.entire, 100);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, again, CAP), 16);
	KUNIT_EXPECT_MEMEQ(test, tx, again, CAP);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 1, 0), EC_MORE);
	KUNIT_EXPECT_EQ(test, w.at, 10ull);
	/* a read repeats its acknowledgement */
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 1, 10), EC_MORE);
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_BUSY, 0, 0), EC_MORE);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&r, tx, CAP), 6);
	KUNIT_EXPECT_EQ(test, tx[0], EC_FOE_ACK);
	KUNIT_EXPECT_EQ(test, tx[2], 1);
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 2, 0), EC_MORE);
	KUNIT_EXPECT_TRUE(test, r.last);
	KUNIT_EXPECT_EQ(test, r.size, 10ull);
}

static void foe_late_packets_change_nothing(struct kunit *test)
{
	struct ec_foe w = write_of(25), r = read_of();
	u8 tx[CAP];

	ec_foe_tx(&w, tx, CAP);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 7, 0), EC_STALE);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_DATA, 1, 3), EC_STALE);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 0, 0), EC_MORE);
	ec_foe_tx(&w, tx, CAP);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 0, 0), EC_STALE);
	KUNIT_EXPECT_EQ(test, slave(&w, EC_FOE_ACK, 2, 0), EC_STALE);
	KUNIT_EXPECT_EQ(test, w.packet, 1u);
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 2, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 1, 10), EC_MORE);
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 1, 10), EC_STALE);
	KUNIT_EXPECT_EQ(test, r.size, 10ull);
	/* more than the mailbox of the slave holds */
	KUNIT_EXPECT_EQ(test, slave(&r, EC_FOE_DATA, 2, 11), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&r, (const u8 *)"\3\0\2\0\0", 5, 10), -EBADMSG);
}

static void foe_errors_have_code_and_printable_text(struct kunit *test)
{
	struct ec_foe f = write_of(1);
	u8 msg[EC_FOE_HDR + 200] = { EC_FOE_ERR, 0, 3, 0x80 };

	memset(msg + EC_FOE_HDR, 'a', 200);
	memcpy(msg + EC_FOE_HDR, "x\n\x1b[31m\xff", 8);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, msg, sizeof(msg), 10), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, f.error, (u32)EC_FOE_ERR_FULL);
	KUNIT_EXPECT_MEMEQ(test, f.text, "x??[31m?aaa", 11);
	KUNIT_EXPECT_EQ(test, strlen(f.text), sizeof(f.text) - 1);
	KUNIT_EXPECT_EQ(test, ec_foe_rx(&f, msg, EC_FOE_HDR, 10), -EREMOTEIO);
	KUNIT_EXPECT_EQ(test, strlen(f.text), (size_t)0);
	KUNIT_EXPECT_STREQ(test, ec_foe_error_text(0x8001), "file not found");
	/* as a dissector numbers them */
	KUNIT_EXPECT_STREQ(test, ec_foe_error_text(1), "file not found");
	KUNIT_EXPECT_NOT_NULL(test, ec_foe_error_text(0x800c));
	KUNIT_EXPECT_NULL(test, ec_foe_error_text(0x800d));
	KUNIT_EXPECT_NULL(test, ec_foe_error_text(0x18001));
}

static void foe_small_mailboxes_are_refused(struct kunit *test)
{
	struct ec_foe w = write_of(1), r = read_of();
	u8 tx[CAP];

	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, 7), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, 8), 8);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&r, tx, 5), -EMSGSIZE);
	slave(&w, EC_FOE_ACK, 0, 0);
	KUNIT_EXPECT_EQ(test, ec_foe_tx(&w, tx, 6), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_foe_error_encode(tx, 5, 0, "x"), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_foe_error_encode(tx, 6, 0, "x"), 6);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(foe_messages_match_protocol_table),
	KUNIT_CASE(foe_read_without_room_for_data_fails),
	KUNIT_CASE(foe_write_ends_with_short_packet),
	KUNIT_CASE(foe_busy_repeats_packet),
	KUNIT_CASE(foe_late_packets_change_nothing),
	KUNIT_CASE(foe_errors_have_code_and_printable_text),
	KUNIT_CASE(foe_small_mailboxes_are_refused),
	{}
};

static struct kunit_suite suite = { .name = "foe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
