// SPDX-License-Identifier: GPL-2.0-only
/* The simulated segment as a virtual device a master can use: "sim0". */
#include <linux/err.h>
#include <linux/rcupdate.h>
#include <linux/slab.h>
#include "devices/ecdev.h"
#include "describe.h"
#include "sim_link.h"
#include "sim_wire.h"

/**
 * struct ec_sim_link - one virtual device
 * @wire: the segment
 * @dev: handle of the offer, known before the first frame
 * @txbuf: transmit buffer; one sender at a time
 */
struct ec_sim_link {
	struct ec_sim_wire wire;
	struct ecdev *dev;
	u8 txbuf[EC_ETH_MAX];
};

static void deliver(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	struct ec_sim_link *l = container_of(w, struct ec_sim_link, wire);

	/* a network stack, too, has only these for the master; a host may send others */
	if (port || (eth[12] << 8 | eth[13]) != EC_ETHERTYPE)
		return;
	rcu_read_lock();
	ecdev_receive(l->dev, eth + 6, eth + EC_ETH_HDR, len - EC_ETH_HDR);
	rcu_read_unlock();
}

static int link_start(void *priv, struct ecdev *dev)
{
	struct ec_sim_link *l = priv;

	l->dev = dev;
	ec_sim_wire_run(&l->wire, true);
	return 0;
}

static void link_stop(void *priv)
{
	struct ec_sim_link *l = priv;

	ec_sim_wire_run(&l->wire, false);
}

static u8 *link_tx_get(void *priv)
{
	struct ec_sim_link *l = priv;

	return l->txbuf;
}

static int link_tx_send(void *priv, u8 *buf, size_t len)
{
	struct ec_sim_link *l = priv;

	return ec_sim_wire_send(&l->wire, 0, buf, len);
}

static void link_poll(void *priv)
{
	struct ec_sim_link *l = priv;

	ec_sim_wire_poll(&l->wire);
}

static void link_cycle(void *priv, bool on)
{
	struct ec_sim_link *l = priv;

	ec_sim_wire_set_polled(&l->wire, on);
}

static bool link_up(void *priv)
{
	struct ec_sim_link *l = priv;

	return ec_sim_wire_up(&l->wire);
}

static const struct ecdev_ops link_ops = {
	.kind = "virtual",
	.atomic = true,
	.start = link_start,
	.stop = link_stop,
	.tx_get = link_tx_get,
	.tx_send = link_tx_send,
	.poll = link_poll,
	.cycle = link_cycle,
	.link_up = link_up,
};

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
	struct ec_sim_link *l = kzalloc(sizeof(*l), GFP_KERNEL);
	struct ecdev *dev;
	int ret;

	if (!l)
		return ERR_PTR(-ENOMEM);
	ret = ec_sim_wire_init(&l->wire, sim, start_ns, deliver);
	if (ret)
		goto err_free;
	dev = ecdev_offer(name, mac, &link_ops, l);
	ret = PTR_ERR_OR_ZERO(dev);
	if (ret)
		goto err_wire;
	l->dev = dev;
	return l;

err_wire:
	ec_sim_wire_exit(&l->wire);
err_free:
	kfree(l);
	return ERR_PTR(ret);
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
 * ec_sim_link_destroy() - take the virtual device away and free the segment
 * @l: link
 *
 * Context: Process. May sleep.
 */
void ec_sim_link_destroy(struct ec_sim_link *l)
{
	ecdev_withdraw(l->dev);
	ec_sim_wire_exit(&l->wire);
	ec_sim_free(l->wire.sim);
	kfree(l);
}
