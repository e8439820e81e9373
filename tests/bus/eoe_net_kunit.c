// SPDX-License-Identifier: GPL-2.0-only
/* Network devices of slaves with EoE: frames of the host to the IP stack of a slave, and back. */
#include <linux/etherdevice.h>
#include <linux/if_arp.h>
#include <linux/if_vlan.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include "bus.h"
#include "devices/sim/app.h"
#include "master/eoe/netdev.h"
#include "master/mailbox/coe.h"
#include "master/mailbox/eoe.h"

#define SEGMENT	"segment seed=5 response=100us\nslave a drive in=8 out=8\n" \
		"slave web EL6614 alias=5 eoe=host\n"

static const u8 slave_ip[4] = { 10, 1, 0, 2 }, host_ip[4] = { 10, 1, 0, 1 };

/* frames that came from the device */
static struct wire {
	struct packet_type type;
	struct net_device *nd;
	u8 last[EC_EOE_FRAME_MAX];
	u32 len;
	u32 frames;
	u32 others;	/* not to the host alone */
	u32 ethercat;
} wire;

static int take(struct sk_buff *skb, struct net_device *nd, struct packet_type *type,
		struct net_device *orig)
{
	struct wire *n = container_of(type, struct wire, type);

	/* those that are sent come as well */
	if (nd == n->nd && skb->pkt_type != PACKET_OUTGOING) {
		n->ethercat += skb->protocol == htons(EC_ETHERTYPE);
		skb_push(skb, ETH_HLEN);
		if (!ether_addr_equal(skb->data, nd->dev_addr)) {
			n->others++;
			goto free;
		}
		n->len = min_t(u32, skb->len, sizeof(n->last));
		skb_copy_bits(skb, 0, n->last, n->len);
		WRITE_ONCE(n->frames, n->frames + 1);
	}
free:
	kfree_skb(skb);
	return 0;
}

static struct net_device *find(const char *name)
{
	struct net_device *nd = dev_get_by_name(&init_net, name);

	if (nd)
		dev_put(nd);
	return nd;
}

static struct net_device *await(struct kunit *test, const char *name, bool there)
{
	u32 ms;

	for (ms = 0; !find(name) == there && ms < 5000; ms += 10)
		msleep(10);
	KUNIT_EXPECT_EQ_MSG(test, !!find(name), there, "%s", name);
	return find(name);
}

static void set_up(struct net_device *nd, bool up)
{
	rtnl_lock();
	if (up)
		dev_open(nd, NULL);
	else
		dev_close(nd);
	rtnl_unlock();
}

static bool await_carrier(struct net_device *nd, bool on)
{
	u32 ms;

	for (ms = 0; netif_carrier_ok(nd) != on && ms < 3000; ms += 5)
		msleep(5);
	return netif_carrier_ok(nd) == on;
}

/* The slave has its address, the device is up. */
static struct bus *net_up(struct kunit *test, const char *text, u32 slaves, const char *name)
{
	struct ec_eoe_ip ip = { .which = EC_EOE_IP | EC_EOE_MASK, .mask = { 255, 255, 255, 0 } };
	struct bus *b = bus_up(test, text, slaves);
	u16 result;

	memcpy(ip.ip, slave_ip, 4);
	KUNIT_ASSERT_EQ(test, ec_eoe_set_ip(&bus_slave(b, 1)->mbox, &ip, &result), 0);
	ec_eoe_start(&b->m->eoe, &b->m->bus, NULL, true);
	/* a case that failed has left it */
	if (wire.nd)
		dev_remove_pack(&wire.type);
	wire = (struct wire){
		.type = { .type = htons(ETH_P_ALL), .func = take },
		.nd = await(test, name, true),
	};
	KUNIT_ASSERT_NOT_NULL(test, wire.nd);
	KUNIT_EXPECT_FALSE(test, netif_carrier_ok(wire.nd));
	dev_add_pack(&wire.type);
	set_up(wire.nd, true);
	KUNIT_ASSERT_TRUE(test, await_carrier(wire.nd, true));
	return b;
}

static void net_exit(struct bus *b)
{
	dev_remove_pack(&wire.type);
	wire.nd = NULL;
	ec_eoe_stop(&b->m->eoe);
}

static void send(const u8 *frame, u32 len)
{
	struct sk_buff *skb = alloc_skb(LL_MAX_HEADER + len, GFP_KERNEL);

	skb_reserve(skb, LL_MAX_HEADER);
	skb_put_data(skb, frame, len);
	skb->dev = wire.nd;
	skb_reset_mac_header(skb);
	skb_set_network_header(skb, ETH_HLEN);
	skb->protocol = eth_hdr(skb)->h_proto;
	dev_queue_xmit(skb);
}

static u32 header(u8 *f, const u8 *to, u16 type)
{
	memcpy(f, to, ETH_ALEN);
	memcpy(f + ETH_ALEN, wire.nd->dev_addr, ETH_ALEN);
	put_unaligned_be16(type, f + 2 * ETH_ALEN);
	return ETH_HLEN;
}

static const u8 all[ETH_ALEN] = { 255, 255, 255, 255, 255, 255 };

/* Ask for the address of the slave; false: no answer within a second. */
static bool ask_address(u8 *mac)
{
	u8 f[ETH_HLEN + 28] = { 0 }, *p = f + header(f, all, ETH_P_ARP);
	u32 ms, before = READ_ONCE(wire.frames);

	put_unaligned_be16(ARPHRD_ETHER, p);
	put_unaligned_be16(ETH_P_IP, p + 2);
	p[4] = ETH_ALEN;
	p[5] = 4;
	put_unaligned_be16(ARPOP_REQUEST, p + 6);
	memcpy(p + 8, wire.nd->dev_addr, ETH_ALEN);
	memcpy(p + 14, host_ip, 4);
	memcpy(p + 24, slave_ip, 4);
	send(f, sizeof(f));
	for (ms = 0; READ_ONCE(wire.frames) == before && ms < 1000; ms++)
		msleep(1);
	if (wire.frames == before || get_unaligned_be16(wire.last + 12) != ETH_P_ARP ||
	    memcmp(wire.last + ETH_HLEN + 14, slave_ip, 4))
		return false;
	memcpy(mac, wire.last + ETH_ALEN, ETH_ALEN);
	return true;
}

static u16 checksum(const u8 *p, u32 len)
{
	u32 i, sum = 0;

	for (i = 0; i < len; i += 2)
		sum += p[i] << 8 | (i + 1 < len ? p[i + 1] : 0);
	sum = (sum & 0xffff) + (sum >> 16);
	return ~((sum & 0xffff) + (sum >> 16));
}

/* An ICMP echo request with @len bytes of data. */
static void send_ping(const u8 *mac, u32 len)
{
	u8 *f = kzalloc(EC_EOE_FRAME_MAX, GFP_KERNEL), *ip = f + header(f, mac, ETH_P_IP);
	u8 *icmp = ip + 20;
	u32 i;

	ip[0] = 0x45;
	put_unaligned_be16(28 + len, ip + 2);
	ip[8] = 64;
	ip[9] = 1;
	memcpy(ip + 12, host_ip, 4);
	memcpy(ip + 16, slave_ip, 4);
	put_unaligned_be16(checksum(ip, 20), ip + 10);
	icmp[0] = 8;
	for (i = 0; i < len; i++)
		icmp[8 + i] = i * 7 + len;
	put_unaligned_be16(checksum(icmp, 8 + len), icmp + 2);
	send(f, ETH_HLEN + 28 + len);
	kfree(f);
}

static bool await_frames(u32 n)
{
	u32 us;

	for (us = 0; READ_ONCE(wire.frames) < n && us < 1000000; us += 50)
		usleep_range(50, 50);
	return wire.frames >= n;
}

/* us until the whole answer, 0: none. */
static u64 ping(struct kunit *test, const u8 *mac, u32 len)
{
	u32 i, before = READ_ONCE(wire.frames);
	u64 t0 = ktime_get_ns();

	send_ping(mac, len);
	if (!await_frames(before + 1))
		return 0;
	t0 = ktime_get_ns() - t0;
	KUNIT_EXPECT_EQ(test, wire.len, max_t(u32, ETH_ZLEN, ETH_HLEN + 28 + len));
	KUNIT_EXPECT_EQ(test, wire.last[ETH_HLEN + 20], 0);	/* echo reply */
	for (i = 0; i < len; i++)
		if (wire.last[ETH_HLEN + 28 + i] != (u8)(i * 7 + len))
			break;
	KUNIT_EXPECT_EQ(test, i, len);
	return div_u64(t0, NSEC_PER_USEC);
}

static void net_ping(struct kunit *test)
{
	static const u32 sizes[] = { 0, 1, 31, 32, 33, 100, 500, 1000, 1471, 1472 };
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	u8 mac[ETH_ALEN];
	u32 i;

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	for (i = 0; i < ARRAY_SIZE(sizes); i++)
		KUNIT_EXPECT_NE_MSG(test, ping(test, mac, sizes[i]), 0ull, "%u", sizes[i]);
	net_exit(b);
}

/*
 * Requests while fragments wait: no answer is taken for a frame, no frame for an answer, none is
 * lost.
 */
static void net_beside_requests(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	struct ec_slave *s = bus_slave(b, 1);
	u32 i, k, before, between = 0;
	struct ec_eoe_counts c, c2;
	u8 mac[ETH_ALEN];
	struct ec_eoe_ip ip;
	u16 result;

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	before = wire.frames;
	for (i = 0; i < 20; i++) {
		for (k = 0; k < 8; k++)
			send_ping(mac, 1400);
		ec_eoe_port_counts(&d->port, &c);
		KUNIT_EXPECT_EQ(test, ec_eoe_get_ip(&s->mbox, &ip, &result), 0);
		KUNIT_EXPECT_MEMEQ(test, ip.ip, slave_ip, 4);
		ec_eoe_port_counts(&d->port, &c2);
		between += c2.tx_fragments + c2.rx_fragments - c.tx_fragments - c.rx_fragments;
		KUNIT_EXPECT_TRUE(test, await_frames(before + 8 * (i + 1)));
	}
	KUNIT_EXPECT_GT(test, between, 20u);
	ec_eoe_port_counts(&d->port, &c);
	KUNIT_EXPECT_EQ(test, c.rx_errors + c.rx_missed, 0ull);
	net_exit(b);
}

/* More frames than may wait: the queue stops, and wakes when frames have left. */
static void net_queue_stops(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	struct ec_eoe_counts c;
	u8 mac[ETH_ALEN];
	u32 i;

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	for (i = 0; i < 3 * EC_EOE_FRAMES; i++)
		send_ping(mac, 10);
	KUNIT_EXPECT_TRUE(test, netif_queue_stopped(wire.nd));
	msleep(500);
	KUNIT_EXPECT_FALSE(test, netif_queue_stopped(wire.nd));
	/* the slave has less room for answers than the device for frames, but none is lost there */
	ec_eoe_port_counts(&d->port, &c);
	KUNIT_EXPECT_EQ(test, c.tx_frames, 1ull + 3 * EC_EOE_FRAMES);
	KUNIT_EXPECT_EQ(test, c.tx_dropped + d->tx_unsent, 0ull);
	KUNIT_EXPECT_NE(test, ping(test, mac, 10), 0ull);
	net_exit(b);
}

/* A frame that is redirected to the device may have any length. */
static void net_long_frames_are_dropped(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	u8 *f = kunit_kzalloc(test, 3000, GFP_KERNEL), mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	header(f, mac, ETH_P_IP);
	send(f, EC_EOE_FRAME_MAX + 1);
	send(f, 2100);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 2ull);
	KUNIT_EXPECT_NE(test, ping(test, mac, 1472), 0ull);
	net_exit(b);
}

/* The wish moves with a slave that has a new device number after a power cycle. */
static void net_wish_stays(struct kunit *test)
{
	struct bus *b = bus_up(test, SEGMENT, 2);
	struct net_device *nd;

	ec_eoe_start(&b->m->eoe, &b->m->bus, NULL, false);
	msleep(200);
	KUNIT_EXPECT_NULL(test, find("eoe0a5"));
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(&b->m->eoe, bus_slave(b, 1)->device, EC_EOE_WISH_ON), 0);
	nd = await(test, "eoe0a5", true);
	KUNIT_ASSERT_NOT_NULL(test, nd);
	set_up(nd, true);
	KUNIT_EXPECT_TRUE(test, await_carrier(nd, true));
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, await_carrier(nd, false));
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, await_carrier(nd, true));
	KUNIT_EXPECT_PTR_EQ(test, find("eoe0a5"), nd);
	KUNIT_EXPECT_EQ(test, ec_eoe_wish(&b->m->eoe, bus_slave(b, 1)->device, EC_EOE_WISH_OFF), 0);
	await(test, "eoe0a5", false);
	ec_eoe_stop(&b->m->eoe);
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
	ec_eoe_start(&b->m->eoe, &b->m->bus, NULL, true);
	await(test, last, true);
	await(test, "eoe0s0", true);
	await(test, "eoe0s1", true);
	ec_eoe_stop(&b->m->eoe);
	unregister_netdev(taken);
	free_netdev(taken);
}

/* The device stays while it is up, without a carrier; the slave finds it again. */
static void net_lost(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct net_device *nd = wire.nd;
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, await_carrier(nd, false));
	bus_wait(b, 1, 0, 3000);
	msleep(500);
	KUNIT_EXPECT_PTR_EQ(test, find("eoe0a5"), nd);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	KUNIT_EXPECT_TRUE(test, await_carrier(nd, true));
	KUNIT_EXPECT_PTR_EQ(test, find("eoe0a5"), nd);
	net_exit(b);
}

/* One that is down goes with its slave. */
static void net_lost_and_down(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");

	set_up(wire.nd, false);
	KUNIT_EXPECT_FALSE(test, netif_carrier_ok(wire.nd));
	dev_remove_pack(&wire.type);
	bus_fault(b, EC_SIM_FAULT_POWER_OFF, 1, 0, 0, 0);
	await(test, "eoe0a5", false);
	bus_fault(b, EC_SIM_FAULT_POWER_ON, 1, 0, 0, 0);
	await(test, "eoe0a5", true);
	ec_eoe_stop(&b->m->eoe);
	KUNIT_EXPECT_NULL(test, find("eoe0a5"));
}

static void net_init_and_back(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	bus_request(b, 1, EC_AL_INIT);
	KUNIT_EXPECT_TRUE(test, await_carrier(wire.nd, false));
	bus_request(b, 1, EC_AL_PREOP);
	KUNIT_EXPECT_TRUE(test, await_carrier(wire.nd, true));
	KUNIT_EXPECT_TRUE(test, ask_address(mac));
	net_exit(b);
}

/* EtherCAT frames pass in neither direction, with VLAN tags or without. */
static void net_no_ethercat(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	u8 f[64] = { 0 }, mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	header(f, all, EC_ETHERTYPE);
	send(f, sizeof(f));
	header(f, all, ETH_P_8021Q);
	put_unaligned_be16(EC_ETHERTYPE, f + ETH_HLEN + 2);
	send(f, sizeof(f));
	msleep(50);
	KUNIT_EXPECT_EQ(test, d->tx_unsent, 2ull);
	bus_command(b, "fault eoe web ethercat");
	KUNIT_EXPECT_TRUE(test, ask_address(mac));
	msleep(50);
	KUNIT_EXPECT_GE(test, d->rx_refused, 1ull);
	KUNIT_EXPECT_EQ(test, wire.ethercat, 0u);
	net_exit(b);
}

/* A frame in which something is wrong is lost, and nothing else. */
static void net_faults(struct kunit *test)
{
	static const char *const kinds[] = { "lost", "offset", "number", "endless", "size" };
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	struct ec_eoe_counts c;
	u8 mac[ETH_ALEN];
	char text[40];
	u64 before;
	u32 i;

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	for (i = 0; i < ARRAY_SIZE(kinds); i++) {
		ec_eoe_port_counts(&d->port, &c);
		before = c.rx_errors;
		snprintf(text, sizeof(text), "fault eoe web %s", kinds[i]);
		bus_command(b, text);
		/* the announced size is too large in each third frame: it is an upper limit */
		if (strcmp(kinds[i], "size"))
			KUNIT_EXPECT_EQ_MSG(test, ping(test, mac, 1400), 0ull, "%s", kinds[i]);
		else
			ping(test, mac, 1400);
		bus_command(b, "fault eoe web good");
		KUNIT_EXPECT_NE_MSG(test, ping(test, mac, 1400), 0ull, "after %s", kinds[i]);
		/* what was incomplete counts when it is old */
		msleep(1500);
		ping(test, mac, 10);
		ec_eoe_port_counts(&d->port, &c);
		KUNIT_EXPECT_GT_MSG(test, c.rx_errors, before, "%s", kinds[i]);
	}
	net_exit(b);
}

static void net_spoof(struct kunit *test)
{
	struct bus *b = net_up(test, SEGMENT, 2, "eoe0a5");
	struct ec_eoe_netdev *d = netdev_priv(wire.nd);
	u8 mac[ETH_ALEN];

	KUNIT_ASSERT_TRUE(test, ask_address(mac));
	bus_command(b, "fault eoe web spoof");
	KUNIT_EXPECT_FALSE(test, ask_address(mac));
	KUNIT_EXPECT_GE(test, d->rx_refused, 1ull);
	net_exit(b);
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
	{ }
};

static struct kunit_suite suite = { .name = "bus_eoe_net", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
