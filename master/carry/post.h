/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * Posts: a post is a few acyclic datagrams that fit into one frame. All acyclic frames consist of
 * posts: a step of a mailbox is one, ec_xfer() is a window of them and a completion.
 *
 *   IDLE -> READY -> FLYING -> IDLE
 *             ^---------/  its frame was lost, and it may be sent again
 *
 * A post ends by a reply, a loss or a cancel. @done reports a reply or a loss, once:
 *
 * - it runs in the context that has received or sent the frame, possibly a hard interrupt on
 *   PREEMPT_RT, or in the thread of the posts: so it is bounded and takes no sleeping lock;
 * - that of a patient post which a cycle owner receives runs in its next send, behind the process
 *   data;
 * - it runs as well when the device of the link was withdrawn;
 * - it may send its post again;
 * - it never runs after ec_post_cancel() has returned: the memory may be freed then, and a late
 *   reply does not access it.
 *
 * A post belongs to its user, which provides its memory and that of its datagrams. While it is
 * READY or FLYING the user does not change them. Nothing is allocated for a frame.
 */
#ifndef EC_POST_H
#define EC_POST_H

#include <linux/completion.h>
#include <linux/list.h>
#include <linux/types.h>
#include "dg.h"

struct ec_links;

/* which of the posts that wait are sent first */
enum ec_post_class {
	EC_POST_NORMAL,
	EC_POST_URGENT,		/* of the monitor: before posts of other callers */
	EC_POST_CLOCK,		/* sets clocks: they are many, others do not wait behind them */
	EC_POST_TRAIN,		/* each in a frame of its own, in one send, before all others */
	EC_POST_CLASSES
};

enum ec_post_state {
	EC_POST_IDLE,
	EC_POST_READY,
	EC_POST_FLYING,
};

/** struct ec_post_wait - a caller that sleeps until its posts have ended */
struct ec_post_wait {
	/** @pending: posts that have not ended, under the lock of the posts */
	unsigned int pending;
	/** @done: completed when there is none */
	struct completion done;
};

/** struct ec_post - datagrams in a frame; it belongs to its user while it is IDLE */
struct ec_post {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @done: all datagrams have their results; see above; immutable */
	void (*done)(struct ec_post *post);
	/** @wait: the caller that sleeps instead, with @done NULL */
	struct ec_post_wait *wait;
	/** @dg: the datagrams, which the user sets */
	struct ec_dg *dg;
	/** @n: how many, which the user sets */
	u16 n;
	/** @class: enum ec_post_class, which the user sets */
	u8 class;
	/** @train: of class EC_POST_TRAIN: posts that leave together, from this one on */
	u8 train;
	/** @sides: mask of the links on which it is sent, which the user sets; 0: all */
	u8 sides;
	/** @shift: added to the positions in its datagrams, see ec_ring_way() */
	u16 shift;
	/** @patient: its end may wait until the cycle has sent, which the user sets */
	bool patient;

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
	/** @running: its end is being reported */
	bool running;
};

void ec_post_init(struct ec_post *post, struct ec_links *l, void (*done)(struct ec_post *post));
void ec_post_send(struct ec_post *post, u64 due_ns);
bool ec_post_recall(struct ec_post *post);
bool ec_post_give_up(struct ec_post *post, unsigned int n, int err);
void ec_post_cancel(struct ec_post *post);

#endif
