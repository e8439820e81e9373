// SPDX-License-Identifier: GPL-2.0-only
/*
 * Generic device: any Ethernet network device of an unmodified kernel. An rx_handler claims
 * it, frames bypass the qdisc, and an egress hook blocks frames of all others.
 */
#include <linux/etherdevice.h>
#include <linux/if_arp.h>
#include <linux/inetdevice.h>
#include <linux/module.h>
#include <linux/netdevice.h>
#include <linux/netfilter.h>
#include <linux/pkt_sched.h>
#include <linux/rtnetlink.h>
#include <linux/skbuff.h>
#include <linux/slab.h>
#include <linux/workqueue.h>
#include <net/net_namespace.h>
#include <net/rtnetlink.h>
#include "ecdev.h"
#include "master/kernel/compat.h"
#include "master/link/tap.h"
#include "master/wire/frame.h"

#define RING		64	/* more than are on their way at once; completion is lazy */
#define SPARES		64
#define HELD_NS		(2 * NSEC_PER_MSEC)	/* an idle link needs far less to send it */
#define SPARE_HEAD	128	/* a lower device may push more headers */

/**
 * struct buf - a transmit buffer
 * @skb: prepared frame; a clone of it is sent
 * @sent_ns: time of the last send (ktime)
 */
struct buf {
	struct sk_buff *skb;
	u64 sent_ns;
};

/**
 * struct gen - one claimed or offered network device
 * @list: in @devices, under RTNL
 * @nd: network device, with a reference
 * @tracker: of that reference
 * @dev: receives the frames; set before the first one can arrive
 * @tap: copies for capture programs at @nd
 * @buf: transmit buffers
 * @next: next of @buf to try
 * @cur: buffer under construction
 * @spare: prepared frames for buffers that are held too long
 * @held: replaced frames, freed when their holders release them
 * @refill: frees @held, makes @spare
 * @hook: keeps other traffic off the wire
 * @claimed: rx_handler is registered
 */
struct gen {
	struct list_head list;
	struct net_device *nd;
	netdevice_tracker tracker;
	struct ecdev *dev;
	struct ec_tap tap;
	struct buf buf[RING];
	unsigned int next;
	struct buf *cur;
	struct sk_buff_head spare;
	struct sk_buff_head held;
	struct work_struct refill;
	struct nf_hook_ops hook;
	bool claimed;
};

static LIST_HEAD(devices);
static bool leaving;	/* under RTNL */

static void look(struct work_struct *work);
static DECLARE_WORK(look_work, look);

static rx_handler_result_t receive(struct sk_buff **pskb)
{
	struct sk_buff *skb;
	struct gen *g;

	/* a copy from @tap, which capture programs have received now */
	if ((*pskb)->pkt_type == PACKET_OUTGOING) {
		consume_skb(*pskb);
		return RX_HANDLER_CONSUMED;
	}
	skb = skb_share_check(*pskb, GFP_ATOMIC);
	if (!skb)
		return RX_HANDLER_CONSUMED;
	*pskb = skb;
	g = rcu_dereference(skb->dev->rx_handler_data);
	if (skb->protocol != htons(EC_ETHERTYPE))
		ecdev_foreign(g->dev);
	else if (!skb_linearize(skb))
		ecdev_receive(g->dev, eth_hdr(skb)->h_source, skb->data, skb->len);
	consume_skb(skb);
	return RX_HANDLER_CONSUMED;
}

/* Frames of others; frames of the master do not pass here. */
static unsigned int egress(void *priv, struct sk_buff *skb, const struct nf_hook_state *state)
{
	return NF_DROP;
}

/*
 * The driver gets a clone, whose companion needs no memory. It may push headers to the clone
 * without a copy: the headroom has no other user, and each send writes the whole frame.
 */
static struct sk_buff *prepare(struct net_device *nd)
{
	unsigned int head = LL_RESERVED_SPACE(nd) + SPARE_HEAD;
	struct sk_buff *skb = alloc_skb_fclone(head + EC_ETH_MAX + nd->needed_tailroom, GFP_KERNEL);

	if (!skb)
		return NULL;
	skb_reserve(skb, head);
	skb->dev = nd;
	skb->protocol = htons(EC_ETHERTYPE);
	skb->priority = TC_PRIO_CONTROL;
	__skb_header_release(skb);
	return skb;
}

static void refill(struct work_struct *work)
{
	struct gen *g = container_of(work, struct gen, refill);
	struct sk_buff *skb;

	skb_queue_purge(&g->held);
	while (skb_queue_len_lockless(&g->spare) < SPARES && (skb = prepare(g->nd)))
		skb_queue_tail(&g->spare, skb);
}

static void free_buffers(struct gen *g)
{
	unsigned int i;

	cancel_work_sync(&g->refill);
	skb_queue_purge(&g->held);
	skb_queue_purge(&g->spare);
	for (i = 0; i < RING; i++) {
		kfree_skb(g->buf[i].skb);
		g->buf[i].skb = NULL;
	}
	ec_tap_exit(&g->tap);
}

static int make_buffers(struct gen *g)
{
	unsigned int i;
	int ret;

	skb_queue_head_init(&g->spare);
	skb_queue_head_init(&g->held);
	INIT_WORK(&g->refill, refill);
	ret = ec_tap_init(&g->tap, g->nd);
	if (ret)
		return ret;
	for (i = 0; i < RING; i++) {
		g->buf[i].skb = prepare(g->nd);
		if (!g->buf[i].skb) {
			free_buffers(g);
			return -ENOMEM;
		}
	}
	refill(&g->refill);
	return 0;
}

/* batman-adv learns every source address. EtherCAT frames have always new ones: it drops most. */
static bool is_mesh(const struct net_device *nd)
{
	return nd->rtnl_link_ops && !strcmp(nd->rtnl_link_ops->kind, "batadv");
}

/* EtherCAT frames do not pass such a device. */
static bool is_eoe(const struct net_device *nd)
{
	return nd->dev.type && !strcmp(nd->dev.type->name, "ethercat_eoe");
}

static int is_eoe_below(struct net_device *nd, struct netdev_nested_priv *priv)
{
	return is_eoe(nd);
}

/* Does it send frames of slaves (EoE), as a bridge with such a port does? */
static bool has_eoe(struct net_device *nd)
{
	ASSERT_RTNL();
	return is_eoe(nd) || netdev_walk_all_lower_dev(nd, is_eoe_below, NULL);
}

static int check(struct net_device *nd)
{
	if (is_mesh(nd)) {
		pr_err_ratelimited("ec_generic: %s: batman-adv mesh loses EtherCAT frames; use an Ethernet interface\n",
				   nd->name);
		return -EOPNOTSUPP;
	}
	if (nd->mtu < ETH_DATA_LEN) {
		pr_err_ratelimited("ec_generic: %s: MTU %u, need %d; run \"ip link set %s mtu %d\"\n",
				   nd->name, nd->mtu, ETH_DATA_LEN, nd->name, ETH_DATA_LEN);
		return -EMSGSIZE;
	}
	if (netdev_is_rx_handler_busy(nd)) {
		pr_err_ratelimited("ec_generic: %s: in use by a bridge, bond, team or macvlan; release it first\n",
				   nd->name);
		return -EBUSY;
	}
	if (has_eoe(nd)) {
		pr_err_ratelimited("ec_generic: %s: network devices of slaves (EoE) are its ports; take them out first\n",
				   nd->name);
		return -EBUSY;
	}
	return 0;
}

/* It forgets them after minutes, which are hundreds of thousands of frames. */
static void warn_bridge(const struct gen *g)
{
	if (netif_is_bridge_master(g->nd) && ecdev_numbered(g->dev))
		pr_warn_ratelimited("ec_generic: %s: the bridge learns the address of each frame; load ec_master with frame_numbers=N, or set its ports to learning off\n",
				    g->nd->name);
}

static int claim(struct gen *g)
{
	int ret;

	ASSERT_RTNL();
	ret = check(g->nd);
	if (ret)
		return ret;
	warn_bridge(g);
	ret = dev_open(g->nd, NULL);
	if (ret) {
		pr_err_ratelimited("ec_generic: %s: cannot bring up the interface (%pe)\n",
				   g->nd->name, ERR_PTR(ret));
		return ret;
	}
	ret = netdev_rx_handler_register(g->nd, receive, g);
	if (ret) {
		pr_err_ratelimited("ec_generic: %s: cannot receive its frames (%pe); use the underlying interface\n",
				   g->nd->name, ERR_PTR(ret));
		return ret;
	}
	g->hook = (struct nf_hook_ops){
		.hook = egress, .dev = g->nd, .pf = NFPROTO_NETDEV,
		.hooknum = NF_NETDEV_EGRESS, .priority = INT_MIN,
	};
	ret = nf_register_net_hook(dev_net(g->nd), &g->hook);
	if (ret) {
		pr_err_ratelimited("ec_generic: %s: cannot block other traffic (%pe)\n",
				   g->nd->name, ERR_PTR(ret));
		netdev_rx_handler_unregister(g->nd);
		return ret;
	}
	g->claimed = true;
	return 0;
}

static void unclaim(struct gen *g)
{
	ASSERT_RTNL();
	if (!g->claimed)
		return;
	g->claimed = false;
	nf_unregister_net_hook(dev_net(g->nd), &g->hook);
	netdev_rx_handler_unregister(g->nd);
}

static int gen_start(void *priv, struct ecdev *dev)
{
	struct gen *g = priv;
	int ret;

	ASSERT_RTNL();
	g->dev = dev;
	ret = make_buffers(g);
	if (ret)
		return ret;
	ret = claim(g);
	if (ret)
		free_buffers(g);
	return ret;
}

static void gen_stop(void *priv)
{
	struct gen *g = priv;

	unclaim(g);
	free_buffers(g);
}

/* The driver, or a capture program below it, still has the clone. */
static bool in_use(const struct sk_buff *skb)
{
	return skb_shared(skb) || skb_cloned(skb) || skb_fclone_busy(NULL, skb);
}

/*
 * A program that captures at a device below this one, or at the other end of a
 * virtual wire, and does not read, keeps the clones. The holder pays for them; the
 * cycle goes on with others.
 */
static bool replace(struct gen *g, struct buf *b)
{
	struct sk_buff *skb;

	if ((s64)(ktime_get_ns() - b->sent_ns) < HELD_NS)
		return false;
	skb = skb_dequeue(&g->spare);
	if (skb) {
		skb_queue_tail(&g->held, b->skb);
		b->skb = skb;
	}
	queue_work(system_highpri_wq, &g->refill);
	return skb;
}

static u8 *gen_tx_get(void *priv)
{
	struct gen *g = priv;
	unsigned int i;

	for (i = 0; i < RING; i++) {
		struct buf *b = &g->buf[(g->next + i) % RING];

		if (in_use(b->skb) && !replace(g, b))
			continue;
		g->next = (g->next + i + 1) % RING;
		g->cur = b;
		return b->skb->data;
	}
	return NULL;
}

static netdev_tx_t start_xmit(struct net_device *nd, struct netdev_queue *txq, struct sk_buff *skb)
{
	/* again: on PREEMPT_RT the caller may have waited, and dev_close() waits for this only */
	if (!netif_running(nd) || netif_xmit_frozen_or_drv_stopped(txq))
		return NETDEV_TX_BUSY;
	return netdev_start_xmit(skb, nd, txq, false);
}

/*
 * Past the qdisc; a linear frame without offloads needs no validation. Some
 * drivers lock by themselves. HARD_TX_LOCK() is no choice: with PREEMPT_RT sparse
 * sees its unlock only.
 */
static netdev_tx_t transmit(struct net_device *nd, struct sk_buff *skb)
{
	struct netdev_queue *txq = netdev_get_tx_queue(nd, 0);
	netdev_tx_t ret;

	local_bh_disable();
	if (ec_netdev_lltx(nd)) {
		ret = start_xmit(nd, txq, skb);
	} else {
		__netif_tx_lock(txq, smp_processor_id());
		ret = start_xmit(nd, txq, skb);
		__netif_tx_unlock(txq);
	}
	local_bh_enable();
	return ret;
}

static int gen_tx_send(void *priv, u8 *buf, size_t len)
{
	struct gen *g = priv;
	struct sk_buff *skb = g->cur->skb;
	int ret;

	if (!netif_running(g->nd) || !netif_carrier_ok(g->nd))
		return -ENETDOWN;
	/* else each attempt would be captured */
	if (netif_xmit_frozen_or_drv_stopped(netdev_get_tx_queue(g->nd, 0)))
		return -EBUSY;
	skb->len = 0;
	skb_reset_tail_pointer(skb);
	skb_put(skb, len);
	skb_reset_mac_header(skb);
	skb_set_network_header(skb, ETH_HLEN);
	skb = skb_clone(skb, GFP_ATOMIC);
	if (!skb)
		return -ENOMEM;
	if (!ec_tap_sent(&g->tap, buf, len))
		ecdev_not_captured(g->dev);
	g->cur->sent_ns = ktime_get_ns();
	ret = transmit(g->nd, skb);
	if (ret == NETDEV_TX_BUSY) {
		kfree_skb(skb);
		return -EBUSY;
	}
	/* a device below this one had no room in its queue */
	if (ret == NET_XMIT_DROP || ret == -ENOBUFS)
		return -EBUSY;
	/* or it failed; it has consumed the frame all the same */
	return min(ret, 0);
}

static bool gen_link_up(void *priv)
{
	struct gen *g = priv;

	return netif_running(g->nd) && netif_carrier_ok(g->nd);
}

static const struct ecdev_ops gen_ops = {
	.kind = "generic",
	.burst = RING - RING / 4,
	.start = gen_start,
	.stop = gen_stop,
	.tx_get = gen_tx_get,
	.tx_send = gen_tx_send,
	.link_up = gen_link_up,
};

static struct gen *find(const struct net_device *nd)
{
	struct gen *g;

	list_for_each_entry(g, &devices, list)
		if (g->nd == nd)
			return g;
	return NULL;
}

static void withdraw(struct gen *g)
{
	ASSERT_RTNL();
	ecdev_withdraw(g->dev);
	list_del(&g->list);
	netdev_put(g->nd, &g->tracker);
	kfree(g);
}

/* The broadcast address does not mean the network of this computer, or a part of a bridge. */
static bool is_free(struct net_device *nd)
{
	const struct in_device *in = __in_dev_get_rtnl(nd);

	ASSERT_RTNL();
	return !netdev_master_upper_dev_get(nd) && !(in && rtnl_dereference(in->ifa_list));
}

/* Other namespaces have names and addresses of their own. */
static bool wanted(struct net_device *nd)
{
	return nd->type == ARPHRD_ETHER && nd->reg_state == NETREG_REGISTERED && !is_eoe(nd) &&
	       net_eq(dev_net(nd), &init_net) &&
	       ecdev_wanted(nd->name, nd->dev_addr, is_free(nd));
}

static void offer(struct net_device *nd)
{
	struct ecdev *dev;
	struct gen *g;

	ASSERT_RTNL();
	if (!wanted(nd) || find(nd))
		return;
	g = kzalloc(sizeof(*g), GFP_KERNEL);
	if (!g)
		return;
	g->nd = nd;
	netdev_hold(nd, &g->tracker, GFP_KERNEL);
	list_add(&g->list, &devices);
	dev = ecdev_offer(nd->name, nd->dev_addr, &gen_ops, g);
	if (IS_ERR(dev)) {
		list_del(&g->list);
		netdev_put(nd, &g->tracker);
		kfree(g);
		return;
	}
	g->dev = dev;
	/* not now: it is offered again when something has changed */
	if (!g->claimed)
		withdraw(g);
}

/*
 * Not in the notifier: while a device registers it cannot be opened, and others
 * have not heard of it yet.
 */
static void look(struct work_struct *work)
{
	struct gen *g, *next;
	struct net_device *nd;

	rtnl_lock();
	/* the master has given it back */
	list_for_each_entry_safe(g, next, &devices, list)
		if (!g->claimed)
			withdraw(g);
	if (!leaving)
		for_each_netdev(&init_net, nd)
			offer(nd);
	rtnl_unlock();
}

/* Do frames of a cycle pass @nd, which may be below the device of a master? */
static bool carries_cycle(struct net_device *nd)
{
	const struct gen *g;
	bool carries = false;

	ASSERT_RTNL();
	rcu_read_lock();
	list_for_each_entry(g, &devices, list)
		carries |= (g->nd == nd || netdev_has_upper_dev_all_rcu(nd, g->nd)) &&
			   ecdev_in_cycle(g->dev);
	rcu_read_unlock();
	return carries;
}

/*
 * Many drivers reset themselves for another MTU, and only then the kernel says what it is to be.
 * So there is no change at all while process data run.
 */
static int prepare_mtu(struct net_device *nd)
{
	if (!carries_cycle(nd))
		return NOTIFY_DONE;
	pr_warn_ratelimited("ec_generic: %s: MTU change refused while process data run\n",
			    nd->name);
	return notifier_from_errno(-EBUSY);
}

/* Not below what frames need; @was: MTU before, or the refused one on its way back */
static int change_mtu(const struct net_device *nd, u32 was)
{
	if (nd->mtu >= ETH_DATA_LEN || was < ETH_DATA_LEN)
		return NOTIFY_DONE;
	pr_warn_ratelimited("ec_generic: %s: MTU change refused: at least %d needed\n", nd->name,
			    ETH_DATA_LEN);
	return notifier_from_errno(-EBUSY);
}

/* Are frames that a port of @nd receives sent to the fieldbus? */
static bool leads_to_fieldbus(struct net_device *nd)
{
	const struct gen *g;
	bool leads = false;

	ASSERT_RTNL();
	rcu_read_lock();
	list_for_each_entry(g, &devices, list)
		leads |= g->claimed && (g->nd == nd || netdev_has_upper_dev_all_rcu(nd, g->nd));
	rcu_read_unlock();
	return leads;
}

/* The ports of a bridge that is the device of a master are on the line of its slaves. */
static int prepare_upper(struct net_device *nd, const struct netdev_notifier_changeupper_info *i)
{
	if (!i->linking || !leads_to_fieldbus(i->upper_dev) || !has_eoe(nd))
		return NOTIFY_DONE;
	NL_SET_ERR_MSG_MOD(i->info.extack, "frames of slaves (EoE) must not get to the fieldbus");
	return notifier_from_errno(-EBUSY);
}

static int event(struct notifier_block *nb, unsigned long what, void *ptr)
{
	struct net_device *nd = netdev_notifier_info_to_dev(ptr);
	struct gen *g;

	/* any user may change devices of a namespace of their own, as often as they want */
	if (!net_eq(dev_net(nd), &init_net))
		return NOTIFY_DONE;
	g = find(nd);
	if (what == NETDEV_PRECHANGEMTU)
		return prepare_mtu(nd);
	if (what == NETDEV_PRECHANGEUPPER)
		return prepare_upper(nd, ptr);
	if (g && what == NETDEV_CHANGEMTU)
		return change_mtu(nd, ((struct netdev_notifier_info_ext *)ptr)->ext.mtu);
	if (g && what == NETDEV_CHANGENAME)
		ecdev_rename(g->dev, nd->name);
	switch (what) {
	case NETDEV_UNREGISTER:
		if (!g)
			break;
		withdraw(g);
		fallthrough;	/* another one may take its place */
	case NETDEV_REGISTER:
	case NETDEV_UP:
	case NETDEV_CHANGEMTU:
	case NETDEV_CHANGENAME:
	case NETDEV_CHANGEADDR:
	case NETDEV_CHANGEUPPER:
		if (!leaving)
			schedule_work(&look_work);
		break;
	}
	return NOTIFY_DONE;
}

static struct notifier_block notifier = { .notifier_call = event };

/* An interface without its last address may be free now, see is_free(). */
static int address_event(struct notifier_block *nb, unsigned long what, void *ptr)
{
	const struct in_ifaddr *a = ptr;

	ASSERT_RTNL();
	/* any user has the addresses of a namespace of their own */
	if (what == NETDEV_DOWN && !leaving && net_eq(dev_net(a->ifa_dev->dev), &init_net))
		schedule_work(&look_work);
	return NOTIFY_DONE;
}

static struct notifier_block address_notifier = { .notifier_call = address_event };

/* The caller waits for what comes of it. */
static int wishes(struct notifier_block *nb, unsigned long what, void *ptr)
{
	look(NULL);
	return NOTIFY_DONE;
}

static struct notifier_block wishes_notifier = { .notifier_call = wishes };

static bool has_address(const struct net_device *nd, const char *spec)
{
	u8 mac[ETH_ALEN];

	return mac_pton(spec, mac) && ether_addr_equal(mac, nd->dev_addr);
}

static bool is_any(const char *spec)
{
	u8 mac[ETH_ALEN];

	return mac_pton(spec, mac) && is_broadcast_ether_addr(mac);
}

/* Why no network device matches @spec; NULL: one does, and was refused. */
static const char * __init why_waiting(const char *spec)
{
	const char *why = "is neither the name nor the MAC address of a network interface";
	struct net_device *nd;
	bool any = is_any(spec);

	if (any)
		why = "selects the first free Ethernet interface, none is present";
	rtnl_lock();
	for_each_netdev(&init_net, nd) {
		if (any && wanted(nd) && !find(nd))
			why = NULL;
		if (!strcmp(spec, nd->name) || has_address(nd, spec))
			why = nd->type == ARPHRD_ETHER ? NULL : "is not an Ethernet interface";
	}
	rtnl_unlock();
	return why;
}

/* A mistyped name waits forever; a name whose driver is loaded later does not. */
static void __init report_waiting(void)
{
	unsigned int i = 0, master;
	char spec[IFNAMSIZ + MAX_ADDR_LEN];
	const char *why;
	bool backup;

	while (ecdev_waiting(&i, &master, spec, sizeof(spec), &backup)) {
		why = strncmp(spec, "sim", 3) ? why_waiting(spec) : NULL;
		if (why)
			pr_warn("ec_generic: %s: \"%s\" %s; master %u waits for it\n",
				backup ? "backup_devices" : "main_devices", spec, why, master);
	}
}

/* No device is offered any more, all are withdrawn. */
static void unhear(void)
{
	rtnl_lock();
	leaving = true;
	rtnl_unlock();
	/* replays UNREGISTER for every device */
	unregister_netdevice_notifier(&notifier);
	cancel_work_sync(&look_work);
}

static int __init gen_init(void)
{
	int ret = register_netdevice_notifier(&notifier);

	if (ret)
		goto err;
	ret = register_inetaddr_notifier(&address_notifier);
	if (ret)
		goto err_netdevices;
	/* the last one: a master that wants a device meanwhile calls into this module */
	ret = ecdev_register_notifier(&wishes_notifier);
	if (ret)
		goto err_addresses;
	/* the first one has reported all devices there are */
	look(NULL);
	report_waiting();
	return 0;

err_addresses:
	unregister_inetaddr_notifier(&address_notifier);
err_netdevices:
	unhear();
err:
	cancel_work_sync(&look_work);
	return ret;
}

static void __exit gen_exit(void)
{
	ecdev_unregister_notifier(&wishes_notifier);
	unregister_inetaddr_notifier(&address_notifier);
	unhear();
}

module_init(gen_init);
module_exit(gen_exit);

MODULE_DESCRIPTION("EtherCAT master: generic network device");
MODULE_AUTHOR("The EtherCAT master team");
MODULE_LICENSE("GPL");
