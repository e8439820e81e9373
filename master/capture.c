// SPDX-License-Identifier: GPL-2.0-only
/*
 * eccapN: a network interface that carries copies of every frame of master N,
 * for tcpdump and the like. Virtual and native devices have no interface of
 * their own. The cycle only copies into a ring, and only while somebody
 * captures; a worker does the rest.
 */
#include <linux/etherdevice.h>
#include <linux/module.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include <linux/skbuff.h>
#include <linux/vmalloc.h>
#include "capture.h"
#include "master.h"
#include "wire/frame.h"

#define RING	1024	/* frames; power of 2 */

static bool capture;
module_param(capture, bool, 0444);
MODULE_PARM_DESC(capture, "1: an interface eccap<N> per master shows its frames to tcpdump");

/**
 * struct captured - one frame in the ring
 * @at: when it was sent or received
 * @out: sent
 * @len: bytes of @data
 * @data: the frame from its destination address
 */
struct captured {
	ktime_t at;
	bool out;
	u16 len;
	u8 data[EC_ETH_MAX];
};

/**
 * struct ec_capture - private part of the interface
 * @nd: the interface
 * @lock: protects @head and the counter of frames that did not fit
 * @head: next to be filled, by whoever sends or receives
 * @tail: next to be shown, by the worker
 * @work: shows what is in the ring
 * @ring: frames
 */
struct ec_capture {
	struct net_device *nd;
	raw_spinlock_t lock;
	unsigned int head;
	unsigned int tail;
	struct delayed_work work;
	struct captured *ring;
};

static bool wanted(const struct ec_capture *c)
{
	return netif_running(c->nd) && dev_nit_active(c->nd);
}

/* the next free place; with the lock held, until publish() */
static struct captured *reserve(struct ec_capture *c, bool out)
{
	struct captured *f = &c->ring[c->head % RING];

	if (c->head - smp_load_acquire(&c->tail) == RING) {
		c->nd->stats.rx_dropped++;
		return NULL;
	}
	f->at = ktime_get_real();
	f->out = out;
	return f;
}

static void publish(struct ec_capture *c)
{
	smp_store_release(&c->head, c->head + 1);
	/* one tick: several frames for one wake-up */
	schedule_delayed_work(&c->work, 1);
}

/**
 * ec_capture_sent() - a frame has been sent
 * @c: interface, NULL: none
 * @frame: from its destination address
 * @len: bytes there
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_capture_sent(struct ec_capture *c, const u8 *frame, size_t len)
{
	struct captured *f;
	unsigned long flags;

	if (!c || !wanted(c) || len > EC_ETH_MAX)
		return;
	raw_spin_lock_irqsave(&c->lock, flags);
	f = reserve(c, true);
	if (f) {
		memcpy(f->data, frame, len);
		f->len = len;
		publish(c);
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
}

/**
 * ec_capture_received() - a frame has been received
 * @c: interface, NULL: none
 * @src: its source address
 * @data: what follows the EtherType
 * @len: bytes there
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_capture_received(struct ec_capture *c, const u8 *src, const u8 *data, size_t len)
{
	struct captured *f;
	unsigned long flags;

	if (!c || !wanted(c) || len > EC_ETH_MAX - EC_ETH_HDR)
		return;
	raw_spin_lock_irqsave(&c->lock, flags);
	f = reserve(c, false);
	if (f) {
		eth_broadcast_addr(f->data);
		ether_addr_copy(f->data + ETH_ALEN, src);
		put_unaligned_be16(EC_ETHERTYPE, f->data + 2 * ETH_ALEN);
		memcpy(f->data + EC_ETH_HDR, data, len);
		f->len = EC_ETH_HDR + len;
		publish(c);
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
}

static void show(struct ec_capture *c, const struct captured *f)
{
	struct sk_buff *skb = netdev_alloc_skb(c->nd, f->len);

	if (!skb) {
		c->nd->stats.rx_errors++;
		return;
	}
	skb_put_data(skb, f->data, f->len);
	skb->protocol = eth_type_trans(skb, c->nd);
	skb->pkt_type = f->out ? PACKET_OUTGOING : PACKET_HOST;
	skb->tstamp = f->at;
	c->nd->stats.rx_packets++;
	c->nd->stats.rx_bytes += f->len;
	local_bh_disable();
	netif_receive_skb(skb);
	local_bh_enable();
}

static void worker(struct work_struct *w)
{
	struct ec_capture *c = container_of(to_delayed_work(w), struct ec_capture, work);

	while (c->tail != smp_load_acquire(&c->head)) {
		show(c, &c->ring[c->tail % RING]);
		smp_store_release(&c->tail, c->tail + 1);
	}
}

/* After the capture programs nobody else wants these frames. */
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

static const struct net_device_ops capture_ops = {
	.ndo_init = capture_init,
	.ndo_uninit = capture_uninit,
	.ndo_start_xmit = capture_xmit,
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
 * ec_capture_create() - make the interface of a master, if that is asked for
 * @m: master
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: 0, -ENOMEM, or -EEXIST when there is such an interface.
 */
int ec_capture_create(struct ec_master *m)
{
	struct net_device *nd;
	struct ec_capture *c;
	char name[IFNAMSIZ];
	int ret;

	if (!capture)
		return 0;
	snprintf(name, sizeof(name), "eccap%u", m->index);
	nd = alloc_netdev(sizeof(*c), name, NET_NAME_ENUM, setup);
	if (!nd)
		return -ENOMEM;
	c = netdev_priv(nd);
	c->nd = nd;
	raw_spin_lock_init(&c->lock);
	INIT_DELAYED_WORK(&c->work, worker);
	c->ring = vzalloc(array_size(RING, sizeof(*c->ring)));
	ret = c->ring ? register_netdev(nd) : -ENOMEM;
	if (ret) {
		vfree(c->ring);
		free_netdev(nd);
		return ret;
	}
	m->capture = c;
	return 0;
}

/**
 * ec_capture_destroy() - remove the interface of a master
 * @m: master, without devices
 *
 * Context: Process. May sleep, takes RTNL.
 */
void ec_capture_destroy(struct ec_master *m)
{
	struct ec_capture *c = m->capture;

	if (!c)
		return;
	m->capture = NULL;
	cancel_delayed_work_sync(&c->work);
	unregister_netdev(c->nd);
	vfree(c->ring);
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
