// SPDX-License-Identifier: GPL-2.0-only
/*
 * Acyclic frames that wait for a send of the cycle. Those that set clocks have a queue
 * of their own: they are many, and nobody else should wait behind them.
 *
 * What one send carries is limited, so that its execution time is: frames per
 * millisecond of cycle, clock frames among them, frames in all, and half of the free wire
 * time. Short frames of several callers leave as one.
 */
#include <linux/atomic.h>
#include <linux/ktime.h>
#include <linux/minmax.h>
#include <linux/module.h>
#include "../master.h"
#include "pack.h"
#include "queue.h"

unsigned int ec_share_max = 64;

static int set_max(const char *value, const struct kernel_param *kp)
{
	return param_set_uint_minmax(value, kp, 1, EC_LINK_QUEUED);
}

static const struct kernel_param_ops max_ops = {
	.set = set_max,
	.get = param_get_uint,
};

module_param_cb(max_acyclic, &max_ops, &ec_share_max, 0644);
MODULE_PARM_DESC(max_acyclic, "Most acyclic frames that one cyclic send carries, 1 to 192 (64)");

/*
 * The position of an urgent frame: before all others, but between two urgent ones one
 * of the others goes. Where hardly any frame fits the urgent ones would be the only ones.
 */
static unsigned int first(struct ec_queue *q)
{
	unsigned int i = --q->tail;

	if (!q->urgent || i + 1 == q->head)
		return i;
	q->q[i % EC_SLOTS] = q->q[(i + 1) % EC_SLOTS];
	return i + 1;
}

/**
 * ec_queue_push() - leave a frame for the cyclic caller
 * @m: master
 * @slot: armed slot; its waiter may give up at any time
 * @urgent: before all others
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or -EBUSY.
 */
int ec_queue_push(struct ec_master *m, struct ec_slot *slot, bool urgent)
{
	struct ec_queue *q = slot->clock ? &m->cq : &m->xq;
	unsigned long flags;
	unsigned int i;
	int ret = -EBUSY;

	raw_spin_lock_irqsave(&m->xq_lock, flags);
	if (q->head - q->tail < EC_SLOTS) {
		i = urgent ? first(q) : q->head++;
		q->q[i % EC_SLOTS] = (struct ec_queued){
			.slot = slot, .seq = slot->seq, .urgent = urgent,
		};
		ret = 0;
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
	return ret;
}

/**
 * ec_queue_peek() - find the oldest frame whose caller still waits
 * @m: master
 * @q: queue of it
 * @next: the frame; it stays in the queue
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: there is none.
 */
bool ec_queue_peek(struct ec_master *m, struct ec_queue *q, struct ec_queued *next)
{
	unsigned long flags;
	bool found = false;

	raw_spin_lock_irqsave(&m->xq_lock, flags);
	for (; q->head != q->tail; q->tail++) {
		const struct ec_queued *e = &q->q[q->tail % EC_SLOTS];

		if (atomic_read_acquire(&e->slot->state) == EC_SLOT_SENT &&
		    e->slot->seq == e->seq) {
			*next = *e;
			found = true;
			break;
		}
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
	return found;
}

/**
 * ec_queue_gather() - take frames together that may leave as one
 * @m: master
 * @q: queue of them
 * @first: the first one
 * @room: what the frame may hold beside the first one
 * @p: the frames; they stay in the queue. None when the caller of @first has given up
 *
 * Their order stays: what does not fit ends it.
 *
 * Context: The owner of the links. RT-safe: bounded, no sleep, no allocation.
 */
void ec_queue_gather(struct ec_master *m, struct ec_queue *q, const struct ec_queued *first,
		     const struct ec_pack_room *room, struct ec_pack *p)
{
	unsigned long flags;
	unsigned int i;

	ec_pack_begin(p);
	raw_spin_lock_irqsave(&m->xq_lock, flags);
	for (i = q->tail; i != q->head; i++) {
		const struct ec_queued *e = &q->q[i % EC_SLOTS];

		/* an urgent one may stand before it by now */
		if (!p->n && (e->slot != first->slot || e->seq != first->seq))
			continue;
		if (!ec_pack_add(p, e, room))
			break;
		if (!p->n)
			break;
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
}

/**
 * ec_queue_drop() - take frames out that were sent or cannot be sent
 * @m: master
 * @q: queue of them
 * @sent: the frames, in their order; urgent ones may stand before them by now
 * @n: how many, at least one
 *
 * Context: The owner of the links. RT-safe: bounded, no sleep, no allocation.
 */
void ec_queue_drop(struct ec_master *m, struct ec_queue *q, const struct ec_queued *sent,
		   unsigned int n)
{
	unsigned long flags;
	unsigned int i, k;

	for (k = 0; k < n; k++)
		WRITE_ONCE(sent[k].slot->left, sent[k].seq);
	raw_spin_lock_irqsave(&m->xq_lock, flags);
	q->urgent = sent[n - 1].urgent;
	for (i = q->tail, k = 0; i != q->head && k < n; i++) {
		struct ec_queued *e = &q->q[i % EC_SLOTS];

		if (e->slot == sent[k].slot && e->seq == sent[k].seq) {
			e->seq--;	/* skipped by the next ec_queue_peek() */
			k++;
		}
	}
	raw_spin_unlock_irqrestore(&m->xq_lock, flags);
}

/**
 * ec_queue_frames() - count the frames that wait
 * @m: master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: how many, those included that have been given up.
 */
unsigned int ec_queue_frames(const struct ec_master *m)
{
	return READ_ONCE(m->xq.head) - READ_ONCE(m->xq.tail) +
	       READ_ONCE(m->cq.head) - READ_ONCE(m->cq.tail);
}

/**
 * ec_share_clock_bytes() - how long clock frames may be to leave as often as they may
 * @m: master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of datagrams, with their headers, of one frame.
 */
u16 ec_share_clock_bytes(const struct ec_master *m)
{
	u32 frames = max(1u, READ_ONCE(m->interval_us) * EC_SHARE_CLOCKS_PER_MS / 1000);
	u32 bytes = ec_cycle_slack_ns(m) / 2 / frames / 80;

	/* what ec_frame_wire_ns() adds, and the headers */
	bytes -= min(bytes, 8u + 4 + 12 + EC_ETH_HDR + EC_FRAME_HDR);
	return min_t(u32, bytes, EC_FRAME_BODY_MAX);
}

/**
 * ec_share_begin() - a cyclic send begins: it may carry acyclic frames again
 * @m: master
 *
 * Short cycles carry a clock frame only now and then.
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_share_begin(struct ec_master *m)
{
	u32 more = m->interval_us * EC_SHARE_CLOCKS_PER_MS;

	m->share = (struct ec_share){
		.clock_credit = min(m->share.clock_credit + more, max(more, 1000u)),
		.clock_last = m->share.clock_last,
	};
}

/**
 * ec_share_next() - find the acyclic frame to send next
 * @m: master
 * @next: the frame
 *
 * Clock frames and others take turns, as long as there is credit for clocks.
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: queue of the frame, or NULL: none may be sent.
 */
struct ec_queue *ec_share_next(struct ec_master *m, struct ec_queued *next)
{
	u32 most = clamp(m->interval_us * EC_SHARE_PER_MS / 1000, 1u, READ_ONCE(ec_share_max));
	bool clocks = m->share.clock_credit >= 1000;

	if (m->share.frames >= most)
		return NULL;
	if (clocks && !m->share.clock_last && ec_queue_peek(m, &m->cq, next))
		return &m->cq;
	if (ec_queue_peek(m, &m->xq, next))
		return &m->xq;
	return clocks && ec_queue_peek(m, &m->cq, next) ? &m->cq : NULL;
}

/**
 * ec_share_fits() - check the wire time of an acyclic frame
 * @m: master
 * @used_ns: wire time that has passed since the cyclic send, or is taken
 * @frame_ns: wire time of the frame
 *
 * A single frame may take all that is left before the next cycle; more of them share
 * half of what the cycle leaves.
 *
 * Context: The master's single cyclic caller. RT-safe.
 * Return: whether it may be sent.
 */
bool ec_share_fits(struct ec_master *m, u32 used_ns, u32 frame_ns)
{
	u64 budget = m->interval_us * 900ULL;

	if (used_ns + (u64)frame_ns > budget)
		return false;
	return !m->share.frames || 2ull * (m->share.wire_ns + frame_ns) <= ec_cycle_slack_ns(m);
}

/**
 * ec_share_room() - find what a frame may hold that callers share
 * @m: master
 * @q: queue of it; clock frames leave alone
 * @used_ns: wire time that has passed since the cyclic send, or is taken
 * @room: result
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_share_room(const struct ec_master *m, const struct ec_queue *q, u32 used_ns,
		   struct ec_pack_room *room)
{
	u32 budget = m->interval_us * 900, half = ec_cycle_slack_ns(m) / 2;
	u32 ns = min(budget - min(budget, used_ns), half - min(half, m->share.wire_ns));
	/* what ec_frame_wire_ns() adds, and the header */
	u32 bytes = ns / 80 - min(ns / 80, 8u + 4 + 12 + EC_ETH_HDR);

	room->len = min_t(u32, bytes, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	room->dgrams = q == &m->cq ? 0 : m->max_datagrams;
}

/**
 * ec_share_sent() - count an acyclic frame
 * @m: master
 * @q: its queue
 * @frame_ns: its wire time
 *
 * Context: The master's single cyclic caller. RT-safe.
 */
void ec_share_sent(struct ec_master *m, const struct ec_queue *q, u32 frame_ns)
{
	m->share.frames++;
	m->share.wire_ns += frame_ns;
	m->share.clock_last = q == &m->cq;
	if (m->share.clock_last)
		m->share.clock_credit -= 1000;
}
