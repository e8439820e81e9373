// SPDX-License-Identifier: GPL-2.0-only
/*
 * The acyclic frames of one cyclic send are limited, so that its execution time is: frames per
 * millisecond of cycle, clock frames among them, frames in total, and half of the free wire time.
 * Short posts share a frame.
 */
#include <linux/ktime.h>
#include <linux/minmax.h>
#include <linux/module.h>
#include "../base/once64.h"
#include "flight.h"
#include "post_int.h"

unsigned int ec_share_max = 64;

static int set_max(const char *value, const struct kernel_param *kp)
{
	return param_set_uint_minmax(value, kp, 1, EC_LINK_QUEUED);
}

static const struct kernel_param_ops max_ops = {
	.set = set_max,
	.get = param_get_uint,
};

module_param_cb(max_acyclic, &max_ops, &ec_share_max, 0644);
MODULE_PARM_DESC(max_acyclic, "Most acyclic frames that one cyclic send carries, 1 to 192 (64)");

/**
 * ec_share_clock_bytes() - length of clock frames of which the permitted number fits
 * @l: links
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: bytes of datagrams, with their headers, of one frame.
 */
u16 ec_share_clock_bytes(const struct ec_links *l)
{
	u32 frames = max(1u, ec_access_interval_us(&l->access) * EC_SHARE_CLOCKS_PER_MS / 1000);
	u32 bytes = ec_access_slack_ns(l) / 2 / frames / 80;

	/* what ec_frame_wire_ns() adds, and the headers */
	bytes -= min(bytes, 8u + 4 + 12 + EC_ETH_HDR + EC_FRAME_HDR);
	return min_t(u32, bytes, EC_FRAME_BODY_MAX);
}

/*
 * The class of the post to send next, and bytes of its frame; false: none may be sent. Clock posts
 * and others take turns, as long as there is credit for clocks. Between two urgent posts a normal
 * one is sent: where hardly any frame fits, urgent posts would be the only ones otherwise.
 */
static bool next_post(struct ec_carry *c, enum ec_post_class *class, unsigned int *len)
{
	u32 most = clamp(ec_access_interval_us(&c->links->access) * EC_SHARE_PER_MS / 1000, 1u,
			 READ_ONCE(ec_share_max));
	struct ec_post *normal, *urgent, *clock, *next;
	unsigned long flags;

	if (c->share.frames >= most)
		return false;
	raw_spin_lock_irqsave(&c->lock, flags);
	ec_post_due(c);
	normal = ec_flight_first(c, EC_POST_NORMAL);
	urgent = ec_flight_first(c, EC_POST_URGENT);
	clock = c->share.clock_credit >= 1000 ? ec_flight_first(c, EC_POST_CLOCK) : NULL;
	/* others may have taken the place of a clock frame in the send before */
	if (clock && clock->dg[0].first && c->share.clocks)
		clock = NULL;
	next = urgent && !(c->share.was_urgent && normal) ? urgent : normal;
	if (clock && (!next || !c->share.clock_last))
		next = clock;
	if (next) {
		*class = next->class;
		*len = EC_ETH_HDR + EC_FRAME_HDR + next->len;
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
	return next;
}

/*
 * A single frame may take all wire time before the next cycle; more frames share half of the free
 * wire time.
 */
static bool fits(const struct ec_carry *c, u32 used_ns, u32 frame_ns)
{
	u64 budget = ec_access_interval_us(&c->links->access) * 900ULL;

	if (used_ns + (u64)frame_ns > budget)
		return false;
	return !c->share.frames ||
	       2ull * (c->share.wire_ns + frame_ns) <= ec_access_slack_ns(c->links);
}

/* Posts of the train that is complete, and the wire time of its frames; 0: there is none. */
static unsigned int next_train(struct ec_carry *c, u32 *wire_ns)
{
	unsigned int n = 0, train = 0;
	const struct ec_post *post;
	unsigned long flags;

	*wire_ns = 0;
	raw_spin_lock_irqsave(&c->lock, flags);
	list_for_each_entry(post, &c->ready[EC_POST_TRAIN], list) {
		train = n ? train : post->train;
		*wire_ns += ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + post->len);
		if (++n == train)
			break;
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
	return n == train ? n : 0;
}

/* Limits of a frame that posts share; a clock post is sent alone. */
static struct ec_flight_room find_room(const struct ec_carry *c, enum ec_post_class class,
				       u32 used_ns)
{
	u32 budget = ec_access_interval_us(&c->links->access) * 900;
	u32 half = ec_access_slack_ns(c->links) / 2;
	u32 ns = min(budget - min(budget, used_ns), half - min(half, c->share.wire_ns));
	/* what ec_frame_wire_ns() adds, and the header */
	u32 bytes = ns / 80 - min(ns / 80, 8u + 4 + 12 + EC_ETH_HDR);

	return (struct ec_flight_room){
		.len = min_t(u32, bytes, EC_FRAME_HDR + EC_FRAME_BODY_MAX),
		.dgrams = ec_post_alone(class) ? 0 : c->links->max_datagrams,
	};
}

static void share_count(struct ec_carry *c, enum ec_post_class class, u32 frame_ns)
{
	c->share.frames++;
	c->share.wire_ns += frame_ns;
	c->share.was_urgent = class == EC_POST_URGENT;
	c->share.clock_last = class == EC_POST_CLOCK;
	if (c->share.clock_last) {
		c->share.clocks++;
		c->share.clock_credit -= 1000;
	}
	if (unlikely(ec_read64(&c->stuck_ns)))
		ec_write64(&c->stuck_ns, 0);
}

/*
 * May a frame that does not fit be sent, and delay the next cycle? A limited number of times a
 * second, evenly spaced, so that a full wire carries acyclic frames as well.
 */
static bool may_be_late(struct ec_share *share)
{
	u32 per_s = READ_ONCE(share->late_per_s);
	u64 now = ktime_get_ns();

	if (!per_s || now < share->late_next_ns)
		return false;
	share->late_next_ns = now + NSEC_PER_SEC / per_s;
	WRITE_ONCE(share->late_cycles, share->late_cycles + 1);
	return true;
}

/* The first frame of a send does not fit: if that lasts, the thread ends its wait. */
static void note_stuck(struct ec_carry *c, enum ec_post_class class)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&c->lock, flags);
	if (!ec_read64(&c->stuck_ns)) {
		ec_write64(&c->stuck_ns, ktime_get_ns());
		c->stuck_class = class;
	}
	raw_spin_unlock_irqrestore(&c->lock, flags);
}

/*
 * The frames of a train have no limit in number, but fit into the free wire time together. Returns
 * that of those sent.
 */
static u32 send_train(struct ec_carry *c, u32 used_ns)
{
	const struct ec_flight_room alone = { .len = 0 };
	struct ec_links *l = c->links;
	u32 need_ns, sent_ns = 0;
	unsigned int n = next_train(c, &need_ns);

	if (!n)
		return 0;
	if (n > ec_links_burst(l) || !fits(c, used_ns, need_ns)) {
		note_stuck(c, EC_POST_TRAIN);
		return 0;
	}
	for (; n; n--) {
		int ret = ec_flight_send(c, EC_POST_TRAIN, &alone,
					 ec_read64(&l->access.last_send_ns) + used_ns + sent_ns);

		if (ret <= 0)
			break;
		share_count(c, EC_POST_TRAIN, ret);
		sent_ns += ret;
	}
	return sent_ns;
}

/**
 * ec_share_send_left() - send posts that wait and fit before the next cycle; see
 *	ecrt_master_set_late_cycles() for posts that do not fit
 * @c: posts of the master; ec_links_flush() must follow
 * @wire_ns: wire time this cycle has used
 *
 * Context: The cycle owner, in an RCU read section. RT-safe.
 */
void ec_share_send_left(struct ec_carry *c, u32 wire_ns)
{
	struct ec_links *l = c->links;
	unsigned int n, len, burst = ec_links_burst(l);
	enum ec_post_class class;

	if (unlikely(!list_empty(&c->ready[EC_POST_TRAIN])))
		wire_ns += send_train(c, wire_ns);
	/* the next cycle needs transmit buffers as well */
	for (n = 0; n < burst && ec_carry_has_left(c) && next_post(c, &class, &len); n++) {
		struct ec_flight_room room;
		int ret;

		if (!ec_carry_has_place(c, class))
			break;
		if (!fits(c, wire_ns, ec_frame_wire_ns(len)) &&
		    (c->share.frames || !may_be_late(&c->share))) {
			if (!c->share.frames)
				note_stuck(c, class);
			break;
		}
		room = find_room(c, class, wire_ns);
		/* behind the frames that this cycle has sent before */
		ret = ec_flight_send(c, class, &room, ec_read64(&l->access.last_send_ns) + wire_ns);
		if (ret <= 0)
			break;
		share_count(c, class, ret);
		wire_ns += ret;
	}
}

/**
 * ec_share_send_between() - send posts that wait, between two cycles
 * @c: posts of the master, whose links are entered
 *
 * Nothing is sent when the next cycle is so near that one frame might delay it; its own send
 * carries the posts then.
 *
 * Context: The cycle owner. RT-safe.
 */
void ec_share_send_between(struct ec_carry *c)
{
	struct ec_links *l = c->links;
	u64 since = ktime_get_ns() - ec_read64(&l->access.last_send_ns);

	if (since + ec_frame_wire_ns(EC_ETH_MAX) < ec_access_interval_us(&l->access) * 900ULL) {
		rcu_read_lock();
		ec_share_send_left(c, since);
		ec_links_flush(l);
		rcu_read_unlock();
	}
}
