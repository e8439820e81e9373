/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Posts: acyclic datagrams whose result comes by a call. No thread waits for them, so what
 * goes on by itself, as the mailbox of a slave, needs none of its own. With cyclic access the
 * cycle owner takes posts along with its next send, and what comes back with a receive may be
 * posted again before the send of the same cycle.
 *
 *   IDLE -> READY -> FLYING -> IDLE
 */
#ifndef EC_POST_H
#define EC_POST_H

#include <linux/list.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include "xfer.h"

struct ec_links;
struct ec_slot;
struct task_struct;

enum ec_post_state {
	EC_POST_IDLE,
	EC_POST_READY,
	EC_POST_FLYING,
};

/** struct ec_post - one datagram; it belongs to its owner while it is IDLE */
struct ec_post {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @done: the datagram is back, or lost; RT-safe, any context; immutable */
	void (*done)(struct ec_post *post);
	/** @call: what ec_post_call() requests; process context, may sleep; immutable */
	void (*call)(struct ec_post *post);
	/** @dg: the datagram, with its result */
	struct ec_dg dg;

	/** @list: in one of the lists of struct ec_posts, whose lock protects these members */
	struct list_head list;
	/** @called: in the list of requested calls */
	struct list_head called;
	/** @due_ns: not sent before that time (ktime) */
	u64 due_ns;
	/** @state: enum ec_post_state */
	u8 state;
	/** @tries: frames with it that were lost in a row */
	u8 tries;
	/** @overdue: looks at which its frame was overdue: at the second one it is lost */
	u8 overdue;
	/** @running: calls of @done and @call in progress */
	u8 running;
	/** @placed: has a place at the link's gate */
	bool placed;
	/** @polls: receives of the cycle at the last look */
	u32 polls;
	/** @wire_ns: wire time of its frame */
	u32 wire_ns;
	/** @x: its slot is back */
	struct ec_xfer x;
	/** @slot: slot while it is FLYING */
	struct ec_slot *slot;
};

/** struct ec_posts - posts of a master */
struct ec_posts {
	/** @lock: protects the other members, and the states of all posts */
	raw_spinlock_t lock;
	/** @ready: to be sent, the oldest first */
	struct list_head ready;
	/** @flying: in a slot */
	struct list_head flying;
	/** @calls: posts with a requested call */
	struct list_head calls;
	/** @n_ready: entries in @ready */
	unsigned int n_ready;
	/** @n_flying: entries in @flying */
	unsigned int n_flying;
	/** @overdue: a frame was overdue at the last look */
	bool overdue;
	/** @closed: nothing is sent any more */
	bool closed;
	/** @kicked: @thread has something to do */
	bool kicked;
	/** @thread: sends with direct access, finds lost frames, makes the calls */
	struct task_struct *thread;
};

int ec_posts_init(struct ec_links *l);
void ec_posts_exit(struct ec_links *l);
void ec_posts_kick(struct ec_links *l);
void ec_post_init(struct ec_post *post, struct ec_links *l, void (*done)(struct ec_post *post),
		  void (*call)(struct ec_post *post));
void ec_post_send(struct ec_post *post, u64 due_ns);
bool ec_post_recall(struct ec_post *post);
void ec_post_call(struct ec_post *post);
void ec_post_cancel(struct ec_post *post);

/* for the owner of the links */
void ec_posts_fill(struct ec_links *l);

#endif
