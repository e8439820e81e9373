// SPDX-License-Identifier: GPL-2.0-only
/*
 * What capture programs see. The cycle only copies a frame into a ring, and only
 * while a program captures; a worker makes socket buffers of the copies. So no
 * program holds a buffer of the cycle, even if it never reads. The first frame
 * wakes the worker, which then runs periodically as long as a program captures.
 */
#include <linux/etherdevice.h>
#include <linux/jiffies.h>
#include <linux/module.h>
#include <linux/netdevice.h>
#include <linux/skbuff.h>
#include <linux/vmalloc.h>
#include "../base/once64.h"
#include "tap.h"
#include "../wire/frame.h"

/** struct ec_tap_frame - one frame in the ring */
struct ec_tap_frame {
	/** @at: when it was sent or received */
	ktime_t at;
	/** @out: sent */
	bool out;
	/** @len: bytes of @data */
	u16 len;
	/** @data: the frame from its destination address */
	u8 data[EC_ETH_MAX];
};

/* the next free entry, until tap_publish() */
static struct ec_tap_frame *reserve(struct ec_tap *t, bool out)
{
	struct ec_tap_frame *f = &t->ring[t->head % EC_TAP_RING];

	lockdep_assert_held(&t->lock);
	/* an entry is overwritten only after it was shown */
	if (t->head - smp_load_acquire(&t->tail) == EC_TAP_RING) {
		ec_write64(&t->dropped, t->dropped + 1);
		return NULL;
	}
	f->at = ktime_get_real();
	f->out = out;
	return f;
}

static void tap_publish(struct ec_tap *t)
{
	lockdep_assert_held(&t->lock);
	/* the frame before the head */
	smp_store_release(&t->head, t->head + 1);
	if (unlikely(!t->awake)) {
		t->awake = true;
		/* unbound: not on the CPU of the cycle */
		queue_delayed_work(system_unbound_wq, &t->work, 0);
	}
}

/**
 * ec_tap_sent() - a frame has been sent
 * @t: tap
 * @frame: from its destination address
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 * Return: false when a program wants the frame and the ring is full.
 */
bool ec_tap_sent(struct ec_tap *t, const u8 *frame, size_t len)
{
	struct ec_tap_frame *f;
	unsigned long flags;

	if (!ec_tap_wanted(t) || len > EC_ETH_MAX)
		return true;
	raw_spin_lock_irqsave(&t->lock, flags);
	f = reserve(t, true);
	if (f) {
		memcpy(f->data, frame, len);
		f->len = len;
		tap_publish(t);
	}
	raw_spin_unlock_irqrestore(&t->lock, flags);
	return f;
}
EXPORT_SYMBOL_GPL(ec_tap_sent);

/**
 * ec_tap_received() - a frame has been received
 * @t: tap
 * @src: its source address
 * @data: what follows the EtherType
 * @len: bytes there
 *
 * Context: Any, in an RCU read section. RT-safe: bounded, no sleep, no allocation.
 * Return: false when a program wants the frame and the ring is full.
 */
bool ec_tap_received(struct ec_tap *t, const u8 *src, const u8 *data, size_t len)
{
	struct ec_tap_frame *f;
	unsigned long flags;

	if (!ec_tap_wanted(t) || len > EC_ETH_MAX - EC_ETH_HDR)
		return true;
	raw_spin_lock_irqsave(&t->lock, flags);
	f = reserve(t, false);
	if (f) {
		eth_broadcast_addr(f->data);
		ether_addr_copy(f->data + ETH_ALEN, src);
		put_unaligned_be16(EC_ETHERTYPE, f->data + 2 * ETH_ALEN);
		memcpy(f->data + EC_ETH_HDR, data, len);
		f->len = EC_ETH_HDR + len;
		tap_publish(t);
	}
	raw_spin_unlock_irqrestore(&t->lock, flags);
	return f;
}

static void show(struct ec_tap *t, const struct ec_tap_frame *f)
{
	struct sk_buff *skb = netdev_alloc_skb(t->nd, f->len);
	unsigned long flags;

	if (!skb) {
		raw_spin_lock_irqsave(&t->lock, flags);
		ec_write64(&t->dropped, t->dropped + 1);
		raw_spin_unlock_irqrestore(&t->lock, flags);
		return;
	}
	skb_put_data(skb, f->data, f->len);
	skb->protocol = eth_type_trans(skb, t->nd);
	skb->pkt_type = f->out ? PACKET_OUTGOING : PACKET_HOST;
	/* not dev_queue_xmit_nit(), which would set the current time */
	skb->tstamp = f->at;
	ec_write64(&t->shown, t->shown + 1);
	ec_write64(&t->bytes, t->bytes + f->len);
	local_bh_disable();
	netif_receive_skb(skb);
	local_bh_enable();
}

/* May the worker sleep until the next frame wakes it? */
static bool capture_is_over(struct ec_tap *t)
{
	unsigned long flags;
	bool over;

	rcu_read_lock();
	raw_spin_lock_irqsave(&t->lock, flags);
	over = t->tail == t->head && !ec_tap_wanted(t);
	if (over)
		t->awake = false;
	raw_spin_unlock_irqrestore(&t->lock, flags);
	rcu_read_unlock();
	return over;
}

static void worker(struct work_struct *w)
{
	struct ec_tap *t = container_of(w, struct ec_tap, work.work);

	/* the head before the frame */
	while (t->tail != smp_load_acquire(&t->head)) {
		show(t, &t->ring[t->tail % EC_TAP_RING]);
		/* shown: the entry is free */
		smp_store_release(&t->tail, t->tail + 1);
		cond_resched();
	}
	if (!capture_is_over(t))
		queue_delayed_work(system_unbound_wq, &t->work, msecs_to_jiffies(EC_TAP_MS));
}

/**
 * ec_tap_init() - prepare the ring of an interface
 * @t: tap
 * @nd: interface; its rx_handler takes the frames after the capture programs. Stays
 *	until ec_tap_exit()
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_tap_init(struct ec_tap *t, struct net_device *nd)
{
	*t = (struct ec_tap){ .nd = nd };
	raw_spin_lock_init(&t->lock);
	INIT_DELAYED_WORK(&t->work, worker);
	t->ring = vzalloc(array_size(EC_TAP_RING, sizeof(*t->ring)));
	return t->ring ? 0 : -ENOMEM;
}
EXPORT_SYMBOL_GPL(ec_tap_init);

/**
 * ec_tap_exit() - free the ring
 * @t: tap; nothing is sent or received any more
 *
 * Context: Process. May sleep.
 */
void ec_tap_exit(struct ec_tap *t)
{
	if (!t->ring)
		return;
	cancel_delayed_work_sync(&t->work);
	vfree(t->ring);
	t->ring = NULL;
}
EXPORT_SYMBOL_GPL(ec_tap_exit);
