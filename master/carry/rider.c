// SPDX-License-Identifier: GPL-2.0-only
#include <linux/bitops.h>
#include <linux/delay.h>
#include <linux/jiffies.h>
#include <linux/ktime.h>
#include <linux/string.h>
#include "../link/links.h"
#include "rider.h"

#define SENDS	3	/* cycles in which a rider may wait for its frame */
#define SLACK_US	5000	/* more time for it: the owner of a fast cycle may pause */
#define STEP_US		2000	/* between two checks of the cycle and the link */

/**
 * ec_rider_register() - make a rider known to the links
 * @rs: riders of the master, not in use yet
 * @r: zeroed structure; stays as long as @rs
 *
 * Context: Process.
 * Return: 0, or -ENOSPC.
 */
int ec_rider_register(struct ec_riders *rs, struct ec_rider *r)
{
	unsigned int i;

	for (i = 0; i < EC_RIDERS; i++) {
		if (rs->rider[i])
			continue;
		init_completion(&r->done);
		r->number = i;
		rs->rider[i] = r;
		return 0;
	}
	return -ENOSPC;
}

static bool move(struct ec_rider *r, enum ec_rider_state from, enum ec_rider_state to)
{
	return atomic_cmpxchg(&r->state, from, to) == from;
}

/* At once: a frame carries all of them, as far as they fit. */
static void queue_all(struct ec_riders *rs, struct ec_rider *r, unsigned int n)
{
	unsigned int i, mask = 0;

	for (i = 0; i < n; i++) {
		atomic_set_release(&r[i].state, EC_RIDER_QUEUED);
		mask |= BIT(r[i].number);
	}
	/* the state before the bit: the cycle reads the bit, then the state */
	smp_mb__before_atomic();
	atomic_or(mask, &rs->queued);
}

static void queue(struct ec_riders *rs, struct ec_rider *r)
{
	queue_all(rs, r, 1);
}

/* Has the time for a cycle passed, or does none send any more? */
static bool is_over(struct ec_riders *rs, u64 until_ns)
{
	struct ec_links *l = rs->links;

	return ktime_get_ns() > until_ns || !ec_access_is_cyclic(&l->access) ||
	       !ec_links_is_up(l) || ec_access_timed_out(l);
}

/**
 * ec_rider_begin() - let the next frame of the cycle carry a rider
 * @rs: riders of the master
 * @r: rider with command, address, length and data
 *
 * ec_rider_end() must follow.
 *
 * Context: Process; the owner of @r.
 */
void ec_rider_begin(struct ec_riders *rs, struct ec_rider *r)
{
	reinit_completion(&r->done);
	queue(rs, r);
}

/**
 * ec_rider_is_back() - is the reply with the rider received?
 * @r: rider after ec_rider_begin()
 *
 * Context: Any; the owner of @r. RT-safe.
 * Return: true, then its results are in @r.
 */
bool ec_rider_is_back(const struct ec_rider *r)
{
	return atomic_read_acquire(&r->state) == EC_RIDER_BACK;
}

/**
 * ec_rider_again() - let the next frame of the cycle carry it again
 * @rs: riders of the master
 * @r: rider in state BACK; its data become 0
 *
 * Context: Any; the owner of @r. RT-safe.
 */
void ec_rider_again(struct ec_riders *rs, struct ec_rider *r)
{
	memset(r->data, 0, r->len);
	queue(rs, r);
}

/**
 * ec_rider_end() - end the use of a rider, with or without a result
 * @r: rider after ec_rider_begin()
 *
 * Context: Process; the owner of @r. Does not wait for a frame.
 * Return: 0 with the results in @r; -EAGAIN: no frame of a cycle has carried it;
 * -ETIMEDOUT: no reply to its frame so far.
 */
int ec_rider_end(struct ec_rider *r)
{
	for (;;) {
		switch (atomic_read_acquire(&r->state)) {
		case EC_RIDER_BACK:
			atomic_set(&r->state, EC_RIDER_IDLE);
			return 0;
		case EC_RIDER_QUEUED:
			if (move(r, EC_RIDER_QUEUED, EC_RIDER_IDLE))
				return -EAGAIN;
			break;
		case EC_RIDER_SENT:
			if (move(r, EC_RIDER_SENT, EC_RIDER_IDLE))
				return -ETIMEDOUT;
			break;
		default:
			/* HELD: the cycle owner uses it for a moment */
			usleep_range(20, 50);
		}
	}
}

/* Wait for a rider, @sends_ns until @until for its frame and then for the reply. */
static int await(struct ec_riders *rs, struct ec_rider *r, u64 sends_ns, u64 until)
{
	struct ec_links *l = rs->links;

	/* the completion may be that of an earlier frame: the state decides */
	for (;;) {
		wait_for_completion_timeout(&r->done, usecs_to_jiffies(STEP_US));
		if (atomic_read_acquire(&r->state) == EC_RIDER_BACK)
			break;
		if (!is_over(rs, until))
			continue;
		if (move(r, EC_RIDER_QUEUED, EC_RIDER_IDLE))
			return -EAGAIN;
		if (is_over(rs, until + sends_ns + l->io_timeout_us * (u64)NSEC_PER_USEC) &&
		    move(r, EC_RIDER_SENT, EC_RIDER_IDLE))
			return -ETIMEDOUT;
	}
	atomic_set(&r->state, EC_RIDER_IDLE);
	return 0;
}

/**
 * ec_rider_exchange_all() - exchange riders with frames of the cycle
 * @rs: riders of the master
 * @r: riders with command, address, length and data
 * @n: how many
 *
 * Context: Process; the owner of @r. May sleep.
 * Return: 0 with the results in @r; or the error of a rider that has none, as
 * ec_rider_exchange().
 */
int ec_rider_exchange_all(struct ec_riders *rs, struct ec_rider *r, unsigned int n)
{
	struct ec_links *l = rs->links;
	u64 sends_ns = (SENDS * (u64)ec_access_interval_us(&l->access) + SLACK_US) * NSEC_PER_USEC;
	u64 until = ktime_get_ns() + sends_ns;
	unsigned int i;
	int ret = 0;

	if (!ec_access_is_cyclic(&l->access))
		return -EAGAIN;
	for (i = 0; i < n; i++)
		reinit_completion(&r[i].done);
	queue_all(rs, r, n);
	for (i = 0; i < n; i++)
		ret = await(rs, &r[i], sends_ns, until) ?: ret;
	return ret;
}

/**
 * ec_rider_exchange() - exchange a rider with a frame of the cycle
 * @rs: riders of the master
 * @r: rider with command, address, length and data
 *
 * Context: Process; the owner of @r. May sleep.
 * Return: 0 with the results in @r; -EAGAIN: no frame of a cycle has carried it;
 * -ETIMEDOUT: its frame is lost.
 */
int ec_rider_exchange(struct ec_riders *rs, struct ec_rider *r)
{
	return ec_rider_exchange_all(rs, r, 1);
}

/* Wire time by which @bytes more make a frame longer. */
static u32 more_ns(const struct ec_frame_buf *fb, size_t bytes)
{
	return ec_frame_wire_ns(EC_ETH_HDR + fb->len + bytes) -
	       ec_frame_wire_ns(EC_ETH_HDR + fb->len);
}

/**
 * ec_riders_add() - add the riders that wait to a frame of the cycle, as far as they fit
 * @rs: riders of the master
 * @fb: frame with the process data
 * @index: datagram index of the frame
 * @riding: result: the riders, and the number of the frame
 *
 * The wire time of a cycle with them stays within the limit for acyclic frames.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_riders_add(struct ec_riders *rs, struct ec_frame_buf *fb, u8 index,
		   struct ec_riding *riding)
{
	struct ec_links *l = rs->links;
	unsigned long left = atomic_read_acquire(&rs->queued);
	u32 slack = ec_access_slack_ns(l);

	riding->mask = 0;
	riding->seq = rs->seq + 1;
	for (; left && fb->count < l->max_datagrams; left &= left - 1) {
		struct ec_rider *r = rs->rider[__ffs(left)];
		u32 ns;
		u8 *p;

		/* before the state: its owner may queue it again at any time */
		atomic_andnot(BIT(r->number), &rs->queued);
		/* see queue(): the bit before the state */
		smp_mb__after_atomic();
		if (!move(r, EC_RIDER_QUEUED, EC_RIDER_HELD))
			continue;	/* its owner has ended it */
		ns = more_ns(fb, EC_DGRAM_OVERHEAD + r->len);
		p = ns <= slack ? ec_frame_add(fb, r->cmd, index, r->adp, r->ado, r->len) : NULL;
		if (!p) {
			queue(rs, r);
			continue;
		}
		memcpy(p, r->data, r->len);
		slack -= ns;
		r->seq = riding->seq;
		riding->mask |= BIT(r->number);
		rs->seq = riding->seq;
		atomic_set_release(&r->state, EC_RIDER_SENT);
	}
}

/* Take the rider that this frame carries; false: it has ended, or is in a later frame. */
static bool hold(struct ec_rider *r, u32 seq)
{
	if (!move(r, EC_RIDER_SENT, EC_RIDER_HELD))
		return false;
	if (r->seq == seq)
		return true;
	atomic_set_release(&r->state, EC_RIDER_SENT);
	return false;
}

/**
 * ec_riders_return() - the frame was not sent: its riders wait for the next one
 * @rs: riders of the master
 * @riding: riders of the frame
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_riders_return(struct ec_riders *rs, const struct ec_riding *riding)
{
	unsigned long left = riding->mask;

	for (; left; left &= left - 1) {
		struct ec_rider *r = rs->rider[__ffs(left)];

		if (hold(r, riding->seq))
			queue(rs, r);
	}
}

/**
 * ec_riders_take() - take the results of the riders of a frame
 * @rs: riders of the master
 * @riding: riders of the frame
 * @at: datagram behind the process data
 * @end: end of the frame
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_riders_take(struct ec_riders *rs, const struct ec_riding *riding, const u8 *at,
		    const u8 *end)
{
	/* the iterator only reads; it has no const form */
	struct ec_frame_iter it = { .p = (u8 *)at, .end = (u8 *)end, .more = true };
	unsigned long left = riding->mask;
	struct ec_dgram d;

	for (; left && ec_frame_iter_next(&it, &d) == 1; left &= left - 1) {
		struct ec_rider *r = rs->rider[__ffs(left)];

		/* in memory of the device it may have changed since it was compared */
		if (d.len != r->len)
			break;
		if (!hold(r, riding->seq))
			continue;	/* its owner has ended it */
		memcpy(r->data, d.data, r->len);
		r->wkc = ec_dgram_wkc(&d);
		r->back = d.adp;
		r->irq = d.irq;
		atomic_set_release(&r->state, EC_RIDER_BACK);
		complete(&r->done);
	}
}
