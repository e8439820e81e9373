// SPDX-License-Identifier: GPL-2.0-only
/* CoE messages typed from the tables of the specification, mostly the slave's side. */
#include "wire_kunit.h"
#include "od_list.h"
#include "../../devices/sim/mbox_encode.h"
#include "../../devices/sim/sdo_server.h"
#include "../../devices/sim/sdoinfo_server.h"
#include "../../master/wire/diag.h"
#include "../../master/wire/sdo.h"

static u8 out[128];

static u32 two_objects(void *ctx, u16 index, u8 sub, bool complete,
		       u8 *buf, size_t cap, size_t *len)
{
	if (index == 0x1001) {
		buf[0] = 0x81;
		*len = 1;
		return 0;
	}
	if (index == 0x1008) {
		memcpy(buf, "Drive", 5);
		*len = 5;
		return 0;
	}
	return EC_ABORT_NO_OBJECT;
}

static void vectors_coe_answers_of_sdo_server(struct kunit *test)
{
	static const struct ec_sdo_srv_ops ops = { .read = two_objects };
	static const u8 req[] = { 0x00, 0x20, 0x40, 0x00, 0x10, 0x00, 0, 0, 0, 0 };
	static const u8 abort[] = { 0x00, 0x20, 0x80, 0x00, 0x10, 0x00, 0x00, 0x00, 0x02, 0x06 };
	static const u8 name[] = { 0x00, 0x20, 0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0 };
	static const u8 drive[] = {
		0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 5, 0, 0, 0, 'D', 'r', 'i', 'v', 'e',
	};
	static const u8 reg[] = { 0x00, 0x20, 0x40, 0x01, 0x10, 0x00, 0, 0, 0, 0 };
	static const u8 one[] = { 0x00, 0x30, 0x4F, 0x01, 0x10, 0x00, 0x81, 0, 0, 0 };
	struct ec_sdo_srv srv;

	ec_sdo_srv_init(&srv, &ops, NULL, out + 64, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, req, 10, out, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out, abort, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, name, 10, out, 64), 15);
	KUNIT_EXPECT_MEMEQ(test, out, drive, 15);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, reg, 10, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, one, 10);
}

static u8 written[32];
static size_t written_len;

static u32 take(void *ctx, u16 index, u8 sub, bool complete, const u8 *data, size_t len)
{
	if (index != 0x2000 || len > sizeof(written))
		return EC_ABORT_READ_ONLY;
	memcpy(written, data, len);
	written_len = len;
	return 0;
}

static void vectors_coe_downloads_into_sdo_server(struct kunit *test)
{
	static const struct ec_sdo_srv_ops ops = { .read = two_objects, .write = take };
	static const u8 two[] = { 0x00, 0x20, 0x2B, 0x00, 0x20, 0x01, 0x34, 0x12, 0, 0 };
	static const u8 ok[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 normal[] = {
		0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 0x05, 0x00, 0x00, 0x00, 'h', 'e', 'l', 'l', 'o',
	};
	static const u8 refused[] = { 0x00, 0x20, 0x2F, 0x18, 0x10, 0x01, 0x07, 0, 0, 0 };
	static const u8 abort[] = { 0x00, 0x20, 0x80, 0x18, 0x10, 0x01, 0x02, 0x00, 0x01, 0x06 };
	struct ec_sdo_srv srv;

	ec_sdo_srv_init(&srv, &ops, NULL, out + 64, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, two, 10, out, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out, ok, 10);
	KUNIT_EXPECT_EQ(test, written_len, (size_t)2);
	KUNIT_EXPECT_MEMEQ(test, written, "\x34\x12", 2);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, normal, 15, out, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out, ok, 10);
	KUNIT_EXPECT_EQ(test, written_len, (size_t)5);
	KUNIT_EXPECT_MEMEQ(test, written, "hello", 5);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, refused, 10, out, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out, abort, 10);
}

static void vectors_coe_segments_into_sdo_server(struct kunit *test)
{
	/* as vectors_segmented_download, seen from the other side */
	static const struct ec_sdo_srv_ops ops = { .read = two_objects, .write = take };
	static const u8 first[] = {
		0x00, 0x20, 0x21, 0x00, 0x20, 0x01, 0x0D, 0x00, 0x00, 0x00, 's', 'e',
	};
	static const u8 seg0[] = { 0x00, 0x20, 0x00, 'g', 'm', 'e', 'n', 't', 'e', 'd', '!', '!' };
	static const u8 seg1[] = { 0x00, 0x20, 0x1B, '.', '.', 0, 0, 0, 0, 0 };
	static const u8 ok[] = { 0x00, 0x30, 0x60, 0x00, 0x20, 0x01, 0, 0, 0, 0 };
	static const u8 ack0[] = { 0x00, 0x30, 0x20, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 ack1[] = { 0x00, 0x30, 0x30, 0, 0, 0, 0, 0, 0, 0 };
	struct ec_sdo_srv srv;

	ec_sdo_srv_init(&srv, &ops, NULL, out + 64, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, first, 12, out, 12), 10);
	KUNIT_EXPECT_MEMEQ(test, out, ok, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, seg0, 12, out, 12), 10);
	KUNIT_EXPECT_MEMEQ(test, out, ack0, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, seg1, 10, out, 12), 10);
	KUNIT_EXPECT_MEMEQ(test, out, ack1, 10);
	KUNIT_EXPECT_EQ(test, written_len, (size_t)13);
	KUNIT_EXPECT_MEMEQ(test, written, "segmented!!..", 13);
}

static u32 ten_bytes(void *ctx, u16 index, u8 sub, bool complete, u8 *buf, size_t cap, size_t *len)
{
	memcpy(buf, "segmented!", 10);
	*len = 10;
	return 0;
}

static void vectors_coe_segments_out_of_sdo_server(struct kunit *test)
{
	/* a mailbox of 16 bytes: nothing with the answer, then 7, then 3 */
	static const struct ec_sdo_srv_ops ops = { .read = ten_bytes };
	static const u8 req[] = { 0x00, 0x20, 0x40, 0x08, 0x10, 0x00, 0, 0, 0, 0 };
	static const u8 first[] = { 0x00, 0x30, 0x41, 0x08, 0x10, 0x00, 0x0A, 0x00, 0x00, 0x00 };
	static const u8 req0[] = { 0x00, 0x20, 0x60, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 seg0[] = { 0x00, 0x30, 0x00, 's', 'e', 'g', 'm', 'e', 'n', 't' };
	static const u8 req1[] = { 0x00, 0x20, 0x70, 0, 0, 0, 0, 0, 0, 0 };
	static const u8 seg1[] = { 0x00, 0x30, 0x19, 'e', 'd', '!', 0, 0, 0, 0 };
	static const u8 toggle[] = { 0x00, 0x20, 0x80, 0x08, 0x10, 0x00, 0x00, 0x00, 0x03, 0x05 };
	struct ec_sdo_srv srv;

	ec_sdo_srv_init(&srv, &ops, NULL, out + 64, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, req, 10, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, first, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, req0, 10, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, seg0, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, req1, 10, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, seg1, 10);
	/* the second segment asked for first */
	ec_sdo_srv_handle(&srv, req, 10, out, 10);
	KUNIT_ASSERT_EQ(test, ec_sdo_srv_handle(&srv, req1, 10, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, toggle, 10);
}

static void vectors_coe_aborts_of_slave(struct kunit *test)
{
	/* "no such object" to an upload, "read only" to a download */
	static const u8 up[] = { 0x00, 0x20, 0x80, 0x00, 0x30, 0x02, 0x00, 0x00, 0x02, 0x06 };
	static const u8 down[] = { 0x00, 0x20, 0x80, 0x18, 0x10, 0x01, 0x02, 0x00, 0x01, 0x06 };
	struct ec_sdo u;
	struct ec_sdo d;

	ec_sdo_upload_init(&u, 0x3000, 2, false, out, 8);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&u, out + 16, 64), 10);
	KUNIT_EXPECT_LT(test, ec_sdo_rx(&u, up, 10), 0);
	KUNIT_EXPECT_EQ(test, u.abort, 0x06020000u);
	ec_sdo_download_init(&d, 0x1018, 1, false, up, 4, 64);
	KUNIT_ASSERT_EQ(test, ec_sdo_tx(&d, out + 16, 64), 10);
	KUNIT_EXPECT_LT(test, ec_sdo_rx(&d, down, 10), 0);
	KUNIT_EXPECT_EQ(test, d.abort, 0x06010002u);
}

static void vectors_coe_emergency(struct kunit *test)
{
	static const u8 want[] = { 0x00, 0x10, 0x10, 0x42, 0x09, 1, 2, 3, 4, 5 };
	struct ec_coe_emergency e = { 0x4210, 0x09, { 1, 2, 3, 4, 5 } };

	KUNIT_ASSERT_EQ(test, ec_coe_emergency_encode(out, sizeof(out), &e), 10);
	KUNIT_EXPECT_MEMEQ(test, out, want, 10);
	memset(&e, 0, sizeof(e));
	KUNIT_ASSERT_EQ(test, ec_coe_emergency_decode(want, sizeof(want), &e), 0);
	KUNIT_EXPECT_EQ(test, e.code, 0x4210);
	KUNIT_EXPECT_EQ(test, e.reg, 9);
	KUNIT_EXPECT_MEMEQ(test, e.data, want + 5, 5);
}

static void vectors_coe_sdo_information(struct kunit *test)
{
	static const u8 list_req[] = { 0x00, 0x80, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00 };
	static const u8 frag1[] = { 0x00, 0x80, 0x82, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x10 };
	static const u8 frag0[] = { 0x00, 0x80, 0x02, 0x00, 0x00, 0x00, 0x18, 0x10 };
	static const u8 entry_req[] = { 0x00, 0x80, 0x05, 0, 0, 0, 0x18, 0x10, 0x02, 0x00 };
	static const u8 entry[] = {
		0x00, 0x80, 0x06, 0x00, 0x00, 0x00,
		0x18, 0x10, 0x02, 0x00, 0x07, 0x00, 0x20, 0x00, 0x07, 0x00, 'P', 'C',
	};
	static const u8 object[] = {
		0x00, 0x80, 0x04, 0x00, 0x00, 0x00,
		0x18, 0x10, 0x23, 0x00, 0x04, 0x09, 'I', 'D',
	};
	struct ec_sdoinfo s;
	struct ec_od_entry e;
	struct ec_od_object o;

	ec_sdoinfo_init(&s, EC_SDOINFO_LIST_REQ, EC_SDOINFO_ALL, 0, out, 64);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_tx(&s, out + 64, 64), 8);
	KUNIT_EXPECT_MEMEQ(test, out + 64, list_req, 8);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_rx(&s, frag1, sizeof(frag1)), EC_WAIT);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_rx(&s, frag0, sizeof(frag0)), 0);
	KUNIT_ASSERT_EQ(test, od_list_count(&s), (size_t)2);
	KUNIT_EXPECT_EQ(test, od_list_get(&s, 0), 0x1000);
	KUNIT_EXPECT_EQ(test, od_list_get(&s, 1), 0x1018);

	ec_sdoinfo_init(&s, EC_SDOINFO_ENTRY_REQ, 0x1018, 2, out, 64);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_tx(&s, out + 64, 64), 10);
	KUNIT_EXPECT_MEMEQ(test, out + 64, entry_req, 10);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_rx(&s, entry, sizeof(entry)), 0);
	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(out, s.size, &e), 0);
	KUNIT_EXPECT_EQ(test, e.type, 7);
	KUNIT_EXPECT_EQ(test, e.bits, 32);
	KUNIT_EXPECT_EQ(test, e.access, EC_OD_READ);
	KUNIT_ASSERT_EQ(test, e.name_len, (size_t)2);
	KUNIT_EXPECT_MEMEQ(test, e.name, "PC", 2);

	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x1018, 0, out, 64);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_rx(&s, object, sizeof(object)), 0);
	KUNIT_ASSERT_EQ(test, ec_od_object_decode(out, s.size, &o), 0);
	KUNIT_EXPECT_EQ(test, o.type, 0x23);
	KUNIT_EXPECT_EQ(test, o.max_sub, 4);
	KUNIT_EXPECT_EQ(test, o.code, EC_OD_RECORD);
	KUNIT_EXPECT_EQ(test, o.name_len, (size_t)2);
}

static void vectors_coe_sdo_information_of_slave(struct kunit *test)
{
	static const u8 list_req[] = { 0x00, 0x80, 0x01, 0x00, 0x00, 0x00, 0x01, 0x00 };
	static const u8 entry_req[] = { 0x00, 0x80, 0x05, 0, 0, 0, 0x18, 0x10, 0x02, 0x03 };
	/* four bytes a message: list type and 0x1000, then 0x1018 */
	static const u8 frag1[] = { 0x00, 0x80, 0x82, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x10 };
	static const u8 frag0[] = { 0x00, 0x80, 0x02, 0x00, 0x00, 0x00, 0x18, 0x10 };
	static const u8 object[] = { 0x18, 0x10, 0x23, 0x00, 0x04, 0x09, 'I', 'D' };
	static const u8 entry[] = {
		0x18, 0x10, 0x02, 0x00, 0x07, 0x00, 0x20, 0x00, 0x07, 0x00, 'P', 'C',
	};
	static const u8 error[] = { 0x00, 0x80, 0x07, 0x00, 0x00, 0x00, 0x00, 0x00, 0x02, 0x06 };
	static const u8 list[] = { 0x01, 0x00, 0x00, 0x10, 0x18, 0x10 };
	struct ec_od_object o = { 0x1018, 0x23, 4, 9, "ID", 2 };
	struct ec_od_entry e = { 0x1018, 2, 0, 7, 32, 7, "PC", 2 };
	struct ec_sdoinfo_req req;
	struct ec_sdoinfo_resp r;
	struct ec_sdoinfo s;

	memset(&req, 0xAA, sizeof(req));
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_req_decode(list_req, 8, &req), 0);
	KUNIT_EXPECT_EQ(test, req.opcode, EC_SDOINFO_LIST_REQ);
	KUNIT_EXPECT_EQ(test, req.index, EC_SDOINFO_ALL);
	KUNIT_EXPECT_EQ(test, req.sub, 0);
	KUNIT_EXPECT_EQ(test, req.info, 0);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_req_decode(entry_req, 10, &req), 0);
	KUNIT_EXPECT_EQ(test, req.opcode, EC_SDOINFO_ENTRY_REQ);
	KUNIT_EXPECT_EQ(test, req.index, 0x1018);
	KUNIT_EXPECT_EQ(test, req.sub, 2);
	KUNIT_EXPECT_EQ(test, req.info, 3);

	ec_sdoinfo_resp_init(&r, EC_SDOINFO_LIST_RESP, list, sizeof(list));
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_resp_next(&r, out, 10), 10);
	KUNIT_EXPECT_MEMEQ(test, out, frag1, 10);
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_resp_next(&r, out, 10), 8);
	KUNIT_EXPECT_MEMEQ(test, out, frag0, 8);
	KUNIT_EXPECT_EQ(test, ec_sdoinfo_resp_next(&r, out, 10), 0);

	KUNIT_ASSERT_EQ(test, ec_od_object_encode(out, 64, &o), (int)sizeof(object));
	KUNIT_EXPECT_MEMEQ(test, out, object, sizeof(object));
	KUNIT_ASSERT_EQ(test, ec_od_entry_encode(out, 64, &e, NULL), (int)sizeof(entry));
	KUNIT_EXPECT_MEMEQ(test, out, entry, sizeof(entry));
	KUNIT_ASSERT_EQ(test, ec_sdoinfo_error_encode(out, 64, 0x06020000), 10);
	KUNIT_EXPECT_MEMEQ(test, out, error, 10);

	ec_sdoinfo_init(&s, EC_SDOINFO_OBJECT_REQ, 0x3000, 0, out, 64);
	KUNIT_EXPECT_LT(test, ec_sdoinfo_rx(&s, error, 10), 0);
	KUNIT_EXPECT_EQ(test, s.abort, 0x06020000u);
}

/* 0x2000:01, UINT16, with unit, default, minimum and maximum, named "V" */
static void vectors_coe_values_of_entry(struct kunit *test)
{
	static const u8 entry[] = {
		0x00, 0x20, 0x01, 0x78, 0x06, 0x00, 0x10, 0x00, 0x3F, 0x00,
		0x00, 0x00, 0x03, 0xB5, 0x64, 0x00, 0x0A, 0x00, 0xE8, 0x03, 'V',
	};
	struct ec_od_values v;
	struct ec_od_entry e;

	KUNIT_ASSERT_EQ(test, ec_od_entry_decode(entry, sizeof(entry), &e), 0);
	KUNIT_EXPECT_EQ(test, e.bits, 16);
	KUNIT_ASSERT_EQ(test, ec_od_values_decode(entry, sizeof(entry), 11, &v), 0);
	KUNIT_EXPECT_EQ(test, v.unit, 0xB5030000u);
	KUNIT_ASSERT_EQ(test, v.size, (size_t)2);
	KUNIT_EXPECT_PTR_EQ(test, v.def, &entry[14]);
	KUNIT_EXPECT_PTR_EQ(test, v.min, &entry[16]);
	KUNIT_EXPECT_PTR_EQ(test, v.max, &entry[18]);
}

/* a warning with code 0x0000E000, text 0x1234, 1 ms, one parameter: UINT32 0x01020304 */
static void vectors_coe_diagnosis_message(struct kunit *test)
{
	static const u8 msg[] = {
		0x00, 0xE0, 0x00, 0x00, 0x01, 0x01, 0x34, 0x12,
		0x40, 0x42, 0x0F, 0x00, 0x00, 0x00, 0x00, 0x00,
		0x07, 0x00, 0x04, 0x03, 0x02, 0x01,
	};
	struct ec_diag_param p;
	struct ec_diag_msg m;

	KUNIT_ASSERT_EQ(test, ec_diag_msg_decode(msg, sizeof(msg), &m), 0);
	KUNIT_EXPECT_EQ(test, m.code, 0xE000u);
	KUNIT_EXPECT_EQ(test, m.flags & 0xF, EC_DIAG_WARNING);
	KUNIT_EXPECT_EQ(test, m.text_id, 0x1234);
	KUNIT_EXPECT_EQ(test, m.time_ns, 1000000ull);
	KUNIT_ASSERT_EQ(test, ec_diag_param_decode(&m, &p), 1);
	KUNIT_EXPECT_EQ(test, p.kind, EC_DIAG_VALUE);
	KUNIT_EXPECT_EQ(test, p.type, 7);
	KUNIT_EXPECT_PTR_EQ(test, p.data, &msg[18]);
	KUNIT_EXPECT_EQ(test, p.size, (size_t)4);
	KUNIT_EXPECT_EQ(test, ec_diag_param_decode(&m, &p), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(vectors_coe_answers_of_sdo_server),
	KUNIT_CASE(vectors_coe_downloads_into_sdo_server),
	KUNIT_CASE(vectors_coe_segments_into_sdo_server),
	KUNIT_CASE(vectors_coe_segments_out_of_sdo_server),
	KUNIT_CASE(vectors_coe_aborts_of_slave),
	KUNIT_CASE(vectors_coe_emergency),
	KUNIT_CASE(vectors_coe_sdo_information),
	KUNIT_CASE(vectors_coe_sdo_information_of_slave),
	KUNIT_CASE(vectors_coe_values_of_entry),
	KUNIT_CASE(vectors_coe_diagnosis_message),
	{}
};

static struct kunit_suite suite = { .name = "vectors_coe", .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
