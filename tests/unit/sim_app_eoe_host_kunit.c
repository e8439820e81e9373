// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: an IP host behind EoE, without faults. */
#include "sim_app_eoe_host.h"

#define WEB	"slave web EL6614 eoe=host response=500us\n"

static void sim_app_eoe_host_answers_arp(struct kunit *test)
{
	static const u8 other[4] = { 192, 168, 0, 18 };
	struct host *h = host_new(test, WEB, 1024);
	const u8 *frame;
	u8 p[60];
	u64 sent;

	sent = h->b->now;
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_ASSERT_EQ(test, host_recv(h, &frame, 5), 60);
	KUNIT_EXPECT_GE(test, h->b->now - sent, 500000ull);
	KUNIT_EXPECT_LT(test, h->b->now - sent, 800000ull);
	KUNIT_EXPECT_MEMEQ(test, frame, host_mac, 6);
	KUNIT_EXPECT_MEMEQ(test, frame + 6, ec_app_eoe_mac(h->app), 6);
	KUNIT_EXPECT_MEMEQ(test, frame + 12, "\x8\6\0\1\x8\0\6\4\0\2", 10);
	KUNIT_EXPECT_MEMEQ(test, frame + 28, slave_ip, 4);
	KUNIT_EXPECT_MEMEQ(test, frame + 38, host_ip, 4);
	KUNIT_EXPECT_EQ(test, frame[6] & 3, 2);		/* locally administered, unicast */
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, other)));
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 5), 0);
}

static void sim_app_eoe_host_uses_addresses_that_are_set(struct kunit *test)
{
	static const u8 set_mac[] = {
		0x02, 0x01, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 2, 1, 2, 3, 4, 5,
	};
	struct host *h = host_new(test, WEB, 1024);
	struct ec_mbox_hdr hdr;
	const u8 *frame;
	u8 p[60];

	memcpy(h->m.tx + EC_MBOX_HDR, set_mac, sizeof(set_mac));
	KUNIT_ASSERT_EQ(test, app_send(h->b, &h->m, EC_MBOX_EOE, sizeof(set_mac)), 1);
	KUNIT_ASSERT_EQ(test, app_recv(h->b, &h->m, &hdr, 10), 4);
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_ASSERT_EQ(test, host_recv(h, &frame, 5), 60);
	KUNIT_EXPECT_MEMEQ(test, frame + 6, set_mac + 8, 6);
	h->app->ip.now.which = 0;		/* no address: no answer */
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 5), 0);
}

/* all sizes up to the largest frame, in small and large mailboxes */
static void sim_app_eoe_host_answers_ping(struct kunit *test)
{
	static const u16 sizes[] = { 48, 128, 512, 1024, 1486 };

	for (u32 i = 0; i < ARRAY_SIZE(sizes); i++) {
		struct host *h;
		char text[64];

		snprintf(text, sizeof(text), "slave s drive eoe=host mbox=%u\n", sizes[i]);
		h = host_new(test, text, sizes[i]);
		for (u16 len = 0; len <= 1472; len = (u16)(len + 92)) {
			KUNIT_ASSERT_TRUE_MSG(test, host_pings(h, len, 50), "%u bytes, mailbox %u",
					      len, sizes[i]);
		}
		KUNIT_EXPECT_EQ(test, h->bad, 0u);
		KUNIT_EXPECT_EQ(test, h->app->eoe->bad, 0u);
		KUNIT_EXPECT_EQ(test, h->app->eoe->received, 17u);
		KUNIT_EXPECT_EQ(test, h->app->eoe->sent, 17u);
		bed_exit(test);
		test->priv = NULL;
	}
}

/* a damaged packet, a part of one, one for another station: no answer, and no harm */
static void sim_app_eoe_host_ignores_wrong_packets(struct kunit *test)
{
	static const struct {
		u8 at;
		u8 value;
	} wrong[] = {
		{ 0, 0x06 }, { 12, 0x86 }, { 14, 0x65 }, { 14, 0x4f }, { 17, 0xff }, { 20, 0x20 },
		{ 33, 99 }, { 34, 9 }, { 50, 0xee },
	};
	struct host *h = host_new(test, WEB, 1024);
	const u8 *frame;
	u8 p[200];
	u16 len;

	for (u32 i = 0; i < ARRAY_SIZE(wrong); i++) {
		len = host_ping(h, p, 100);
		p[wrong[i].at] = wrong[i].value;
		KUNIT_ASSERT_TRUE(test, host_send(h, p, len));
		KUNIT_EXPECT_EQ_MSG(test, host_recv(h, &frame, 3), 0, "case %u", i);
	}
	for (u16 n = 0; n < 50; n++) {
		host_ping(h, p, 100);
		host_send(h, p, n);
	}
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 3), 0);
	KUNIT_EXPECT_TRUE(test, host_pings(h, 100, 5));
}

/* more than it keeps: the rest is lost, and it goes on */
static void sim_app_eoe_host_queue_is_bounded(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	const u8 *frame;
	u8 p[60];
	u32 n = 0;

	for (u32 i = 0; i < 40; i++)
		KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	/* one of them is in the mailbox already */
	KUNIT_EXPECT_EQ(test, h->app->eoe->n, EC_APP_EOE_QUEUE);
	KUNIT_EXPECT_EQ(test, h->app->eoe->dropped, 40u - EC_APP_EOE_QUEUE - 1);
	while (host_recv(h, &frame, 3))
		n++;
	KUNIT_EXPECT_EQ(test, n, EC_APP_EOE_QUEUE + 1u);
	KUNIT_EXPECT_TRUE(test, host_pings(h, 100, 5));
}

/* a fragment is taken while a message waits to be read: both directions at once */
static void sim_app_eoe_host_receives_while_it_sends(struct kunit *test)
{
	struct host *h = host_new(test, "slave s drive eoe=host mbox=128\n", 128);
	const u8 *frame;
	u8 p[EC_EOE_FRAME_MAX];
	u32 n = 0;

	for (u32 i = 0; i < 4; i++)
		KUNIT_ASSERT_TRUE(test, host_send(h, p, host_ping(h, p, 1400)));
	KUNIT_EXPECT_EQ(test, h->app->eoe->received, 4u);
	while (host_recv(h, &frame, 3))
		n++;
	KUNIT_EXPECT_EQ(test, n, 4u);
}

/* in INIT there is no mailbox; afterwards what was on its way is forgotten */
static void sim_app_eoe_host_forgets_frames_in_init(struct kunit *test)
{
	struct host *h = host_new(test, WEB, 1024);
	const u8 *frame;
	u8 p[60];

	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_ASSERT_EQ(test, app_al(h->b, STATION(0), EC_AL_INIT, 5), (u32)EC_AL_INIT);
	KUNIT_ASSERT_EQ(test, app_al(h->b, STATION(0), EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 5), 0);
	KUNIT_EXPECT_TRUE(test, host_pings(h, 100, 5));	/* its address is the same */
}

/* without eoe= frames vanish */
static void sim_app_eoe_host_needs_option(struct kunit *test)
{
	struct host *h = host_new(test, "slave s EL6614\n", 1024);
	const u8 *frame;
	u8 p[60];

	KUNIT_EXPECT_PTR_EQ(test, h->app->eoe, (struct ec_app_eoe *)NULL);
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 5), 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_eoe_host_answers_arp),
	KUNIT_CASE(sim_app_eoe_host_uses_addresses_that_are_set),
	KUNIT_CASE(sim_app_eoe_host_answers_ping),
	KUNIT_CASE(sim_app_eoe_host_ignores_wrong_packets),
	KUNIT_CASE(sim_app_eoe_host_queue_is_bounded),
	KUNIT_CASE(sim_app_eoe_host_receives_while_it_sends),
	KUNIT_CASE(sim_app_eoe_host_forgets_frames_in_init),
	KUNIT_CASE(sim_app_eoe_host_needs_option),
	{ }
};

static struct kunit_suite suite = {
	.name = "sim_app_eoe_host",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
