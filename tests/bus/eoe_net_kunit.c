// SPDX-License-Identifier: GPL-2.0-only
/* Network devices of slaves with EoE: frames of the host to the IP stack of a slave, and back. */
#include <linux/etherdevice.h>
#include <linux/if_vlan.h>
#include "devices/sim/app.h"
#include "eoe_wire.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/eoe.h"

#define SEGMENT	"segment seed=5 response=100us\nslave a drive in=8 out=8\n" \
		"slave web EL6614 alias=5 eoe=host\n"

static void net_ping(struct kunit *test)
{
	static const u32 sizes[] = { 0, 1, 31, 32, 33, 100, 500, 1000, 1471, 1472 };
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	u8 mac[ETH_ALEN];
	u32 i;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < ARRAY_SIZE(sizes); i++)
		KUNIT_EXPECT_NE_MSG(test, eoe_ping(w, mac, sizes[i]), 0ull, "%u", sizes[i]);
	eoe_down(w);
}

/*
 * Requests while fragments wait: no answer is taken for a frame, no frame for an answer, none is
 * lost.
 */
static void net_beside_requests(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	struct ec_slave *s = bus_slave(b, 1);
	u32 i, k, before, between = 0;
	struct ec_eoe_counts c, c2;
	u8 mac[ETH_ALEN];
	struct ec_eoe_ip ip;
	u16 result;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	before = w->frames;
	for (i = 0; i < 20; i++) {
		for (k = 0; k < 8; k++)
			eoe_send_ping(w, mac, 1400);
		ec_eoe_port_counts(&d->port, &c);
		KUNIT_EXPECT_EQ(test, ec_eoe_get_ip(&s->mbox, &ip, &result), 0);
		KUNIT_EXPECT_MEMEQ(test, ip.ip, eoe_slave_ip, 4);
		ec_eoe_port_counts(&d->port, &c2);
		between += c2.tx_fragments + c2.rx_fragments - c.tx_fragments - c.rx_fragments;
		KUNIT_EXPECT_TRUE(test, eoe_await_frames(w, before + 8 * (i + 1)));
	}
	KUNIT_EXPECT_GT(test, between, 20u);
	ec_eoe_port_counts(&d->port, &c);
	KUNIT_EXPECT_EQ(test, c.rx_errors + c.rx_missed, 0ull);
	eoe_down(w);
}

/* More frames than may wait: the queue stops, and wakes when frames have left. */
static void net_queue_stops(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	struct ec_eoe_counts c;
	u8 mac[ETH_ALEN];
	u32 i;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < 3 * EC_EOE_FRAMES; i++)
		eoe_send_ping(w, mac, 10);
	KUNIT_EXPECT_TRUE(test, netif_queue_stopped(w->nd));
	msleep(500);
	KUNIT_EXPECT_FALSE(test, netif_queue_stopped(w->nd));
	/* the slave has less room for answers than the device for frames, but none is lost there */
	ec_eoe_port_counts(&d->port, &c);
	KUNIT_EXPECT_EQ(test, c.tx_frames, 1ull + 3 * EC_EOE_FRAMES);
	KUNIT_EXPECT_EQ(test, c.tx_dropped + d->tx_unsent, 0ull);
	KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 10), 0ull);
	eoe_down(w);
}

/* A frame that is redirected to the device may have any length. */
static void net_long_frames_are_dropped(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u8 *f = kunit_kzalloc(test, 3000, GFP_KERNEL), mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	eoe_header(w, f, mac, ETH_P_IP);
	eoe_send(w, f, EC_EOE_FRAME_MAX + 1);
	eoe_send(w, f, 2100);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 2ull);
	KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 1472), 0ull);
	eoe_down(w);
}

/* The wish moves with a slave that has a new device number after a power cycle. */
static void net_wish_stays(struct kunit *test)
{
	struct bus *b = bus_up(test, SEGMENT, 2);
	struct net_device *nd;

	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, false);
	msleep(200);
	KUNIT_EXPECT_NULL(test, eoe_find("eoe0a5"));
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(bus_eoe(b), bus_slave(b, 1)->device, EC_EOE_WISH_ON), 0);
	nd = eoe_await(test, "eoe0a5", true);
	KUNIT_ASSERT_NOT_NULL(test, nd);
	eoe_set_up(nd, true);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(nd, true));
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(nd, false));
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(nd, true));
	KUNIT_EXPECT_PTR_EQ(test, eoe_find("eoe0a5"), nd);
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(bus_eoe(b), bus_slave(b, 1)->device, EC_EOE_WISH_OFF), 0);
	eoe_await(test, "eoe0a5", false);
	ec_eoe_stop(bus_eoe(b));
}

/* Twins have names by position; a name that is taken is no reason to have none. */
static void net_names(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=5\nslave a EL6614 alias=5\n"
			       "slave b EL6614 alias=5\nslave c EL6614\n", 3);
	struct net_device *taken = alloc_netdev(0, "eoe0s2", NET_NAME_USER, ether_setup);
	static const struct net_device_ops none;
	char last[IFNAMSIZ];

	KUNIT_ASSERT_NOT_NULL(test, taken);
	taken->netdev_ops = &none;
	KUNIT_ASSERT_EQ(test, register_netdev(taken), 0);
	snprintf(last, sizeof(last), "eoe0d%llu", bus_slave(b, 2)->device);
	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	eoe_await(test, last, true);
	eoe_await(test, "eoe0s0", true);
	eoe_await(test, "eoe0s1", true);
	ec_eoe_stop(bus_eoe(b));
	unregister_netdev(taken);
	free_netdev(taken);
}

/* The device stays while it is up, without a carrier; the slave finds it again. */
static void net_lost(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	struct net_device *nd = w->nd;
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(nd, false));
	bus_wait(b, 1, 0, 3000);
	msleep(500);
	KUNIT_EXPECT_PTR_EQ(test, eoe_find("eoe0a5"), nd);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(nd, true));
	KUNIT_EXPECT_PTR_EQ(test, eoe_find("eoe0a5"), nd);
	eoe_down(w);
}

/* One that is down goes with its slave. */
static void net_lost_and_down(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;

	eoe_set_up(w->nd, false);
	KUNIT_EXPECT_FALSE(test, netif_carrier_ok(w->nd));
	dev_remove_pack(&w->type);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	eoe_await(test, "eoe0a5", false);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	eoe_await(test, "eoe0a5", true);
	ec_eoe_stop(bus_eoe(b));
	KUNIT_EXPECT_NULL(test, eoe_find("eoe0a5"));
}

static void net_init_and_back(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	bus_request(b, 1, EC_AL_INIT);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, false));
	bus_request(b, 1, EC_AL_PREOP);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, true));
	KUNIT_EXPECT_TRUE(test, eoe_ask_address(w, mac));
	eoe_down(w);
}

/* EtherCAT frames pass in neither direction, with VLAN tags or without. */
static void net_no_ethercat(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u8 f[64] = { 0 }, mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	eoe_header(w, f, eoe_all, EC_ETHERTYPE);
	eoe_send(w, f, sizeof(f));
	eoe_header(w, f, eoe_all, ETH_P_8021Q);
	put_unaligned_be16(EC_ETHERTYPE, f + ETH_HLEN + 2);
	eoe_send(w, f, sizeof(f));
	msleep(50);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 2ull);
	bus_command(b, "fault eoe web ethercat");
	KUNIT_EXPECT_TRUE(test, eoe_ask_address(w, mac));
	msleep(50);
	KUNIT_EXPECT_GE(test, d->rx_refused, 1ull);
	KUNIT_EXPECT_EQ(test, w->ethercat, 0u);
	eoe_down(w);
}

/* A frame in which something is wrong is lost, and nothing else. */
static void net_faults(struct kunit *test)
{
	static const char *const kinds[] = { "lost", "offset", "number", "endless", "size" };
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	struct ec_eoe_counts c;
	u8 mac[ETH_ALEN];
	char text[40];
	u64 before;
	u32 i;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		ec_eoe_port_counts(&d->port, &c);
		before = c.rx_errors;
		snprintf(text, sizeof(text), "fault eoe web %s", kinds[i]);
		bus_command(b, text);
		/* the announced size is too large in each third frame: it is an upper limit */
		if (strcmp(kinds[i], "size"))
			KUNIT_EXPECT_EQ_MSG(test, eoe_ping(w, mac, 1400), 0ull, "%s", kinds[i]);
		else
			eoe_ping(w, mac, 1400);
		bus_command(b, "fault eoe web good");
		KUNIT_EXPECT_NE_MSG(test, eoe_ping(w, mac, 1400), 0ull, "after %s", kinds[i]);
		/* what was incomplete counts when it is old */
		msleep(1500);
		eoe_ping(w, mac, 10);
		ec_eoe_port_counts(&d->port, &c);
		KUNIT_EXPECT_GT_MSG(test, c.rx_errors, before, "%s", kinds[i]);
		/* once a frame, however many fragments follow; one without end begins again */
		if (strcmp(kinds[i], "endless"))
			KUNIT_EXPECT_LE_MSG(test, c.rx_errors, before + 2, "%s", kinds[i]);
	}
	eoe_down(w);
}

static void net_spoof(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct bus *b = w->b;
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	bus_command(b, "fault eoe web spoof");
	KUNIT_EXPECT_FALSE(test, eoe_ask_address(w, mac));
	KUNIT_EXPECT_GE(test, d->rx_refused, 1ull);
	eoe_down(w);
}

/* A stream of frames to the slave leaves room for what it answers. */
static void net_answers_beside_stream(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u8 *f = kunit_kzalloc(test, 1400, GFP_KERNEL), mac[ETH_ALEN];
	u32 i, us, before, heard = 0;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	before = w->frames;
	eoe_header(w, f, mac, ETH_P_802_EX1);	/* no answer to it */
	for (i = 0; i < 300 && !heard; i++) {
		for (us = 0; !ec_eoe_port_has_room(&d->port) && us < 100000; us += 10)
			usleep_range(10, 10);
		if (i == 50)
			eoe_send_ping(w, mac, 10);
		else
			eoe_send(w, f, 1400);
		heard = w->frames == before ? 0 : i;
	}
	/* the ping itself waits behind those that were given before */
	KUNIT_EXPECT_GT(test, heard, 50u);
	KUNIT_EXPECT_LT(test, heard, 50u + EC_EOE_FRAMES + 5);
	eoe_down(w);
}

/* The reader of frames is no exchange, so what other slaves send is fetched soon. */
static void net_emergency_of_another(struct kunit *test)
{
	struct eoe_wire *w = eoe_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_app *app = bus_app(w->b, "a");
	u8 mac[ETH_ALEN];
	u32 ms, i, worst = 0;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	bus_idle(w->b);
	for (i = 0; i < 20; i++) {
		/* at any phase; between them a frame of the other slave */
		usleep_range(230000 + i * 13000, 230001 + i * 13000);
		KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 10), 0ull);
		ec_app_emergency(app, 0x3210, 0x04, (u8[5]){ i }, ktime_get_ns());
		for (ms = 0; app->mbox.out_len && ms < 5000; ms++)
			usleep_range(1000, 1001);
		worst = max(worst, ms);
	}
	bus_figure("emergency beside a device that is up: fetched after at most %u ms", worst);
	KUNIT_EXPECT_LE(test, worst, 25u);
	eoe_down(w);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(net_ping),
	KUNIT_CASE(net_beside_requests),
	KUNIT_CASE(net_queue_stops),
	KUNIT_CASE(net_long_frames_are_dropped),
	KUNIT_CASE(net_wish_stays),
	KUNIT_CASE(net_names),
	KUNIT_CASE(net_lost),
	KUNIT_CASE(net_lost_and_down),
	KUNIT_CASE(net_init_and_back),
	KUNIT_CASE(net_no_ethercat),
	KUNIT_CASE(net_faults),
	KUNIT_CASE(net_spoof),
	KUNIT_CASE(net_answers_beside_stream),
	KUNIT_CASE(net_emergency_of_another),
	{ }
};

static struct kunit_suite suite = { .name = "bus_eoe_net", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
