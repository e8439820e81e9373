// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: IP parameters over EoE. */
#include "sim_app_kunit.h"

/* one exchange; bytes of the answer behind the mailbox header, -1: none */
static int ask(struct bed *b, struct app_mbox *m, const u8 *req, size_t len, u8 *type)
{
	struct ec_mbox_hdr h;
	int ret;

	memcpy(m->tx + EC_MBOX_HDR, req, len);
	if (app_send(b, m, EC_MBOX_EOE, len) != 1)
		return -1;
	ret = app_recv(b, m, &h, 100);
	*type = h.type;
	return ret;
}

static void sim_app_eoe_ip_parameters(struct kunit *test)
{
	static const u8 set_ip[] = {	/* up to the address only */
		0x02, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0x11, 0x00, 0xa8, 0xc0,
	};
	static const u8 set_mask[] = {
		0x02, 0x01, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0xff, 0xff, 0xff,
	};
	static const u8 ok[] = { 0x03, 0x01, 0x00, 0x00 };
	static const u8 get[] = { 0x06, 0x01, 0x00, 0x00 };
	static const u8 both[] = {
		0x07, 0x01, 0x00, 0x00, 0x06, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0x11, 0x00, 0xa8, 0xc0, 0x00, 0xff, 0xff, 0xff,
	};
	static const u8 filter[] = { 0x04, 0x01, 0x00, 0x00 };
	static const u8 no_filter[] = { 0x05, 0x01, 0x01, 0x04 };
	struct bed *b = app_bed(test, "slave s EL6614\n");
	struct app_mbox *m = kunit_kzalloc(test, sizeof(*m), GFP_KERNEL);
	u8 type = 0;

	KUNIT_ASSERT_NOT_NULL(test, m);
	m->station = STATION(0);
	m->size = 1024;
	app_mbox_sms(b, m->station, 1024);
	KUNIT_ASSERT_EQ(test, app_al(b, m->station, EC_AL_PREOP, 5), (u32)EC_AL_PREOP);

	KUNIT_EXPECT_EQ(test, ask(b, m, set_ip, sizeof(set_ip), &type), 4);
	KUNIT_EXPECT_EQ(test, type, EC_MBOX_EOE);
	KUNIT_EXPECT_MEMEQ(test, m->rx + EC_MBOX_HDR, ok, 4);
	KUNIT_EXPECT_EQ(test, ask(b, m, set_mask, sizeof(set_mask), &type), 4);
	KUNIT_EXPECT_EQ(test, ask(b, m, get, sizeof(get), &type), 62);
	KUNIT_EXPECT_MEMEQ(test, m->rx + EC_MBOX_HDR, both, sizeof(both));
	KUNIT_EXPECT_EQ(test, ask(b, m, filter, sizeof(filter), &type), 4);
	KUNIT_EXPECT_MEMEQ(test, m->rx + EC_MBOX_HDR, no_filter, 4);
	/* too short for what it says: a mailbox error, nothing is taken */
	KUNIT_EXPECT_EQ(test, ask(b, m, set_mask, 20, &type), 4);
	KUNIT_EXPECT_EQ(test, type, EC_MBOX_ERR);
	KUNIT_EXPECT_EQ(test, get_unaligned_le16(m->rx + EC_MBOX_HDR + 2),
			EC_MBOX_ERR_TOO_SHORT);
}

static void sim_app_eoe_ip_refused(struct kunit *test)
{
	static const u8 set[] = {
		0x02, 0x01, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00,
		0, 0, 0, 0, 0, 0, 0x11, 0x00, 0xa8, 0xc0,
	};
	static const u8 no_ip[] = { 0x03, 0x01, 0x01, 0x02 };
	struct bed *b = app_bed(test, "slave s EL6614 ip=no\n");
	struct app_mbox *m = kunit_kzalloc(test, sizeof(*m), GFP_KERNEL);
	u8 type = 0;

	KUNIT_ASSERT_NOT_NULL(test, m);
	m->station = STATION(0);
	m->size = 1024;
	app_mbox_sms(b, m->station, 1024);
	KUNIT_ASSERT_EQ(test, app_al(b, m->station, EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, ask(b, m, set, sizeof(set), &type), 4);
	KUNIT_EXPECT_MEMEQ(test, m->rx + EC_MBOX_HDR, no_ip, 4);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_eoe_ip_parameters),
	KUNIT_CASE(sim_app_eoe_ip_refused),
	{ }
};

static struct kunit_suite suite = {
	.name = "sim_app_eoe",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
