// SPDX-License-Identifier: GPL-2.0-only
/* Simulated slaves: a switch behind EoE whose Ethernet port ends outside of the model. */
#include "sim_app_eoe_host.h"

#define SWITCH	"slave s EL6614 eoe=switch response=300us\n"

static void sim_app_eoe_port_passes_frames(struct kunit *test)
{
	struct host *h = host_new(test, SWITCH, 1024);
	u8 p[EC_EOE_FRAME_MAX], *out = kunit_kzalloc(test, EC_EOE_FRAME_MAX, GFP_KERNEL);
	const u8 *frame;
	u64 from;

	KUNIT_ASSERT_NOT_NULL(test, out);
	KUNIT_ASSERT_TRUE(test, ec_app_eoe_has_port(h->app));
	KUNIT_EXPECT_EQ(test, ec_app_eoe_leave(h->app, out), 0);
	for (u16 len = 14; len <= EC_EOE_FRAME_MAX; len = (u16)(len + 188)) {
		for (u32 i = 0; i < len; i++)
			p[i] = (u8)(i + len);
		KUNIT_ASSERT_TRUE(test, host_send(h, p, len));
		KUNIT_ASSERT_EQ(test, ec_app_eoe_leave(h->app, out), len);
		KUNIT_EXPECT_FALSE(test, memcmp(out, p, len));
		from = h->b->now;
		ec_app_eoe_enter(h->app, p, len, from);
		KUNIT_ASSERT_EQ(test, host_recv(h, &frame, 20), max_t(int, len, 60));
		KUNIT_EXPECT_GE(test, h->b->now - from, 300000ull);
		KUNIT_EXPECT_FALSE(test, memcmp(frame, p, len));
	}
	/* it has no IP of its own */
	KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	KUNIT_EXPECT_EQ(test, host_recv(h, &frame, 5), 0);
}

static void sim_app_eoe_port_queues_are_bounded(struct kunit *test)
{
	struct host *h = host_new(test, SWITCH, 1024);
	u8 p[60], out[EC_EOE_FRAME_MAX];
	const u8 *frame;
	u32 n = 0;

	for (u32 i = 0; i < 40; i++)
		KUNIT_ASSERT_TRUE(test, host_send(h, p, host_arp(p, slave_ip)));
	while (ec_app_eoe_leave(h->app, out))
		n++;
	KUNIT_EXPECT_EQ(test, n, (u32)EC_APP_EOE_QUEUE);
	KUNIT_EXPECT_EQ(test, h->app->eoe->dropped, 40u - EC_APP_EOE_QUEUE);
	for (n = 0; ec_app_eoe_takes(h->app); n++)
		ec_app_eoe_enter(h->app, p, sizeof(p), h->b->now);
	KUNIT_EXPECT_EQ(test, n, (u32)EC_APP_EOE_QUEUE);
	ec_app_eoe_enter(h->app, p, sizeof(p), h->b->now);
	for (n = 0; host_recv(h, &frame, 3); n++)
		;
	KUNIT_EXPECT_EQ(test, n, (u32)EC_APP_EOE_QUEUE);
	KUNIT_EXPECT_TRUE(test, ec_app_eoe_takes(h->app));
}

/* too long, too short, or no mailbox: nothing comes */
static void sim_app_eoe_port_drops_wrong_frames(struct kunit *test)
{
	struct host *h = host_new(test, SWITCH, 1024);
	u8 p[60] = { 0 };

	ec_app_eoe_enter(h->app, p, 13, h->b->now);
	ec_app_eoe_enter(h->app, p, EC_EOE_FRAME_MAX + 1, h->b->now);
	KUNIT_EXPECT_EQ(test, h->app->eoe->n, 0);
	KUNIT_ASSERT_TRUE(test, host_send(h, p, sizeof(p)));
	KUNIT_ASSERT_EQ(test, app_al(h->b, STATION(0), EC_AL_INIT, 5), (u32)EC_AL_INIT);
	ec_app_eoe_enter(h->app, p, sizeof(p), h->b->now);
	KUNIT_EXPECT_EQ(test, h->app->eoe->n, 0);
	KUNIT_ASSERT_EQ(test, app_al(h->b, STATION(0), EC_AL_PREOP, 5), (u32)EC_AL_PREOP);
	KUNIT_EXPECT_EQ(test, h->app->eoe->port->n, 0);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(sim_app_eoe_port_passes_frames),
	KUNIT_CASE(sim_app_eoe_port_queues_are_bounded),
	KUNIT_CASE(sim_app_eoe_port_drops_wrong_frames),
	{ }
};

static struct kunit_suite suite = {
	.name = "sim_app_eoe_port",
	.exit = bed_exit,
	.test_cases = cases,
};
kunit_test_suite(suite);
