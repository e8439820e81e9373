// SPDX-License-Identifier: GPL-2.0-only
/* The generic device on a network device that gives every result there is for a frame. */
#include <linux/etherdevice.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include "bus.h"
#include "master/link/device.h"

/* private part of the network device */
struct fake {
	int result;
	u32 frames;
};

static netdev_tx_t fake_xmit(struct sk_buff *skb, struct net_device *nd)
{
	struct fake *o = netdev_priv(nd);

	o->frames++;
	if (o->result != NETDEV_TX_BUSY)
		consume_skb(skb);
	return o->result;
}

static const struct net_device_ops fake_ops = { .ndo_start_xmit = fake_xmit };

static void fake_setup(struct net_device *nd)
{
	ether_setup(nd);
	nd->netdev_ops = &fake_ops;
	eth_hw_addr_random(nd);
}

/* what a device says of a frame, and what the frame is then */
static const struct result {
	const char *name;
	int result;
	enum { SENT, WAITS, ERROR } want;
} results[] = {
	{ "sent", NETDEV_TX_OK, SENT },
	{ "sent, congestion near", NET_XMIT_CN, SENT },
	{ "dropped below", NET_XMIT_DROP, WAITS },
	{ "ring full", NETDEV_TX_BUSY, WAITS },
	{ "queue full below", -ENOBUFS, WAITS },
	{ "device below is down", -ENETDOWN, ERROR },
	{ "no memory", -ENOMEM, ERROR },
};

static void result_desc(const struct result *r, char *desc)
{
	strscpy(desc, r->name, KUNIT_PARAM_DESC_SIZE);
}

KUNIT_ARRAY_PARAM(result, results, result_desc);

static u64 sent(const struct bus *b)
{
	return atomic64_read(&b->m->links.link[0].stats.tx_frames);
}

static u64 errors(const struct bus *b)
{
	return atomic64_read(&b->m->links.link[0].stats.tx_errors);
}

static void expect_result(struct bus *b, struct fake *o, const struct result *r)
{
	u64 before = sent(b), bad = errors(b);
	u32 frames = o->frames;

	o->result = r->result;
	msleep(500);
	if (r->want == SENT)
		KUNIT_EXPECT_GE(b->test, sent(b), before + 10);
	else
		KUNIT_EXPECT_LE(b->test, sent(b), before + 1);
	if (r->want == ERROR)
		KUNIT_EXPECT_GE(b->test, errors(b), bad + 10);
	else
		KUNIT_EXPECT_EQ(b->test, errors(b), bad);
	/* one that waits is tried again all the time */
	KUNIT_EXPECT_GE(b->test, o->frames, frames + (r->want == WAITS ? 1000 : 10));
	/* a frame waits for a second, then the device hangs */
	msleep(1000);
	KUNIT_EXPECT_EQ(b->test, errors(b) > bad, r->want != SENT);
}

/* the network device that the master waits for */
static struct net_device *fake_new(struct bus *b)
{
	struct net_device *nd = alloc_netdev(sizeof(struct fake), "bus0", NET_NAME_USER,
					     fake_setup);
	struct fake *o;
	u32 i;

	KUNIT_ASSERT_NOT_NULL(b->test, nd);
	o = netdev_priv(nd);
	o->result = NETDEV_TX_OK;
	KUNIT_ASSERT_EQ(b->test, register_netdev(nd), 0);
	for (i = 0; i < 100 && !READ_ONCE(b->m->links.link[0].dev); i++)
		msleep(1);
	KUNIT_EXPECT_NOT_NULL(b->test, b->m->links.link[0].dev);
	return nd;
}

static void fake_free(struct bus *b, struct net_device *nd)
{
	unregister_netdev(nd);
	KUNIT_EXPECT_NULL(b->test, b->m->links.link[0].dev);
	free_netdev(nd);
}

static void generic_result_of_frame(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_new(b);

	msleep(100);
	expect_result(b, netdev_priv(nd), test->param_value);
	fake_free(b, nd);
}

static void rename_to(struct kunit *test, struct net_device *nd, const char *name)
{
	struct ifreq r = {};
	bool copy;

	strscpy(r.ifr_name, nd->name, sizeof(r.ifr_name));
	strscpy(r.ifr_newname, name, sizeof(r.ifr_newname));
	/* some kernels refuse while it is up */
	rtnl_lock();
	dev_close(nd);
	rtnl_unlock();
	KUNIT_EXPECT_EQ(test, dev_ioctl(&init_net, SIOCSIFNAME, &r, NULL, &copy), 0);
	rtnl_lock();
	KUNIT_EXPECT_EQ(test, dev_open(nd, NULL), 0);
	rtnl_unlock();
}

/* What commands show, and what a rival is recognized by; its master keeps it. */
static void generic_rename_shown(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_new(b);
	const struct ecdev *dev = b->m->links.link[0].dev;
	unsigned int rival;

	rename_to(test, nd, "lan7");
	msleep(100);
	KUNIT_EXPECT_PTR_EQ(test, (const struct ecdev *)b->m->links.link[0].dev, dev);
	KUNIT_EXPECT_STREQ(test, dev->name, "lan7");
	KUNIT_EXPECT_EQ(test, ec_device_release(&b->m->links, "lan7", &rival), -EEXIST);
	fake_free(b, nd);
}

/* a capture program at the network device */
struct program {
	struct packet_type pt;
	u32 sent;
};

static int get(struct sk_buff *skb, struct net_device *nd, struct packet_type *pt,
	       struct net_device *orig)
{
	struct program *p = container_of(pt, struct program, pt);

	p->sent += skb->pkt_type == PACKET_OUTGOING;
	consume_skb(skb);
	return NET_RX_SUCCESS;
}

static void generic_full_queue_not_captured(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_new(b);
	struct program p = { .pt = { .type = htons(ETH_P_ALL), .dev = nd, .func = get } };
	u32 shown;

	dev_add_pack(&p.pt);
	msleep(500);
	KUNIT_EXPECT_GE(test, p.sent, 10u);
	netif_stop_queue(nd);
	msleep(10);
	shown = p.sent;
	/* what waits is tried again all the time */
	msleep(500);
	KUNIT_EXPECT_EQ(test, p.sent, shown);
	netif_wake_queue(nd);
	msleep(100);
	KUNIT_EXPECT_GT(test, p.sent, shown);
	dev_remove_pack(&p.pt);
	fake_free(b, nd);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(generic_result_of_frame, result_gen_params),
	KUNIT_CASE(generic_rename_shown),
	KUNIT_CASE(generic_full_queue_not_captured),
	{ }
};

static struct kunit_suite suite = { .name = "bus_generic", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
