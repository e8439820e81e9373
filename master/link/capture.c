// SPDX-License-Identifier: GPL-2.0-only
/*
 * eccapN: a network interface that carries copies of every frame of master N,
 * for tcpdump and the like. Virtual and native devices have no interface of
 * their own.
 */
#include <linux/etherdevice.h>
#include <linux/module.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include <linux/skbuff.h>
#include "capture.h"
#include "links.h"
#include "../base/log.h"
#include "../base/once64.h"

bool ec_capture;
module_param_named(capture, ec_capture, bool, 0444);
MODULE_PARM_DESC(capture, "1: an interface eccap<N> per master shows its frames to tcpdump");

/**
 * ec_capture_sent() - a frame has been sent
 * @c: interface, NULL: none
 * @frame: from its destination address
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 * Return: false when a program wants the frame and the ring is full.
 */
bool ec_capture_sent(struct ec_capture *c, const u8 *frame, size_t len)
{
	return !c || ec_tap_sent(&c->tap, frame, len);
}

/**
 * ec_capture_received() - a frame has been received
 * @c: interface, NULL: none
 * @src: its source address
 * @data: what follows the EtherType
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 * Return: false when a program wants the frame and the ring is full.
 */
bool ec_capture_received(struct ec_capture *c, const u8 *src, const u8 *data, size_t len)
{
	return ec_tap_received(&c->tap, src, data, len);
}

/* Only capture programs take these frames. */
static rx_handler_result_t swallow(struct sk_buff **pskb)
{
	consume_skb(*pskb);
	return RX_HANDLER_CONSUMED;
}

static int capture_init(struct net_device *nd)
{
	return netdev_rx_handler_register(nd, swallow, NULL);
}

static void capture_uninit(struct net_device *nd)
{
	netdev_rx_handler_unregister(nd);
}

/* Nothing is ever sent here: not even what the protocol stack would like to. */
static netdev_tx_t capture_xmit(struct sk_buff *skb, struct net_device *nd)
{
	dev_kfree_skb_any(skb);
	return NETDEV_TX_OK;
}

static void capture_stats(struct net_device *nd, struct rtnl_link_stats64 *stats)
{
	const struct ec_capture *c = netdev_priv(nd);

	stats->rx_packets = ec_read64(&c->tap.shown);
	stats->rx_bytes = ec_read64(&c->tap.bytes);
	stats->rx_dropped = ec_read64(&c->tap.dropped);
}

static const struct net_device_ops capture_ops = {
	.ndo_init = capture_init,
	.ndo_uninit = capture_uninit,
	.ndo_start_xmit = capture_xmit,
	.ndo_get_stats64 = capture_stats,
};

static void setup(struct net_device *nd)
{
	ether_setup(nd);
	nd->netdev_ops = &capture_ops;
	nd->flags = IFF_NOARP;
	nd->priv_flags |= IFF_NO_QUEUE;
	nd->priv_flags &= ~IFF_TX_SKB_SHARING;
	eth_hw_addr_random(nd);
}

/**
 * ec_capture_create() - create the interface of a master, if the parameter is set
 * @l: links
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0, -ENOMEM, or -EEXIST when an interface has this name already.
 */
int ec_capture_create(struct ec_links *l)
{
	struct net_device *nd;
	struct ec_capture *c;
	char name[IFNAMSIZ];
	int ret;

	if (!ec_capture)
		return 0;
	snprintf(name, sizeof(name), "eccap%u", l->base->index);
	nd = alloc_netdev(sizeof(*c), name, NET_NAME_ENUM, setup);
	if (!nd)
		return -ENOMEM;
	c = netdev_priv(nd);
	c->nd = nd;
	ret = ec_tap_init(&c->tap, nd) ?: register_netdev(nd);
	if (ret) {
		ec_err(l, "cannot make the interface %s (%pe)\n", name, ERR_PTR(ret));
		ec_tap_exit(&c->tap);
		free_netdev(nd);
		return ret;
	}
	l->capture = c;
	return 0;
}

/**
 * ec_capture_destroy() - remove the interface of a master
 * @l: links, without devices
 *
 * Context: Process. May sleep, takes RTNL.
 */
void ec_capture_destroy(struct ec_links *l)
{
	struct ec_capture *c = l->capture;

	if (!c)
		return;
	l->capture = NULL;
	/* before the interface, to which its worker may be delivering a frame */
	ec_tap_exit(&c->tap);
	unregister_netdev(c->nd);
	free_netdev(c->nd);
}

/**
 * ec_capture_is() - is @name this interface?
 * @c: interface, NULL: none
 * @name: name of a network interface
 *
 * Context: Any.
 * Return: true, then no master may use it as its device.
 */
bool ec_capture_is(const struct ec_capture *c, const char *name)
{
	return c && !strcmp(c->nd->name, name);
}
