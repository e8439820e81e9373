// SPDX-License-Identifier: GPL-2.0-only
/* The simulated segment as a virtual device a master can use: "sim0". */
#include <linux/err.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "devices/ecdev.h"
#include "describe.h"
#include "sim_link.h"
#include "sim_wire.h"

#define TX_BUFS	64

/**
 * struct end - one virtual device: an end of the segment
 * @link: both ends
 * @port: master port of the segment
 * @offer: handle of the offer, NULL: none
 * @dev: the same while a master uses the device, known before the first frame
 * @polled: that master polls
 * @tx_next: transmit buffer that is next in turn; one sender at a time
 * @tx: transmit buffers
 */
struct end {
	struct ec_sim_link *link;
	int port;
	struct ecdev *offer;
	struct ecdev *dev;
	bool polled;
	unsigned int tx_next;
	u8 tx[TX_BUFS][EC_ETH_MAX];
};

/**
 * struct ec_sim_link - virtual devices of a segment
 * @wire: the segment
 * @lock: protects members of the ends that more than one of them depends on
 * @end: by master port
 * @keeps: the card of the second end has a link without a master, too
 */
struct ec_sim_link {
	struct ec_sim_wire wire;
	spinlock_t lock;
	bool keeps;
	struct end end[EC_SIM_PORTS];
};

static void deliver(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	struct ec_sim_link *l = container_of(w, struct ec_sim_link, wire);
	struct ecdev *dev;

	/* a network stack, too, has only these for the master; a host may send others */
	if ((eth[12] << 8 | eth[13]) != EC_ETHERTYPE)
		return;
	rcu_read_lock();
	dev = READ_ONCE(l->end[port].dev);
	if (dev)
		ecdev_receive(dev, eth + 6, eth + EC_ETH_HDR, len - EC_ETH_HDR);
	rcu_read_unlock();
}

/* The segment is polled while all ends that a master uses poll. */
static void poll_anew(struct ec_sim_link *l)
{
	bool polled = false, idle = false;
	unsigned int i;

	lockdep_assert_held(&l->lock);
	for (i = 0; i < EC_SIM_PORTS; i++) {
		polled |= l->end[i].polled;
		idle |= !l->end[i].polled && READ_ONCE(l->end[i].dev);
	}
	ec_sim_wire_set_polled(&l->wire, polled && !idle);
}

/* The segment runs while a master uses an end. */
static void set_dev(struct end *e, struct ecdev *dev)
{
	struct ec_sim_link *l = e->link;
	bool runs = false;
	unsigned int i;

	spin_lock_bh(&l->lock);
	WRITE_ONCE(e->dev, dev);
	poll_anew(l);
	spin_unlock_bh(&l->lock);
	/* a card that is off has no link: frames turn at the last slave */
	if (e->port)
		ec_sim_wire_card(&l->wire, e->port, dev || READ_ONCE(l->keeps));
	for (i = 0; i < EC_SIM_PORTS; i++)
		runs |= READ_ONCE(l->end[i].dev) != NULL;
	ec_sim_wire_run(&l->wire, runs);
}

static int link_start(void *priv, struct ecdev *dev)
{
	set_dev(priv, dev);
	return 0;
}

static void link_stop(void *priv)
{
	set_dev(priv, NULL);
}

static u8 *link_tx_get(void *priv)
{
	struct end *e = priv;

	return e->tx[e->tx_next];
}

static int link_tx_send(void *priv, u8 *buf, size_t len)
{
	struct end *e = priv;
	int ret = ec_sim_wire_send(&e->link->wire, e->port, buf, len);

	if (!ret)
		e->tx_next = (e->tx_next + 1) % TX_BUFS;
	return ret;
}

static void link_poll(void *priv)
{
	struct end *e = priv;

	ec_sim_wire_poll(&e->link->wire);
}

static void link_cycle(void *priv, bool on)
{
	struct end *e = priv;

	spin_lock_bh(&e->link->lock);
	e->polled = on;
	poll_anew(e->link);
	spin_unlock_bh(&e->link->lock);
}

static bool link_up(void *priv)
{
	struct end *e = priv;

	return ec_sim_wire_up(&e->link->wire, e->port);
}

static const struct ecdev_ops link_ops = {
	.kind = "virtual",
	.atomic = true,
	.start = link_start,
	.stop = link_stop,
	.tx_get = link_tx_get,
	.stays = true,
	.tx_send = link_tx_send,
	.poll = link_poll,
	.cycle = link_cycle,
	.link_up = link_up,
};

static int offer_end(struct ec_sim_link *l, int port, const char *name, const u8 *mac)
{
	struct end *e = &l->end[port];
	struct ecdev *dev;

	e->link = l;
	e->port = port;
	dev = ecdev_offer(name, mac, &link_ops, e);
	if (IS_ERR(dev))
		return PTR_ERR(dev);
	e->offer = dev;
	return 0;
}

/**
 * ec_sim_link_create() - offer a segment as a virtual device
 * @name: device name, "sim0"
 * @mac: its address
 * @sim: segment; belongs to the link afterwards
 * @start_ns: kernel time (ktime) when the segment's time is 0
 *
 * Context: Process. May sleep.
 * Return: link, or ERR_PTR; then @sim still belongs to the caller.
 */
struct ec_sim_link *ec_sim_link_create(const char *name, const u8 *mac, struct ec_sim *sim,
				       u64 start_ns)
{
	struct ec_sim_link *l = kvzalloc(sizeof(*l), GFP_KERNEL);
	int ret;

	if (!l)
		return ERR_PTR(-ENOMEM);
	spin_lock_init(&l->lock);
	ret = ec_sim_wire_init(&l->wire, sim, start_ns, deliver);
	if (ret)
		goto err_free;
	ec_sim_wire_card(&l->wire, 1, false);
	ret = offer_end(l, 0, name, mac);
	if (ret)
		goto err_wire;
	return l;

err_wire:
	ec_sim_wire_exit(&l->wire);
err_free:
	kvfree(l);
	return ERR_PTR(ret);
}

/**
 * ec_sim_link_second() - offer the other end of a ring as a virtual device as well
 * @l: link, once
 * @name: device name, "sim0b"
 * @mac: its address
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_sim_link_second(struct ec_sim_link *l, const char *name, const u8 *mac)
{
	return offer_end(l, 1, name, mac);
}

/**
 * ec_sim_link_keep() - the card of the second end keeps its link when no master uses the device
 * @l: link
 *
 * Context: Any.
 */
void ec_sim_link_keep(struct ec_sim_link *l)
{
	WRITE_ONCE(l->keeps, true);
}

/**
 * ec_sim_link_second_withdraw() - take the device of the other end away
 * @l: link
 *
 * Context: Process. May sleep.
 */
void ec_sim_link_second_withdraw(struct ec_sim_link *l)
{
	if (l->end[1].offer)
		ecdev_withdraw(l->end[1].offer);
	l->end[1].offer = NULL;
}

/**
 * ec_sim_link_wire() - segment of a virtual device
 * @l: link
 *
 * Context: Any.
 * Return: the segment, in the kernel's time.
 */
struct ec_sim_wire *ec_sim_link_wire(struct ec_sim_link *l)
{
	return &l->wire;
}

/**
 * ec_sim_link_destroy() - take the virtual devices away and free the segment
 * @l: link
 *
 * Context: Process. May sleep.
 */
void ec_sim_link_destroy(struct ec_sim_link *l)
{
	ec_sim_link_second_withdraw(l);
	ecdev_withdraw(l->end[0].offer);
	ec_sim_wire_exit(&l->wire);
	ec_sim_free(l->wire.sim);
	kvfree(l);
}
