// SPDX-License-Identifier: GPL-2.0-only
/*
 * No event reports a loss, so a thread checks for overdue frames, links that are down, and posts
 * that wait for too long. With direct access it also sends posts that no caller sends. While there
 * is no post, it sleeps without a timer.
 */
#include <linux/bitmap.h>
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include <linux/module.h>
#include <linux/sched.h>
#include "../base/once64.h"
#include "../kernel/compat.h"
#include "direct.h"
#include "flight.h"
#include "loss.h"
#include "post_int.h"

#define LOOK_NS		NSEC_PER_MSEC	/* between two checks, at least */
#define REST_NS		(20 * NSEC_PER_MSEC)	/* between two checks of posts, at most */
#define RETRY_NS	(100 * NSEC_PER_USEC)	/* until a transmit buffer may be free */
#define SLEEP_MIN_NS	(10 * NSEC_PER_USEC)
#define SLOWEST		4	/* a device that sends at 25 Mbit/s instead of 100 */
#define STUCK_CYCLES	100	/* a frame not sent after so many is too long for the cycle */
#define STUCK_NS	(50 * NSEC_PER_MSEC)	/* if this time is over as well */
#define FULL_NS		NSEC_PER_SEC	/* a device that sends nothing for so long has failed */
#define WAIT_NS		(30 * (u64)NSEC_PER_SEC)	/* hundreds of callers may wait */

static bool fifo = true;
module_param_named(fifo_posts, fifo, bool, 0444);
MODULE_PARM_DESC(fifo_posts, "The thread that looks for lost acyclic frames has SCHED_FIFO 1 (Y)");

/**
 * ec_loss_watch() - let the thread check each millisecond: a caller has waited that long
 * @c: posts of the master
 *
 * Context: Process.
 */
void ec_loss_watch(struct ec_carry *c)
{
	if (READ_ONCE(c->watched))
		return;
	WRITE_ONCE(c->watched, true);
	ec_carry_kick(c);
}

/* frames in flight ----------------------------------------------------------*/

/* State of the links at a check. */
struct look {
	u64 now;
	u8 up;		/* mask */
	u8 there;	/* with a device */
};

static void look_at_links(struct ec_links *l, struct look *k)
{
	unsigned int i;

	k->now = ktime_get_ns();
	k->up = 0;
	k->there = 0;
	for (i = 0; i < EC_MAX_LINKS; i++) {
		if (READ_ONCE(l->link[i].dev))
			k->there |= BIT(i);
		if (ec_link_is_up(&l->link[i]))
			k->up |= BIT(i);
	}
}

static int loss_error(const struct look *k, u8 sides)
{
	return sides & k->up ? 0 : sides & k->there ? -ENETDOWN : -ENODEV;
}

static u64 limit_ns(const struct ec_links *l)
{
	u64 ns = l->io_timeout_us * (u64)NSEC_PER_USEC;

	if (ec_access_is_cyclic(&l->access))
		return ns;
	/* half of it is for the frame, the rest for frames in flight before it */
	return max(ns, ns / 2 + SLOWEST * (u64)ec_links_acyclic_ns(l));
}

/*
 * Why a frame is lost; 0: it may still be received. A timeout takes two checks with a poll of the
 * device between them: the whole machine may have stood still.
 */
static int outcome(struct ec_carry *c, unsigned int i, const struct look *k)
{
	struct ec_links *l = c->links;
	struct ec_flight *f = &c->flight[i];
	u32 polls = READ_ONCE(l->access.polls);
	int err = loss_error(k, f->sides);

	lockdep_assert_held(&c->lock);
	if (err)
		return err;
	if ((s64)(k->now - ec_read64(&l->slots.slot[i].sent_ns)) <= (s64)limit_ns(l))
		return 0;
	if (ec_access_is_cyclic(&l->access) && polls == f->polls)
		return 0;
	f->polls = polls;
	c->overdue = true;
	return f->overdue++ ? -ETIMEDOUT : 0;
}

static void look_at_frame(struct ec_carry *c, unsigned int i, const struct look *k)
{
	struct ec_slot *slot = &c->links->slots.slot[i];
	bool settled = false, lost = false;
	unsigned long flags;
	LIST_HEAD(posts);
	int err = 0;
	u8 sides;

	raw_spin_lock_irqsave(&c->lock, flags);
	if (test_bit(i, c->flying) && atomic_read(&slot->state) == EC_SLOT_SENT)
		err = outcome(c, i, k);
	if (err) {
		/* a frame with the copy of one link is not lost */
		settled = ec_slot_settle(slot);
		lost = !settled && ec_slot_cancel(slot, k->now);
	}
	sides = slot->sides;
	if (lost)
		ec_flight_end(c, slot, &posts);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	if (settled)
		ec_flight_landed(slot);
	if (!lost)
		return;
	ec_links_lost(c->links, slot, sides);
	ec_post_lost(c, &posts, err);
}

/* posts that have not left --------------------------------------------------*/

/* Has the first post waited so long for free wire time that it is too long for the cycle? */
static bool is_stuck(const struct ec_carry *c, const struct look *k)
{
	u64 limit = ec_access_interval_us(&c->links->access) * (u64)NSEC_PER_USEC * STUCK_CYCLES;
	u32 late_per_s = READ_ONCE(c->share.late_per_s);	/* a takeover may change it */
	u64 since = ec_read64(&c->stuck_ns);

	lockdep_assert_held(&c->lock);
	if (!since || !ec_access_is_cyclic(&c->links->access))
		return false;
	limit = max(limit, (u64)STUCK_NS);
	if (late_per_s)
		limit += 2 * NSEC_PER_SEC / late_per_s;
	return (s64)(k->now - since) > (s64)limit;
}

/* Why a post will not be sent; 0: it may still be. */
static int refusal(struct ec_carry *c, const struct ec_post *post, const struct look *k)
{
	u64 since = max(post->since_ns, post->due_ns), full = ec_read64(&c->full_ns);
	int err = loss_error(k, post->sides);

	lockdep_assert_held(&c->lock);
	if (err)
		return err;
	if (post->due_ns > k->now)
		return 0;
	if (full && (s64)(k->now - full) > (s64)FULL_NS) {
		ec_links_count(c->links, post->sides, tx_errors);
		return -EBUSY;
	}
	return (s64)(k->now - since) > (s64)WAIT_NS ? -EBUSY : 0;
}

static void look_at_list(struct ec_carry *c, struct list_head *list, const struct look *k,
			 bool stuck, struct list_head *ended)
{
	struct ec_post *post, *next;

	lockdep_assert_held(&c->lock);
	list_for_each_entry_safe(post, next, list, list) {
		int err = refusal(c, post, k);

		if (!err && stuck)
			err = -EAGAIN;
		/* only the first post is stuck, or a train */
		stuck &= post->class == EC_POST_TRAIN;
		if (err)
			ec_post_refuse(c, post, err, ended);
	}
}

static void look_at_ready(struct ec_carry *c, const struct look *k)
{
	unsigned long flags;
	unsigned int class;
	LIST_HEAD(ended);

	raw_spin_lock_irqsave(&c->lock, flags);
	for (class = 0; class < EC_POST_CLASSES; class++) {
		bool stuck = class == c->stuck_class && is_stuck(c, k);

		if (stuck)
			ec_write64(&c->stuck_ns, 0);
		look_at_list(c, &c->ready[class], k, stuck, &ended);
	}
	look_at_list(c, &c->later, k, false, &ended);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	ec_post_finish(c, &ended);
}

/* thread --------------------------------------------------------------------*/

static void look_at_all(struct ec_carry *c)
{
	struct ec_links *l = c->links;
	DECLARE_BITMAP(flying, EC_SLOTS);
	unsigned long flags;
	unsigned int i;
	struct look k;

	/* replies may wait in a device; some devices read their link state only by a look */
	if (c->overdue) {
		for (i = 0; i < EC_MAX_LINKS; i++)
			ec_link_look(&l->link[i]);
		ec_access_poll(l);
	}
	/* the monitor checks this as well, but may be a caller that waits here */
	if (ec_access_is_cyclic(&l->access) && ec_access_timed_out(l))
		ec_access_timeout(l);
	look_at_links(l, &k);
	raw_spin_lock_irqsave(&c->lock, flags);
	bitmap_copy(flying, c->flying, EC_SLOTS);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	c->overdue = false;
	/* the cycle owner has received, and sends no more */
	if (ec_carry_has_landed(c))
		ec_flight_land(c);
	for_each_set_bit(i, flying, EC_SLOTS)
		look_at_frame(c, i, &k);
	look_at_ready(c, &k);
	if (!atomic_read(&c->waiting))
		WRITE_ONCE(c->watched, false);
}

/* Time (ktime) at which the thread has to send a post. */
static u64 until_due(struct ec_carry *c, u64 now)
{
	unsigned int class;

	lockdep_assert_held(&c->lock);
	if (ec_access_is_cyclic(&c->links->access))
		return U64_MAX;
	for (class = 0; class < EC_POST_CLASSES; class++)
		if (!list_empty(&c->ready[class]))
			return now + RETRY_NS;
	return c->due_ns;
}

/* Time (ktime) until which the thread may sleep; U64_MAX: until it is kicked. */
static u64 idle_until(struct ec_carry *c, u64 looked)
{
	struct ec_links *l = c->links;
	u64 until = U64_MAX, limit = limit_ns(l), now = ktime_get_ns();
	unsigned long flags;
	unsigned int i;

	raw_spin_lock_irqsave(&c->lock, flags);
	if (ec_carry_is_busy(c))
		until = now + REST_NS;
	for_each_set_bit(i, c->flying, EC_SLOTS)
		until = min(until, ec_read64(&l->slots.slot[i].sent_ns) + limit + 1);
	if (READ_ONCE(c->watched))
		until = now;
	until = max(until, looked + LOOK_NS);
	/* held posts are sent when a reply is received */
	if (!READ_ONCE(c->held))
		until = min(until, until_due(c, now));
	raw_spin_unlock_irqrestore(&c->lock, flags);
	return until;
}

/* The thread has not run, for example because of a loop of higher priority on its CPU. */
static enum hrtimer_restart starved(struct hrtimer *t)
{
	struct ec_carry *c = container_of(t, struct ec_carry, starved);
	struct ec_base *b = c->links->base;
	u64 now = ktime_get_ns(), since = now - ec_read64(&c->looked_ns);

	/* the whole machine stood still, like a paused guest: one more second */
	if (now - ktime_to_ns(hrtimer_get_expires(t)) > NSEC_PER_SEC / 10)
		since = 0;
	/* it has nothing to do: it went to rest just as the timer was started */
	if (READ_ONCE(c->rests) && !READ_ONCE(c->kicked))
		return HRTIMER_NORESTART;
	if (since < EC_STARVED_NS) {
		hrtimer_forward_now(t, ns_to_ktime(EC_STARVED_NS - since));
		return HRTIMER_RESTART;
	}
	/* the timer was started on the CPU of the thread, or where it was kicked */
	ec_log_event(b, EC_LOG_ANY, 0, KERN_WARNING,
		     "thread EtherCAT%u-post has not run for a second: a thread of higher priority keeps its CPU, perhaps %u; lost frames are not found meanwhile, mailboxes wait\n",
		     b->index, raw_smp_processor_id());
	return HRTIMER_NORESTART;
}

static void sleep_until(struct ec_carry *c, u64 until)
{
	u64 now = ktime_get_ns(), at = max(until, now + SLEEP_MIN_NS);
	ktime_t limit = ns_to_ktime(at);

	set_current_state(TASK_IDLE);
	if (!kthread_should_stop() && !READ_ONCE(c->kicked)) {
		if (until == U64_MAX) {
			schedule();
		} else {
			ec_carry_expect(c, at - now);
			schedule_hrtimeout(&limit, HRTIMER_MODE_ABS);
		}
	}
	__set_current_state(TASK_RUNNING);
}

/* Sleep until a time (ktime), or a kick. With U64_MAX not if there are posts by now. */
static void rest(struct ec_carry *c, u64 until)
{
	/* a kick that finds it at rest starts the timer again */
	if (until == U64_MAX)
		hrtimer_try_to_cancel(&c->starved);
	WRITE_ONCE(c->rests, until == U64_MAX);
	smp_mb();	/* @rests before the posts; pairs with ec_post_send() */
	if (until != U64_MAX || !ec_carry_is_busy(c))
		sleep_until(c, until);
	WRITE_ONCE(c->rests, false);
}

static int run(void *data)
{
	struct ec_carry *c = data;
	u64 looked = 0;

	if (fifo)
		sched_set_fifo_low(current);
	while (!kthread_should_stop()) {
		WRITE_ONCE(c->kicked, false);
		smp_mb();	/* cleared before the posts are read */
		if (ec_carry_has_left(c) && !ec_direct_push_on(c))
			usleep_range(RETRY_NS / 1000, RETRY_NS / 500);
		if (ktime_get_ns() - looked >= LOOK_NS) {
			looked = ktime_get_ns();
			ec_write64(&c->looked_ns, looked);
			if (ec_carry_is_busy(c))
				look_at_all(c);
			else
				WRITE_ONCE(c->watched, false);
		}
		rest(c, idle_until(c, looked));
	}
	return 0;
}

/**
 * ec_loss_start() - start the thread of the posts
 * @c: posts of a master
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_loss_start(struct ec_carry *c)
{
	struct task_struct *t;

	hrtimer_setup(&c->starved, starved, CLOCK_MONOTONIC, HRTIMER_MODE_REL_HARD);
	t = kthread_run(run, c, "EtherCAT%u-post", c->links->base->index);
	if (IS_ERR(t))
		return PTR_ERR(t);
	WRITE_ONCE(c->thread, t);
	ec_carry_kick(c);
	return 0;
}

/**
 * ec_loss_stop() - end the thread
 * @c: posts of a master
 *
 * Context: Process. May sleep.
 */
void ec_loss_stop(struct ec_carry *c)
{
	struct task_struct *t = c->thread;

	WRITE_ONCE(c->thread, NULL);
	if (!t)
		return;
	kthread_stop(t);
	hrtimer_cancel(&c->starved);
}

/**
 * ec_loss_end_all() - all posts end with -ENODEV
 * @c: posts of a master, closed, without thread
 *
 * Context: Process. May sleep.
 */
void ec_loss_end_all(struct ec_carry *c)
{
	const struct look none = { .now = ktime_get_ns() };
	unsigned int i;

	ec_flight_land(c);
	for (i = 0; i < EC_SLOTS; i++)
		look_at_frame(c, i, &none);
	look_at_ready(c, &none);
}
