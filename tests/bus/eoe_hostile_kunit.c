// SPDX-License-Identifier: GPL-2.0-only
/*
 * Slaves that send wrong or forbidden Ethernet frames, or too many of them: nothing of it disturbs
 * others, nor remains when the slave works again.
 */
#include <linux/etherdevice.h>
#include <linux/rtnetlink.h>
#include "eoe_wire.h"
#include "talk.h"
#include "master/mailbox/soe.h"

#define SLAVE	"slave a drive in=8 out=8 serial=4\n" \
		"slave web drive serial=5 alias=5 mbox=256 foe=64 soe=1 eoe=host\n"
#define SEGMENT	"segment seed=5 response=100us transition=1ms\n" SLAVE
#define WEB	1
#define LIMIT_MS	20	/* of a request */

static struct eoe_wire *w;

static struct bus *hostile_up(struct kunit *test, const char *text, u32 slaves, const char *name)
{
	w = eoe_up(test, text, slaves, name);
	return w->b;
}

static void fault(struct bus *b, const char *kind)
{
	char text[60];

	snprintf(text, sizeof(text), "fault eoe web %s", kind);
	bus_command(b, text);
}

static struct ec_eoe_counts counts(void)
{
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	struct ec_eoe_counts c;

	ec_eoe_port_counts(&d->port, &c);
	return c;
}

/* It may take as long as a mailbox that had failed is tried again. Older answers come first. */
static bool works_again(struct kunit *test, const u8 *mac)
{
	const u32 len = 1400;
	u32 i;

	w->len = 0;
	for (i = 0; i < 60 && w->len != ETH_HLEN + 28 + len; i++) {
		eoe_send_ping(w, mac, len);
		msleep(200);
	}
	return netif_carrier_ok(w->nd) && eoe_ping(w, mac, len);
}

/* us that the longest of @n uploads of a serial number takes; ~0: one failed */
static u64 uploads(struct bus *b, u32 position, u32 n, u32 serial)
{
	struct talk *t = talk_new(b, position, LIMIT_MS);
	u64 longest = 0;

	while (n--) {
		u64 t0 = ktime_get_ns();

		if (talk_upload(t, 0x1018, 4, false) || get_unaligned_le32(t->data) != serial)
			longest = ~0ull;
		longest = max(longest, div_u64(ktime_get_ns() - t0, NSEC_PER_USEC));
	}
	kunit_kfree(b->test, t);
	return longest;
}

static void hostile_boot_gets_no_frame(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	struct talk *t = talk_new(b, WEB, 100);
	u8 mac[ETH_ALEN];
	u64 sent;
	u32 i;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < EC_EOE_FRAMES; i++)
		eoe_send_ping(w, mac, 1400);
	bus_request(b, WEB, EC_AL_BOOT);
	KUNIT_ASSERT_NE(test, bus_wait_al(b, WEB, EC_AL_BOOT, 500), ~0ull);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, false));
	sent = counts().tx_fragments;
	for (i = 0; i < 10; i++)
		eoe_send_ping(w, mac, 1400);
	KUNIT_EXPECT_EQ(test, talk_put(t, "data", 1000), 0);
	msleep(500);
	KUNIT_EXPECT_EQ(test, counts().tx_fragments, sent);
	KUNIT_EXPECT_FALSE(test, netif_carrier_ok(w->nd));
	bus_request(b, WEB, EC_AL_PREOP);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, true));
	KUNIT_EXPECT_TRUE(test, works_again(test, mac));
	eoe_down(w);
}

/* Each refused fragment costs its frame; the others pass, the carrier stays. */
static void hostile_refusal_costs_one_frame(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	u32 i, answers = 0, lines, changes;
	u8 mac[ETH_ALEN];
	u64 refused;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	changes = atomic_read(&w->nd->carrier_up_count);
	lines = bus_log_lines("refuses Ethernet frames");
	fault(b, "refuse every=3");
	refused = counts().refused;
	for (i = 0; i < 9; i++)
		answers += !!eoe_ping(w, mac, 1400);
	KUNIT_EXPECT_EQ(test, answers, 6u);
	KUNIT_EXPECT_EQ(test, counts().refused, refused + 3);
	fault(b, "refuse");
	KUNIT_EXPECT_EQ(test, eoe_ping(w, mac, 1400), 0ull);
	/* an error reply to a fragment is none to a request */
	for (i = 0; i < 20; i++) {
		eoe_send_ping(w, mac, 1400);
		KUNIT_EXPECT_NE(test, uploads(b, WEB, 1, 5), ~0ull);
	}
	msleep(500);
	/* some are taken for late ones of requests */
	KUNIT_EXPECT_GE(test, counts().refused, refused + 3 + 15);
	fault(b, "good");
	KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 1400), 0ull);
	KUNIT_EXPECT_EQ(test, atomic_read(&w->nd->carrier_up_count), changes);
	KUNIT_EXPECT_EQ(test, bus_log_lines("refuses Ethernet frames"), lines + 1);
	eoe_down(w);
}

/* A message that is no mailbox message costs itself, no other frame, and not the carrier. */
static void hostile_malformed_costs_one_message(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	u8 mac[ETH_ALEN];
	u32 i, changes;
	u64 before;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	changes = atomic_read(&w->nd->carrier_down_count);
	before = counts().rx_errors;
	for (i = 1; i <= 5; i++) {
		bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, EC_SIM_MAILBOX_LENGTH, 0);
		KUNIT_EXPECT_EQ(test, eoe_ping(w, mac, 100), 0ull);
		KUNIT_EXPECT_EQ(test, counts().rx_errors, before + i);
		bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, EC_SIM_MAILBOX_GOOD, 0);
		KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 1400), 0ull);
	}
	/* one that is no answer to a frame either: nothing was sent */
	fault(b, "flood");
	bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, EC_SIM_MAILBOX_LENGTH, 0);
	KUNIT_EXPECT_NE(test, uploads(b, 0, 1, 4), ~0ull);
	msleep(100);
	fault(b, "good");
	bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, EC_SIM_MAILBOX_GOOD, 0);
	msleep(100);
	KUNIT_EXPECT_GT(test, counts().rx_errors, before + 5);
	KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 1400), 0ull);
	KUNIT_EXPECT_EQ(test, atomic_read(&w->nd->carrier_down_count), changes);
	eoe_down(w);
}

/* A slave whose application hangs takes no message: its device has no carrier until it does. */
static void hostile_hung_slave_has_no_carrier(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	bus_command(b, "fault mute web");
	eoe_send_ping(w, mac, 100);
	eoe_send_ping(w, mac, 100);
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, false));
	bus_command(b, "fault unmute web");
	KUNIT_EXPECT_TRUE(test, eoe_await_carrier(w->nd, true));
	KUNIT_EXPECT_TRUE(test, works_again(test, mac));
	eoe_down(w);
}

/* Requests to a slave that floods, and to another one, get through; so do frames to it. */
static void hostile_flood_leaves_room(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u64 quiet[2], flooded[2], t0, frames;
	struct ec_eoe_counts c;
	u8 mac[ETH_ALEN];
	u32 i;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < 2; i++)
		quiet[i] = uploads(b, i, 50, 4 + i);
	fault(b, "flood");
	msleep(100);
	frames = d->rx_packets;
	t0 = ktime_get_ns();
	for (i = 0; i < 2; i++)
		flooded[i] = uploads(b, i, 50, 4 + i);
	KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 100), 0ull);
	msleep(1000);
	frames = d->rx_packets - frames;
	t0 = ktime_get_ns() - t0;
	c = counts();
	bus_figure("beside a flood of %llu frames/s an upload of another slave takes at most %llu us (%llu without), one of the slave itself %llu (%llu)",
		   div64_u64(frames * NSEC_PER_SEC, t0), flooded[0], quiet[0], flooded[1],
		   quiet[1]);
	KUNIT_EXPECT_GT(test, frames, 100ull);
	KUNIT_EXPECT_LE(test, flooded[0], 2 * quiet[0]);
	KUNIT_EXPECT_LE(test, flooded[1], (u64)LIMIT_MS * USEC_PER_MSEC / 2);
	/* no more is kept than what waits */
	KUNIT_EXPECT_LE(test, ec_eoe_port_waiting(&d->port), (u32)EC_EOE_FRAMES);
	KUNIT_EXPECT_EQ(test, c.rx_dropped, 0ull);
	fault(b, "good");
	KUNIT_EXPECT_TRUE(test, works_again(test, mac));
	eoe_down(w);
}

/* The begin of a UDP frame with a header of EtherCAT. */
static void send_udp(u16 header_word)
{
	u8 f[64] = { 0 }, *ip = f + eoe_header(w, f, eoe_all, ETH_P_IP);

	ip[0] = 0x45;
	put_unaligned_be16(46, ip + 2);
	ip[9] = 17;
	put_unaligned_be16(EC_ETHERTYPE, ip + 22);
	put_unaligned_be16(26, ip + 24);
	put_unaligned_le16(header_word, ip + 28);
	eoe_send(w, f, sizeof(f));
}

/* EtherCAT in UDP passes in neither direction; a mailbox gateway's does. */
static void hostile_ethercat_in_udp_is_dropped(struct kunit *test)
{
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(w->nd);
	u32 i, others;
	u8 mac[ETH_ALEN];
	u64 refused;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	send_udp(0x100e);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 1ull);
	send_udp(0x500e);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 1ull);
	msleep(50);
	refused = d->rx_refused;
	others = w->others;
	fault(b, "udp");
	for (i = 0; i < 3; i++)
		KUNIT_EXPECT_NE(test, eoe_ping(w, mac, 100), 0ull);
	msleep(50);
	KUNIT_EXPECT_GE(test, d->rx_refused, refused + 3);
	KUNIT_EXPECT_EQ(test, w->others, others);
	for (i = 0; i < 2; i++)
		KUNIT_EXPECT_EQ(test, bus_slave(b, i)->al.status, EC_AL_PREOP);
	eoe_down(w);
}

/* What it does with its frames is of no use against requests. */
static void hostile_frames_disturb_no_request(struct kunit *test)
{
	static const char *const kinds[] = {
		"interleave", "stamp", "short", "lost", "offset", "number", "endless", "size",
		"flood", "spoof", "ethercat", "udp", "refuse",
	};
	struct bus *b = hostile_up(test, SEGMENT, 2, "eoe0a5");
	u64 longest = 0;
	u8 mac[ETH_ALEN];
	u32 i, k;

	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		fault(b, kinds[i]);
		for (k = 0; k < 20; k++) {
			u64 us;

			eoe_send_ping(w, mac, 700);
			us = uploads(b, WEB, 1, 5);
			KUNIT_EXPECT_NE_MSG(test, us, ~0ull, "%s", kinds[i]);
			longest = max(longest, us);
		}
		fault(b, "good");
		msleep(100);
		KUNIT_EXPECT_NE_MSG(test, eoe_ping(w, mac, 1400), 0ull, "after %s", kinds[i]);
	}
	bus_figure("beside wrong Ethernet frames an upload of the slave takes at most %llu us",
		   longest);
	KUNIT_EXPECT_EQ(test, w->ethercat, 0u);
	eoe_down(w);
}

/* Any answer in the mailbox, to frames and to requests of all protocols. */
static void hostile_calls(struct talk *t, const u8 *mac)
{
	u16 error;

	t->limit.timeout_ms = LIMIT_MS;
	eoe_send_ping(w, mac, 1400);
	talk_upload(t, 0x1018, 4, false);
	talk_upload(t, 0x2000, 0, false);
	eoe_send_ping(w, mac, 10);
	talk_put(t, "data", 200);
	talk_get(t, "data");
	eoe_send_ping(w, mac, 300);
	ec_soe_read(&t->s->mbox, 0, 17, t->data, sizeof(t->data), &t->got, &error, &t->limit);
	ec_soe_write(&t->s->mbox, 0, 47, t->data, 4, &error, &t->limit);
}

static void hostile_mailbox(struct kunit *test, u32 seed, u32 kind)
{
	char *text = kunit_kzalloc(test, 300, GFP_KERNEL);
	u8 mac[ETH_ALEN];
	struct talk *t;
	struct bus *b;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(test, text);
	scnprintf(text, 300, "segment seed=%u response=100us transition=1ms\n" SLAVE, seed);
	b = hostile_up(test, text, 2, "eoe0a5");
	t = talk_new(b, WEB, LIMIT_MS);
	KUNIT_ASSERT_TRUE(test, eoe_ask_address(w, mac));
	/* its own part in it */
	fault(b, seed & 1 ? "endless every=2" : "size every=2");
	bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, kind, 0);
	for (i = 0; i < 10; i++)
		hostile_calls(t, mac);
	KUNIT_EXPECT_NE(test, uploads(b, 0, 3, 4), ~0ull);
	bus_fault(b, EC_SIM_FAULT_MAILBOX, WEB, 0, EC_SIM_MAILBOX_GOOD, 0);
	fault(b, "good");
	KUNIT_EXPECT_TRUE_MSG(test, works_again(test, mac), "kind %u, seed %u", kind, seed);
	t->limit.timeout_ms = 100;
	talk_upload(t, 0x1018, 4, false);	/* what is left is thrown away */
	KUNIT_EXPECT_EQ(test, talk_upload(t, 0x1018, 4, false), 0);
	eoe_down(w);
	bus_down(b);
	test->priv = NULL;
	kunit_kfree(test, t);
	kunit_kfree(test, text);
}

static void hostile_mailbox_recovers(struct kunit *test)
{
	static const u8 kinds[] = {
		EC_SIM_MAILBOX_GARBAGE, EC_SIM_MAILBOX_ALMOST, EC_SIM_MAILBOX_LENGTH,
		EC_SIM_MAILBOX_SHORT, EC_SIM_MAILBOX_COUNTER, EC_SIM_MAILBOX_BABBLE,
		EC_SIM_MAILBOX_ERROR, EC_SIM_MAILBOX_DUPLICATE, EC_SIM_MAILBOX_LOST,
		EC_SIM_MAILBOX_GARBAGE, EC_SIM_MAILBOX_ALMOST,
	};
	u32 i;

	for (i = 0; i < ARRAY_SIZE(kinds); i++)
		hostile_mailbox(test, i + 1, kinds[i]);
}

/* A long holder of RTNL delays only the removal itself. */
static void hostile_rtnl_delays_no_wish(struct kunit *test)
{
	struct bus *b = bus_up(test, "segment seed=5\nslave x EL6614 serial=1\n"
			       "slave y EL6614 serial=2\n", 2);
	u64 t0;

	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	eoe_await(test, "eoe0n1", true);
	eoe_await(test, "eoe0n2", true);
	rtnl_lock();
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(bus_eoe(b), bus_slave(b, 0)->device, EC_EOE_WISH_OFF), 0);
	msleep(300);		/* the work waits for RTNL */
	t0 = ktime_get_ns();
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(bus_eoe(b), bus_slave(b, 1)->device, EC_EOE_WISH_OFF), 0);
	KUNIT_EXPECT_LE(test, ktime_get_ns() - t0, (u64)NSEC_PER_MSEC);
	KUNIT_EXPECT_NOT_NULL(test, eoe_find("eoe0n1"));
	rtnl_unlock();
	eoe_await(test, "eoe0n1", false);
	eoe_await(test, "eoe0n2", false);
	ec_eoe_stop(bus_eoe(b));
}

/* Several slaves are lost at once: each device gets its own back, those that are down go. */
static void hostile_loss_of_many_mixes_no_device(struct kunit *test)
{
	static const char *const names[] = { "eoe0a7", "eoe0n8", "eoe0s3", "eoe0s4", "eoe0s5" };
	struct bus *b = bus_up(test, "segment seed=5\nslave a drive\n"
			       "slave p EL6614 alias=7 serial=9\n"
			       "slave q EL6614 serial=8\nslave r EL6614\nslave s EL6614 serial=9\n"
			       "slave t EL6614\n", 6);
	struct net_device *nds[ARRAY_SIZE(names)];
	u32 i;

	ec_eoe_start(bus_eoe(b), bus_table(b), NULL, true);
	for (i = 0; i < ARRAY_SIZE(names); i++) {
		nds[i] = eoe_await(test, names[i], true);
		KUNIT_ASSERT_NOT_NULL(test, nds[i]);
		if (i < 4)
			eoe_set_up(nds[i], true);
	}
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_TRUE_MSG(test, eoe_await_carrier(nds[i], true), "%s", names[i]);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	for (i = 0; i < 4; i++)
		KUNIT_EXPECT_TRUE_MSG(test, eoe_await_carrier(nds[i], false), "%s", names[i]);
	eoe_await(test, names[4], false);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	for (i = 0; i < 4; i++) {
		KUNIT_EXPECT_TRUE_MSG(test, eoe_await_carrier(nds[i], true), "%s", names[i]);
		KUNIT_EXPECT_PTR_EQ(test, eoe_find(names[i]), nds[i]);
		KUNIT_EXPECT_EQ(test, ((struct ec_eoe_netdev *)netdev_priv(nds[i]))->id.position,
				i + 1);
	}
	eoe_await(test, names[4], true);
	ec_eoe_stop(bus_eoe(b));
	for (i = 0; i < ARRAY_SIZE(names); i++)
		KUNIT_EXPECT_NULL_MSG(test, eoe_find(names[i]), "%s", names[i]);
}

static struct kunit_case cases[] = {
	KUNIT_CASE(hostile_boot_gets_no_frame),
	KUNIT_CASE(hostile_refusal_costs_one_frame),
	KUNIT_CASE(hostile_malformed_costs_one_message),
	KUNIT_CASE(hostile_hung_slave_has_no_carrier),
	KUNIT_CASE(hostile_flood_leaves_room),
	KUNIT_CASE(hostile_ethercat_in_udp_is_dropped),
	KUNIT_CASE(hostile_frames_disturb_no_request),
	KUNIT_CASE(hostile_mailbox_recovers),
	KUNIT_CASE(hostile_rtnl_delays_no_wish),
	KUNIT_CASE(hostile_loss_of_many_mixes_no_device),
	{ }
};

static struct kunit_suite suite = {
	.name = "bus_eoe_hostile", .exit = bus_exit, .test_cases = cases,
};
kunit_test_suite(suite);
