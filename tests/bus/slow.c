// SPDX-License-Identifier: GPL-2.0-only
#include <linux/err.h>
#include <linux/hrtimer.h>
#include <linux/rcupdate.h>
#include "slow.h"
#include "devices/ecdev.h"
#include "master/kernel/compat.h"

#define RING_MAX	64
#define RX_MAX		64

/* a transmit buffer */
struct tx {
	size_t len;
	u8 data[EC_ETH_MAX];
};

/**
 * struct slow - the device
 * @wire: the segment behind it
 * @dev: handle of the offer
 * @lock: protects the ring
 * @timer: one frame has left the ring
 * @ring: its transmit buffers
 * @slowness: times the wire time of 100 Mbit/s
 * @head: next buffer to fill
 * @tail: the one that leaves next
 * @rung: the first one that leaves only after another doorbell
 * @doorbells: that let frames leave
 * @full: how often there was none
 * @claim: slaves that broadcasts seem to have passed, 0: as many as there are
 * @pass: frames that begin with @refused_cmd and pass before the first is refused
 * @refuse: frames that the ring refuses only when they are sent, as a stack with queues
 *	of its own does: so many that begin with command @refused_cmd
 * @refused_cmd: EC_CMD_*
 * @stopped: nothing leaves the ring
 * @tx: buffers
 * @rx: received frames, which stay until the next poll
 * @n_rx: how many were received since then
 * @polled: by the cycle
 */
struct slow {
	struct ec_sim_wire wire;
	struct ecdev *dev;
	raw_spinlock_t lock;
	struct hrtimer timer;
	u32 ring;
	u32 slowness;
	u32 head;
	u32 tail;
	u32 rung;
	u32 doorbells;
	u32 full;
	u32 claim;
	u32 pass;
	u32 refuse;
	u8 refused_cmd;
	bool stopped;
	struct tx tx[RING_MAX];
	u8 rx[RX_MAX][EC_ETH_MAX];
	u32 n_rx;
	bool polled;
};

static void deliver(struct ec_sim_wire *w, int port, const u8 *eth, size_t len)
{
	struct slow *s = container_of(w, struct slow, wire);
	u8 *rx = s->rx[s->n_rx % RX_MAX], *d = rx + EC_ETH_HDR + EC_FRAME_HDR;

	/* as a card whose ring is full */
	if (s->polled && s->n_rx == RX_MAX)
		return;
	s->n_rx++;
	memcpy(rx, eth, len);
	if (s->claim && d[0] == EC_CMD_BRD)
		put_unaligned_le16(s->claim, d + 2);
	rcu_read_lock();
	ecdev_receive(s->dev, rx + 6, rx + EC_ETH_HDR, len - EC_ETH_HDR);
	rcu_read_unlock();
}

static struct tx *at(struct slow *s, u32 i)
{
	return &s->tx[i % s->ring];
}

/* the oldest frame begins to leave */
static void start(struct slow *s)
{
	hrtimer_start(&s->timer,
		      ns_to_ktime((u64)s->slowness * ec_frame_wire_ns(at(s, s->tail)->len)),
		      HRTIMER_MODE_REL_SOFT);
}

static enum hrtimer_restart has_left(struct hrtimer *timer)
{
	struct slow *s = container_of(timer, struct slow, timer);
	struct tx *t = at(s, s->tail);
	unsigned long flags;

	ec_sim_wire_send(&s->wire, 0, t->data, t->len);
	raw_spin_lock_irqsave(&s->lock, flags);
	if (++s->tail != s->rung && !s->stopped)
		start(s);
	raw_spin_unlock_irqrestore(&s->lock, flags);
	return HRTIMER_NORESTART;
}

static int slow_start(void *priv, struct ecdev *dev)
{
	struct slow *s = priv;

	s->dev = dev;
	ec_sim_wire_run(&s->wire, true);
	return 0;
}

static void slow_end(void *priv)
{
	struct slow *s = priv;

	hrtimer_cancel(&s->timer);
	ec_sim_wire_run(&s->wire, false);
}

static u8 *tx_get(void *priv)
{
	struct slow *s = priv;

	if (s->head - READ_ONCE(s->tail) < s->ring)
		return at(s, s->head)->data;
	s->full++;
	return NULL;
}

static int tx_send(void *priv, u8 *buf, size_t len)
{
	struct slow *s = priv;
	unsigned long flags;

	if (!ec_sim_wire_up(&s->wire, 0))
		return -ENETDOWN;
	if (s->refuse && buf[EC_ETH_HDR + EC_FRAME_HDR] == s->refused_cmd) {
		if (!s->pass) {
			s->refuse--;
			return -EBUSY;
		}
		s->pass--;
	}
	raw_spin_lock_irqsave(&s->lock, flags);
	at(s, s->head)->len = len;
	s->head++;
	raw_spin_unlock_irqrestore(&s->lock, flags);
	return 0;
}

static void tx_flush(void *priv)
{
	struct slow *s = priv;
	unsigned long flags;

	raw_spin_lock_irqsave(&s->lock, flags);
	if (s->rung != s->head) {
		if (s->rung == s->tail && !s->stopped)
			start(s);
		s->rung = s->head;
		s->doorbells++;
	}
	raw_spin_unlock_irqrestore(&s->lock, flags);
}

static void poll(void *priv)
{
	struct slow *s = priv;

	/* who reads those of the last poll now notices it */
	memset(s->rx, 0xee, sizeof(s->rx));
	s->n_rx = 0;
	ec_sim_wire_poll(&s->wire);
}

static void cycle(void *priv, bool on)
{
	struct slow *s = priv;

	s->polled = on;
	ec_sim_wire_set_polled(&s->wire, on);
}

static bool link_up(void *priv)
{
	struct slow *s = priv;

	return ec_sim_wire_up(&s->wire, 0);
}

static const struct ecdev_ops ops = {
	.kind = "slow",
	.atomic = true,
	.start = slow_start,
	.stop = slow_end,
	.tx_get = tx_get,
	.tx_send = tx_send,
	.tx_flush = tx_flush,
	.poll = poll,
	.keeps = true,
	.cycle = cycle,
	.link_up = link_up,
};

/**
 * slow_plug() - offer the segment to the master at a slow device
 * @b: bus of bus_new()
 * @ring: transmit buffers
 * @slowness: times the wire time of 100 Mbit/s
 *
 * Return: the device.
 */
struct slow *slow_plug(struct bus *b, u32 ring, u32 slowness)
{
	static const u8 mac[6] = { 0x02, 0x00, 0x00, 0xec, 0x51, 0x01 };
	struct slow *s = kvzalloc(sizeof(*s), GFP_KERNEL);
	struct ecdev *dev;

	KUNIT_ASSERT_NOT_NULL(b->test, s);
	b->slow = s;
	s->ring = ring;
	s->slowness = slowness;
	raw_spin_lock_init(&s->lock);
	hrtimer_setup(&s->timer, has_left, CLOCK_MONOTONIC, HRTIMER_MODE_REL_SOFT);
	KUNIT_ASSERT_EQ(b->test, ec_sim_wire_init(&s->wire, b->sim, 0, deliver), 0);
	b->t0 = ktime_get_ns();
	dev = ecdev_offer("bus0", mac, &ops, s);
	KUNIT_ASSERT_FALSE(b->test, IS_ERR(dev));
	s->dev = dev;
	return s;
}

/**
 * slow_destroy() - take it away and free the segment
 * @s: device
 */
void slow_destroy(struct slow *s)
{
	if (s->dev)
		ecdev_withdraw(s->dev);
	if (s->wire.frames)
		ec_sim_wire_exit(&s->wire);
	kvfree(s);
}

/**
 * slow_claim() - let broadcasts come back as if they had passed many slaves
 * @s: device
 * @slaves: how many, 0: the truth
 */
void slow_claim(struct slow *s, u32 slaves)
{
	WRITE_ONCE(s->claim, slaves);
}

/**
 * slow_stop() - the device hangs: nothing leaves the ring
 * @s: device
 * @stop: true: hangs, false: goes on
 */
void slow_stop(struct slow *s, bool stop)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&s->lock, flags);
	s->stopped = stop;
	if (!stop && s->rung != s->tail && !hrtimer_active(&s->timer))
		start(s);
	raw_spin_unlock_irqrestore(&s->lock, flags);
}

/**
 * slow_refuse() - let tx_send() answer that there is no room
 * @s: device
 * @cmd: for frames that begin with this command
 * @pass: so many of them pass first
 * @frames: how many
 */
void slow_refuse(struct slow *s, u8 cmd, u32 pass, u32 frames)
{
	s->pass = pass;
	s->refused_cmd = cmd;
	s->refuse = frames;
}

/**
 * slow_to_refuse() - how many frames are still to be refused
 * @s: device
 *
 * Return: frames.
 */
u32 slow_to_refuse(const struct slow *s)
{
	return s->refuse;
}

/**
 * slow_full() - how often the transmit ring was full
 * @s: device
 *
 * Return: times.
 */
u32 slow_full(const struct slow *s)
{
	return s->full;
}

/**
 * slow_doorbells() - how often frames were let go
 * @s: device
 *
 * Return: times.
 */
u32 slow_doorbells(const struct slow *s)
{
	return s->doorbells;
}

/**
 * slow_sent() - frames in the ring since the beginning
 * @s: device
 *
 * Return: frames.
 */
u32 slow_sent(const struct slow *s)
{
	return s->head;
}
