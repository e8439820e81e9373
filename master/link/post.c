// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/kthread.h>
#include <linux/ktime.h>
#include "../base/once64.h"
#include "device.h"
#include "links.h"
#include "pack.h"
#include "post.h"

#define CHECK_NS	(2 * NSEC_PER_MSEC)	/* between looks for lost frames, at least */
#define REST_NS		(20 * NSEC_PER_MSEC)	/* and at most */
#define TRIES		4	/* of a repeatable datagram */
#define UNPLACED	16	/* posts that fly without a place at the link's gate */
#define QUEUE_MAX	64	/* frames that wait for the cycle, then posts wait as well */
#define RETRY_NS	(100 * NSEC_PER_USEC)	/* of a post for which there was no room */
#define QUEUE_CYCLES	100	/* a frame that has not left by then may be too long */
#define QUEUE_NS	(50 * NSEC_PER_MSEC)	/* or by then */
#define FLIGHT_NS	(300 * NSEC_PER_USEC)	/* on the wire: later ones leave together */
#define SLEEP_MIN_NS	(10 * NSEC_PER_USEC)
#define RING_US		200	/* until there may be room in the transmit ring */
#define SLOWEST		4	/* a device that sends at 25 Mbit/s instead of 100 */

static void kick(struct ec_posts *ps)
{
	struct task_struct *t = READ_ONCE(ps->thread);

	WRITE_ONCE(ps->kicked, true);
	if (t)
		wake_up_process(t);
}

/**
 * ec_posts_kick() - the bus access has changed: the thread of the posts looks
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_posts_kick(struct ec_links *l)
{
	kick(&l->posts);
}

/**
 * ec_post_init() - prepare a post
 * @post: zeroed structure
 * @l: links
 * @done: called when the datagram is back or lost; may call ec_post_send()
 * @call: called by a thread of the master after ec_post_call()
 *
 * Context: Any.
 */
void ec_post_init(struct ec_post *post, struct ec_links *l, void (*done)(struct ec_post *post),
		  void (*call)(struct ec_post *post))
{
	post->links = l;
	post->done = done;
	post->call = call;
	INIT_LIST_HEAD(&post->list);
	INIT_LIST_HEAD(&post->called);
}

static void make_ready(struct ec_posts *ps, struct ec_post *post, u64 due_ns)
{
	lockdep_assert_held(&ps->lock);
	post->state = EC_POST_READY;
	post->due_ns = due_ns;
	list_add_tail(&post->list, &ps->ready);
	WRITE_ONCE(ps->n_ready, ps->n_ready + 1);
}

static void take_ready(struct ec_posts *ps, struct ec_post *post)
{
	lockdep_assert_held(&ps->lock);
	list_del_init(&post->list);
	WRITE_ONCE(ps->n_ready, ps->n_ready - 1);
}

/**
 * ec_post_send() - send a post
 * @post: IDLE; its datagram stays as it is until @done is called
 * @due_ns: not before that time (ktime); 0: as soon as possible
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_post_send(struct ec_post *post, u64 due_ns)
{
	struct ec_posts *ps = &post->links->posts;
	unsigned long flags;
	bool first;

	raw_spin_lock_irqsave(&ps->lock, flags);
	first = !ps->n_ready && !ps->n_flying;
	if (!ps->closed)
		make_ready(ps, post, due_ns);
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	/* the cycle takes it along; the thread only has to know that there is something */
	if (first || !ec_access_is_cyclic(&post->links->access))
		kick(ps);
}

/**
 * ec_post_recall() - take a post back that was not sent so far
 * @post: post in any state
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: it is IDLE, and @done is not called.
 */
bool ec_post_recall(struct ec_post *post)
{
	struct ec_posts *ps = &post->links->posts;
	unsigned long flags;
	bool ready;

	raw_spin_lock_irqsave(&ps->lock, flags);
	ready = post->state == EC_POST_READY;
	if (ready) {
		take_ready(ps, post);
		post->state = EC_POST_IDLE;
		post->tries = 0;
	}
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	return ready;
}

/**
 * ec_post_call() - let a thread of the master call @post->call once
 * @post: post in any state
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_post_call(struct ec_post *post)
{
	struct ec_posts *ps = &post->links->posts;
	unsigned long flags;

	raw_spin_lock_irqsave(&ps->lock, flags);
	if (list_empty(&post->called))
		list_add_tail(&post->called, &ps->calls);
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	kick(ps);
}

static void leave_slot(struct ec_post *post)
{
	struct ec_link *link = &post->links->link[0];

	if (post->placed)
		ec_gate_leave(&link->acyclic);
	atomic_sub(post->wire_ns, &link->acyclic_ns);
	post->slot = NULL;
}

static void land(struct ec_posts *ps, struct ec_post *post)
{
	lockdep_assert_held(&ps->lock);
	list_del_init(&post->list);
	WRITE_ONCE(ps->n_flying, ps->n_flying - 1);
	post->state = EC_POST_IDLE;
	post->running++;
}

/**
 * ec_post_cancel() - wait until a post is IDLE and none of its calls is in progress
 * @post: post whose owner sends it no more; not the one whose call this is
 *
 * Context: Process. May sleep, as long as the call takes.
 */
void ec_post_cancel(struct ec_post *post)
{
	struct ec_posts *ps = &post->links->posts;
	bool over, cancelled;
	unsigned long flags;

	for (;;) {
		raw_spin_lock_irqsave(&ps->lock, flags);
		list_del_init(&post->called);
		cancelled = false;
		if (post->state == EC_POST_READY) {
			take_ready(ps, post);
			post->state = EC_POST_IDLE;
		} else if (post->state == EC_POST_FLYING) {
			/* the cycle owner may need long, or never come back */
			cancelled = ec_slot_cancel(post->slot, ktime_get_ns());
			if (cancelled) {
				land(ps, post);
				post->running--;
			}
		}
		over = post->state == EC_POST_IDLE && !post->running;
		raw_spin_unlock_irqrestore(&ps->lock, flags);
		if (cancelled)
			leave_slot(post);
		if (over)
			return;
		usleep_range(200, 500);
	}
}

/* back and lost -------------------------------------------------------------*/

/* A call of the owner; the post stays until it has returned. */
static void call(struct ec_post *post, void (*fn)(struct ec_post *post))
{
	struct ec_posts *ps = &post->links->posts;
	unsigned long flags;

	fn(post);
	raw_spin_lock_irqsave(&ps->lock, flags);
	post->running--;
	raw_spin_unlock_irqrestore(&ps->lock, flags);
}

/* Its slot is back, in the context that receives. */
static void back(struct ec_xfer *x)
{
	struct ec_post *post = container_of(x, struct ec_post, x);
	struct ec_posts *ps = &post->links->posts;
	struct ec_slot *slot = post->slot;
	struct ec_dg *dg = &post->dg;
	struct ec_frame_iter it;
	struct ec_dgram d;
	unsigned long flags;

	raw_spin_lock_irqsave(&ps->lock, flags);
	land(ps, post);
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	/* checked against what was sent when it was matched */
	ec_frame_iter_init(&it, ec_slot_body(slot), slot->eth_len - EC_ETH_HDR);
	dg->err = -EIO;
	if (ec_frame_iter_next(&it, &d) == 1)
		ec_dg_take(dg, &d, slot->sent_ns);
	ec_slot_put(slot);
	leave_slot(post);
	post->tries = 0;
	call(post, post->done);
}

/* It will not come back: again, if that changes nothing at the slave. */
static void lose(struct ec_post *post, int err)
{
	struct ec_posts *ps = &post->links->posts;
	unsigned long flags;
	bool again;

	if (post->slot) {
		if (ec_slot_leads(post->slot) && err == -ETIMEDOUT)
			atomic64_inc(&post->links->link[0].stats.lost);
		leave_slot(post);
	}
	again = err == -ETIMEDOUT && post->dg.repeat && post->tries < TRIES - 1;
	post->tries = again ? post->tries + 1 : 0;
	if (!again) {
		post->dg.err = err;
		call(post, post->done);
		return;
	}
	raw_spin_lock_irqsave(&ps->lock, flags);
	make_ready(ps, post, 0);
	post->running--;
	raw_spin_unlock_irqrestore(&ps->lock, flags);
}

/* sending -------------------------------------------------------------------*/

static void build(struct ec_links *l, struct ec_post *post)
{
	struct ec_slot *slot = post->slot;
	const struct ec_dg *dg = &post->dg;
	struct ec_frame_buf fb;
	u8 *p;

	ec_frame_begin(&fb, ec_slot_body(slot), EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	p = ec_frame_add(&fb, dg->cmd, slot->index, dg->adp, dg->ado, dg->len);
	ec_dg_fill(dg, p);
	/* one that a slave never forwards must not take others with it twice */
	slot->dgrams = post->tries ? 0 : 1;
	slot->last = 0;
	slot->clock = false;
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
}

/* Put a post into the queue of the cycle; false: there is no room now. */
static bool take_off(struct ec_links *l, struct ec_post *post, u64 now)
{
	struct ec_posts *ps = &l->posts;
	struct ec_link *link = &l->link[0];

	lockdep_assert_held(&ps->lock);
	post->placed = ec_gate_try(&link->acyclic);
	if (!post->placed && ps->n_flying >= UNPLACED)
		return false;
	post->slot = ec_slot_get(&l->slots, false, now);
	if (!post->slot) {
		if (post->placed)
			ec_gate_leave(&link->acyclic);
		return false;
	}
	build(l, post);
	post->wire_ns = ec_frame_wire_ns(post->slot->eth_len);
	atomic_add(post->wire_ns, &link->acyclic_ns);
	atomic_set(&post->x.pending, 1);
	post->x.notify = back;
	post->slot->xfer = &post->x;
	post->overdue = 0;
	post->polls = READ_ONCE(l->access.polls);
	ec_slot_queue(&l->slots, post->slot, l->carry, now);
	if (!ec_queue_push(&l->queues, post->slot, false)) {
		take_ready(ps, post);
		post->state = EC_POST_FLYING;
		list_add_tail(&post->list, &ps->flying);
		WRITE_ONCE(ps->n_flying, ps->n_flying + 1);
		return true;
	}
	/* it has not left, so no reply can have been taken but a forged one */
	if (ec_slot_disarm(post->slot))
		ec_slot_put(post->slot);
	leave_slot(post);
	return false;
}

/**
 * ec_posts_fill() - move posts to the queue of acyclic frames
 * @l: links
 *
 * With cyclic access as many as half of the free wire time carries, so that the time of
 * a cycle is limited; with direct access as many as keep the wire busy, so that those that
 * become ready meanwhile share frames.
 *
 * Context: The owner of the links. RT-safe.
 */
void ec_posts_fill(struct ec_links *l)
{
	u32 bytes = ec_access_slack_ns(l) / 2 / 80, used = 0;
	struct ec_posts *ps = &l->posts;
	struct ec_post *post, *next;
	u64 now = ktime_get_ns();
	unsigned long flags;

	raw_spin_lock_irqsave(&ps->lock, flags);
	list_for_each_entry_safe(post, next, &ps->ready, list) {
		if (post->due_ns > now)
			continue;
		if (!ec_access_is_cyclic(&l->access) && ps->n_flying &&
		    ec_links_acyclic_ns(l) >= FLIGHT_NS)
			break;
		if (used && used + post->dg.len + EC_DGRAM_OVERHEAD > bytes)
			break;
		if (ec_queue_frames(&l->queues) >= QUEUE_MAX || !take_off(l, post, now))
			break;
		used += post->dg.len + EC_DGRAM_OVERHEAD;
	}
	raw_spin_unlock_irqrestore(&ps->lock, flags);
}

/* Send what is in the queue, several datagrams in a frame. False: the ring is full. */
static bool send_queue(struct ec_links *l)
{
	const struct ec_pack_room room = {
		.len = EC_FRAME_HDR + EC_FRAME_BODY_MAX, .dgrams = l->max_datagrams,
	};
	struct ec_queued next;
	struct ec_pack pack;
	int ret = 0;

	lockdep_assert_held(&l->access.lock);
	rcu_read_lock();
	while (ret != -EBUSY && ec_queue_peek(&l->queues, &l->queues.acyclic, &next)) {
		ec_queue_gather(&l->queues, &l->queues.acyclic, &next, &room, &pack);
		if (pack.n)
			ret = ec_links_send_pack(l, &pack, ktime_get_ns());
	}
	ec_links_flush(l);
	rcu_read_unlock();
	return ret != -EBUSY;
}

/* With direct access the thread sends; else the cycle owner gets to know of it. */
static bool send_ready(struct ec_links *l)
{
	bool ok = true;

	rt_mutex_lock(&l->access.lock);
	if (READ_ONCE(l->access.mode) == EC_ACCESS_DIRECT) {
		ec_posts_fill(l);
		ok = send_queue(l);
	} else if (l->ops && l->ops->queued) {
		l->ops->queued(l);
	}
	rt_mutex_unlock(&l->access.lock);
	return ok;
}

/* lost frames ---------------------------------------------------------------*/

static u64 limit_ns(const struct ec_links *l)
{
	u64 ns = l->io_timeout_us * (u64)NSEC_PER_USEC;

	if (ec_access_is_cyclic(&l->access))
		return ns;
	/* half of it is for the frame, the rest for what is on its way before it */
	return max(ns, ns / 2 + SLOWEST * (u64)ec_links_acyclic_ns(l));
}

/* In the queue, where it may not fit beside the cycle any more. */
static bool is_stuck(struct ec_links *l, const struct ec_slot *slot, u64 now)
{
	u64 limit = ec_access_interval_us(&l->access) * (u64)NSEC_PER_USEC * QUEUE_CYCLES;

	return atomic_read(&slot->state) == EC_SLOT_QUEUED &&
	       (s64)(now - ec_read64(&slot->sent_ns)) > (s64)max(limit, (u64)QUEUE_NS);
}

/*
 * What has become of its frame: -ETIMEDOUT: it has been overdue for so long that it is lost, the
 * machine may have stood still; -EAGAIN: it has not left; 0: nothing so far.
 */
static int outcome(struct ec_links *l, struct ec_post *post, u64 now)
{
	u32 polls = READ_ONCE(l->access.polls);

	lockdep_assert_held(&l->posts.lock);
	if (is_stuck(l, post->slot, now))
		return -EAGAIN;
	if (atomic_read(&post->slot->state) != EC_SLOT_SENT ||
	    (s64)(now - ec_read64(&post->slot->sent_ns)) <= (s64)limit_ns(l))
		return 0;
	if (ec_access_is_cyclic(&l->access) && polls == post->polls)
		return 0;
	post->polls = polls;
	l->posts.overdue = true;
	return post->overdue++ ? -ETIMEDOUT : 0;
}

/* Take lost posts out of the list to @lost; also those that cannot leave any more. */
static void collect_lost(struct ec_links *l, int err, struct list_head *lost)
{
	struct ec_posts *ps = &l->posts;
	struct ec_post *post, *next;
	u64 now = ktime_get_ns();
	unsigned long flags;

	raw_spin_lock_irqsave(&ps->lock, flags);
	ps->overdue = false;
	list_for_each_entry_safe(post, next, &ps->flying, list) {
		int ret = err ?: outcome(l, post, now);

		if (ret && ec_slot_cancel(post->slot, now)) {
			land(ps, post);
			post->dg.err = ret;
			list_add_tail(&post->list, lost);
		}
	}
	list_for_each_entry_safe(post, next, &ps->ready, list) {
		if (!err)
			break;
		take_ready(ps, post);
		post->state = EC_POST_IDLE;
		post->running++;
		post->dg.err = err;
		list_add_tail(&post->list, lost);
	}
	raw_spin_unlock_irqrestore(&ps->lock, flags);
}

static void find_lost(struct ec_links *l, int err)
{
	struct ec_post *post, *next;
	LIST_HEAD(lost);

	/* have they arrived unnoticed? */
	if (READ_ONCE(l->posts.overdue) && !err)
		ec_access_poll(l);
	collect_lost(l, err, &lost);
	list_for_each_entry_safe(post, next, &lost, list) {
		list_del_init(&post->list);
		lose(post, post->dg.err);
	}
}

/* thread --------------------------------------------------------------------*/

static void make_calls(struct ec_posts *ps)
{
	struct ec_post *post;
	unsigned long flags;

	for (;;) {
		raw_spin_lock_irqsave(&ps->lock, flags);
		post = list_first_entry_or_null(&ps->calls, struct ec_post, called);
		if (post) {
			list_del_init(&post->called);
			post->running++;
		}
		raw_spin_unlock_irqrestore(&ps->lock, flags);
		if (!post)
			return;
		call(post, post->call);
	}
}

/* Until when nothing has to be done: ktime; U64_MAX: until it is kicked. */
static u64 idle_until(struct ec_links *l, u64 checked)
{
	bool direct = !ec_access_is_cyclic(&l->access);
	struct ec_posts *ps = &l->posts;
	u64 until = U64_MAX, now = ktime_get_ns();
	struct ec_post *post;
	unsigned long flags;

	raw_spin_lock_irqsave(&ps->lock, flags);
	if (ps->n_flying || ps->n_ready)
		until = now + REST_NS;
	list_for_each_entry(post, &ps->flying, list)
		if (atomic_read(&post->slot->state) == EC_SLOT_SENT)
			until = min(until, ec_read64(&post->slot->sent_ns) + limit_ns(l) + 1);
	until = max(until, checked + CHECK_NS);
	list_for_each_entry(post, &ps->ready, list)
		if (direct)
			until = min(until, post->due_ns > now ? post->due_ns : now + RETRY_NS);
	/* the transmit ring was full */
	if (direct && ec_queue_frames(&l->queues))
		until = min(until, now + RETRY_NS);
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	return until;
}

static void sleep_until(struct ec_posts *ps, u64 until)
{
	ktime_t at = ns_to_ktime(max(until, ktime_get_ns() + SLEEP_MIN_NS));

	set_current_state(TASK_IDLE);
	if (!kthread_should_stop() && !READ_ONCE(ps->kicked)) {
		if (until == U64_MAX)
			schedule();
		else
			schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
	}
	__set_current_state(TASK_RUNNING);
}

/* Also what the transmit ring had no room for. */
static bool has_to_send(const struct ec_links *l)
{
	return READ_ONCE(l->posts.n_ready) ||
	       (!ec_access_is_cyclic(&l->access) && ec_queue_frames(&l->queues));
}

static int link_error(const struct ec_links *l)
{
	return !ec_links_attached(l) ? -ENODEV : ec_links_is_up(l) ? 0 : -ENETDOWN;
}

static int run(void *data)
{
	struct ec_links *l = data;
	struct ec_posts *ps = &l->posts;
	u64 checked = 0;

	while (!kthread_should_stop()) {
		WRITE_ONCE(ps->kicked, false);
		smp_mb();	/* before what it stands for is read */
		make_calls(ps);
		if (has_to_send(l) && !send_ready(l))
			usleep_range(RING_US, 2 * RING_US);
		if (ktime_get_ns() - checked >= CHECK_NS) {
			checked = ktime_get_ns();
			if (READ_ONCE(ps->n_flying) || READ_ONCE(ps->n_ready))
				find_lost(l, link_error(l));
		}
		sleep_until(ps, idle_until(l, checked));
	}
	return 0;
}

/**
 * ec_posts_init() - prepare the posts of a master
 * @l: links
 *
 * Context: Process. May sleep.
 * Return: 0 or -errno.
 */
int ec_posts_init(struct ec_links *l)
{
	struct ec_posts *ps = &l->posts;
	struct task_struct *t;

	raw_spin_lock_init(&ps->lock);
	INIT_LIST_HEAD(&ps->ready);
	INIT_LIST_HEAD(&ps->flying);
	INIT_LIST_HEAD(&ps->calls);
	t = kthread_run(run, l, "EtherCAT%u-post", l->base->index);
	if (IS_ERR(t))
		return PTR_ERR(t);
	WRITE_ONCE(ps->thread, t);
	kick(ps);
	return 0;
}

/**
 * ec_posts_exit() - end all posts
 * @l: links without device; later posts are not sent and never done
 *
 * Context: Process. May sleep.
 */
void ec_posts_exit(struct ec_links *l)
{
	struct ec_posts *ps = &l->posts;
	struct task_struct *t = ps->thread;
	unsigned long flags;

	WRITE_ONCE(ps->thread, NULL);
	if (t)
		kthread_stop(t);
	raw_spin_lock_irqsave(&ps->lock, flags);
	ps->closed = true;
	raw_spin_unlock_irqrestore(&ps->lock, flags);
	find_lost(l, -ENODEV);
}
