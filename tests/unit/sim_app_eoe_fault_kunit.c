// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: what is wrong with Ethernet frames behind EoE on request. */
#include "sim_app_eoe_host.h"

#define SLAVE	"slave s drive eoe=host mbox=128\n"

/* begins a fault, as a command does while the segment runs */
static void fault(struct kunit *test, struct host *h, const char *text)
{
	struct ec_sim_error err = { 0 };
	struct ec_sim_fault f;

	KUNIT_ASSERT_EQ_MSG(test, ec_sim_command(h->b->sim, &bed_ops, text, strlen(text), &f,
						 &err), 0, "%s", err.text);
	KUNIT_ASSERT_EQ(test, ec_sim_add_fault(h->b->sim, &f), 0);
}

/* frames that the slave sends in this time, counted by kind */
struct seen {
	u32 frames;
	u32 shorter;
	u32 pongs;
	u32 ethercat;
	u32 udp;
	u32 noise;
	u32 from_host;
};

static struct seen listen(struct host *h, u32 ms, u16 data)
{
	u64 end = h->b->now + ms * 1000000ull;
	struct seen s = { 0 };
	const u8 *p = NULL;

	while (h->b->now < end) {
		int len = host_recv(h, &p, 1);

		if (!len)
			continue;
		s.frames++;
		s.shorter += len < EC_EOE_FRAME_MIN;
		s.pongs += host_is_pong(p, len, data);
		s.ethercat += p[12] == 0x88 && p[13] == 0xa4;
		s.udp += p[12] == 8 && ec_eoe_is_ethercat(p, len);
		s.noise += p[12] == 0x88 && p[13] == 0xb5;
		s.from_host += !memcmp(p + 6, host_mac, 6);
	}
	return s;
}

/* an echo request of several fragments; the frame announced by the fault has passed */
static struct seen ping_with(struct kunit *test, struct host *h, const char *text, u16 data)
{
	u8 p[EC_EOE_FRAME_MAX];

	fault(test, h, text);
	listen(h, 10, 0);
	h->bad = 0;
	h->fragments = 0;
	KUNIT_EXPECT_TRUE(test, host_send(h, p, host_ping(h, p, data)));
	return listen(h, 20, data);
}

/* afterwards all is well again */
static void good(struct kunit *test, struct host *h)
{
	fault(test, h, "eoe s good");
	listen(h, 10, 0);
	KUNIT_EXPECT_TRUE(test, host_pings(h, 400, 20));
	h->bad = 0;
	KUNIT_EXPECT_TRUE(test, host_pings(h, 1400, 20));
	KUNIT_EXPECT_EQ(test, h->bad, 0u);
}

/* none of these frames can be put together */
static void sim_app_eoe_fault_breaks_frames(struct kunit *test)
{
	static const struct {
		const char *text;
		u16 data;
		u32 bad;	/* fragments refused, at least */
	} faults[] = {
		{ "eoe s lost", 400, 1 }, { "eoe s lost", 10, 0 }, { "eoe s offset", 400, 1 },
		{ "eoe s number", 400, 1 }, { "eoe s number", 10, 1 }, { "eoe s endless", 400, 1 },
		{ "eoe s endless", 10, 1 },
	};
	struct host *h = host_new(test, SLAVE, 128);

	for (u32 i = 0; i < ARRAY_SIZE(faults); i++) {
		struct seen s = ping_with(test, h, faults[i].text, faults[i].data);

		KUNIT_EXPECT_EQ_MSG(test, s.frames, 0u, "%s", faults[i].text);
		KUNIT_EXPECT_GE_MSG(test, h->bad, faults[i].bad, "%s", faults[i].text);
		good(test, h);
	}
}

static void sim_app_eoe_fault_sizes_lie(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	u8 p[200];
	u32 pongs = 0;

	fault(test, h, "eoe s size");
	listen(h, 10, 0);
	for (u32 i = 0; i < 6; i++) {	/* 0, 32, 2016 bytes: only the last one is enough */
		KUNIT_EXPECT_TRUE(test, host_send(h, p, host_ping(h, p, 100)));
		pongs += listen(h, 10, 100).pongs;
	}
	KUNIT_EXPECT_EQ(test, pongs, 2u);
	good(test, h);
}

/* every= leaves the others as they are */
static void sim_app_eoe_fault_concerns_each_nth_frame(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	u8 p[500];
	u32 pongs = 0;

	fault(test, h, "eoe s lost every=5");
	listen(h, 10, 0);
	for (u32 i = 0; i < 20; i++) {
		KUNIT_EXPECT_TRUE(test, host_send(h, p, host_ping(h, p, 400)));
		pongs += listen(h, 10, 400).pongs;
	}
	KUNIT_EXPECT_EQ(test, pongs, 16u);
	good(test, h);
}

/* the fragments of two frames alternate; with one place for all both are lost */
static void sim_app_eoe_fault_interleaves_frames(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	struct ec_eoe_part one = { 0 };
	u8 p[EC_EOE_FRAME_MAX], *data = kunit_kzalloc(test, EC_EOE_FRAME_MAX, GFP_KERNEL);
	u32 changes = 0, bad = 0;
	int last = -1;
	struct seen s;

	KUNIT_ASSERT_NOT_NULL(test, data);
	s = ping_with(test, h, "eoe s interleave", 400);
	KUNIT_EXPECT_EQ(test, s.pongs, 1u);
	KUNIT_EXPECT_EQ(test, s.frames, 2u);
	KUNIT_EXPECT_EQ(test, h->bad, 0u);
	KUNIT_EXPECT_TRUE(test, host_send(h, p, host_ping(h, p, 400)));
	for (u32 i = 0; i < 20; i++) {
		struct ec_eoe_fragment f;
		struct ec_mbox_hdr hdr;
		int len = app_recv(h->b, &h->m, &hdr, 1);

		if (len < 0 || ec_eoe_fragment_decode(h->m.rx + 6, (size_t)len, &f))
			continue;
		changes += last >= 0 && f.frame != last;
		last = f.frame;
		bad += ec_eoe_part_add(&one, data, EC_EOE_FRAME_MAX, &f) < 0;
	}
	KUNIT_EXPECT_GE(test, changes, 4u);
	KUNIT_EXPECT_GE(test, bad, 4u);
	good(test, h);
}

/* also where the last fragment fills the mailbox */
static void sim_app_eoe_fault_appends_time_stamps(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);

	for (u16 data = 60; data < 240; data++) {
		struct seen s = ping_with(test, h, "eoe s stamp", data);

		KUNIT_ASSERT_EQ_MSG(test, s.pongs, 1u, "%u bytes", data);
	}
	KUNIT_EXPECT_EQ(test, h->bad, 0u);
	KUNIT_EXPECT_EQ(test, h->stamped, 2 * 180u);
	good(test, h);
	KUNIT_EXPECT_EQ(test, h->stamped, 2 * 180u);
}

static void sim_app_eoe_fault_omits_padding(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	u8 p[60];

	fault(test, h, "eoe s short");
	listen(h, 10, 0);
	KUNIT_EXPECT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_EXPECT_EQ(test, listen(h, 5, 0).shorter, 1u);
	good(test, h);
	KUNIT_EXPECT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_EXPECT_EQ(test, listen(h, 5, 0).shorter, 0u);
}

/* the bus remains usable: SDOs and answers take their turn */
static void sim_app_eoe_fault_floods(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	struct ec_mbox_hdr hdr;
	struct seen s;
	u32 coe = 0;

	fault(test, h, "eoe s flood");
	s = listen(h, 50, 0);
	KUNIT_EXPECT_GT(test, s.noise, 50u);
	KUNIT_EXPECT_EQ(test, s.noise, s.frames);
	KUNIT_EXPECT_TRUE(test, host_pings(h, 400, 50));
	/* upload of 0x1000 */
	memcpy(h->m.tx + EC_MBOX_HDR, "\0\x20\x40\0\x10\0\0\0\0\0", 10);
	KUNIT_ASSERT_EQ(test, app_send(h->b, &h->m, EC_MBOX_COE, 10), 1);
	for (u32 i = 0; i < 3; i++)
		coe += app_recv(h->b, &h->m, &hdr, 1) == 10 && hdr.type == EC_MBOX_COE;
	KUNIT_EXPECT_EQ(test, coe, 1u);
	good(test, h);
}

static void sim_app_eoe_fault_sends_forbidden_frames(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	struct seen s = ping_with(test, h, "eoe s ethercat", 100);

	KUNIT_EXPECT_EQ(test, s.pongs, 1u);
	KUNIT_EXPECT_EQ(test, s.ethercat, 1u);
	good(test, h);
	/* one without a request: when the fault begins */
	fault(test, h, "eoe s ethercat");
	KUNIT_EXPECT_EQ(test, listen(h, 5, 0).ethercat, 1u);
	good(test, h);
	s = ping_with(test, h, "eoe s udp", 100);
	KUNIT_EXPECT_EQ(test, s.pongs, 1u);
	KUNIT_EXPECT_EQ(test, s.udp, 1u);
	good(test, h);
	fault(test, h, "eoe s spoof");
	KUNIT_EXPECT_EQ(test, listen(h, 5, 0).from_host, 1u);
	good(test, h);
	KUNIT_EXPECT_EQ(test, listen(h, 5, 0).from_host, 0u);
}

/* Each third frame is lost, for an error reply. */
static void sim_app_eoe_fault_refuses_frames(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);
	u8 p[100];
	u32 pongs = 0;

	fault(test, h, "eoe s refuse every=3");
	listen(h, 10, 0);
	h->bad = 0;
	for (u32 i = 0; i < 9; i++) {
		KUNIT_EXPECT_TRUE(test, host_send(h, p, host_ping(h, p, 50)));
		pongs += listen(h, 20, 50).pongs;
	}
	KUNIT_EXPECT_EQ(test, pongs, 6u);
	KUNIT_EXPECT_EQ(test, h->bad, 3u);
	good(test, h);
}

/* A flood is no endless loop where each message is lost. */
static void sim_app_eoe_fault_ends_where_messages_are_lost(struct kunit *test)
{
	struct host *h = host_new(test, SLAVE, 128);

	fault(test, h, "mailbox s lost");
	fault(test, h, "eoe s flood");
	KUNIT_EXPECT_EQ(test, listen(h, 20, 0).frames, 0u);
	fault(test, h, "eoe s endless");
	KUNIT_EXPECT_EQ(test, listen(h, 20, 0).frames, 0u);
	fault(test, h, "mailbox s good");
	listen(h, 20, 0);
	good(test, h);
}

static void sim_app_eoe_fault_needs_ethernet(struct kunit *test)
{
	struct bed *b = app_bed(test, "slave s drive\n");
	struct ec_sim_error err = { 0 };
	struct ec_sim_fault f;

	KUNIT_EXPECT_EQ(test, ec_sim_command(b->sim, &bed_ops, "eoe s lost", 10, &f, &err),
			-EINVAL);
	KUNIT_EXPECT_STREQ(test, err.text, "the slave has no Ethernet; add eoe=host or eoe=switch to it");
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_eoe_fault_breaks_frames),
	KUNIT_CASE(sim_app_eoe_fault_sizes_lie),
	KUNIT_CASE(sim_app_eoe_fault_concerns_each_nth_frame),
	KUNIT_CASE(sim_app_eoe_fault_interleaves_frames),
	KUNIT_CASE(sim_app_eoe_fault_appends_time_stamps),
	KUNIT_CASE(sim_app_eoe_fault_omits_padding),
	KUNIT_CASE(sim_app_eoe_fault_floods),
	KUNIT_CASE(sim_app_eoe_fault_sends_forbidden_frames),
	KUNIT_CASE(sim_app_eoe_fault_refuses_frames),
	KUNIT_CASE(sim_app_eoe_fault_ends_where_messages_are_lost),
	KUNIT_CASE(sim_app_eoe_fault_needs_ethernet),
	{ }
};

static struct kunit_suite suite = {
	.name = "sim_app_eoe_fault",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
