// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: SoE and VoE servers. */
#include "sim_app_kunit.h"

struct drive {
	struct bed *b;
	struct app_mbox m;
	u8 buf[256];
};

static struct drive *drive_new(struct kunit *test, const char *text)
{
	struct drive *x = kunit_kzalloc(test, sizeof(*x), GFP_KERNEL);

	KUNIT_ASSERT_NOT_NULL(test, x);
	x->b = app_bed(test, text);
	x->m.station = STATION(0);
	x->m.size = 256;
	app_mbox_sms(x->b, x->m.station, 256);
	KUNIT_ASSERT_EQ(test, app_al(x->b, x->m.station, EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	return x;
}

/* sends @len bytes, returns those of the answer in @x->m.rx, or -1 */
static int ask(struct drive *x, u8 type, const void *msg, size_t len, u8 *got)
{
	struct ec_mbox_hdr h = { .len = 0 };
	int ret;

	memcpy(x->m.tx + EC_MBOX_HDR, msg, len);
	if (app_send(x->b, &x->m, type, len) != 1)
		return -1;
	ret = app_recv(x->b, &x->m, &h, 100);
	*got = h.type;
	return ret;
}

/* one access to the value; 0 or the error code; ~0: nothing of sense */
static u32 soe(struct drive *x, bool write, u8 drive, u8 element, u16 idn, size_t size)
{
	struct ec_soe_access a = {
		.write = write, .drive = drive, .elements = element, .idn = idn, .data = x->buf,
		.cap = sizeof(x->buf), .size = size,
	};
	u8 msg[256], type;
	int len = ec_soe_tx(&a, msg, 250), ret;

	len = len < 0 ? len : ask(x, EC_MBOX_SOE, msg, (size_t)len, &type);
	if (len < 0 || type != EC_MBOX_SOE)
		return ~0u;
	ret = ec_soe_rx(&a, x->m.rx + EC_MBOX_HDR, (size_t)len);
	return ret == -EIO ? a.error : ret ? ~0u : 0;
}

static u32 get(struct drive *x, u8 drive, u16 idn)
{
	memset(x->buf, 0, sizeof(x->buf));
	return soe(x, false, drive, EC_SOE_VALUE, idn, 0);
}

static u32 put(struct drive *x, u8 drive, u16 idn, u64 v, size_t size)
{
	put_unaligned_le64(v, x->buf);
	return soe(x, true, drive, EC_SOE_VALUE, idn, size);
}

static void sim_app_soe_values_are_read_and_written(struct kunit *test)
{
	struct drive *x = drive_new(test, "slave d drive soe=2\n");

	KUNIT_EXPECT_EQ(test, get(x, 0, 91), 0u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(x->buf), 3000u);
	KUNIT_EXPECT_EQ(test, put(x, 1, 91, 4000, 4), 0u);
	KUNIT_EXPECT_EQ(test, get(x, 0, 91), 0u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(x->buf), 3000u);
	KUNIT_EXPECT_EQ(test, get(x, 1, 91), 0u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(x->buf), 4000u);
	KUNIT_EXPECT_EQ(test, get(x, 1, 0x80A1), 0u);
	KUNIT_EXPECT_EQ(test, get_unaligned_le64(x->buf), 0x1122334455667788u);
	/* lists: length, largest length, data */
	KUNIT_EXPECT_EQ(test, get(x, 0, 30), 0u);
	KUNIT_EXPECT_MEMEQ(test, x->buf, "\x07\0\x10\0SIM 1.0", 11);
	KUNIT_EXPECT_EQ(test, get(x, 0, 17), 0u);
	KUNIT_EXPECT_MEMEQ(test, x->buf, "\x3a\0\x3a\0\1\0\2\0\x0b\0", 10);
	memcpy(x->buf, "\3\0\0\0abc", 7);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_VALUE, 0x80A0, 7), 0u);
	KUNIT_EXPECT_EQ(test, get(x, 0, 0x80A0), 0u);
	KUNIT_EXPECT_MEMEQ(test, x->buf, "\3\0\xC8\0abc", 7);
	/* gone with the power */
	ec_sim_add_fault(x->b->sim, &(struct ec_sim_fault){ .type = EC_SIM_FAULT_POWER_OFF });
	ec_sim_advance(x->b->sim, x->b->now + 1000);
	KUNIT_EXPECT_EQ(test, ec_sim_find(x->b->sim, "d")->soe.writes, 2u);
	ec_sim_add_fault(x->b->sim, &(struct ec_sim_fault){ .type = EC_SIM_FAULT_POWER_ON });
	ec_sim_advance(x->b->sim, x->b->now + 2000);
	KUNIT_EXPECT_EQ(test, ec_sim_find(x->b->sim, "d")->soe.writes, 0u);
}

static void sim_app_soe_errors_are_reported(struct kunit *test)
{
	struct drive *x = drive_new(test, "slave d drive soe=2\n");
	struct bed *b = x->b;

	KUNIT_EXPECT_EQ(test, get(x, 2, 91), EC_SOE_ERR_DRIVE);
	KUNIT_EXPECT_EQ(test, get(x, 0, 92), EC_SOE_ERR_NO_IDN);
	KUNIT_EXPECT_EQ(test, soe(x, false, 0, 0, 91, 0), EC_SOE_ERR_NO_ELEMENT);
	KUNIT_EXPECT_EQ(test, put(x, 0, 91, 9, 4), EC_SOE_ERR_BELOW);
	KUNIT_EXPECT_EQ(test, put(x, 0, 91, 6001, 4), EC_SOE_ERR_ABOVE);
	KUNIT_EXPECT_EQ(test, put(x, 0, 91, 100, 3), EC_SOE_ERR_SHORT);
	KUNIT_EXPECT_EQ(test, put(x, 0, 91, 100, 5), EC_SOE_ERR_LONG);
	KUNIT_EXPECT_EQ(test, put(x, 0, 30, 0, 4), EC_SOE_ERR_READ_ONLY);
	KUNIT_EXPECT_EQ(test, put(x, 0, 0x80AA, 1, 2), EC_SOE_ERR_PROTECTED);
	KUNIT_EXPECT_EQ(test, put(x, 0, 15, 1, 2), 0u);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_NAME, 91, 4), EC_SOE_ERR_NAME_RO);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_MAX, 91, 4), EC_SOE_ERR_MAX_RO);
	KUNIT_EXPECT_EQ(test, soe(x, false, 0, EC_SOE_STATE, 91, 0), EC_SOE_ERR_NO_STATE);
	KUNIT_EXPECT_EQ(test, soe(x, false, 0, EC_SOE_MIN, 47, 0), EC_SOE_ERR_NO_MIN);
	memcpy(x->buf, "\4\0\0\0abc", 7);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_VALUE, 0x80A0, 7), EC_SOE_ERR_SHORT);
	memcpy(x->buf, "\2\0\0\0abc", 7);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_VALUE, 0x80A0, 7), EC_SOE_ERR_LONG);
	put_unaligned_le16(201, x->buf);
	KUNIT_EXPECT_EQ(test, soe(x, true, 0, EC_SOE_VALUE, 0x80A0, 205), EC_SOE_ERR_LONG);
	bed_sm(b, STATION(0), 2, 0x1200, 8, 0x64);
	bed_sm(b, STATION(0), 3, 0x1218, 8, 0x20);
	KUNIT_ASSERT_EQ(test, app_al(b, STATION(0), EC_AL_SAFEOP, 1), (u32)EC_AL_SAFEOP);
	KUNIT_EXPECT_EQ(test, put(x, 0, 15, 1, 2), EC_SOE_ERR_PROTECTED);
	KUNIT_EXPECT_EQ(test, put(x, 0, 0x80AA, 1, 2), 0u);
}

/* name, attribute, unit, limits and value in one answer, ascending */
static void sim_app_soe_elements(struct kunit *test)
{
	static const u8 req[] = { 0x01, 0x7E, 0x5B, 0x00 };
	static const u8 head[] = { 0x02, 0x7E, 0x5B, 0x00, 28, 0, 28, 0, 'B', 'i', 'p' };
	static const u8 tail[] = {
		0, 0, 2, 0, 3, 0, 3, 0, 'r', 'p', 'm', 10, 0, 0, 0, 0x70, 0x17, 0, 0,
		0xB8, 0x0B, 0, 0,
	};
	struct drive *x = drive_new(test, "slave d drive soe=1\n");
	u8 type;

	KUNIT_ASSERT_EQ(test, ask(x, EC_MBOX_SOE, req, 4, &type), 4 + 32 + (int)sizeof(tail));
	KUNIT_EXPECT_EQ(test, type, EC_MBOX_SOE);
	KUNIT_EXPECT_MEMEQ(test, x->m.rx + EC_MBOX_HDR, head, sizeof(head));
	KUNIT_EXPECT_MEMEQ(test, x->m.rx + EC_MBOX_HDR + 36, tail, sizeof(tail));
}

static u16 error_of(struct drive *x, u8 type, const void *msg, size_t len)
{
	u8 got;
	int n = ask(x, type, msg, len, &got);

	return n == 4 && got == EC_MBOX_ERR ? get_unaligned_le16(x->m.rx + EC_MBOX_HDR + 2) : 0;
}

static void sim_app_soe_wrong_messages(struct kunit *test)
{
	struct drive *x = drive_new(test, "slave d drive soe=1\n");
	/* the first fragment has no answer; the second miscounts */
	static const u8 fragment[] = { 0x0B, 0x40, 0x03, 0x00, 1, 2 };
	static const u8 wrong[] = { 0x0B, 0x40, 0x01, 0x00, 1, 2 };
	static const u8 error[] = { 0x14, 0x40, 0x01, 0x00, 0x0B, 0x80 };
	u8 type;

	KUNIT_EXPECT_EQ(test, error_of(x, EC_MBOX_SOE, "\1\x40\x5B", 3), EC_MBOX_ERR_TOO_SHORT);
	KUNIT_EXPECT_EQ(test, error_of(x, EC_MBOX_SOE, "\2\x40\x5B\0", 4), EC_MBOX_ERR_SERVICE);
	KUNIT_EXPECT_EQ(test, error_of(x, EC_MBOX_VOE, "123456", 6), EC_MBOX_ERR_PROTOCOL);
	KUNIT_ASSERT_EQ(test, ask(x, EC_MBOX_SOE, fragment, 6, &type), -1);
	KUNIT_ASSERT_EQ(test, ask(x, EC_MBOX_SOE, wrong, 6, &type), 6);
	KUNIT_EXPECT_MEMEQ(test, x->m.rx + EC_MBOX_HDR, error, 6);
}

static void sim_app_soe_vendor_messages(struct kunit *test)
{
	static const u8 req[] = { 0xAD, 0xDE, 0xEF, 0xBE, 0x11, 0x22, 'h', 'i' };
	static const u8 resp[] = { 0xAD, 0xDE, 0xEF, 0xBE, 0x34, 0x12, 'h', 'i' };
	static const u8 unasked[] = { 5, 0, 0, 0, 6, 0, 0, 1, 2 };
	struct drive *x = drive_new(test, "slave d drive voe=0x1234\n"
					  "fault at=50ms voe d vendor=5 type=6 size=3\n");
	struct ec_mbox_hdr h;
	u8 type;

	KUNIT_ASSERT_EQ(test, ask(x, EC_MBOX_VOE, req, 8, &type), 8);
	KUNIT_EXPECT_EQ(test, type, EC_MBOX_VOE);
	KUNIT_EXPECT_MEMEQ(test, x->m.rx + EC_MBOX_HDR, resp, 8);
	KUNIT_EXPECT_EQ(test, error_of(x, EC_MBOX_VOE, req, 5), EC_MBOX_ERR_TOO_SHORT);
	KUNIT_EXPECT_EQ(test, app_recv(x->b, &x->m, &h, 20), -1);
	KUNIT_ASSERT_EQ(test, app_recv(x->b, &x->m, &h, 100), 9);
	KUNIT_EXPECT_EQ(test, h.type, EC_MBOX_VOE);
	KUNIT_EXPECT_MEMEQ(test, x->m.rx + EC_MBOX_HDR, unasked, 9);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_soe_values_are_read_and_written),
	KUNIT_CASE(sim_app_soe_errors_are_reported),
	KUNIT_CASE(sim_app_soe_elements),
	KUNIT_CASE(sim_app_soe_wrong_messages),
	KUNIT_CASE(sim_app_soe_vendor_messages),
	{}
};

static struct kunit_suite suite = { .name = "sim_app_soe", .exit = bed_exit, .test_cases = cases };
kunit_test_suites(&suite);
MODULE_LICENSE("GPL");
