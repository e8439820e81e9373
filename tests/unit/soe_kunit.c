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

static void soe_request_must_fit_into_one_message(struct kunit *test)
{
	u8 value[4] = { 1, 2, 3, 4 }, tx[8];
	struct ec_soe_access w = {
		.write = true, .element = EC_SOE_VALUE, .idn = 1, .data = value, .size = 4,
	};
	struct ec_soe_access r = { .element = EC_SOE_VALUE, .idn = 1, .error = 5 };

	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 8), 8);
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 7), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&r, tx, 4), 4);
	KUNIT_EXPECT_EQ(test, r.error, 0);
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&r, tx, 3), -EMSGSIZE);
	w.size = 0;
	KUNIT_EXPECT_EQ(test, ec_soe_tx(&w, tx, 4), 4);
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
		{ { 0x2a, 0x40, 0x01, 0, 1, 2 }, 6, -EMSGSIZE },
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
			.drive = 1, .element = EC_SOE_VALUE, .idn = 91, .data = value, .cap = 4,
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
		.element = EC_SOE_VALUE, .idn = 91, .data = value, .cap = 3,
	};

	KUNIT_EXPECT_EQ(test, ec_soe_rx(&a, msg, sizeof(msg)), -ENOBUFS);
	KUNIT_EXPECT_EQ(test, value[0], 9);
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
	KUNIT_CASE(soe_request_must_fit_into_one_message),
	KUNIT_CASE(soe_answers),
	KUNIT_CASE(soe_value_larger_than_buffer_is_refused),
	KUNIT_CASE(soe_every_error_code_of_table_has_text),
	KUNIT_CASE(soe_voe_header_survives_both_ways),
	{}
};

static struct kunit_suite suite = { .name = "soe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
