// SPDX-License-Identifier: GPL-2.0-only
/* Sending with direct access: by the sender of a post, or by the thread of the posts. */
#include <linux/ktime.h>
#include "direct.h"
#include "flight.h"
#include "post_int.h"

#define FLIGHT_NS	(300 * NSEC_PER_USEC)	/* wire time in flight: more posts wait */

static bool next_class(struct ec_carry *c, enum ec_post_class *class)
{
	static const enum ec_post_class order[] = {
		EC_POST_TRAIN, EC_POST_URGENT, EC_POST_NORMAL, EC_POST_CLOCK,
	};
	unsigned long flags;
	unsigned int i;

	raw_spin_lock_irqsave(&c->lock, flags);
	ec_post_due(c);
	for (i = 0; i < ARRAY_SIZE(order); i++)
		if (ec_flight_first(c, order[i]))
			break;
	raw_spin_unlock_irqrestore(&c->lock, flags);
	if (i == ARRAY_SIZE(order))
		return false;
	*class = order[i];
	return true;
}

static bool is_busy(const struct ec_carry *c, enum ec_post_class class, bool hold)
{
	return !ec_carry_has_place(c, class) ||
	       (hold && ec_links_acyclic_ns(c->links) >= FLIGHT_NS);
}

/*
 * Send posts that are READY, several in a frame. With @hold only as many as keep the wire busy:
 * posts that become READY meanwhile share frames. False: the device is full.
 */
static bool send_ready(struct ec_carry *c, bool hold)
{
	struct ec_links *l = c->links;
	enum ec_post_class class;
	int ret = 0;

	lockdep_assert_held(&l->access.lock);
	WRITE_ONCE(c->held, false);
	rcu_read_lock();
	while (ret != -EBUSY && next_class(c, &class)) {
		const struct ec_flight_room room = {
			.len = EC_FRAME_HDR + EC_FRAME_BODY_MAX,
			.dgrams = ec_post_alone(class) ? 0 : l->max_datagrams,
		};

		if (is_busy(c, class, hold)) {
			WRITE_ONCE(c->held, true);
			smp_mb();	/* @held before the places; see ec_flight_landed() */
			if (is_busy(c, class, hold))
				break;
			WRITE_ONCE(c->held, false);
		}
		ret = ec_flight_send(c, class, &room, ktime_get_ns());
	}
	ec_links_flush(l);
	rcu_read_unlock();
	return ret != -EBUSY;
}

static bool push(struct ec_carry *c, bool hold)
{
	struct ec_links *l = c->links;
	bool ok = true;

	rt_mutex_lock(&l->access.lock);
	if (READ_ONCE(l->access.mode) == EC_ACCESS_DIRECT)
		ok = send_ready(c, hold);
	else if (c->ops && c->ops->queued)
		c->ops->queued(c);
	rt_mutex_unlock(&l->access.lock);
	return ok;
}

/**
 * ec_direct_push() - send posts that are READY; with cyclic access report that they wait
 * @c: posts of the master
 *
 * Context: Process. May sleep on the access lock, whose owner inherits the caller's priority.
 */
void ec_direct_push(struct ec_carry *c)
{
	/* no driver reports a free transmit buffer: the thread tries for all callers */
	if (!push(c, false))
		ec_carry_kick(c);
}

/**
 * ec_direct_push_on() - the same for posts that no caller sends
 * @c: posts of the master
 *
 * Context: The thread of the posts.
 * Return: false: the device is full.
 */
bool ec_direct_push_on(struct ec_carry *c)
{
	return push(c, true);
}
