/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Posts: acyclic datagrams, some that fit into one frame. Whatever is not cyclic goes as posts:
 * a step of a mailbox is one, ec_xfer() is a window of them and a completion.
 *
 *   IDLE -> READY -> FLYING -> IDLE
 *             ^---------/  its frame was lost, and it may be sent again
 *
 * Its end is one of reply, loss and cancel. Reply and loss are told by @done, once:
 *
 * - in the context that has received the frame, possibly a hard interrupt on PREEMPT_RT, or by
 *   the thread of the posts: so it takes no sleeping lock, and what it does is bounded;
 * - also when the device of the link has gone away;
 * - it may send its post again;
 * - never after ec_post_cancel() has returned: then the memory may be freed, and a reply that
 *   comes later finds nothing.
 *
 * A post belongs to its user, who provides its memory and that of its datagrams. While it is
 * READY or FLYING no other thread changes them. Nothing is allocated for a frame.
 */
#ifndef EC_POST_H
#define EC_POST_H

#include <linux/completion.h>
#include <linux/list.h>
#include <linux/types.h>
#include "dg.h"

struct ec_links;

/* In this order a list of them is looked through. */
enum ec_post_class {
	EC_POST_NORMAL,
	EC_POST_URGENT,		/* of the monitor: before what others have left */
	EC_POST_CLOCK,		/* sets clocks: many, which others do not wait behind */
	EC_POST_CLASSES
};

enum ec_post_state {
	EC_POST_IDLE,
	EC_POST_READY,
	EC_POST_FLYING,
};

/**
 * struct ec_post_wait - a caller that sleeps until its posts have ended
 * @pending: posts that have not ended, under the lock of the posts
 * @done: completed when there is none
 */
struct ec_post_wait {
	unsigned int pending;
	struct completion done;
};

/** struct ec_post - datagrams in a frame; it belongs to its user while it is IDLE */
struct ec_post {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @done: all datagrams have their results; see above; immutable */
	void (*done)(struct ec_post *post);
	/** @wait: who sleeps instead, with @done NULL */
	struct ec_post_wait *wait;
	/** @dg: the datagrams, which the user sets */
	struct ec_dg *dg;
	/** @n: how many, which the user sets */
	u16 n;
	/** @class: enum ec_post_class, which the user sets */
	u8 class;
	/** @sides: mask of the links on which it is sent, which the user sets; 0: all */
	u8 sides;

	/** @list: of the posts that are READY, or of its frame; the lock protects what follows */
	struct list_head list;
	/** @due_ns: not sent before that time (ktime) */
	u64 due_ns;
	/** @since_ns: when it was sent by its user (ktime) */
	u64 since_ns;
	/** @len: bytes of its datagrams that have no result, with headers and counters */
	u16 len;
	/** @at: where they begin in the frame, behind the EtherType */
	u16 at;
	/** @dgrams: how many they are */
	u8 dgrams;
	/** @slot: index of its frame while it is FLYING */
	u8 slot;
	/** @state: enum ec_post_state */
	u8 state;
	/** @tries: frames with it that were lost in a row */
	u8 tries;
	/** @running: its end is being told */
	bool running;
};

void ec_post_init(struct ec_post *post, struct ec_links *l, void (*done)(struct ec_post *post));
void ec_post_send(struct ec_post *post, u64 due_ns);
bool ec_post_recall(struct ec_post *post);
bool ec_post_give_up(struct ec_post *post, unsigned int n, int err);
void ec_post_cancel(struct ec_post *post);

#endif
