// SPDX-License-Identifier: GPL-2.0-only
/*
 * The simulated segment at network devices: what arrives there goes through
 * the model and back out of them, as if slaves hung at the cable.
 */
#include <linux/etherdevice.h>
#include <linux/if_arp.h>
#include <linux/if_vlan.h>
#include <linux/ktime.h>
#include <linux/netdevice.h>
#include <linux/rtnetlink.h>
#include <linux/skbuff.h>
#include <linux/slab.h>
#include <linux/workqueue.h>
#include <net/net_namespace.h>
#include "describe.h"
#include "sim_responder.h"
#include "sim_wire.h"

/**
 * struct end - where a master port of the segment is
 * @wire: the segment
 * @name: of the network device, immutable
 * @port: number of the master port, immutable
 * @nd: network device with a reference, NULL: waiting for it; under RTNL, and
 *	RCU for senders
 * @tracker: of that reference
 */
struct end {
	struct ec_sim_wire *wire;
	const char *name;
	int port;
	struct net_device __rcu *nd;
	netdevice_tracker tracker;
};

/**
 * struct ec_sim_responder - a segment at network devices
 * @wire: the segment
 * @end: network devices
 * @n: how many
 * @nb: reports when they come and go
 * @work: takes one that has come
 * @leaving: the end is near; under RTNL
 */
struct ec_sim_responder {
	struct ec_sim_wire wire;
	struct end end[EC_SIM_PORTS];
	unsigned int n;
	struct notifier_block nb;
	struct work_struct work;
	bool leaving;
};

/* What the slaves process; anything else is left to the machine. */
static bool is_ethercat(struct sk_buff *skb)
{
	u8 head[EC_SIM_ETH_HEAD];
	size_t len = min_t(size_t, EC_ETH_HDR + skb->len, sizeof(head));

	if (skb->protocol == htons(EC_ETHERTYPE))
		return true;
	return skb->protocol == htons(ETH_P_IP) && !skb_copy_bits(skb, -EC_ETH_HDR, head, len) &&
	       ec_sim_eth_is_ethercat(head, len);
}

/* The network stack takes a VLAN tag out of a frame; slaves see the frame with it. */
static rx_handler_result_t receive(struct sk_buff **pskb)
{
	struct end *e = rcu_dereference((*pskb)->dev->rx_handler_data);
	struct sk_buff *skb;

	if (!is_ethercat(*pskb))
		return RX_HANDLER_PASS;
	skb = skb_share_check(*pskb, GFP_ATOMIC);
	if (!skb)
		return RX_HANDLER_CONSUMED;
	skb_push(skb, EC_ETH_HDR);
	if (skb_vlan_tag_present(skb))
		skb = __vlan_hwaccel_push_inside(skb);
	if (!skb)
		return RX_HANDLER_CONSUMED;
	if (skb->len <= EC_SIM_ETH_MAX && !skb_linearize(skb))
		ec_sim_wire_send(e->wire, e->port, skb->data, skb->len);
	consume_skb(skb);
	return RX_HANDLER_CONSUMED;
}

static void transmit(struct net_device *nd, const u8 *eth, size_t len)
{
	struct sk_buff *skb = alloc_skb(LL_RESERVED_SPACE(nd) + len + nd->needed_tailroom,
					GFP_ATOMIC);

	if (!skb)
		return;		/* lost, as frames are now and then */
	skb_reserve(skb, LL_RESERVED_SPACE(nd));
	skb_put_data(skb, eth, len);
	skb->dev = nd;
	skb_reset_mac_header(skb);
	skb->protocol = eth_hdr(skb)->h_proto;
	skb_set_network_header(skb, EC_ETH_HDR);
	dev_queue_xmit(skb);
}

static void deliver(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	struct ec_sim_responder *r = container_of(w, struct ec_sim_responder, wire);
	struct net_device *nd;

	if (port < 0 || port >= r->n)
		return;
	rcu_read_lock();
	nd = rcu_dereference(r->end[port].nd);
	if (nd)
		transmit(nd, eth, len);
	rcu_read_unlock();
}

static int attach(struct end *e, struct net_device *nd)
{
	int ret;

	ASSERT_RTNL();
	if (nd->type != ARPHRD_ETHER) {
		pr_err_ratelimited("ec_sim: %s is not an Ethernet device\n", e->name);
		return -EINVAL;
	}
	ret = dev_open(nd, NULL);
	if (ret) {
		pr_err_ratelimited("ec_sim: cannot bring up %s (%pe)\n", e->name,
				   ERR_PTR(ret));
		return ret;
	}
	netdev_hold(nd, &e->tracker, GFP_KERNEL);
	rcu_assign_pointer(e->nd, nd);
	ret = netdev_rx_handler_register(nd, receive, e);
	if (ret) {
		pr_err_ratelimited("ec_sim: cannot claim %s (%pe)%s\n", e->name,
				   ERR_PTR(ret),
				   ret == -EBUSY ? ": in use by a master, bridge or bond" : "");
		rcu_assign_pointer(e->nd, NULL);
		synchronize_net();
		netdev_put(nd, &e->tracker);
		return ret;
	}
	pr_info_ratelimited("ec_sim: %u slave(s) at %s\n", ec_sim_count(e->wire->sim), e->name);
	return 0;
}

static void detach(struct end *e)
{
	struct net_device *nd = rtnl_dereference(e->nd);

	if (!nd)
		return;
	netdev_rx_handler_unregister(nd);
	rcu_assign_pointer(e->nd, NULL);
	synchronize_net();
	netdev_put(nd, &e->tracker);
}

/* A device that went away has come again; not in the notifier, see generic.c */
static void look(struct work_struct *work)
{
	struct ec_sim_responder *r = container_of(work, struct ec_sim_responder, work);
	struct net_device *nd;
	unsigned int i;

	rtnl_lock();
	for (i = 0; i < r->n && !r->leaving; i++) {
		if (rtnl_dereference(r->end[i].nd))
			continue;
		nd = __dev_get_by_name(&init_net, r->end[i].name);
		if (nd)
			attach(&r->end[i], nd);
	}
	rtnl_unlock();
}

static int event(struct notifier_block *nb, unsigned long what, void *ptr)
{
	struct ec_sim_responder *r = container_of(nb, struct ec_sim_responder, nb);
	struct net_device *nd = netdev_notifier_info_to_dev(ptr);
	unsigned int i;

	switch (what) {
	case NETDEV_UNREGISTER:
		for (i = 0; i < r->n; i++) {
			if (rtnl_dereference(r->end[i].nd) != nd)
				continue;
			if (!r->leaving)
				pr_info_ratelimited("ec_sim: %s detached, waiting for it\n",
						    r->end[i].name);
			detach(&r->end[i]);
		}
		break;
	case NETDEV_REGISTER:
	case NETDEV_UP:
	case NETDEV_CHANGENAME:
		for (i = 0; i < r->n; i++)
			if (!rtnl_dereference(r->end[i].nd) && !strcmp(nd->name, r->end[i].name))
				schedule_work(&r->work);
		break;
	}
	return NOTIFY_DONE;
}

/* All of them must be there at the start, so that a wrong name shows. */
static int attach_all(struct ec_sim_responder *r)
{
	unsigned int i;
	int ret = 0;

	rtnl_lock();
	for (i = 0; i < r->n && !ret; i++) {
		struct net_device *nd = __dev_get_by_name(&init_net, r->end[i].name);

		if (nd) {
			ret = attach(&r->end[i], nd);
		} else {
			pr_err("ec_sim: no network device '%s'\n", r->end[i].name);
			ret = -ENODEV;
		}
	}
	while (ret && i--)
		detach(&r->end[i]);
	rtnl_unlock();
	return ret;
}

/**
 * ec_sim_responder_create() - let a segment answer at network devices
 * @names: of the devices, for master port 0 and 1; must stay valid
 * @n: how many, 1..EC_SIM_PORTS
 * @sim: segment; belongs to the responder afterwards
 *
 * Context: Process. May sleep, takes RTNL.
 * Return: responder, or ERR_PTR; then @sim still belongs to the caller.
 */
struct ec_sim_responder *ec_sim_responder_create(char *const *names, unsigned int n,
						 struct ec_sim *sim)
{
	struct ec_sim_responder *r = kzalloc(sizeof(*r), GFP_KERNEL);
	unsigned int i;
	int ret;

	if (!r)
		return ERR_PTR(-ENOMEM);
	ret = ec_sim_wire_init(&r->wire, sim, ktime_get_ns(), deliver);
	if (ret)
		goto err_free;
	r->n = n;
	for (i = 0; i < n; i++)
		r->end[i] = (struct end){ .wire = &r->wire, .name = names[i], .port = i };
	INIT_WORK(&r->work, look);
	r->nb.notifier_call = event;
	ec_sim_wire_run(&r->wire, true);
	ret = attach_all(r);
	if (ret)
		goto err_wire;
	ret = register_netdevice_notifier(&r->nb);
	if (ret)
		goto err_detach;
	return r;

err_detach:
	rtnl_lock();
	for (i = 0; i < n; i++)
		detach(&r->end[i]);
	rtnl_unlock();
err_wire:
	ec_sim_wire_exit(&r->wire);
err_free:
	kfree(r);
	return ERR_PTR(ret);
}

/**
 * ec_sim_responder_wire() - segment of a responder
 * @r: responder
 *
 * Context: Any.
 * Return: the segment, in the kernel's time.
 */
struct ec_sim_wire *ec_sim_responder_wire(struct ec_sim_responder *r)
{
	return &r->wire;
}

/**
 * ec_sim_responder_destroy() - stop answering and free the segment
 * @r: responder
 *
 * Context: Process. May sleep, takes RTNL.
 */
void ec_sim_responder_destroy(struct ec_sim_responder *r)
{
	rtnl_lock();
	r->leaving = true;
	rtnl_unlock();
	/* replays UNREGISTER for every device, so all are detached */
	unregister_netdevice_notifier(&r->nb);
	cancel_work_sync(&r->work);
	ec_sim_wire_exit(&r->wire);
	ec_sim_free(r->wire.sim);
	kfree(r);
}
