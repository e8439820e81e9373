// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "../../master/wire/soe.h"
#include "../../master/wire/voe.h"

static void soe_header_survives_both_ways(struct kunit *test)
{
	struct ec_soe_hdr out, in = { .error = true, .drive = 7, .elements = 0x44, .idn = 0x8096 };
	u8 msg[EC_SOE_HDR];
	u8 op;

	for (op = 1; op <= 6; op++) {
		struct ec_wbuf w = ec_wbuf(msg, sizeof(msg));
		struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));

		in.opcode = op;
		in.incomplete = op & 1;
		ec_soe_hdr_encode(&w, &in);
		KUNIT_ASSERT_EQ(test, ec_soe_hdr_decode(&r, &out), 0);
		KUNIT_EXPECT_EQ(test, out.opcode, op);
		KUNIT_EXPECT_EQ(test, out.incomplete, in.incomplete);
		KUNIT_EXPECT_TRUE(test, out.error);
		KUNIT_EXPECT_EQ(test, out.drive, 7);
		KUNIT_EXPECT_EQ(test, out.elements, 0x44);
		KUNIT_EXPECT_EQ(test, out.idn, 0x8096);
		r = ec_rbuf(msg, 3);
		KUNIT_EXPECT_EQ(test, ec_soe_hdr_decode(&r, &out), -EMSGSIZE);
	}
}

static void soe_request_larger_than_message_is_cut(struct kunit *test)
{
	static const u8 parts[3][7] = {
		{ 0x2b, 0x40, 2, 0, 1, 2, 3 }, { 0x2b, 0x40, 1, 0, 4, 5, 6 },
		{ 0x23, 0x40, 0x5b, 0, 7 },
	};
	u8 value[7] = { 1, 2, 3, 4, 5, 6, 7 }, tx[8];
	struct ec_soe_access w = {
		.write = true, .drive = 1, .elements = EC_SOE_VALUE, .idn = 91, .data = value,
		.size = 7,
	};
	struct ec_soe_access r = { .elements = EC_SOE_VALUE, .idn = 1, .error = 5 };
	u32 i;

	for (i = 0; i < 3; i++) {
		KUNIT_ASSERT_EQ(test, ec_soe_tx(&w, tx, 7), i < 2 ? 7 : 5);
		KUNIT_EXPECT_MEMEQ(test, tx, parts[i], i < 2 ? 7 : 5);
		KUNIT_EXPECT_EQ(test, ec_soe_awaits(&w), i == 2);
	}
	w = (struct ec_soe_access){ .write = true, .data = value, .size = 4 };
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 8), 8);
	KUNIT_EXPECT_TRUE(test, ec_soe_awaits(&w));
	/* no byte of it fits, or too many fragments would be needed */
	w.at = 0;
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 4), -EMSGSIZE);
	w.size = 0x10001;
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 5), -EMSGSIZE);
	w.size = 0;
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 4), 4);
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&r, tx, 4), 4);
	KUNIT_EXPECT_EQ(test, r.error, 0);
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&r, tx, 3), -EMSGSIZE);
}

/* what may come while the answer to reading S-0-0091 of drive 1 is awaited */
static void soe_answers(struct kunit *test)
{
	static const struct {
		u8 msg[8];
		u8 len;
		int ret;
	} in[] = {
		{ { 0x22, 0x40, 0x5b, 0, 1, 2 }, 6, 0 },
		{ { 0x22, 0x40, 0x5b, 0 }, 4, 0 },
		{ { 0x22, 0x40, 0x5b, 0, 1, 2, 3, 4 }, 8, 0 },
		{ { 0x42, 0x40, 0x5b, 0, 1, 2 }, 6, EC_STALE },	/* drive */
		{ { 0x22, 0x40, 0x5c, 0, 1, 2 }, 6, EC_STALE },	/* IDN */
		{ { 0x22, 0x04, 0x5b, 0, 1, 2 }, 6, EC_STALE },	/* element */
		{ { 0x24, 0x40, 0x5b, 0, 1, 2 }, 6, EC_STALE },	/* write response */
		{ { 0x25, 0x40, 0x5b, 0, 1, 2 }, 6, EC_STALE },	/* notification */
		{ { 0x2a, 0x40, 0x01, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x2a, 0x40, 0x01, 0 }, 4, EC_STALE },		/* no data in it */
		{ { 0x2a, 0x40, 0x00, 0, 1 }, 5, EC_STALE },		/* none behind it */
		{ { 0x2a, 0x04, 0x01, 0, 1 }, 5, EC_STALE },		/* element */
		{ { 0x3a, 0x40, 0x01, 0, 1, 0x10 }, 6, -EIO },
		{ { 0x32, 0x40, 0x5b, 0, 1, 0x10 }, 6, -EIO },
		{ { 0x32, 0x40, 0x5b, 0, 9, 9, 1, 0x10 }, 8, -EIO },
		{ { 0x32, 0x40, 0x5b, 0, 1 }, 5, -EBADMSG },
		{ { 0x22, 0x40, 0x5b }, 3, -EBADMSG },
		{ { 0 }, 0, -EBADMSG },
	};
	u8 value[4];
	size_t i;

	for (i = 0; i < ARRAY_SIZE(in); i++) {
		struct ec_soe_access a = {
			.drive = 1, .elements = EC_SOE_VALUE, .idn = 91, .data = value, .cap = 4,
		};

		KUNIT_EXPECT_EQ_MSG(test, ec_soe_rx(&a, in[i].msg, in[i].len), in[i].ret, "%zu", i);
		if (!in[i].ret) {
			KUNIT_EXPECT_EQ(test, a.size, (size_t)in[i].len - 4);
			KUNIT_EXPECT_MEMEQ(test, value, in[i].msg + 4, a.size);
		}
		KUNIT_EXPECT_EQ(test, a.error, in[i].ret == -EIO ? 0x1001 : 0);
	}
}

static void soe_value_larger_than_buffer_is_refused(struct kunit *test)
{
	static const u8 msg[] = { 0x02, 0x40, 0x5b, 0, 1, 2, 3, 4 };
	u8 value[4] = { 9, 9, 9, 9 };
	struct ec_soe_access a = {
		.elements = EC_SOE_VALUE, .idn = 91, .data = value, .cap = 3,
	};

	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, msg, sizeof(msg)), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, value[0], 9);
}

/* Messages that answer reading S-0-0091 of drive 1 into 8 bytes. */
struct message {
	u8 msg[8];
	u8 len;
	int ret;
};

static int feed(struct kunit *test, struct ec_soe_access *a, const struct message *in, u32 n)
{
	int ret = 0;
	u32 i;

	for (i = 0; i < n; i++) {
		ret = ec_soe_rx(a, in[i].msg, in[i].len);
		KUNIT_EXPECT_EQ_MSG(test, ret, in[i].ret, "message %u", i);
	}
	return ret;
}

#define ANSWER(name)							\
	u8 value[8];							\
	struct ec_soe_access name = {					\
		.drive = 1, .elements = EC_SOE_VALUE, .idn = 91, .data = value, .cap = 8, \
	}

static void soe_fragments_of_answer_are_joined(struct kunit *test)
{
	static const struct message in[] = {
		{ { 0x2a, 0x40, 2, 0, 1, 2, 3 }, 7, EC_WAIT },
		{ { 0x25, 0x01, 0x94, 0, 7, 0 }, 6, EC_STALE },	/* a notification between them */
		{ { 0x2a, 0x40, 1, 0, 4, 5, 6 }, 7, EC_WAIT },
		{ { 0x22, 0x40, 0x5b, 0, 7, 8 }, 6, 0 },
	};
	ANSWER(a);

	KUNIT_ASSERT_EQ(test, feed(test, &a, in, ARRAY_SIZE(in)), 0);
	KUNIT_EXPECT_EQ(test, a.size, (size_t)8);
	KUNIT_EXPECT_MEMEQ(test, value, "\1\2\3\4\5\6\7\10", 8);
}

/* The rest is awaited, so that it is not taken for the next answer. */
static void soe_fragments_that_miscount_are_refused(struct kunit *test)
{
	static const struct message same[] = {
		{ { 0x2a, 0x40, 2, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x2a, 0x40, 2, 0, 3, 4 }, 6, EC_STALE },
		{ { 0x2a, 0x40, 1, 0, 5, 6 }, 6, EC_STALE },
		{ { 0x22, 0x40, 0x5b, 0, 7, 8 }, 6, -EPROTO },
	};
	static const struct message early[] = {
		{ { 0x2a, 0x40, 2, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x22, 0x40, 0x5b, 0, 7, 8 }, 6, -EPROTO },
	};
	static const struct message late[] = {
		{ { 0x2a, 0x40, 1, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x2a, 0x40, 1, 0, 3, 4 }, 6, EC_STALE },
		{ { 0x22, 0x40, 0x5b, 0, 7, 8 }, 6, -EPROTO },
	};
	static const struct message empty[] = {
		{ { 0x2a, 0x40, 1, 0 }, 4, EC_STALE },
		{ { 0x22, 0x40, 0x5b, 0, 7, 8 }, 6, -EBADMSG },
	};
	ANSWER(a);
	const struct ec_soe_access fresh = a;

	feed(test, &a, same, ARRAY_SIZE(same));
	a = fresh;
	feed(test, &a, early, ARRAY_SIZE(early));
	a = fresh;
	feed(test, &a, late, ARRAY_SIZE(late));
	a = fresh;
	feed(test, &a, empty, ARRAY_SIZE(empty));
}

static void soe_fragments_larger_than_buffer_are_refused(struct kunit *test)
{
	static const struct message in[] = {
		{ { 0x2a, 0x40, 3, 0, 1, 2, 3, 4 }, 8, EC_WAIT },
		{ { 0x2a, 0x40, 2, 0, 5, 6, 7 }, 7, EC_WAIT },
		{ { 0x2a, 0x40, 1, 0, 8, 9, 10 }, 7, EC_STALE },
		{ { 0x22, 0x40, 0x5b, 0, 1 }, 5, -ENOBUFS },
	};
	ANSWER(a);

	value[7] = 99;
	feed(test, &a, in, ARRAY_SIZE(in));
	KUNIT_EXPECT_EQ(test, value[7], 99);
}

static void soe_error_amid_fragments_ends_them(struct kunit *test)
{
	static const struct message in[] = {
		{ { 0x2a, 0x40, 3, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x32, 0x40, 0x5b, 0, 0x0b, 0x70 }, 6, -EIO },
	};
	static const u8 early[] = { 0x3c, 0x40, 1, 0, 3, 0x70 };
	u8 tx[8], data[8] = { 0 };
	struct ec_soe_access w = {
		.write = true, .drive = 1, .elements = EC_SOE_VALUE, .idn = 91, .data = data,
		.size = 8,
	};
	ANSWER(a);

	feed(test, &a, in, ARRAY_SIZE(in));
	KUNIT_EXPECT_EQ(test, a.error, 0x700b);
	/* of a write the slave does not know the IDN before the last fragment */
	KUNIT_ASSERT_EQ(test, ec_soe_tx(&w, tx, 8), 8);
	KUNIT_EXPECT_EQ(test, ec_soe_rx(&w, early, sizeof(early)), -EIO);
	KUNIT_EXPECT_EQ(test, w.error, 0x7003);
}

/* What an access that was ended early has left: its last fragment has another IDN. */
static void soe_fragments_of_another_answer_are_dropped(struct kunit *test)
{
	static const struct message in[] = {
		{ { 0x2a, 0x40, 1, 0, 9, 9 }, 6, EC_WAIT },
		{ { 0x22, 0x40, 0x11, 0, 9, 9 }, 6, EC_STALE },
		{ { 0x4a, 0x40, 1, 0, 9, 9 }, 6, EC_STALE },	/* another drive */
		{ { 0x2a, 0x40, 1, 0, 1, 2 }, 6, EC_WAIT },
		{ { 0x22, 0x40, 0x5b, 0, 3 }, 5, 0 },
	};
	ANSWER(a);

	KUNIT_ASSERT_EQ(test, feed(test, &a, in, ARRAY_SIZE(in)), 0);
	KUNIT_EXPECT_EQ(test, a.size, (size_t)3);
	KUNIT_EXPECT_MEMEQ(test, value, "\1\2\3", 3);
}

static void soe_command_states_have_text(struct kunit *test)
{
	static const struct {
		u16 state;
		const char *text;
	} in[] = {
		{ 0, "not set" }, { 3, "executed" }, { 5, "interrupted" }, { 7, "in process" },
		{ 0xf, "error" }, { 8, "error" }, { 0x103, "executed" },
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(in); i++)
		KUNIT_EXPECT_STREQ(test, ec_soe_command_text(in[i].state), in[i].text);
}

static void soe_every_error_code_of_table_has_text(struct kunit *test)
{
	static const u16 known[] = {
		0x1001, 0x1009, 0x2001, 0x2002, 0x2003, 0x2004, 0x2005, 0x3002, 0x3003, 0x3004,
		0x3005, 0x4001, 0x4002, 0x4003, 0x4004, 0x4005, 0x5001, 0x5002, 0x5003, 0x5004,
		0x5005, 0x6001, 0x6002, 0x6003, 0x6004, 0x6005, 0x7002, 0x7003, 0x7004, 0x7005,
		0x7006, 0x7007, 0x7008, 0x7009, 0x700A, 0x700B, 0x700C, 0x7010, 0x7011, 0x7012,
		0x7013, 0x7014, 0x8001, 0x8002, 0x8004, 0x800A, 0x800B, 0x800C,
	};
	unsigned int n = 0;
	size_t i;
	u32 code;

	for (i = 0; i < ARRAY_SIZE(known); i++)
		KUNIT_EXPECT_NOT_NULL_MSG(test, ec_soe_error_text(known[i]), "0x%04x", known[i]);
	for (code = 0; code < 0x10000; code++)
		n += !!ec_soe_error_text((u16)code);
	KUNIT_EXPECT_EQ(test, n, (unsigned int)ARRAY_SIZE(known));
}

static void soe_voe_header_survives_both_ways(struct kunit *test)
{
	struct ec_voe_hdr out, in = { .vendor = 0x12345678, .type = 0xabcd };
	u8 msg[EC_VOE_HDR + 2] = { 0 };
	struct ec_wbuf w = ec_wbuf(msg, sizeof(msg));
	struct ec_rbuf r = ec_rbuf(msg, sizeof(msg));

	ec_voe_hdr_encode(&w, &in);
	KUNIT_ASSERT_EQ(test, ec_voe_hdr_decode(&r, &out), 0);
	KUNIT_EXPECT_EQ(test, out.vendor, in.vendor);
	KUNIT_EXPECT_EQ(test, out.type, in.type);
	KUNIT_EXPECT_EQ(test, ec_rbuf_left(&r), (size_t)2);
	r = ec_rbuf(msg, 5);
	KUNIT_EXPECT_EQ(test, ec_voe_hdr_decode(&r, &out), -EMSGSIZE);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(soe_header_survives_both_ways),
	KUNIT_CASE(soe_request_larger_than_message_is_cut),
	KUNIT_CASE(soe_answers),
	KUNIT_CASE(soe_value_larger_than_buffer_is_refused),
	KUNIT_CASE(soe_fragments_of_answer_are_joined),
	KUNIT_CASE(soe_fragments_that_miscount_are_refused),
	KUNIT_CASE(soe_fragments_larger_than_buffer_are_refused),
	KUNIT_CASE(soe_error_amid_fragments_ends_them),
	KUNIT_CASE(soe_fragments_of_another_answer_are_dropped),
	KUNIT_CASE(soe_command_states_have_text),
	KUNIT_CASE(soe_every_error_code_of_table_has_text),
	KUNIT_CASE(soe_voe_header_survives_both_ways),
	{}
};

static struct kunit_suite suite = { .name = "soe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
