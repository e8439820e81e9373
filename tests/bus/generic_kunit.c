// SPDX-License-Identifier: GPL-2.0-only
/* The generic device on a network device that gives every result there is for a frame. */
#include <linux/etherdevice.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include "bus.h"
#include "master/boundary/ioctl.h"
#include "master/link/device.h"

/* private part of the network device */
struct fake {
	int result;
	u32 frames;
	u32 resets;	/* for another MTU */
	u32 refused;	/* to come up, -EIO with @broken */
	bool broken;
};

static netdev_tx_t fake_xmit(struct sk_buff *skb, struct net_device *nd)
{
	struct fake *o = netdev_priv(nd);

	o->frames++;
	if (o->result != NETDEV_TX_BUSY)
		consume_skb(skb);
	return o->result;
}

static int fake_open(struct net_device *nd)
{
	struct fake *o = netdev_priv(nd);

	if (!o->broken)
		return 0;
	o->refused++;
	return -EIO;
}

static int fake_change_mtu(struct net_device *nd, int mtu)
{
	struct fake *o = netdev_priv(nd);

	o->resets++;
	nd->mtu = mtu;
	return 0;
}

static const struct net_device_ops fake_ops = {
	.ndo_start_xmit = fake_xmit,
	.ndo_open = fake_open,
	.ndo_change_mtu = fake_change_mtu,
};

static void fake_setup(struct net_device *nd)
{
	ether_setup(nd);
	nd->netdev_ops = &fake_ops;
	nd->max_mtu = ETH_MAX_MTU;
	eth_hw_addr_random(nd);
}

static struct net_device *fake_alloc(struct bus *b, const char *name)
{
	struct net_device *nd = alloc_netdev(sizeof(struct fake), name, NET_NAME_USER,
					     fake_setup);
	struct fake *o;

	KUNIT_ASSERT_NOT_NULL(b->test, nd);
	o = netdev_priv(nd);
	o->result = NETDEV_TX_OK;
	return nd;
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
	return bus_frames(b);
}

static u64 errors(const struct bus *b)
{
	return bus_tx_errors(b);
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
	struct net_device *nd = fake_alloc(b, "bus0");
	u32 i;

	KUNIT_ASSERT_EQ(b->test, register_netdev(nd), 0);
	for (i = 0; i < 100 && !bus_dev(b); i++)
		msleep(1);
	KUNIT_EXPECT_NOT_NULL(b->test, bus_dev(b));
	return nd;
}

static void fake_free(struct bus *b, struct net_device *nd)
{
	unregister_netdev(nd);
	KUNIT_EXPECT_NULL(b->test, bus_dev(b));
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
	const struct ecdev *dev = bus_dev(b);
	unsigned int rival;

	rename_to(test, nd, "lan7");
	msleep(100);
	KUNIT_EXPECT_PTR_EQ(test, (const struct ecdev *)bus_dev(b), dev);
	KUNIT_EXPECT_STREQ(test, dev->name, "lan7");
	KUNIT_EXPECT_EQ(test, ec_device_release(bus_links(b), EC_MAIN, "lan7", &rival), -EEXIST);
	fake_free(b, nd);
}

/* The main device is released for a while, in which the generic driver withdraws it. */
static void generic_main_device_back_after_backup_use(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_new(b);
	struct ec_ioc_device_use use = { .flags = EC_DEVICE_FLAG_BACKUP, .name = "eth7" };

	KUNIT_EXPECT_EQ(test, ec_ioc(&b->app, EC_IOC_DEVICE_USE, &use), -ENODEV);
	KUNIT_ASSERT_NOT_NULL(test, (const struct ecdev *)bus_dev(b));
	KUNIT_EXPECT_STREQ(test, bus_dev(b)->name, nd->name);
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

static int set_mtu(struct net_device *nd, int mtu)
{
	int ret;

	rtnl_lock();
	ret = dev_set_mtu(nd, mtu);
	rtnl_unlock();
	return ret;
}

/* The driver would reset itself first, also that of a device below. */
static void generic_mtu_in_cycle_refused_before_driver(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_new(b), *low = fake_alloc(b, "low0");
	struct fake *o = netdev_priv(nd), *below = netdev_priv(low);

	KUNIT_ASSERT_EQ(test, register_netdev(low), 0);
	rtnl_lock();
	KUNIT_EXPECT_EQ(test, netdev_upper_dev_link(low, nd, NULL), 0);
	rtnl_unlock();
	ec_access_change(bus_links(b), EC_ACCESS_CYCLIC);
	KUNIT_EXPECT_EQ(test, set_mtu(nd, 600), -EBUSY);
	KUNIT_EXPECT_EQ(test, set_mtu(nd, 2000), -EBUSY);
	KUNIT_EXPECT_EQ(test, set_mtu(low, 600), -EBUSY);
	KUNIT_EXPECT_EQ(test, o->resets + below->resets, 0u);
	KUNIT_EXPECT_EQ(test, nd->mtu, (u32)ETH_DATA_LEN);
	ec_access_change(bus_links(b), EC_ACCESS_DIRECT);
	KUNIT_EXPECT_EQ(test, set_mtu(nd, 2000), 0);
	KUNIT_EXPECT_EQ(test, set_mtu(low, 600), 0);
	KUNIT_EXPECT_EQ(test, set_mtu(nd, 600), -EBUSY);
	KUNIT_EXPECT_EQ(test, nd->mtu, 2000u);
	rtnl_lock();
	netdev_upper_dev_unlink(low, nd);
	rtnl_unlock();
	unregister_netdev(low);
	free_netdev(low);
	fake_free(b, nd);
}

/* Each look for a device tries to bring up the one that is wanted. */
static void generic_change_in_foreign_namespace_ignored(struct kunit *test)
{
	struct bus *b = bus_new(test, "slave a EK1100\n");
	struct net_device *nd = fake_alloc(b, "bus0"), *other = fake_alloc(b, "other0");
	struct net *net = copy_net_ns(CLONE_NEWNET, &init_user_ns, &init_net);
	struct fake *o = netdev_priv(nd);
	u32 refused;

	KUNIT_ASSERT_FALSE(test, IS_ERR(net));
	o->broken = true;
	KUNIT_ASSERT_EQ(test, register_netdev(nd), 0);
	msleep(100);
	refused = o->refused;
	KUNIT_EXPECT_GE(test, refused, 1u);
	dev_net_set(other, net);
	KUNIT_ASSERT_EQ(test, register_netdev(other), 0);
	rtnl_lock();
	KUNIT_EXPECT_EQ(test, dev_open(other, NULL), 0);
	rtnl_unlock();
	KUNIT_EXPECT_EQ(test, set_mtu(other, 600), 0);
	msleep(100);
	KUNIT_EXPECT_EQ(test, o->refused, refused);
	unregister_netdev(other);
	free_netdev(other);
	put_net(net);
	/* a change in its own one is a reason to look */
	KUNIT_EXPECT_EQ(test, set_mtu(nd, 2000), 0);
	msleep(100);
	KUNIT_EXPECT_GT(test, o->refused, refused);
	unregister_netdev(nd);
	free_netdev(nd);
}

static struct kunit_case cases[] = {
	KUNIT_CASE_PARAM(generic_result_of_frame, result_gen_params),
	KUNIT_CASE(generic_rename_shown),
	KUNIT_CASE(generic_main_device_back_after_backup_use),
	KUNIT_CASE(generic_full_queue_not_captured),
	KUNIT_CASE(generic_mtu_in_cycle_refused_before_driver),
	KUNIT_CASE(generic_change_in_foreign_namespace_ignored),
	{ }
};

static struct kunit_suite suite = { .name = "bus_generic", .exit = bus_exit, .test_cases = cases };
kunit_test_suite(suite);
