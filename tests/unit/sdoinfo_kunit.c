// SPDX-License-Identifier: GPL-2.0-only
#include "wire_kunit.h"
#include "od_list.h"
#include "../../devices/sim/sdoinfo_server.h"

static u8 tx[1500], body[4096], got[4096];
static u16 list[1000];

/* Sends @resp through mailboxes of @mbox bytes; the last result of rx. */
static int transfer(struct ec_sdoinfo *s, struct ec_sdoinfo_resp *resp, size_t mbox)
{
	int ret = -EPIPE, len;

	while ((len = ec_sdoinfo_resp_next(resp, tx, mbox)) > 0) {
		ret = ec_sdoinfo_rx(s, tx, (size_t)len);
		if (ret != EC_WAIT)
			return ret;
	}
	return len ? len : ret;
}

/* the body of a list answer */
static int put_list(const u16 *index, size_t n)
{
	struct ec_wbuf w = ec_wbuf(body, sizeof(body));
	size_t i;

	ec_wbuf_le16(&w, EC_SDOINFO_ALL);
	for (i = 0; i < n; i++)
		ec_wbuf_le16(&w, index[i]);
	return w.bad ? -ENOBUFS : (int)(w.p - body);
}

static void sdoinfo_lists_come_in_as_many_fragments_as_needed(struct kunit *test)
{
	static const size_t mboxes[] = { 10, 11, 24, 58, 122, 250, 1480 };
	static const size_t counts[] = { 0, 1, 2, 8, 57, 1000 };
	struct ec_sdoinfo s;
	struct ec_sdoinfo_resp resp;
	size_t i, j, k;
	int len;

	for (k = 0; k < ARRAY_SIZE(list); k++)
		list[k] = (u16)(0x1000 + k * 7);
	for (i = 0; i < ARRAY_SIZE(mboxes); i++) {
		for (j = 0; j < ARRAY_SIZE(counts); j++) {
			len = put_list(list, counts[j]);
			KUNIT_ASSERT_EQ(test, len, (int)(2 + 2 * counts[j]));
			ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got,
					sizeof(got));
			KUNIT_ASSERT_EQ(test, ec_sdoinfo_tx(&s, tx, sizeof(tx)), 8);
			ec_sdoinfo_resp_init(&resp, EC_SDOINFO_LIST_RESP, body, (size_t)len);
			KUNIT_ASSERT_EQ(test, transfer(&s, &resp, mboxes[i]), 0);
			KUNIT_ASSERT_EQ(test, od_list_count(&s), counts[j]);
			for (k = 0; k < counts[j]; k++)
				KUNIT_ASSERT_EQ(test, od_list_get(&s, k), list[k]);
			KUNIT_ASSERT_EQ(test, od_list_get(&s, k), 0);
		}
	}
}

static void sdoinfo_object_description_survives_both_ways(struct kunit *test)
{
	struct ec_od_object in = { 0x1018, 0x0023, 4, EC_OD_RECORD, "Identity", 8 }, out;
	struct ec_sdoinfo s;
	struct ec_sdoinfo_resp resp;
	int len = ec_od_object_encode(body, sizeof(body), &in);

	KUNIT_ASSERT_EQ(test, len, 14);
	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, got, sizeof(got));
	ec_sdoinfo_resp_init(&resp, EC_SDOINFO_OBJECT_RESP, body, (size_t)len);
	KUNIT_ASSERT_EQ(test, transfer(&s, &resp, 10), 0);
	KUNIT_ASSERT_EQ(test, s.size, (size_t)14);
	KUNIT_ASSERT_EQ(test, ec_od_object_decode(got, s.size, &out), 0);
	KUNIT_EXPECT_EQ(test, out.index, 0x1018);
	KUNIT_EXPECT_EQ(test, out.type, 0x0023);
	KUNIT_EXPECT_EQ(test, out.max_sub, 4);
	KUNIT_EXPECT_EQ(test, out.code, EC_OD_RECORD);
	KUNIT_ASSERT_EQ(test, out.name_len, (size_t)8);
	KUNIT_EXPECT_MEMEQ(test, out.name, "Identity", 8);
	KUNIT_EXPECT_EQ(test, ec_od_object_encode(body, 13, &in), -ENOBUFS);
}

static void sdoinfo_entry_description_survives_both_ways(struct kunit *test)
{
	struct ec_od_entry in = { 0x1018, 1, 0x7F, 0x0007, 32, EC_OD_READ, "Vendor ID", 9 }, out;
	struct ec_sdoinfo s;
	struct ec_sdoinfo_resp resp;
	int len = ec_od_entry_encode(body, sizeof(body), &in, NULL);

	KUNIT_ASSERT_EQ(test, len, 19);
	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_tx(&s, tx, sizeof(tx)), 10);
	ec_sdoinfo_resp_init(&resp, EC_SDOINFO_ENTRY_RESP, body, (size_t)len);
	KUNIT_ASSERT_EQ(test, transfer(&s, &resp, 12), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(got, s.size, &out), 0);
	KUNIT_EXPECT_EQ(test, out.index, 0x1018);
	KUNIT_EXPECT_EQ(test, out.sub, 1);
	KUNIT_EXPECT_EQ(test, out.info, 0x07);
	KUNIT_EXPECT_EQ(test, out.type, 7);
	KUNIT_EXPECT_EQ(test, out.bits, 32);
	KUNIT_EXPECT_EQ(test, out.access, 7);
	KUNIT_ASSERT_EQ(test, out.name_len, (size_t)9);
	KUNIT_EXPECT_MEMEQ(test, out.name, "Vendor ID", 9);
}

static void sdoinfo_optional_fields_of_entry_are_skipped(struct kunit *test)
{
	u8 in[] = {
		0x00, 0x20, 0x01, 0x70, 0x06, 0x00, 0x10, 0x00, 0x3F, 0x00,
		1, 0, 2, 0, 3, 0,		/* default, minimum, maximum */
		'N', 'a', 0,
	};
	struct ec_od_entry e;

	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(in, sizeof(in), &e), 0);
	KUNIT_ASSERT_EQ(test, e.name_len, (size_t)2);
	KUNIT_EXPECT_MEMEQ(test, e.name, "Na", 2);
	in[6] = 0xFF;	/* values larger than the message */
	in[7] = 0xFF;
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(in, sizeof(in), &e), 0);
	KUNIT_EXPECT_EQ(test, e.name_len, (size_t)0);
}

/* unit of @unit_size bytes and all values of @bits: what comes back */
static void values_both_ways(struct kunit *test, u8 unit_size, u16 bits)
{
	static const u8 def[8] = { 1, 2, 3, 4 }, min[8] = { 5, 6 }, max[8] = { 7, 8, 9, 10, 11 };
	struct ec_od_entry e = { 0x2000, 1, 0, 6, bits, EC_OD_READ, "Name", 4 };
	struct ec_od_values in = {
		.info = EC_OD_INFO_VALUES, .unit_size = unit_size, .unit = 0xB503,
		.size = DIV_ROUND_UP(bits, 8), .def = def, .min = min, .max = max,
	}, out;
	int plain = ec_od_entry_encode(body, sizeof(body), &e, NULL);
	int len = ec_od_entry_encode(body, sizeof(body), &e, &in);

	KUNIT_ASSERT_EQ(test, plain, 14);
	KUNIT_ASSERT_EQ(test, len, plain + unit_size + 3 * (int)in.size);
	KUNIT_ASSERT_EQ(test, ec_od_values_decode(body, (size_t)len, (size_t)plain, &out), 0);
	KUNIT_EXPECT_EQ(test, out.info, EC_OD_INFO_VALUES);
	KUNIT_EXPECT_EQ(test, out.unit_size, unit_size);
	KUNIT_EXPECT_EQ(test, out.unit, 0xB503u);
	KUNIT_ASSERT_EQ(test, out.size, in.size);
	KUNIT_EXPECT_MEMEQ(test, out.def, def, in.size);
	KUNIT_EXPECT_MEMEQ(test, out.min, min, in.size);
	KUNIT_EXPECT_MEMEQ(test, out.max, max, in.size);
	/* neither a byte more nor one less */
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(body, (size_t)len + 1, (size_t)plain, &out),
			-EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(body, (size_t)len - 1, (size_t)plain, &out),
			-EBADMSG);
	KUNIT_EXPECT_EQ(test, out.info, 0);
}

static void sdoinfo_values_survive_both_ways(struct kunit *test)
{
	static const u16 bits[] = { 1, 8, 12, 16, 32, 64 };
	size_t i;

	for (i = 0; i < ARRAY_SIZE(bits); i++) {
		values_both_ways(test, 2, bits[i]);
		values_both_ways(test, 4, bits[i]);
	}
}

static void sdoinfo_values_of_inconsistent_size_are_refused(struct kunit *test)
{
	/* only a maximum; the name has 2 characters */
	u8 in[] = {
		0x00, 0x20, 0x01, 0x40, 0x06, 0x00, 0x10, 0x00, 0x3F, 0x00, 7, 8, 'N', 'a',
	};
	struct ec_od_values v;

	KUNIT_ASSERT_EQ(test, ec_od_values_decode(in, sizeof(in), 12, &v), 0);
	KUNIT_EXPECT_EQ(test, v.info, EC_OD_INFO_MAX);
	KUNIT_EXPECT_NULL(test, v.def);
	KUNIT_EXPECT_NULL(test, v.min);
	KUNIT_EXPECT_PTR_EQ(test, v.max, &in[10]);
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, 9, 12, &v), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 9, &v), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 15, &v), -EBADMSG);
	in[3] = 0x48;	/* unit without place for it */
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 12, &v), -EBADMSG);
	in[3] = 0x00;	/* the bytes are announced by no bit */
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 12, &v), -EBADMSG);
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 14, &v), 0);
	in[3] = 0x70;
	in[6] = 0xFF;	/* values larger than the message */
	in[7] = 0xFF;
	KUNIT_EXPECT_EQ(test, ec_od_values_decode(in, sizeof(in), 12, &v), -EBADMSG);
}

static void sdoinfo_short_descriptions_are_refused(struct kunit *test)
{
	static const u8 in[10];
	struct ec_od_object o;
	struct ec_od_entry e;
	size_t len;

	for (len = 0; len < 6; len++)
		KUNIT_EXPECT_EQ(test, ec_od_object_decode(in, len, &o), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_od_object_decode(in, 6, &o), 0);
	KUNIT_EXPECT_EQ(test, o.name_len, (size_t)0);
	for (len = 0; len < 10; len++)
		KUNIT_EXPECT_EQ(test, ec_od_entry_decode(in, len, &e), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_od_entry_decode(in, 10, &e), 0);
	KUNIT_EXPECT_EQ(test, e.name_len, (size_t)0);
}

static void sdoinfo_answers_to_other_questions_are_stale(struct kunit *test)
{
	static const u8 other_list[] = { 0, 0x80, 2, 0, 0, 0, 2, 0 };
	static const u8 object[] = { 0, 0x80, 4, 0, 0, 0, 0x18, 0x10, 0, 0, 0, 7 };
	static const u8 other_sub[] = { 0, 0x80, 6, 0, 0, 0, 0x18, 0x10, 2, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 sdo[] = { 0, 0x30, 0x60, 0, 0x10, 0, 0, 0, 0, 0 };
	static const u8 request[] = { 0, 0x80, 1, 0, 0, 0, 1, 0 };
	static const u8 service[] = { 0, 0x30, 2, 0, 0, 0, 1, 0 };
	struct ec_sdoinfo s;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, other_list, sizeof(other_list)), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, object, sizeof(object)), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, sdo, sizeof(sdo)), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, request, sizeof(request)), EC_STALE);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, service, sizeof(service)), EC_STALE);
	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1019, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, object, sizeof(object)), EC_STALE);
	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, other_sub, sizeof(other_sub)), EC_STALE);
}

static void sdoinfo_refusal_carries_its_abort_code(struct kunit *test)
{
	struct ec_sdoinfo s;
	u8 msg[16];
	int len = ec_sdoinfo_error_encode(msg, sizeof(msg), EC_ABORT_NO_OBJECT);

	KUNIT_ASSERT_EQ(test, len, 10);
	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, 10), -EIO);
	KUNIT_EXPECT_EQ(test, s.abort, EC_ABORT_NO_OBJECT);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, 10), -EINVAL);
	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, 9), -EMSGSIZE);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_error_encode(msg, 9, 0), -EMSGSIZE);
}

static void sdoinfo_short_fragments_are_refused(struct kunit *test)
{
	static const u8 msg[] = { 0, 0x80, 6, 0, 0, 0, 0x18, 0x10, 1, 0 };
	struct ec_sdoinfo s;
	size_t len;

	for (len = 0; len < 9; len++) {
		ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 1, got, sizeof(got));
		KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, len), -EMSGSIZE);
	}
}

static void sdoinfo_lost_fragment_is_noticed(struct kunit *test)
{
	u8 msg[] = { 0, 0x80, 0x82, 0, 3, 0, 1, 0, 0, 0x10 };
	struct ec_sdoinfo s;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, sizeof(msg)), EC_WAIT);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_tx(&s, tx, sizeof(tx)), -EINVAL);
	msg[4] = 2;
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, sizeof(msg)), EC_WAIT);
	msg[4] = 0;
	msg[2] = 0x02;
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, sizeof(msg)), -EPROTO);
}

static void sdoinfo_fragments_without_end_are_bounded(struct kunit *test)
{
	static const u8 msg[] = { 0, 0x80, 0x82, 0, 0, 0, 1, 0 };
	struct ec_sdoinfo s;
	int n = 0, ret;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, sizeof(got));
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, 8), EC_WAIT);
	while ((ret = ec_sdoinfo_rx(&s, msg, 6)) == EC_WAIT)
		KUNIT_ASSERT_LT(test, n++, 70000);
	KUNIT_EXPECT_EQ(test, ret, -EPROTO);

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, sizeof(got));
	while ((ret = ec_sdoinfo_rx(&s, msg, 8)) == EC_WAIT)
		KUNIT_ASSERT_LE(test, s.size, sizeof(got));
	KUNIT_EXPECT_EQ(test, ret, -ENOBUFS);
}

static void sdoinfo_answer_larger_than_buffer_is_refused(struct kunit *test)
{
	static const u8 msg[] = { 0, 0x80, 2, 0, 0, 0, 1, 0, 0, 0x10, 1, 0x10 };
	struct ec_sdoinfo s;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, 3);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, sizeof(msg)), -ENOBUFS);
	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, got, 4);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_rx(&s, msg, sizeof(msg)), 0);
}

static void sdoinfo_requests_are_understood_by_server(struct kunit *test)
{
	struct ec_sdoinfo s;
	struct ec_sdoinfo_req req;
	size_t len;
	int n;

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1C12, 3, NULL, 0);
	s.info = 0x08;
	n = ec_sdoinfo_tx(&s, tx, sizeof(tx));
	KUNIT_ASSERT_EQ(test, n, 10);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_req_decode(tx, 10, &req), 0);
	KUNIT_EXPECT_EQ(test, req.opcode, EC_SDOINFO_ENTRY_REQ);
	KUNIT_EXPECT_EQ(test, req.index, 0x1C12);
	KUNIT_EXPECT_EQ(test, req.sub, 3);
	KUNIT_EXPECT_EQ(test, req.info, 8);
	for (len = 0; len < 10; len++)
		KUNIT_EXPECT_EQ(test, ec_sdoinfo_req_decode(tx, len, &req), -EMSGSIZE);
	tx[2] = 2;
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_req_decode(tx, 10, &req), -EOPNOTSUPP);
	tx[1] = 0x20;
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_req_decode(tx, 10, &req), -ENOMSG);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_tx(&s, tx, 9), -EMSGSIZE);
}

static void sdoinfo_mailbox_too_small_for_fragment_is_refused(struct kunit *test)
{
	struct ec_sdoinfo_resp resp;

	ec_sdoinfo_resp_init(&resp, EC_SDOINFO_LIST_RESP, body, 100);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_resp_next(&resp, tx, 9), -EMSGSIZE);
	ec_sdoinfo_resp_init(&resp, EC_SDOINFO_LIST_RESP, body, 2);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_resp_next(&resp, tx, 10), 8);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_resp_next(&resp, tx, 10), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sdoinfo_lists_come_in_as_many_fragments_as_needed),
	KUNIT_CASE(sdoinfo_object_description_survives_both_ways),
	KUNIT_CASE(sdoinfo_entry_description_survives_both_ways),
	KUNIT_CASE(sdoinfo_optional_fields_of_entry_are_skipped),
	KUNIT_CASE(sdoinfo_values_survive_both_ways),
	KUNIT_CASE(sdoinfo_values_of_inconsistent_size_are_refused),
	KUNIT_CASE(sdoinfo_short_descriptions_are_refused),
	KUNIT_CASE(sdoinfo_answers_to_other_questions_are_stale),
	KUNIT_CASE(sdoinfo_refusal_carries_its_abort_code),
	KUNIT_CASE(sdoinfo_short_fragments_are_refused),
	KUNIT_CASE(sdoinfo_lost_fragment_is_noticed),
	KUNIT_CASE(sdoinfo_fragments_without_end_are_bounded),
	KUNIT_CASE(sdoinfo_answer_larger_than_buffer_is_refused),
	KUNIT_CASE(sdoinfo_requests_are_understood_by_server),
	KUNIT_CASE(sdoinfo_mailbox_too_small_for_fragment_is_refused),
	{}
};

static struct kunit_suite suite = { .name = "sdoinfo", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
