/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The layer "carry": all acyclic frames consist of posts. With direct access the sender of a post
 * sends its frame, or the thread of the posts does. With cyclic access the cycle owner sends posts
 * that fit beside the cycle.
 */
#ifndef EC_CARRY_H
#define EC_CARRY_H

#include <linux/bitmap.h>
#include <linux/hrtimer.h>
#include <linux/list.h>
#include <linux/spinlock.h>
#include "../link/links.h"
#include "armw.h"
#include "post.h"
#include "share.h"

#define EC_STARVED_NS	((u64)NSEC_PER_SEC)	/* the thread has not run for so long: reported */

struct ec_carry;
struct task_struct;

/** struct ec_carry_ops - what the layer reports to higher ones; each may be NULL */
struct ec_carry_ops {
	/** @queued: a post waits for the cycle; with the access lock held */
	void (*queued)(struct ec_carry *c);
};

/** struct ec_flight - posts in one frame, while its slot is in use for them */
struct ec_flight {
	/** @posts: in their order in the frame */
	struct list_head posts;
	/** @wire_ns: wire time of the frame */
	u32 wire_ns;
	/** @polls: struct ec_access.polls at the send, later at the last overdue check */
	u32 polls;
	/** @sides: mask of the links whose @acyclic counts it */
	u8 sides;
	/** @class: enum ec_post_class of its posts */
	u8 class;
	/** @overdue: checks at which it was overdue: at the second one it is lost */
	u8 overdue;
	/** @built: the frame has been written; its posts may be cancelled */
	bool built;
	/** @patient: all its posts are */
	bool patient;
};

/** struct ec_carry - posts of a master */
struct ec_carry {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @ops: immutable */
	const struct ec_carry_ops *ops;
	/** @ref_minus_ktime: time of the reference clock less ktime, ns, or NULL; immutable */
	const atomic64_t *ref_minus_ktime;
	/** @armw: how the time of the reference clock is sent, or NULL; immutable */
	const struct ec_armw *armw;
	/**
	 * @clocks_held: posts do not give the time of the reference clock to other clocks;
	 * written by the cycle owner
	 */
	bool clocks_held;
	/** @monitor: thread whose posts overtake those of other callers, NULL: none */
	const struct task_struct *monitor;

	/** @lock: protects the posts, and the members up to @closed */
	raw_spinlock_t lock;
	/** @ready: posts to be sent, by enum ec_post_class, the oldest first */
	struct list_head ready[EC_POST_CLASSES];
	/** @later: posts that are not due */
	struct list_head later;
	/** @due_ns: when the first post of @later is due (ktime), U64_MAX: none */
	u64 due_ns;
	/** @n_ready: entries in @ready and @later */
	unsigned int n_ready;
	/** @flying: slots whose frame is in flight */
	DECLARE_BITMAP(flying, EC_SLOTS);
	/** @n_flying: bits in @flying */
	unsigned int n_flying;
	/** @flight: by index of the slot */
	struct ec_flight flight[EC_SLOTS];
	/** @landed: slots with the reply to patient posts, which have not ended; atomic */
	DECLARE_BITMAP(landed, EC_SLOTS);
	/** @has_landed: there may be some */
	bool has_landed;
	/** @polled: the cycle owner takes replies from the devices just now */
	bool polled;
	/** @stuck_ns: since when the first frame does not fit beside the cycle, ktime; or 0 */
	aligned_u64 stuck_ns;
	/** @stuck_class: of that frame, enum ec_post_class */
	u8 stuck_class;
	/** @full_ns: since when the transmit ring is full (ktime), 0: it is not */
	aligned_u64 full_ns;
	/** @held: the link is busy, posts wait; written by the owner of the bus access */
	bool held;
	/** @closed: no post is sent any more */
	bool closed;

	/** @share: limits of the posts that a cyclic send carries */
	struct ec_share share;

	/** @thread: finds lost frames; with direct access sends posts that no caller sends */
	struct task_struct *thread;
	/** @looked_ns: when @thread looked last (ktime) */
	aligned_u64 looked_ns;
	/** @kicked: @thread has something to do */
	bool kicked;
	/** @watched: @thread checks each millisecond, since a caller has waited that long */
	bool watched;
	/** @overdue: a frame was overdue at the last check; for @thread only */
	bool overdue;
	/** @rests: @thread sleeps until it is kicked */
	bool rests;
	/** @waiting: callers that sleep until their posts have ended */
	atomic_t waiting;
	/** @starved: reports that @thread has not run for a second although it should */
	struct hrtimer starved;
};

/* do posts wait to be sent, due or not? RT-safe */
static inline bool ec_carry_has_left(const struct ec_carry *c)
{
	return READ_ONCE(c->n_ready);
}

/* do replies to patient posts wait? RT-safe */
static inline bool ec_carry_has_landed(const struct ec_carry *c)
{
	return READ_ONCE(c->has_landed);
}

/* have posts not ended, in frames or not? */
static inline bool ec_carry_is_busy(const struct ec_carry *c)
{
	return READ_ONCE(c->n_ready) || READ_ONCE(c->n_flying);
}

void ec_carry_changed(struct ec_links *l);
void ec_carry_kick(struct ec_carry *c);
void ec_carry_expect(struct ec_carry *c, u64 after_ns);
bool ec_carry_has_place(const struct ec_carry *c, u8 class);

#endif
