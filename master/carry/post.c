// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include "../base/once64.h"
#include "post_int.h"

/**
 * ec_post_init() - prepare a post
 * @post: zeroed structure
 * @l: links
 * @done: as described in post.h, NULL: @post->wait is completed instead
 *
 * Context: Any.
 */
void ec_post_init(struct ec_post *post, struct ec_links *l, void (*done)(struct ec_post *post))
{
	post->links = l;
	post->done = done;
	INIT_LIST_HEAD(&post->list);
}

static void measure(struct ec_post *post)
{
	unsigned int i;

	post->len = 0;
	post->dgrams = 0;
	for (i = 0; i < post->n; i++) {
		if (post->dg[i].err != -EINPROGRESS)
			continue;
		post->len += EC_DGRAM_OVERHEAD + post->dg[i].len;
		post->dgrams++;
	}
}

static void fail(struct ec_post *post, int err)
{
	unsigned int i;

	for (i = 0; i < post->n; i++)
		if (post->dg[i].err == -EINPROGRESS)
			post->dg[i].err = err;
}

/* Wake a caller that sleeps. It may free its posts from then on, so this is the last access. */
static void wake_caller(struct ec_post *post)
{
	struct ec_post_wait *wait = post->wait;

	if (!post->done && !--wait->pending)
		complete(&wait->done);
}

static void make_ready(struct ec_carry *c, struct ec_post *post)
{
	lockdep_assert_held(&c->lock);
	measure(post);
	if (!c->n_ready) {
		ec_write64(&c->full_ns, 0);
		ec_write64(&c->stuck_ns, 0);
	}
	post->state = EC_POST_READY;
	if (post->due_ns > post->since_ns) {
		list_add_tail(&post->list, &c->later);
		c->due_ns = min(c->due_ns, post->due_ns);
	} else {
		list_add_tail(&post->list, &c->ready[post->class]);
	}
	WRITE_ONCE(c->n_ready, c->n_ready + 1);
}

/**
 * ec_post_due() - move posts that are due to the lists of posts to be sent
 * @c: posts of the master
 *
 * Context: Any, with the lock of the posts held. RT-safe.
 */
void ec_post_due(struct ec_carry *c)
{
	struct ec_post *post, *next;
	u64 now_ns;

	lockdep_assert_held(&c->lock);
	/* mostly none: the clock is not read */
	if (likely(c->due_ns == U64_MAX))
		return;
	now_ns = ktime_get_ns();
	if (now_ns < c->due_ns)
		return;
	c->due_ns = U64_MAX;
	list_for_each_entry_safe(post, next, &c->later, list) {
		if (post->due_ns <= now_ns)
			list_move_tail(&post->list, &c->ready[post->class]);
		else
			c->due_ns = min(c->due_ns, post->due_ns);
	}
}

/**
 * ec_post_send() - send a post
 * @post: IDLE; its datagrams fit into one frame, and do not change until it has ended
 * @due_ns: not before that time (ktime); 0: as soon as possible
 *
 * With direct access the thread of the posts sends it, unless the caller uses ec_direct_push().
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_post_send(struct ec_post *post, u64 due_ns)
{
	struct ec_carry *c = post->links->carry;
	unsigned long flags;
	unsigned int i;

	for (i = 0; i < post->n; i++)
		ec_dg_begin(&post->dg[i]);
	post->due_ns = due_ns;
	post->since_ns = ktime_get_ns();
	post->tries = 0;
	post->sides = post->sides ?: READ_ONCE(post->links->sides);
	raw_spin_lock_irqsave(&c->lock, flags);
	if (!c->closed) {
		make_ready(c, post);
	} else {
		/* else a caller that waits would sleep forever */
		fail(post, -ENODEV);
		wake_caller(post);
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
	if (!post->done)
		return;
	/* the post before @rests; pairs with rest() */
	smp_mb();
	if (!ec_access_is_cyclic(&post->links->access) || READ_ONCE(c->rests))
		ec_carry_kick(c);
}

/* Take a READY post from its list. */
static void take_ready(struct ec_carry *c, struct ec_post *post)
{
	lockdep_assert_held(&c->lock);
	list_del_init(&post->list);
	WRITE_ONCE(c->n_ready, c->n_ready - 1);
	post->state = EC_POST_IDLE;
	/* else the thread wakes for it again and again */
	if (list_empty(&c->later))
		c->due_ns = U64_MAX;
}

/**
 * ec_post_recall() - withdraw a post that was not sent so far
 * @post: post in any state
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: it is IDLE, and @done is not called.
 */
bool ec_post_recall(struct ec_post *post)
{
	struct ec_carry *c = post->links->carry;
	unsigned long flags;
	bool ready;

	raw_spin_lock_irqsave(&c->lock, flags);
	ready = post->state == EC_POST_READY;
	if (ready)
		take_ready(c, post);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	return ready;
}

/* Take a post out of its frame, if that has been built; the frame stays in flight. */
static void leave(struct ec_carry *c, struct ec_post *post)
{
	lockdep_assert_held(&c->lock);
	if (!c->flight[post->slot].built)
		return;
	list_del_init(&post->list);
	post->state = EC_POST_IDLE;
}

/**
 * ec_post_cancel() - end a post: afterwards it is IDLE, and its @done does not run
 * @post: post that its user sends no more; not from its own @done
 *
 * Context: Process. May sleep, as long as @done takes.
 */
void ec_post_cancel(struct ec_post *post)
{
	struct ec_carry *c = post->links->carry;
	unsigned long flags;
	bool over;

	for (;;) {
		raw_spin_lock_irqsave(&c->lock, flags);
		if (post->state == EC_POST_READY)
			take_ready(c, post);
		else if (post->state == EC_POST_FLYING)
			leave(c, post);
		over = post->state == EC_POST_IDLE && !post->running;
		raw_spin_unlock_irqrestore(&c->lock, flags);
		if (over)
			return;
		usleep_range(200, 500);
	}
}

/**
 * ec_post_give_up() - end the posts of a caller that sleeps, except for those in flight
 * @post: its posts, with the same @wait
 * @n: how many
 * @err: result of the datagrams of these posts
 *
 * Posts in flight are still awaited, but not sent again.
 *
 * Context: Process.
 * Return: whether all have ended.
 */
bool ec_post_give_up(struct ec_post *post, unsigned int n, int err)
{
	struct ec_carry *c = post->links->carry;
	struct ec_post_wait *wait = post->wait;
	unsigned long flags;
	bool over;

	raw_spin_lock_irqsave(&c->lock, flags);
	for (; n; n--, post++) {
		post->tries = EC_POST_TRIES;
		if (post->state != EC_POST_READY)
			continue;
		take_ready(c, post);
		fail(post, err);
		wait->pending--;
	}
	over = !wait->pending;
	raw_spin_unlock_irqrestore(&c->lock, flags);
	return over;
}

/**
 * ec_post_refuse() - a post that was not sent ends
 * @c: posts of the master
 * @post: READY
 * @err: result of its datagrams
 * @posts: list for ec_post_finish(), gets it
 *
 * Context: Any, with the lock of the posts held. RT-safe.
 */
void ec_post_refuse(struct ec_carry *c, struct ec_post *post, int err, struct list_head *posts)
{
	lockdep_assert_held(&c->lock);
	take_ready(c, post);
	fail(post, err);
	post->running = true;
	list_add_tail(&post->list, posts);
}

/**
 * ec_post_finish() - report the end of posts
 * @c: posts of the master
 * @posts: IDLE and @running, with all results; an empty list afterwards
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_post_finish(struct ec_carry *c, struct list_head *posts)
{
	struct ec_post *post, *next;
	unsigned long flags;

	list_for_each_entry_safe(post, next, posts, list) {
		list_del_init(&post->list);
		if (post->done)
			post->done(post);
		raw_spin_lock_irqsave(&c->lock, flags);
		post->running = false;
		wake_caller(post);
		raw_spin_unlock_irqrestore(&c->lock, flags);
	}
}

static bool may_repeat(struct ec_post *post, int err)
{
	bool again = false;
	unsigned int i;

	for (i = 0; i < post->n; i++) {
		struct ec_dg *dg = &post->dg[i];

		if (dg->err != -EINPROGRESS)
			continue;
		if (err == -ETIMEDOUT && dg->repeat && post->tries < EC_POST_TRIES - 1)
			again = true;
		else
			dg->err = err;
	}
	return again;
}

/**
 * ec_post_lost() - the frame of posts is lost: they are sent again, or end with an error
 * @c: posts of the master
 * @posts: IDLE and @running; an empty list afterwards
 * @err: -ETIMEDOUT: datagrams that may be repeated are, see struct ec_dg; or another -errno
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_post_lost(struct ec_carry *c, struct list_head *posts, int err)
{
	struct ec_post *post, *next;
	unsigned long flags;

	raw_spin_lock_irqsave(&c->lock, flags);
	list_for_each_entry_safe(post, next, posts, list) {
		if (c->closed || !may_repeat(post, err))
			continue;
		list_del(&post->list);
		post->running = false;
		post->tries++;
		post->due_ns = 0;
		make_ready(c, post);
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
	list_for_each_entry(post, posts, list)
		fail(post, err);
	ec_post_finish(c, posts);
}
