/* SPDX-License-Identifier: GPL-2.0-only */
/*
 * The layer "carry": everything acyclic as posts. With direct access who sends a post sends its
 * frame, or the thread does; with cyclic access the cycle owner takes along what fits.
 */
#ifndef EC_CARRY_H
#define EC_CARRY_H

#include <linux/bitmap.h>
#include <linux/hrtimer.h>
#include <linux/list.h>
#include <linux/spinlock.h>
#include "../link/links.h"
#include "post.h"
#include "share.h"

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
	/** @polls: receives of the cycle at the last look */
	u32 polls;
	/** @sides: mask of the links for which it counts */
	u8 sides;
	/** @class: enum ec_post_class of its posts */
	u8 class;
	/** @overdue: looks at which it was overdue: at the second one it is lost */
	u8 overdue;
	/** @built: the frame has been written; its posts may be cancelled */
	bool built;
};

/** struct ec_carry - posts of a master */
struct ec_carry {
	/** @links: way to the slaves, immutable */
	struct ec_links *links;
	/** @ops: immutable */
	const struct ec_carry_ops *ops;
	/** @ref_minus_ktime: time of the reference clock less ktime, ns, or NULL; immutable */
	const atomic64_t *ref_minus_ktime;
	/** @monitor: thread whose posts overtake those of other callers, NULL: none */
	const struct task_struct *monitor;

	/** @lock: protects the posts, and the members up to @closed */
	raw_spinlock_t lock;
	/** @ready: posts to be sent, by enum ec_post_class, the oldest first */
	struct list_head ready[EC_POST_CLASSES];
	/** @later: posts that are not due */
	struct list_head later;
	/** @due_ns: when the first of these is (ktime), U64_MAX: there is none */
	u64 due_ns;
	/** @n_ready: entries in @ready and @later */
	unsigned int n_ready;
	/** @flying: slots whose frame is on its way */
	DECLARE_BITMAP(flying, EC_SLOTS);
	/** @n_flying: bits in @flying */
	unsigned int n_flying;
	/** @flight: by index of the slot */
	struct ec_flight flight[EC_SLOTS];
	/** @stuck_ns: since when the first frame does not fit beside the cycle, ktime; or 0 */
	aligned_u64 stuck_ns;
	/** @stuck_class: of that frame, enum ec_post_class */
	u8 stuck_class;
	/** @full_ns: since when the transmit ring takes nothing (ktime), 0: it does */
	aligned_u64 full_ns;
	/** @held: posts were left because the link is busy; of the owner of the links */
	bool held;
	/** @closed: nothing is sent any more */
	bool closed;

	/** @share: what a cyclic send carries of the posts */
	struct ec_share share;

	/** @thread: finds what is lost; sends with direct access what no caller sends */
	struct task_struct *thread;
	/** @kicked: @thread has something to do */
	bool kicked;
	/** @watched: @thread looks each millisecond: a caller has waited for longer */
	bool watched;
	/** @overdue: a frame was overdue at the last look; of @thread */
	bool overdue;
	/** @rests: @thread sleeps until it is kicked */
	bool rests;
	/** @waiting: callers that sleep until their posts have ended */
	atomic_t waiting;
	/** @starved: tells when @thread does not run although it should */
	struct hrtimer starved;
};

/* has anybody left posts for the next send? RT-safe */
static inline bool ec_carry_has_left(const struct ec_carry *c)
{
	return READ_ONCE(c->n_ready);
}

/* posts that have not ended, in frames or not */
static inline bool ec_carry_is_busy(const struct ec_carry *c)
{
	return READ_ONCE(c->n_ready) || READ_ONCE(c->n_flying);
}

void ec_carry_changed(struct ec_links *l);
void ec_carry_kick(struct ec_carry *c);
void ec_carry_expect(struct ec_carry *c, u64 after_ns);
bool ec_carry_has_place(const struct ec_carry *c, u8 class);

#endif
