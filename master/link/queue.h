/* SPDX-License-Identifier: GPL-2.0-only */
/* Acyclic frames that wait for a send of the cycle, and how many of them it carries. */
#ifndef EC_QUEUE_H
#define EC_QUEUE_H

#include <linux/spinlock.h>
#include "slots.h"

struct ec_master;
struct ec_pack;
struct ec_pack_room;

/**
 * struct ec_queue - frames left by ec_xfer() for the cyclic caller
 * @q: ring of them
 * @head: entries so far
 * @tail: of these gone
 * @urgent: the last one that was sent was an urgent one
 */
struct ec_queue {
	struct ec_queued q[EC_SLOTS];
	unsigned int head;
	unsigned int tail;
	bool urgent;
};

/**
 * struct ec_share - acyclic frames since the last cyclic send; owned by the cyclic caller
 * @frames: sent
 * @wire_ns: wire time of them
 * @clock_credit: clock frames that may be sent, 1/1000
 * @clock_last: the last one was a clock frame
 */
struct ec_share {
	u32 frames;
	u32 wire_ns;
	u32 clock_credit;
	bool clock_last;
};

#define EC_SHARE_PER_MS		8	/* acyclic frames per millisecond of cycle */
#define EC_SHARE_CLOCKS_PER_MS	2	/* clock frames among them */

extern unsigned int ec_share_max;	/* acyclic frames of one send: max_acyclic of the module */

int ec_queue_push(struct ec_master *m, struct ec_slot *slot, bool urgent);
bool ec_queue_peek(struct ec_master *m, struct ec_queue *q, struct ec_queued *next);
void ec_queue_gather(struct ec_master *m, struct ec_queue *q, const struct ec_queued *first,
		     const struct ec_pack_room *room, struct ec_pack *p);
void ec_queue_drop(struct ec_master *m, struct ec_queue *q, const struct ec_queued *sent,
		   unsigned int n);
unsigned int ec_queue_frames(const struct ec_master *m);

u16 ec_share_clock_bytes(const struct ec_master *m);
void ec_share_begin(struct ec_master *m);
struct ec_queue *ec_share_next(struct ec_master *m, struct ec_queued *next);
bool ec_share_fits(struct ec_master *m, u32 used_ns, u32 frame_ns);
void ec_share_room(const struct ec_master *m, const struct ec_queue *q, u32 used_ns,
		   struct ec_pack_room *room);
void ec_share_sent(struct ec_master *m, const struct ec_queue *q, u32 frame_ns);

#endif
