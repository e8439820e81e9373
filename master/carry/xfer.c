// SPDX-License-Identifier: GPL-2.0-only
/* Callers that sleep until their datagrams have results: a window of posts, and a completion. */
#include <linux/hrtimer.h>
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include <linux/swait.h>
#include "direct.h"
#include "post_int.h"
#include "loss.h"
#include "xfer.h"

#define TRIES		4	/* of a post that was too long for its cycle, shorter each time */
#define WATCH_US	1000	/* a wait that lasts longer is watched, see ec_loss_watch() */
#define FEW		4	/* posts on the stack of the caller */

/*
 * Half of the posts that a batch has in flight. While the caller waits for one half, the other one
 * keeps the wire busy.
 */
struct half {
	struct ec_post_wait wait;
	struct ec_post *post;
	unsigned int n;
};

struct batch {
	struct ec_carry *c;
	struct ec_dg *dg;
	unsigned int n;
	enum ec_post_class class;
	unsigned int most;	/* posts of a half */
	u8 sides;		/* mask of the links, 0: as their way is */
	struct half half[2];
	int err;	/* why the other datagrams are not sent */
};

static bool goes(const struct ec_links *l, const struct ec_dg *dg, struct ec_ring_way way)
{
	struct ec_ring_way its = ec_ring_way(l, dg->cmd, dg->adp);

	return its.sides == way.sides && its.shift == way.shift;
}

/*
 * How many datagrams from @first on fit into a frame before the next cycle; at least one. All have
 * the way of the first one: the ring may change at any time.
 */
static unsigned int xfer_count(const struct batch *b, unsigned int first, struct ec_ring_way way)
{
	const struct ec_links *l = b->c->links;
	unsigned int most = l->max_datagrams, len = 0, i;
	u16 least = b->dg[first].len +
		    (b->dg[first].pair ? EC_DGRAM_OVERHEAD + b->dg[first + 1].len : 0);
	u16 room = EC_DGRAM_OVERHEAD + max(ec_access_room(l), least);

	/* clock frames are shorter, so that the permitted number of them fits into a cycle */
	if (b->class == EC_POST_CLOCK) {
		most = EC_CLOCK_DATAGRAMS;
		room = clamp_t(u16, ec_share_clock_bytes(l), EC_DGRAM_OVERHEAD + least, room);
	}
	if (b->class == EC_POST_TRAIN)
		room = EC_FRAME_BODY_MAX;
	room = min_t(u16, room, EC_FRAME_BODY_MAX);
	for (i = first; i < b->n && i - first < most && b->dg[i].err == -EAGAIN; i++) {
		len += EC_DGRAM_OVERHEAD + b->dg[i].len;
		if (len > room || (i > first && !goes(l, &b->dg[i], way)))
			break;
		if (b->class == EC_POST_TRAIN && b->dg[i].last)
			return i + 1 - first;
	}
	if (i > first + 1 && b->dg[i - 1].pair)
		i--;
	return i - first;
}

/* of the frames of a train before its last one: the caller waits for that */
static void passed(struct ec_post *post)
{
}

/* Posts of a train leave together; only the last one is awaited. */
static void couple(struct half *h)
{
	unsigned int i;

	for (i = 0; i < h->n; i++) {
		h->post[i].train = h->n - i;
		if (i + 1 == h->n)
			continue;
		h->post[i].wait = NULL;
		h->post[i].done = passed;
	}
	h->wait.pending = 1;
}

/* The frames of a train return in their order: what is missing behind the last one is lost. */
static void uncouple(struct half *h)
{
	unsigned int i, k;

	for (i = 0; i + 1 < h->n; i++) {
		ec_post_cancel(&h->post[i]);
		for (k = 0; k < h->post[i].n; k++)
			if (h->post[i].dg[k].err == -EINPROGRESS)
				h->post[i].dg[k].err = -ETIMEDOUT;
	}
}

/* Send half a window of posts from datagram @first on; returns the first datagram not sent. */
static unsigned int send_half(struct batch *b, struct half *h, unsigned int first)
{
	unsigned int i;

	for (h->n = 0; h->n < b->most; h->n++) {
		struct ec_post *post = &h->post[h->n];
		struct ec_ring_way way;

		while (first < b->n && b->dg[first].err != -EAGAIN)
			first++;
		if (first >= b->n)
			break;
		memset(post, 0, sizeof(*post));
		ec_post_init(post, b->c->links, NULL);
		post->wait = &h->wait;
		post->class = b->class;
		post->dg = &b->dg[first];
		way = ec_ring_way(b->c->links, post->dg->cmd, post->dg->adp);
		way.sides = b->sides ?: way.sides;
		post->n = xfer_count(b, first, way);
		post->sides = way.sides;
		post->shift = way.shift;
		first += post->n;
	}
	if (!h->n)
		return first;
	h->wait.pending = h->n;
	if (b->class == EC_POST_TRAIN)
		couple(h);
	init_completion(&h->wait.done);
	for (i = 0; i < h->n; i++)
		ec_post_send(&h->post[i], 0);
	ec_direct_push(b->c);
	return first;
}

/* Wait without the thread of the posts: most replies are received within this time. */
static bool wait_unwatched(struct completion *done)
{
	ktime_t limit = ns_to_ktime(WATCH_US * NSEC_PER_USEC);
	DECLARE_SWAITQUEUE(wait);

	prepare_to_swait_exclusive(&done->wait, &wait, TASK_UNINTERRUPTIBLE);
	if (!completion_done(done))
		schedule_hrtimeout(&limit, HRTIMER_MODE_REL);
	finish_swait(&done->wait, &wait);
	return try_wait_for_completion(done);
}

static void wait_half(struct batch *b, struct half *h)
{
	atomic_inc(&b->c->waiting);
	if (READ_ONCE(b->c->watched) || !wait_unwatched(&h->wait.done)) {
		ec_loss_watch(b->c);
		if (wait_for_completion_killable(&h->wait.done) &&
		    !ec_post_give_up(h->post, h->n, -EINTR))
			wait_for_completion(&h->wait.done);
	}
	atomic_dec(&b->c->waiting);
}

/* Wait for the posts of a half. */
static void finish_half(struct batch *b, struct half *h)
{
	unsigned int i;

	wait_half(b, h);
	if (b->class == EC_POST_TRAIN)
		uncouple(h);
	for (i = 0; i < h->n && !b->err; i++) {
		int err = h->post[i].dg[0].err;

		if (err == -EINTR || err == -EBUSY || err == -ENODEV || err == -ENETDOWN)
			b->err = err;
	}
	h->n = 0;
}

/* Send all datagrams without a result, once. */
static void exchange(struct batch *b)
{
	unsigned int i, first = 0, cur = 0;

	for (;;) {
		struct half *h = &b->half[cur];

		if (h->n)
			finish_half(b, h);
		if (first < b->n && !b->err)
			first = send_half(b, h, first);
		if (!b->half[0].n && !b->half[1].n)
			break;
		if (b->half[1].post)
			cur = !cur;
	}
	for (i = first; i < b->n; i++)
		if (b->dg[i].err == -EAGAIN)
			b->dg[i].err = b->err;
}

/* Datagrams that did not fit beside the cycle any more are sent again, in shorter frames. */
static bool has_to_go_again(const struct batch *b)
{
	unsigned int i;

	for (i = 0; i < b->n; i++)
		if (b->dg[i].err == -EAGAIN)
			return true;
	return false;
}

static int result(struct batch *b)
{
	unsigned int i;
	int ret = 0;

	for (i = 0; i < b->n; i++) {
		if (b->dg[i].err == -EAGAIN)
			b->dg[i].err = -ETIMEDOUT;
		ret = ret ?: b->dg[i].err;
	}
	return ret;
}

/* Why a frame cannot be sent at all: the caller does not wait for it. */
static int xfer_link_error(const struct ec_links *l)
{
	if (!ec_links_attached(l))
		return -ENODEV;
	return ec_access_is_cyclic(&l->access) && !ec_links_is_up(l) ? -ENETDOWN : 0;
}

static int transfer_on(struct ec_links *l, struct ec_dg *dg, unsigned int n,
		       enum ec_post_class class, u8 sides)
{
	struct batch b = {
		.c = l->carry, .dg = dg, .n = n, .class = class, .err = xfer_link_error(l),
		.sides = sides,
	};
	unsigned int i, try, window = class == EC_POST_CLOCK ? EC_CLOCK_WINDOW : EC_XFER_WINDOW;
	struct ec_post few[FEW], *more = NULL;

	/* tools must not delay the monitor, which watches the application and the link */
	if (class == EC_POST_NORMAL && current == READ_ONCE(b.c->monitor))
		b.class = EC_POST_URGENT;
	for (i = 0; i < n; i++) {
		if (dg[i].len > EC_DGRAM_DATA_MAX)
			return -EMSGSIZE;
		dg[i].err = -EAGAIN;
	}
	b.most = n;
	b.half[0].post = few;
	if (n > FEW) {
		/* a train is one half */
		if (class != EC_POST_TRAIN)
			b.most = DIV_ROUND_UP(min(n, window), 2);
		more = kmalloc_array(2 * b.most, sizeof(*more), GFP_KERNEL);
		if (!more)
			return -ENOMEM;
		b.half[0].post = more;
		if (class != EC_POST_TRAIN)
			b.half[1].post = more + b.most;
	}
	for (try = 0; try < TRIES && has_to_go_again(&b); try++)
		exchange(&b);
	kfree(more);
	return result(&b);
}

static int transfer(struct ec_links *l, struct ec_dg *dg, unsigned int n, enum ec_post_class class)
{
	return transfer_on(l, dg, n, class, 0);
}

/**
 * ec_xfer_probe() - exchange a datagram on one link, also if that is mute
 * @l: links
 * @dg: datagram; its result is in it; not repeated
 * @side: number of the link
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_xfer_probe(struct ec_links *l, struct ec_dg *dg, u8 side)
{
	dg->repeat = false;
	return transfer_on(l, dg, 1, EC_POST_URGENT, BIT(side));
}

/**
 * ec_xfer() - exchange a batch of datagrams
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many; they are packed into as few frames as fit
 *
 * Repeatable datagrams are sent again when their frame is lost, others never.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 when every datagram was received, with any working counter; else the error of the
 * first one that was not; -EMSGSIZE when one fits into no frame, or -ENOMEM: then nothing was
 * sent.
 */
int ec_xfer(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, EC_POST_NORMAL);
}

/**
 * ec_xfer_all() - exchange datagrams, each of which one slave has to process
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0; -EIO when a working counter is not 1; or as ec_xfer().
 */
int ec_xfer_all(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	int ret = ec_xfer(l, dg, n);
	unsigned int i;

	for (i = 0; i < n && !ret; i++)
		if (dg[i].wkc != 1)
			ret = -EIO;
	return ret;
}

/**
 * ec_xfer_urgent() - exchange a few datagrams before all others
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * For the monitor, which has to reach the bus while many other callers send.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_xfer_urgent(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, EC_POST_URGENT);
}

/**
 * ec_xfer_clock() - exchange datagrams that set or compensate clocks
 * @l: links
 * @dg: datagrams; results are in them
 * @n: how many
 *
 * They may be many: a cyclic send carries fewer of them than of other frames, and
 * others do not wait behind them.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer().
 */
int ec_xfer_clock(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	return transfer(l, dg, n, EC_POST_CLOCK);
}

/**
 * ec_xfer_train() - exchange datagrams in frames that leave together
 * @l: links
 * @dg: datagrams; results are in them; @last ends a frame
 * @n: how many, in at most 16 frames
 *
 * Beside a cycle all frames are in one send, behind the process data, unless the device is full
 * after some of them: then the others are the first ones of the next send. A cycle in whose free
 * wire time they do not fit sends none of them. No frame is repeated, and a frame that has not
 * returned when the last one has is lost.
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_xfer(); -ETIMEDOUT also when they do not fit.
 */
int ec_xfer_train(struct ec_links *l, struct ec_dg *dg, unsigned int n)
{
	unsigned int i;

	for (i = 0; i < n; i++)
		dg[i].repeat = false;
	return transfer(l, dg, n, EC_POST_TRAIN);
}

/**
 * ec_xfer_one() - exchange one repeatable datagram
 * @l: links
 * @cmd: enum ec_cmd
 * @adp: low half of the address
 * @ado: high half of the address
 * @data: data, sent or filled by @cmd
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: working counter, or -errno as in struct ec_dg.
 */
int ec_xfer_one(struct ec_links *l, u8 cmd, u16 adp, u16 ado, void *data, u16 len)
{
	struct ec_dg dg = EC_DG(cmd, adp, ado, len, data);
	int ret = ec_xfer(l, &dg, 1);

	return ret ? ret : dg.wkc;
}

/**
 * ec_xfer_fprd() - read registers of one slave
 * @l: links
 * @station: station address
 * @ado: register
 * @data: result
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not process it, or as ec_xfer().
 */
int ec_xfer_fprd(struct ec_links *l, u16 station, u16 ado, void *data, u16 len)
{
	int ret = ec_xfer_one(l, EC_CMD_FPRD, station, ado, data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}

/**
 * ec_xfer_fpwr() - write registers of one slave; may be executed twice
 * @l: links
 * @station: station address
 * @ado: register
 * @data: value
 * @len: bytes
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EIO when the slave did not process it, or as ec_xfer().
 */
int ec_xfer_fpwr(struct ec_links *l, u16 station, u16 ado, const void *data, u16 len)
{
	int ret = ec_xfer_one(l, EC_CMD_FPWR, station, ado, (void *)data, len);

	return ret < 0 ? ret : ret == 1 ? 0 : -EIO;
}
