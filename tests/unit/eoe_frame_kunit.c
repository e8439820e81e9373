// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/eoe_frame.h"

#define MAILBOX	128
#define ROOM	96	/* of a fragment in it */

static u8 frame[EC_EOE_FRAME_MAX], joined[EC_EOE_FRAME_MAX], wire[1600];

static void fill(void)
{
	for (unsigned int i = 0; i < sizeof(frame); i++)
		frame[i] = (u8)(i * 7 + (i >> 8));
	memset(joined, 0xee, sizeof(joined));
}

/* a fragment of @frame as it should be */
static struct ec_eoe_fragment part_of(u8 number, u16 units, u16 at, u16 len, bool last)
{
	return (struct ec_eoe_fragment){
		.number = number, .units = units, .data = frame + at, .len = len, .last = last,
	};
}

static int add(struct ec_eoe_part *p, u8 number, u16 units, u16 at, u16 len, bool last)
{
	struct ec_eoe_fragment f = part_of(number, units, at, len, last);

	return ec_eoe_part_add(p, joined, sizeof(joined), &f);
}

static void eoe_frame_header_has_each_field(struct kunit *test)
{
	struct ec_eoe_fragment out, f = {
		.port = 3, .number = 5, .frame = 9, .time_request = true, .units = 15,
		.data = (const u8 *)"0123456789abcdef0123456789abcdef", .len = 32,
	};

	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_encode(wire, 36, &f), 36);
	KUNIT_EXPECT_MEMEQ(test, wire, "\x30\x04\xc5\x93" "0123", 8);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_encode(wire, 35, &f), -EMSGSIZE);
	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(wire, 36, &out), 0);
	KUNIT_EXPECT_EQ(test, out.port, 3);
	KUNIT_EXPECT_EQ(test, out.number, 5);
	KUNIT_EXPECT_EQ(test, out.frame, 9);
	KUNIT_EXPECT_EQ(test, out.units, 15);
	KUNIT_EXPECT_TRUE(test, out.time_request);
	KUNIT_EXPECT_FALSE(test, out.last);
	KUNIT_EXPECT_EQ(test, out.len, 32);
	KUNIT_EXPECT_PTR_EQ(test, out.data, (const u8 *)wire + 4);
	f.last = true;
	ec_eoe_fragment_encode(wire, 36, &f);
	KUNIT_EXPECT_EQ(test, wire[1], 5);
	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(wire, 36, &out), 0);
	KUNIT_EXPECT_TRUE(test, out.last);
}

static void eoe_frame_other_messages_are_refused(struct kunit *test)
{
	struct ec_eoe_fragment f;

	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode((const u8 *)"\2\1\0\0", 4, &f), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode((const u8 *)"\1\1\0\0", 4, &f), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode((const u8 *)"\0\1\0", 3, &f), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode((const u8 *)"", 0, &f), -EBADMSG);
}

/* it counts only behind the last fragment */
static void eoe_frame_time_stamp_is_no_data(struct kunit *test)
{
	struct ec_eoe_fragment f;
	u8 msg[12] = { 0x00, 0x03, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8 };

	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(msg, 12, &f), 0);
	KUNIT_EXPECT_EQ(test, f.len, 4);
	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(msg, 8, &f), 0);
	KUNIT_EXPECT_EQ(test, f.len, 0);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_decode(msg, 7, &f), -EBADMSG);
	msg[1] = 0x02;
	KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(msg, 12, &f), 0);
	KUNIT_EXPECT_EQ(test, f.len, 8);
}

static void eoe_frame_room_depends_on_mailbox(struct kunit *test)
{
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(0), 0u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(9), 0u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(41), 0u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(42), 32u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(MAILBOX), (unsigned int)ROOM);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(1024), 992u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_room(1486), 1472u);
}

/* cut, written, read and joined: every length, each mailbox */
static void eoe_frame_survives_both_ways(struct kunit *test)
{
	static const u16 mailboxes[] = { 42, 48, MAILBOX, 256, 1024, 1486 };
	struct ec_eoe_fragment f = { .port = 2 }, in;
	struct ec_eoe_part p = { 0 };

	fill();
	for (u16 len = 1; len <= EC_EOE_FRAME_MAX; len++) {
		u16 mailbox = mailboxes[len % ARRAY_SIZE(mailboxes)], at = 0;
		u8 number = 0;
		int ret;

		f.frame = len % 16;
		do {
			unsigned int n = ec_eoe_fragment_cut(&f, frame, len, at, number++, mailbox);

			KUNIT_ASSERT_GT(test, n, 0u);
			at = (u16)(at + n);
			ret = ec_eoe_fragment_encode(wire, mailbox - 6u, &f);
			KUNIT_ASSERT_GT(test, ret, 0);
			KUNIT_ASSERT_EQ(test, ec_eoe_fragment_decode(wire, (size_t)ret, &in), 0);
			ret = ec_eoe_part_add(&p, joined, len, &in);
			KUNIT_ASSERT_EQ(test, ret, at == len ? len : 0);
		} while (!ret);
		KUNIT_EXPECT_EQ(test, p.port, 2);
		KUNIT_EXPECT_FALSE(test, p.open);
		KUNIT_ASSERT_FALSE(test, memcmp(joined, frame, len));
	}
}

/* all but the last one are whole units, the last one may fill the mailbox */
static void eoe_frame_cut_keeps_rules(struct kunit *test)
{
	struct ec_eoe_fragment f = { 0 };

	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 200, 0, 0, MAILBOX), (u32)ROOM);
	KUNIT_EXPECT_EQ(test, f.units, 7);	/* 200 / 32, rounded up */
	KUNIT_EXPECT_FALSE(test, f.last);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 200, ROOM, 1, MAILBOX), 104u);
	KUNIT_EXPECT_EQ(test, f.units, ROOM / 32);
	KUNIT_EXPECT_TRUE(test, f.last);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, MAILBOX - 10, 0, 0, MAILBOX),
			MAILBOX - 10u);
	KUNIT_EXPECT_TRUE(test, f.last);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, MAILBOX - 9, 0, 0, MAILBOX),
			(u32)ROOM);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 200, 200, 2, MAILBOX), 0u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 200, 0, 0, 41), 0u);
	KUNIT_EXPECT_EQ(test, ec_eoe_fragment_cut(&f, frame, 2017, 0, 0, MAILBOX), 0u);
}

static void eoe_frame_port_is_that_of_last_fragment(struct kunit *test)
{
	struct ec_eoe_fragment f = part_of(0, 2, 0, 32, false);
	struct ec_eoe_part p = { 0 };

	fill();
	f.port = 1;
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, joined, sizeof(joined), &f), 0);
	f = part_of(1, 1, 32, 30, true);
	f.port = 4;
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, joined, sizeof(joined), &f), 62);
	KUNIT_EXPECT_EQ(test, p.port, 4);
}

/* each is refused, and what follows it as well, until a fragment 0 */
static void eoe_frame_wrong_fragment_drops_frame(struct kunit *test)
{
	static const struct {
		u8 number;
		u16 units;
		u16 len;
		bool last;
		u8 frame;
	} wrong[] = {
		{ 2, 1, 32, false, 0 },		/* gap */
		{ 1, 2, 32, false, 0 },		/* offset */
		{ 1, 0, 32, false, 0 },
		{ 1, 1, 32, false, 1 },		/* another frame */
		{ 1, 1, 31, false, 0 },		/* no whole units */
		{ 1, 1, 0, false, 0 },		/* nothing */
		{ 1, 1, 96, false, 0 },		/* longer than announced */
		{ 1, 1, 65, true, 0 },
	};
	struct ec_eoe_part p = { 0 };

	fill();
	KUNIT_EXPECT_EQ(test, add(&p, 1, 0, 0, 32, false), -EBADMSG);
	KUNIT_EXPECT_EQ(test, add(&p, 1, 0, 0, 32, true), -EBADMSG);
	for (unsigned int i = 0; i < ARRAY_SIZE(wrong); i++) {
		struct ec_eoe_fragment f = part_of(wrong[i].number, wrong[i].units, 32,
						   wrong[i].len, wrong[i].last);

		f.frame = wrong[i].frame;
		KUNIT_EXPECT_EQ(test, add(&p, 0, 3, 0, 32, false), 0);
		KUNIT_EXPECT_TRUE(test, p.open);
		KUNIT_EXPECT_EQ_MSG(test, ec_eoe_part_add(&p, joined, sizeof(joined), &f),
				    -EBADMSG, "case %u", i);
		KUNIT_EXPECT_FALSE(test, p.open);
		KUNIT_EXPECT_EQ(test, add(&p, 1, 1, 32, 64, true), -EBADMSG);
	}
	KUNIT_EXPECT_EQ(test, add(&p, 0, 3, 0, 32, false), 0);
	KUNIT_EXPECT_EQ(test, add(&p, 1, 1, 32, 64, true), 96);
}

static void eoe_frame_size_has_limits(struct kunit *test)
{
	struct ec_eoe_fragment f = part_of(0, 63, 0, 1472, false);
	struct ec_eoe_part p = { 0 };

	fill();
	KUNIT_EXPECT_EQ(test, add(&p, 0, 0, 0, 60, true), -EBADMSG);
	KUNIT_EXPECT_EQ(test, add(&p, 0, 1, 0, 33, true), -EBADMSG);
	KUNIT_EXPECT_EQ(test, add(&p, 0, 1, 0, 0, true), -EBADMSG);
	KUNIT_EXPECT_FALSE(test, p.open);
	/* the announced size is an upper limit */
	KUNIT_EXPECT_EQ(test, add(&p, 0, 48, 0, 60, true), 60);
	/* so is the caller's memory */
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, joined, 1471, &f), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_eoe_part_add(&p, joined, 1472, &f), 0);
	KUNIT_EXPECT_EQ(test, add(&p, 1, 46, 0, 1, true), -EBADMSG);
}

static void eoe_frame_fragment_0_begins_frame(struct kunit *test)
{
	struct ec_eoe_part p = { 0 };

	fill();
	KUNIT_EXPECT_EQ(test, add(&p, 0, 3, 0, 64, false), 0);
	KUNIT_EXPECT_EQ(test, add(&p, 0, 3, 32, 32, false), 0);
	KUNIT_EXPECT_EQ(test, add(&p, 1, 1, 64, 40, true), 72);
	KUNIT_EXPECT_MEMEQ(test, joined, frame + 32, 72);
}

/* What follows two MAC addresses, in memory of exactly @len bytes. */
static bool is_ethercat(struct kunit *test, const char *bytes, size_t len)
{
	u8 *f = kunit_kzalloc(test, 12 + len, GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, f);
	memcpy(f + 12, bytes, len);
	return ec_eoe_is_ethercat(f, 12 + len);
}

#define IP(first, proto)	"\x08\0" first "\0\0\x2e\0\0\0\0\x40" proto "\0\0\x0a\1\0\2\xff\xff\xff\xff"
#define UDP(port)		"\1\2" port "\0\x1a\0\0"

static void eoe_frame_ethercat_is_recognized(struct kunit *test)
{
	static const char udp[] = IP("\x45", "\x11") UDP("\x88\xa4") "\x0e\x10";
	static const char tagged[] = "\x88\xa8\0\5\x81\0\0\7"
				     IP("\x45", "\x11") UDP("\x88\xa4") "\x0e\x10";
	static const char options[] = IP("\x46", "\x11") UDP("\x88\xa4") "\x0e\x10";
	static const char tcp[] = IP("\x45", "\x06") UDP("\x88\xa4") "\x0e\x10";
	static const char dns[] = IP("\x45", "\x11") UDP("\0\x35") "\x0e\x10";
	/* a mailbox gateway's */
	static const char mailbox[] = IP("\x45", "\x11") UDP("\x88\xa4") "\x0e\x50";
	size_t len;

	KUNIT_EXPECT_TRUE(test, is_ethercat(test, "\x88\xa4", 2));
	KUNIT_EXPECT_TRUE(test, is_ethercat(test, "\x81\0\0\5\x88\xa4", 6));
	KUNIT_EXPECT_TRUE(test, is_ethercat(test, "\x88\xa8\0\5\x81\0\0\7\x88\xa4", 10));
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, "\x88\xa5", 2));
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, "\x08\6\x88\xa4", 4));
	KUNIT_EXPECT_TRUE(test, is_ethercat(test, udp, sizeof(udp) - 1));
	for (len = 0; len < sizeof(udp) - 1; len++)
		KUNIT_EXPECT_FALSE_MSG(test, is_ethercat(test, udp, len), "%zu", len);
	KUNIT_EXPECT_TRUE(test, is_ethercat(test, tagged, sizeof(tagged) - 1));
	/* slaves take none of these */
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, options, sizeof(options) - 1));
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, tcp, sizeof(tcp) - 1));
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, dns, sizeof(dns) - 1));
	KUNIT_EXPECT_FALSE(test, is_ethercat(test, mailbox, sizeof(mailbox) - 1));
	KUNIT_EXPECT_FALSE(test, ec_eoe_is_ethercat(frame, 0));
}

static struct kunit_case cases[] = {
	KUNIT_CASE(eoe_frame_header_has_each_field),
	KUNIT_CASE(eoe_frame_other_messages_are_refused),
	KUNIT_CASE(eoe_frame_time_stamp_is_no_data),
	KUNIT_CASE(eoe_frame_room_depends_on_mailbox),
	KUNIT_CASE(eoe_frame_survives_both_ways),
	KUNIT_CASE(eoe_frame_cut_keeps_rules),
	KUNIT_CASE(eoe_frame_port_is_that_of_last_fragment),
	KUNIT_CASE(eoe_frame_wrong_fragment_drops_frame),
	KUNIT_CASE(eoe_frame_size_has_limits),
	KUNIT_CASE(eoe_frame_fragment_0_begins_frame),
	KUNIT_CASE(eoe_frame_ethercat_is_recognized),
	{ }
};

static struct kunit_suite suite = { .name = "eoe_frame", .test_cases = cases };
kunit_test_suite(suite);
