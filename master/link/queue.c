// SPDX-License-Identifier: GPL-2.0-only
/*
 * Acyclic frames that wait for a send of the cycle. Those that set clocks have a queue
 * of their own: they are many, and other frames should not wait behind them.
 */
#include <linux/atomic.h>
#include "pack.h"
#include "queue.h"

/**
 * ec_queues_init() - empty queues
 * @qs: zeroed structure
 *
 * Context: Any.
 */
void ec_queues_init(struct ec_queues *qs)
{
	raw_spin_lock_init(&qs->lock);
}

/*
 * The position of an urgent frame: before all others, but between two urgent ones one
 * of the others goes. Where hardly any frame fits the urgent ones would be the only ones.
 */
static unsigned int first(struct ec_queue *q)
{
	unsigned int i = q->tail - 1;

	WRITE_ONCE(q->tail, i);
	if (!q->urgent || i + 1 == q->head)
		return i;
	q->q[i % EC_SLOTS] = q->q[(i + 1) % EC_SLOTS];
	return i + 1;
}

/**
 * ec_queue_push() - leave a frame for the cyclic caller
 * @qs: queues
 * @slot: slot in state QUEUED; its waiter may give up at any time
 * @urgent: before all others
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0 or -EBUSY.
 */
int ec_queue_push(struct ec_queues *qs, struct ec_slot *slot, bool urgent)
{
	struct ec_queue *q = slot->clock ? &qs->clock : &qs->acyclic;
	unsigned long flags;
	unsigned int i;
	int ret = -EBUSY;

	raw_spin_lock_irqsave(&qs->lock, flags);
	if (q->head - q->tail < EC_SLOTS) {
		i = urgent ? first(q) : q->head;
		if (!urgent)
			WRITE_ONCE(q->head, i + 1);
		q->q[i % EC_SLOTS] = (struct ec_queued){
			.slot = slot, .seq = slot->seq, .urgent = urgent,
		};
		ret = 0;
	}
	raw_spin_unlock_irqrestore(&qs->lock, flags);
	return ret;
}

/**
 * ec_queue_peek() - find the oldest frame whose caller still waits
 * @qs: queues
 * @q: queue of it
 * @next: the frame; it stays in the queue
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: false: there is none.
 */
bool ec_queue_peek(struct ec_queues *qs, struct ec_queue *q, struct ec_queued *next)
{
	unsigned long flags;
	bool found = false;

	raw_spin_lock_irqsave(&qs->lock, flags);
	while (q->head != q->tail) {
		const struct ec_queued *e = &q->q[q->tail % EC_SLOTS];

		/* else it was sent, or given up */
		if (atomic_read_acquire(&e->slot->state) == EC_SLOT_QUEUED &&
		    READ_ONCE(e->slot->seq) == e->seq) {
			*next = *e;
			found = true;
			break;
		}
		WRITE_ONCE(q->tail, q->tail + 1);
	}
	raw_spin_unlock_irqrestore(&qs->lock, flags);
	return found;
}

/**
 * ec_queue_gather() - take frames together that may leave as one
 * @qs: queues
 * @q: queue of them
 * @first: the first one
 * @room: what the frame may hold beside the first one
 * @p: the frames. None when the caller of @first has given up
 *
 * Their order stays: what does not fit ends it.
 *
 * Context: The owner of the links. RT-safe: bounded, no sleep, no allocation.
 */
void ec_queue_gather(struct ec_queues *qs, struct ec_queue *q, const struct ec_queued *first,
		     const struct ec_pack_room *room, struct ec_pack *p)
{
	unsigned long flags;
	unsigned int i;

	ec_pack_begin(p);
	raw_spin_lock_irqsave(&qs->lock, flags);
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
	if (p->n)
		q->urgent = p->e[p->n - 1].urgent;
	raw_spin_unlock_irqrestore(&qs->lock, flags);
}
