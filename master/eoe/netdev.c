// SPDX-License-Identifier: GPL-2.0-only
/*
 * The network device of a slave with EoE. It has a carrier while it is up and the mailbox of its
 * slave runs. EtherCAT frames pass in neither direction: there is no loop into the fieldbus.
 */
#include <linux/etherdevice.h>
#include <linux/ethtool.h>
#include <linux/jhash.h>
#include <linux/nsproxy.h>
#include <linux/rtnetlink.h>
#include <linux/skbuff.h>
#include "../base/once64.h"
#include "../bus/slave.h"
#include "../kernel/compat.h"
#include "netdev.h"
#include "netdevs.h"

#define DRIVER	"ec_eoe"
#define AGAIN_MIN_MS	200u	/* after a failure of the mailbox */
#define AGAIN_MAX_MS	10000u
#define STANDS	20	/* looks without a frame that leaves, then the mailbox has failed: 2 s */

static struct ec_eoe_netdev *of_port(struct ec_eoe_port *p)
{
	return container_of(p, struct ec_eoe_netdev, port);
}

/* Slaves would take it as a frame of the fieldbus. */
static bool is_ethercat(const struct sk_buff *skb)
{
	return ec_eoe_is_ethercat(skb->data, skb_headlen(skb));
}

/* frames --------------------------------------------------------------------*/

static netdev_tx_t drop(struct ec_eoe_netdev *d, struct sk_buff *skb)
{
	ec_write64(&d->tx_unsent, d->tx_unsent + 1);
	dev_kfree_skb_any(skb);
	return NETDEV_TX_OK;
}

/* Also after a race: some may have left in between, and nothing would wake the queue. */
static bool stop_queue(struct ec_eoe_netdev *d)
{
	netif_stop_queue(d->nd);
	/* the queue before the room, as the work has the room before the queue */
	smp_mb();
	if (!ec_eoe_port_has_room(&d->port))
		return true;
	netif_start_queue(d->nd);
	return false;
}

static netdev_tx_t eoe_xmit(struct sk_buff *skb, struct net_device *nd)
{
	struct ec_eoe_netdev *d = netdev_priv(nd);

	/* a redirected frame may have any length */
	if (skb->len > EC_EOE_FRAME_MAX || skb_linearize(skb) || is_ethercat(skb))
		return drop(d, skb);
	/* it frees the frame if there is no memory */
	if (eth_skb_pad(skb)) {
		ec_write64(&d->tx_unsent, d->tx_unsent + 1);
		return NETDEV_TX_OK;
	}
	if (!ec_eoe_port_has_room(&d->port) && stop_queue(d))
		return NETDEV_TX_BUSY;
	skb_tx_timestamp(skb);
	/* a slave may keep a frame waiting for long */
	skb_orphan(skb);
	nf_reset_ct(skb);
	if (ec_eoe_port_send(&d->port, skb))
		return drop(d, skb);
	if (!ec_eoe_port_has_room(&d->port))
		stop_queue(d);
	return NETDEV_TX_OK;
}

/**
 * ec_eoe_netdev_room() - frames have left a port, so others may be given
 * @p: port of a device
 *
 * Context: The work of the port.
 */
void ec_eoe_netdev_room(struct ec_eoe_port *p)
{
	netif_wake_queue(of_port(p)->nd);
}

/**
 * ec_eoe_netdev_deliver() - the slave has sent a frame
 * @p: port of a device
 * @skb: frame; this function frees it
 *
 * Context: The work of the port.
 */
void ec_eoe_netdev_deliver(struct ec_eoe_port *p, struct sk_buff *skb)
{
	struct ec_eoe_netdev *d = of_port(p);
	const struct ethhdr *eth = (const struct ethhdr *)skb->data;

	/* nobody else has the address of this device */
	if (is_ethercat(skb) || !is_valid_ether_addr(eth->h_source) ||
	    ether_addr_equal(eth->h_source, d->nd->dev_addr)) {
		ec_write64(&d->rx_refused, d->rx_refused + 1);
		kfree_skb(skb);
		return;
	}
	/* it frees the frame if there is no memory */
	if (eth_skb_pad(skb)) {
		ec_write64(&d->rx_refused, d->rx_refused + 1);
		return;
	}
	ec_write64(&d->rx_packets, d->rx_packets + 1);
	ec_write64(&d->rx_bytes, d->rx_bytes + skb->len);
	skb->protocol = eth_type_trans(skb, d->nd);
	netif_rx(skb);
}

/* slave ---------------------------------------------------------------------*/

static u64 fragments(const struct ec_eoe_netdev *d)
{
	return ec_read64(&d->port.counts.rx_fragments) + ec_read64(&d->port.counts.tx_fragments);
}

/* Try again later, at first soon. */
static void put_off(struct ec_eoe_netdev *d, const struct ec_slave *s, int err)
{
	lockdep_assert_held(&d->lock);
	if (!d->again_ms)
		ec_slave_warn(s, "no Ethernet frames (EoE) pass: %pe; retrying\n", ERR_PTR(err));
	d->again_ms = clamp(2 * d->again_ms, AGAIN_MIN_MS, AGAIN_MAX_MS);
	d->again_ns = ktime_get_ns() + (u64)d->again_ms * NSEC_PER_MSEC;
}

static void netdev_leave(struct ec_eoe_netdev *d)
{
	lockdep_assert_held(&d->lock);
	if (!d->slave)
		return;
	netif_carrier_off(d->nd);
	ec_eoe_port_close(&d->port);
	/* no eoe_xmit() runs behind it */
	netif_tx_disable(d->nd);
	ec_eoe_port_detach(&d->port);
	ec_slave_unref(d->slave);
	d->slave = NULL;
}

static void netdev_join(struct ec_eoe_netdev *d, struct ec_slave *s)
{
	int ret;

	lockdep_assert_held(&d->lock);
	ret = ec_eoe_port_attach(&d->port, &s->mbox);
	if (ret) {
		put_off(d, s, ret);
		return;
	}
	d->slave = ec_slave_ref(s);
	d->refused = ec_read64(&d->port.counts.refused);
	d->stands = 0;
	d->seen = fragments(d);
	netif_wake_queue(d->nd);
	netif_carrier_on(d->nd);
}

/* Said once; the slave may refuse each frame. */
static void report_refusal(struct ec_eoe_netdev *d)
{
	lockdep_assert_held(&d->lock);
	if (d->refusing || ec_read64(&d->port.counts.refused) == d->refused)
		return;
	d->refusing = true;
	ec_slave_warn(d->slave, "refuses Ethernet frames (EoE) by mailbox errors\n");
}

/* Has the port to be left? -errno of its mailbox, or 0. */
static int netdev_judge(struct ec_eoe_netdev *d)
{
	u64 seen = fragments(d);

	lockdep_assert_held(&d->lock);
	d->stands = ec_eoe_port_stands(&d->port) ? d->stands + 1 : 0;
	if (seen != d->seen)
		d->again_ms = 0;
	d->seen = seen;
	report_refusal(d);
	return READ_ONCE(d->port.err) ?: (d->stands > STANDS ? -ETIMEDOUT : 0);
}

/**
 * ec_eoe_netdev_follow() - the slave of a device, now
 * @d: device
 * @s: its slave; NULL: it is not connected
 *
 * Context: The work of the master. May sleep.
 */
void ec_eoe_netdev_follow(struct ec_eoe_netdev *d, struct ec_slave *s)
{
	bool runs = s && ec_eoe_runs(&s->mbox) && !READ_ONCE(s->reply.silent);
	int ret;

	mutex_lock(&d->lock);
	ret = d->slave ? netdev_judge(d) : 0;
	if (d->slave && (d->slave != s || !runs || ret))
		netdev_leave(d);
	if (ret && runs)
		put_off(d, s, ret);
	if (d->open && runs && !d->slave && ktime_get_ns() >= d->again_ns)
		netdev_join(d, s);
	mutex_unlock(&d->lock);
}

/**
 * ec_eoe_netdev_failed() - the mailbox of the slave does not run
 * @p: port of a device; ec_eoe_netdev_follow() attaches it again
 *
 * Context: The work of the port.
 */
void ec_eoe_netdev_failed(struct ec_eoe_port *p)
{
	netif_carrier_off(of_port(p)->nd);
}

/* network device ------------------------------------------------------------*/

static int eoe_open(struct net_device *nd)
{
	struct ec_eoe_netdev *d = netdev_priv(nd);

	mutex_lock(&d->lock);
	d->open = true;
	mutex_unlock(&d->lock);
	ec_eoe_kick(d->eoe);
	return 0;
}

static int eoe_stop(struct net_device *nd)
{
	struct ec_eoe_netdev *d = netdev_priv(nd);

	mutex_lock(&d->lock);
	d->open = false;
	netdev_leave(d);
	mutex_unlock(&d->lock);
	ec_eoe_kick(d->eoe);
	return 0;
}

static void eoe_stats(struct net_device *nd, struct rtnl_link_stats64 *st)
{
	struct ec_eoe_netdev *d = netdev_priv(nd);
	struct ec_eoe_counts c;

	ec_eoe_port_counts(&d->port, &c);
	st->rx_packets = ec_read64(&d->rx_packets);
	st->rx_bytes = ec_read64(&d->rx_bytes);
	st->rx_errors = c.rx_errors;
	st->rx_dropped = ec_read64(&d->rx_refused) + c.rx_dropped;
	st->rx_missed_errors = c.rx_missed;
	st->tx_packets = c.tx_frames;
	st->tx_bytes = c.tx_bytes;
	st->tx_errors = c.tx_lost + c.refused;
	st->tx_dropped = ec_read64(&d->tx_unsent) + c.tx_dropped;
}

/**
 * ec_eoe_netdev_measure() - the rates of the last second
 * @d: device
 *
 * Context: The work of the master.
 */
void ec_eoe_netdev_measure(struct ec_eoe_netdev *d)
{
	u64 now = ktime_get_ns(), took = now - d->measured_ns;
	u64 rx = ec_read64(&d->rx_bytes), tx;
	struct ec_eoe_counts c;

	if (took < NSEC_PER_SEC)
		return;
	ec_eoe_port_counts(&d->port, &c);
	tx = c.tx_bytes;
	/* the first time it is not known since when they count */
	if (d->measured_ns) {
		WRITE_ONCE(d->rx_rate, div64_u64((rx - d->measured[0]) * NSEC_PER_SEC, took));
		WRITE_ONCE(d->tx_rate, div64_u64((tx - d->measured[1]) * NSEC_PER_SEC, took));
	}
	d->measured_ns = now;
	d->measured[0] = rx;
	d->measured[1] = tx;
}

/**
 * ec_eoe_netdev_show() - a device and its statistics
 * @d: device
 * @info: @index; result
 *
 * Context: Process. No lock.
 */
void ec_eoe_netdev_show(struct ec_eoe_netdev *d, struct ec_ioc_eoe *info)
{
	bool up = READ_ONCE(d->nd->flags) & IFF_UP;
	struct ec_eoe_counts c;

	ec_eoe_port_counts(&d->port, &c);
	*info = (struct ec_ioc_eoe){
		.index = info->index, .device = d->id.device, .position = d->id.position,
		.state = (up ? EC_EOE_UP : 0) |
			 (READ_ONCE(d->connected) ? EC_EOE_CONNECTED : 0) |
			 (up && netif_carrier_ok(d->nd) ? EC_EOE_RUNNING : 0),
		.waiting = ec_eoe_port_waiting(&d->port), .room = EC_EOE_FRAMES,
		.rx_rate = up ? d->rx_rate : 0, .tx_rate = up ? d->tx_rate : 0,
		.rx_frames = ec_read64(&d->rx_packets), .rx_bytes = ec_read64(&d->rx_bytes),
		.rx_errors = c.rx_errors, .rx_missed = c.rx_missed,
		.rx_dropped = ec_read64(&d->rx_refused) + c.rx_dropped,
		.tx_frames = c.tx_frames, .tx_bytes = c.tx_bytes,
		.tx_lost = c.tx_lost + c.refused,
		.tx_dropped = ec_read64(&d->tx_unsent) + c.tx_dropped,
	};
	/* a name of another namespace may be that of another device here; it may just be changed */
	if (net_eq(dev_net(d->nd), current->nsproxy->net_ns))
		memcpy(info->name, d->nd->name, sizeof(info->name) - 1);
	ether_addr_copy(info->address, d->nd->dev_addr);
}

static const struct net_device_ops eoe_ops = {
	.ndo_open = eoe_open,
	.ndo_stop = eoe_stop,
	.ndo_start_xmit = eoe_xmit,
	.ndo_get_stats64 = eoe_stats,
	.ndo_set_mac_address = eth_mac_addr,
	.ndo_validate_addr = eth_validate_addr,
};

static void eoe_drvinfo(struct net_device *nd, struct ethtool_drvinfo *info)
{
	struct ec_eoe_netdev *d = netdev_priv(nd);

	strscpy(info->driver, DRIVER, sizeof(info->driver));
	snprintf(info->bus_info, sizeof(info->bus_info), "%u:%u, device %llu",
		 d->eoe->bus->base->index, d->id.position, d->id.device);
}

static const struct ethtool_ops eoe_ethtool = {
	.get_drvinfo = eoe_drvinfo,
	.get_link = ethtool_op_get_link,
	.get_ts_info = ethtool_op_get_ts_info,
};

/* udev rules know the devices by this type */
static const struct device_type eoe_type = { .name = "ethercat_eoe" };

static void eoe_setup(struct net_device *nd)
{
	ether_setup(nd);
	nd->netdev_ops = &eoe_ops;
	nd->ethtool_ops = &eoe_ethtool;
	nd->max_mtu = ETH_DATA_LEN;
	/* tags need four bytes more than a frame with the whole MTU has: they are in the data */
	nd->priv_flags &= ~IFF_TX_SKB_SHARING;
	SET_NETDEV_DEVTYPE(nd, &eoe_type);
}

/*
 * The name is that of the incumbent where the slave has an alias, else by the serial number, which
 * also moves with the slave; else by its position. @choice: others have the first names.
 */
static void make_name(char *name, unsigned int master, const struct ec_eoe_id *id,
		      unsigned int choice)
{
	if (choice > 1)
		snprintf(name, IFNAMSIZ, "eoe%ud%llu", master, id->device);
	else if (!choice && id->alias && !id->alias_shared)
		snprintf(name, IFNAMSIZ, "eoe%ua%u", master, id->alias);
	else if (!choice && id->serial && !id->serial_shared)
		snprintf(name, IFNAMSIZ, "eoe%un%x", master, id->serial);
	else
		snprintf(name, IFNAMSIZ, "eoe%us%u", master, id->position);
}

/*
 * Locally administered, and the same after each restart: from the address of the main device, so
 * that two hosts differ, and what the slave is called.
 */
static void make_address(struct net_device *nd, const u8 *main, const struct ec_eoe_id *id,
			 const char *name)
{
	u32 what[] = { id->vendor, id->product, id->serial };
	u32 a = jhash(main, ETH_ALEN, jhash2(what, ARRAY_SIZE(what), 0));
	u32 b = jhash(name, strlen(name), a);
	u8 addr[ETH_ALEN];

	put_unaligned_be16(b, addr);
	put_unaligned_be32(a ^ b, addr + 2);
	addr[0] = (addr[0] & ~1) | 2;
	eth_hw_addr_set(nd, addr);
}

/**
 * ec_eoe_netdev_create() - make the network device of a slave; it is down
 * @eoe: of the master
 * @id: slave
 * @choice: of the names: 0 by alias or serial number, 1 by position, 2 by device number
 *
 * Context: Process. Takes rtnl.
 * Return: device; ERR_PTR(): -EEXIST: another device has the name, or -errno.
 */
struct ec_eoe_netdev *ec_eoe_netdev_create(struct ec_eoe *eoe, const struct ec_eoe_id *id,
					   unsigned int choice)
{
	struct ec_eoe_netdev *d;
	struct net_device *nd;
	char name[IFNAMSIZ], alias[IFNAMSIZ];
	int ret;

	make_name(name, eoe->bus->base->index, id, choice);
	nd = alloc_netdev(sizeof(*d), name, NET_NAME_PREDICTABLE, eoe_setup);
	if (!nd)
		return ERR_PTR(-ENOMEM);
	d = netdev_priv(nd);
	d->nd = nd;
	d->eoe = eoe;
	d->id = *id;
	mutex_init(&d->lock);
	ec_eoe_port_init(&d->port);
	make_address(nd, eoe->main, id, name);
	/* a udev rule makes it another name */
	snprintf(alias, sizeof(alias), "eoe%us%u", eoe->bus->base->index, id->position);
	if (strcmp(alias, name))
		dev_set_alias(nd, alias, strlen(alias));
	SET_NETDEV_DEV(nd, eoe->parent);
	netif_carrier_off(nd);
	ret = register_netdev(nd);
	if (!ret)
		return d;
	free_netdev(nd);
	return ERR_PTR(ret);
}

/**
 * ec_eoe_netdev_destroy() - remove network devices
 * @old: devices, by their member @old; may be empty
 *
 * All at once: each removal alone would wait for RCU several times.
 *
 * Context: Process. Takes rtnl.
 */
void ec_eoe_netdev_destroy(struct list_head *old)
{
	struct ec_eoe_netdev *d, *next;
	LIST_HEAD(nds);

	if (list_empty(old))
		return;
	rtnl_lock();
	list_for_each_entry(d, old, old)
		unregister_netdevice_queue(d->nd, &nds);
	unregister_netdevice_many(&nds);
	rtnl_unlock();
	list_for_each_entry_safe(d, next, old, old)
		free_netdev(d->nd);
}
