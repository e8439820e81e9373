/* SPDX-License-Identifier: GPL-2.0-only */
/* Acyclic frames that wait for a send of the cycle. */
#ifndef EC_QUEUE_H
#define EC_QUEUE_H

#include <linux/spinlock.h>
#include "slots.h"

struct ec_pack;
struct ec_pack_room;

/**
 * struct ec_queue - frames in the order in which they leave
 * @q: ring of them
 * @head: entries so far
 * @tail: of these gone
 * @urgent: the last one that was taken out was an urgent one
 */
struct ec_queue {
	struct ec_queued q[EC_SLOTS];
	unsigned int head;
	unsigned int tail;
	bool urgent;
};

/** struct ec_queues - acyclic frames that wait for the cycle */
struct ec_queues {
	/** @lock: protects the other members */
	raw_spinlock_t lock;
	/** @acyclic: frames of ec_xfer() */
	struct ec_queue acyclic;
	/** @clock: frames of ec_xfer_clock() */
	struct ec_queue clock;
};

void ec_queues_init(struct ec_queues *qs);
int ec_queue_push(struct ec_queues *qs, struct ec_slot *slot, bool urgent);
bool ec_queue_peek(struct ec_queues *qs, struct ec_queue *q, struct ec_queued *next);
void ec_queue_gather(struct ec_queues *qs, struct ec_queue *q, const struct ec_queued *first,
		     const struct ec_pack_room *room, struct ec_pack *p);

/**
 * ec_queue_frames() - count the frames that wait
 * @qs: queues
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: how many, those included that have been sent since, or given up.
 */
static inline unsigned int ec_queue_frames(const struct ec_queues *qs)
{
	return READ_ONCE(qs->acyclic.head) - READ_ONCE(qs->acyclic.tail) +
	       READ_ONCE(qs->clock.head) - READ_ONCE(qs->clock.tail);
}

#endif
