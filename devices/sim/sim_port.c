// SPDX-License-Identifier: GPL-2.0-only
/*
 * The computer at the Ethernet port of a simulated switch (eoe=switch) is this one: what a network
 * device of the host sends enters the port, what leaves the port is received. It polls the port, as
 * ethercat-sim does.
 */
#include <linux/err.h>
#include <linux/etherdevice.h>
#include <linux/hrtimer.h>
#include <linux/netdevice.h>
#include "eoe.h"
#include "master/kernel/compat.h"
#include "sim_port.h"

#define POLL_NS	(NSEC_PER_MSEC / 2)

/**
 * struct port - private part of a network device
 * @list: in ports
 * @nd: network device
 * @w: segment
 * @app: slave
 * @timer: polls while the device is up
 * @buf: of the timer: a frame that leaves the port
 */
struct port {
	struct list_head list;
	struct net_device *nd;
	struct ec_sim_wire *w;
	struct ec_app *app;
	struct hrtimer timer;
	u8 buf[EC_EOE_FRAME_MAX];
};

/* made and removed with the module */
static LIST_HEAD(ports);

static void port_deliver(struct port *p, u16 len)
{
	struct sk_buff *skb = netdev_alloc_skb_ip_align(p->nd, len);

	if (!skb) {
		p->nd->stats.rx_dropped++;
		return;
	}
	skb_put_data(skb, p->buf, len);
	skb->protocol = eth_type_trans(skb, p->nd);
	p->nd->stats.rx_packets++;
	p->nd->stats.rx_bytes += len;
	netif_rx(skb);
}

static enum hrtimer_restart port_poll(struct hrtimer *timer)
{
	struct port *p = container_of(timer, struct port, timer);
	u16 len;

	/* not more than the port keeps: a flood of the master would hold the CPU */
	for (unsigned int i = 0; i < EC_APP_EOE_QUEUE; i++) {
		len = ec_sim_wire_leave(p->w, p->app, p->buf);
		if (!len)
			break;
		port_deliver(p, len);
	}
	if (netif_queue_stopped(p->nd) && ec_sim_wire_takes(p->w, p->app))
		netif_wake_queue(p->nd);
	hrtimer_forward_now(timer, ns_to_ktime(POLL_NS));
	return HRTIMER_RESTART;
}

static int port_open(struct net_device *nd)
{
	struct port *p = netdev_priv(nd);

	netif_start_queue(nd);
	hrtimer_start(&p->timer, ns_to_ktime(POLL_NS), HRTIMER_MODE_REL_SOFT);
	return 0;
}

static int port_stop(struct net_device *nd)
{
	struct port *p = netdev_priv(nd);

	netif_stop_queue(nd);
	hrtimer_cancel(&p->timer);
	return 0;
}

static netdev_tx_t port_xmit(struct sk_buff *skb, struct net_device *nd)
{
	struct port *p = netdev_priv(nd);

	if (skb->len > EC_EOE_FRAME_MAX || skb_linearize(skb)) {
		nd->stats.tx_dropped++;
		dev_kfree_skb_any(skb);
		return NETDEV_TX_OK;
	}
	/* the timer wakes it */
	if (!ec_sim_wire_enter(p->w, p->app, skb->data, skb->len)) {
		netif_stop_queue(nd);
		return NETDEV_TX_BUSY;
	}
	nd->stats.tx_packets++;
	nd->stats.tx_bytes += skb->len;
	dev_consume_skb_any(skb);
	return NETDEV_TX_OK;
}

static const struct net_device_ops port_ops = {
	.ndo_open = port_open,
	.ndo_stop = port_stop,
	.ndo_start_xmit = port_xmit,
	.ndo_set_mac_address = eth_mac_addr,
	.ndo_validate_addr = eth_validate_addr,
};

static void port_setup(struct net_device *nd)
{
	ether_setup(nd);
	nd->netdev_ops = &port_ops;
	nd->max_mtu = ETH_DATA_LEN;
	nd->priv_flags &= ~IFF_TX_SKB_SHARING;
}

/**
 * ec_sim_port_add() - make the network device at the port of a slave; it is down
 * @name: of the segment
 * @w: the segment; must stay until ec_sim_port_exit()
 * @index: slave, below ec_sim_count()
 *
 * It is called NAME-SLAVE, NAME-pINDEX where that is no name of a device.
 *
 * Context: Process. Takes rtnl.
 * Return: 0, also for a slave without such a port; -errno.
 */
int ec_sim_port_add(const char *name, struct ec_sim_wire *w, u32 index)
{
	struct ec_app *app = ec_app_of(ec_sim_at(w->sim, index));
	char full[EC_APP_NAME + IFNAMSIZ];
	struct net_device *nd;
	struct port *p;
	int ret;

	if (!ec_app_eoe_has_port(app))
		return 0;
	snprintf(full, sizeof(full), "%s-%s", name, app->name);
	if (!dev_valid_name(full) || strchr(full, '%'))
		snprintf(full, sizeof(full), "%.8s-p%u", name, index);
	nd = alloc_netdev(sizeof(*p), full, NET_NAME_PREDICTABLE, port_setup);
	if (!nd)
		return -ENOMEM;
	p = netdev_priv(nd);
	p->nd = nd;
	p->w = w;
	p->app = app;
	hrtimer_setup(&p->timer, port_poll, CLOCK_MONOTONIC, HRTIMER_MODE_REL_SOFT);
	eth_hw_addr_random(nd);
	ret = register_netdev(nd);
	if (ret) {
		free_netdev(nd);
		return ret;
	}
	list_add(&p->list, &ports);
	return 0;
}

/**
 * ec_sim_port_exit() - remove all
 *
 * Context: Process. Takes rtnl.
 */
void ec_sim_port_exit(void)
{
	struct port *p, *next;

	list_for_each_entry_safe(p, next, &ports, list) {
		list_del(&p->list);
		unregister_netdev(p->nd);
		free_netdev(p->nd);
	}
}
