// SPDX-License-Identifier: GPL-2.0-only
/* The simulated segment as a virtual device a master can use: "sim0". */
#include <linux/hrtimer.h>
#include <linux/ktime.h>
#include <linux/list.h>
#include <linux/mm.h>
#include <linux/module.h>
#include <linux/slab.h>
#include <linux/spinlock.h>
#include <linux/vmalloc.h>
#include "devices/ecdev.h"
#include "describe.h"
#include "sim.h"
#include "sim_link.h"

#define FRAMES	320	/* on their way at once; a master has 256 slots */

/* a frame on its way */
struct flying {
	struct list_head list;
	u64 due_ns;
	size_t len;
	u8 src[6];
	u8 data[EC_FRAME_HDR + EC_FRAME_BODY_MAX];
};

/**
 * struct ec_sim_link - one virtual device
 * @sim: segment
 * @dev: offer to the masters
 * @lock: protects everything below and @sim
 * @timer: delivers in idle mode
 * @flying: frames on their way, by arrival
 * @free: unused frames
 * @frames: all of them
 * @wire_free_ns: when the last frame sent has left the master's port
 * @polled: the master polls, no timer wanted
 * @running: started
 * @txbuf: transmit buffer; one sender at a time
 */
struct ec_sim_link {
	struct ec_sim *sim;
	struct ecdev *dev;
	spinlock_t lock;
	struct hrtimer timer;
	struct list_head flying;
	struct list_head free;
	struct flying *frames;
	u64 wire_free_ns;
	bool polled;
	bool running;
	u8 txbuf[EC_ETH_MAX];
};

static void *sim_alloc(size_t bytes)
{
	return kvzalloc(bytes, GFP_KERNEL);
}

static void sim_free(void *p)
{
	kvfree(p);
}

const struct ec_sim_ops ec_sim_link_ops = { .alloc = sim_alloc, .free = sim_free };

/* Sorted by arrival; nearly always the new one is the last. */
static void insert(struct ec_sim_link *l, struct flying *f)
{
	struct flying *p;

	list_for_each_entry_reverse(p, &l->flying, list)
		if (p->due_ns <= f->due_ns) {
			list_add(&f->list, &p->list);
			return;
		}
	list_add(&f->list, &l->flying);
}

static void arm(struct ec_sim_link *l)
{
	struct flying *f = list_first_entry_or_null(&l->flying, struct flying, list);

	if (f && !l->polled && l->running)
		hrtimer_start(&l->timer, ns_to_ktime(f->due_ns), HRTIMER_MODE_ABS_SOFT);
}

static struct flying *due(struct ec_sim_link *l, u64 now)
{
	struct flying *f = list_first_entry_or_null(&l->flying, struct flying, list);

	if (!f || f->due_ns > now)
		return NULL;
	list_del(&f->list);
	return f;
}

/* Deliver what has arrived by now. */
static void deliver(struct ec_sim_link *l)
{
	struct flying *f;

	spin_lock_bh(&l->lock);
	while ((f = due(l, ktime_get_ns()))) {
		spin_unlock_bh(&l->lock);
		/* not known yet while ecdev_offer() runs: then it is lost */
		if (READ_ONCE(l->dev))
			ecdev_receive(l->dev, f->src, f->data, f->len);
		spin_lock_bh(&l->lock);
		list_add(&f->list, &l->free);
	}
	arm(l);
	spin_unlock_bh(&l->lock);
}

static enum hrtimer_restart timeout(struct hrtimer *timer)
{
	deliver(container_of(timer, struct ec_sim_link, timer));
	return HRTIMER_NORESTART;
}

static int link_start(void *priv)
{
	struct ec_sim_link *l = priv;

	spin_lock_bh(&l->lock);
	l->running = true;
	spin_unlock_bh(&l->lock);
	return 0;
}

static void link_stop(void *priv)
{
	struct ec_sim_link *l = priv;

	spin_lock_bh(&l->lock);
	l->running = false;
	list_splice_init(&l->flying, &l->free);
	spin_unlock_bh(&l->lock);
	hrtimer_cancel(&l->timer);
}

static u8 *link_tx_get(void *priv)
{
	struct ec_sim_link *l = priv;

	return l->txbuf;
}

/* One copy of a frame through the segment. */
static void launch(struct ec_sim_link *l, const u8 *buf, size_t len)
{
	struct flying *f = list_first_entry_or_null(&l->free, struct flying, list), *g;
	struct ec_sim_result res;
	u64 start;
	s64 delay;
	u8 i;

	if (!f)
		return;
	start = max(ktime_get_ns(), l->wire_free_ns);
	l->wire_free_ns = start + ec_frame_wire_ns(len);
	f->len = len - EC_ETH_HDR;
	memcpy(f->src, buf + 6, sizeof(f->src));
	memcpy(f->data, buf + EC_ETH_HDR, f->len);
	delay = ec_sim_frame_result(l->sim, 0, f->data, f->len, start, &res);
	if (delay < 0 || !res.copies || res.out_port)
		return;
	f->src[0] |= 2;		/* a slave has processed it */
	f->due_ns = start + delay;
	list_del(&f->list);
	insert(l, f);
	for (i = 1; i < res.copies; i++) {
		g = list_first_entry_or_null(&l->free, struct flying, list);
		if (!g)
			break;
		list_del(&g->list);
		g->due_ns = f->due_ns + i * ec_frame_wire_ns(len);
		g->len = f->len;
		memcpy(g->src, f->src, sizeof(g->src));
		memcpy(g->data, f->data, f->len);
		insert(l, g);
	}
}

static int link_tx_send(void *priv, u8 *buf, size_t len)
{
	struct ec_sim_link *l = priv;
	int ret = 0;

	spin_lock_bh(&l->lock);
	if (!l->running || !ec_sim_link(l->sim, 0))
		ret = -ENETDOWN;
	else
		launch(l, buf, len);
	arm(l);
	spin_unlock_bh(&l->lock);
	return ret;
}

static void link_poll(void *priv)
{
	deliver(priv);
}

static void link_cycle(void *priv, bool on)
{
	struct ec_sim_link *l = priv;

	spin_lock_bh(&l->lock);
	l->polled = on;
	arm(l);
	spin_unlock_bh(&l->lock);
}

static bool link_up(void *priv)
{
	struct ec_sim_link *l = priv;
	bool up;

	spin_lock_bh(&l->lock);
	ec_sim_advance(l->sim, ktime_get_ns());
	up = ec_sim_link(l->sim, 0);
	spin_unlock_bh(&l->lock);
	return up;
}

static const struct ecdev_ops link_ops = {
	.kind = "virtual",
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
 *
 * Context: Process. May sleep.
 * Return: link, or ERR_PTR; then @sim still belongs to the caller.
 */
struct ec_sim_link *ec_sim_link_create(const char *name, const u8 *mac, struct ec_sim *sim)
{
	struct ec_sim_link *l = kzalloc(sizeof(*l), GFP_KERNEL);
	struct ecdev *dev;
	unsigned int i;

	if (!l)
		return ERR_PTR(-ENOMEM);
	l->frames = vzalloc(array_size(FRAMES, sizeof(*l->frames)));
	if (!l->frames) {
		kfree(l);
		return ERR_PTR(-ENOMEM);
	}
	l->sim = sim;
	spin_lock_init(&l->lock);
	hrtimer_init(&l->timer, CLOCK_MONOTONIC, HRTIMER_MODE_ABS_SOFT);
	l->timer.function = timeout;
	INIT_LIST_HEAD(&l->flying);
	INIT_LIST_HEAD(&l->free);
	for (i = 0; i < FRAMES; i++)
		list_add(&l->frames[i].list, &l->free);
	dev = ecdev_offer(name, mac, &link_ops, l);
	if (IS_ERR(dev)) {
		vfree(l->frames);
		kfree(l);
		return ERR_CAST(dev);
	}
	WRITE_ONCE(l->dev, dev);
	return l;
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
	hrtimer_cancel(&l->timer);
	ec_sim_free(l->sim);
	vfree(l->frames);
	kfree(l);
}
