// SPDX-License-Identifier: GPL-2.0-only
/*
 * Posts of several callers share a frame where they fit: a cyclic send carries a limited number of
 * frames, and most posts are a single short datagram. The frame has one slot. A post knows where
 * its datagrams are in it, so a cancelled post does not affect the others.
 */
#include <linux/bitops.h>
#include <linux/ktime.h>
#include "../base/once64.h"
#include "../wire/regs.h"
#include "flight.h"
#include "post_int.h"

/*
 * May @post share the frame of @first? A repeated post is sent alone: if its frame is lost each
 * time, it must not take other posts with it twice.
 */
static bool shares(const struct ec_post *first, const struct ec_post *post, unsigned int n,
		   unsigned int len, unsigned int dgrams, const struct ec_flight_room *room)
{
	return n < EC_POSTS_MAX && !first->tries && !post->tries && post->sides == first->sides &&
	       dgrams + post->dgrams <= room->dgrams && len + post->len <= room->len;
}

/* Move posts that are sent together to the frame of a slot, in their order. */
static struct ec_post *gather(struct ec_carry *c, enum ec_post_class class, struct ec_slot *slot,
			      const struct ec_flight_room *room)
{
	struct ec_post *first = ec_flight_first(c, class), *post = first, *next;
	unsigned int len = EC_FRAME_HDR, dgrams = 0, n = 0;
	struct ec_flight *f = &c->flight[slot->index];

	lockdep_assert_held(&c->lock);
	f->built = false;
	f->class = class;
	if (!first)
		return NULL;
	list_for_each_entry_safe_from(post, next, &c->ready[class], list) {
		if (n && !shares(first, post, n, len, dgrams, room))
			break;
		list_move_tail(&post->list, &f->posts);
		post->state = EC_POST_FLYING;
		post->slot = slot->index;
		post->at = len;
		len += post->len;
		dgrams += post->dgrams;
		n++;
	}
	WRITE_ONCE(c->n_ready, c->n_ready - n);
	return first;
}

/* Write the frame. Its posts cannot be cancelled meanwhile, see @built. */
static void build(struct ec_flight *f, struct ec_slot *slot, u8 *frame)
{
	struct ec_frame_buf fb;
	struct ec_post *post;
	unsigned int i;

	ec_frame_begin(&fb, frame + EC_ETH_HDR, EC_FRAME_HDR + EC_FRAME_BODY_MAX);
	f->patient = true;
	list_for_each_entry(post, &f->posts, list) {
		f->patient &= post->patient;
		for (i = 0; i < post->n; i++) {
			const struct ec_dg *dg = &post->dg[i];
			u8 *p;

			if (dg->err != -EINPROGRESS)
				continue;
			p = ec_frame_add(&fb, dg->cmd, slot->index, dg->adp + post->shift, dg->ado,
					 dg->len);
			if (WARN_ON_ONCE(!p))
				break;
			ec_dg_fill(dg, p);
		}
	}
	slot->eth_len = EC_ETH_HDR + ec_frame_end(&fb);
	f->wire_ns = ec_frame_wire_ns(slot->eth_len);
}

/*
 * Write the time of the reference clock into a frame that sets clocks. If that clock does not
 * reply, the other clocks take the time in the drift compensation datagram, and an old one would
 * slow them down. What the cycle holds, or ARMW needs and is not certain, is only read.
 */
static void stamp(const struct ec_carry *c, u8 *frame, size_t len, u64 sent_ns)
{
	struct ec_frame_iter it;
	struct ec_dgram d;
	u8 time[8];

	if (!c->ref_minus_ktime || ec_frame_iter_init(&it, frame, len))
		return;
	put_unaligned_le64(atomic64_read(c->ref_minus_ktime) + sent_ns, time);
	while (ec_frame_iter_next(&it, &d) == 1) {
		u16 adp = d.adp;

		if (d.cmd != EC_CMD_FRMW || d.ado != EC_REG_DC_SYSTIME || d.len > sizeof(time))
			continue;
		memcpy(d.data, time, d.len);
		*d.hdr = READ_ONCE(c->clocks_held) ? EC_CMD_FPRD : ec_armw_command(c->armw, &adp);
		put_unaligned_le16(adp, d.hdr + 2);
	}
}

/* Count a frame as in flight, before it is sent: see ecdev_awaits(). */
static void take_off(struct ec_carry *c, struct ec_flight *f, struct ec_slot *slot, u8 sides)
{
	struct ec_links *l = c->links;
	unsigned long left, flags;

	f->sides = sides;
	f->overdue = 0;
	f->polls = READ_ONCE(l->access.polls);
	for (left = sides; left; left &= left - 1) {
		atomic_inc(&l->link[__ffs(left)].acyclic);
		atomic_add(f->wire_ns, &l->link[__ffs(left)].acyclic_ns);
	}
	raw_spin_lock_irqsave(&c->lock, flags);
	__set_bit(slot->index, c->flying);
	WRITE_ONCE(c->n_flying, c->n_flying + 1);
	f->built = true;
	raw_spin_unlock_irqrestore(&c->lock, flags);
}

static void take_down(struct ec_carry *c, const struct ec_slot *slot)
{
	const struct ec_flight *f = &c->flight[slot->index];
	unsigned long left;

	lockdep_assert_held(&c->lock);
	__clear_bit(slot->index, c->flying);
	WRITE_ONCE(c->n_flying, c->n_flying - 1);
	for (left = f->sides; left; left &= left - 1) {
		struct ec_link *link = &c->links->link[__ffs(left)];

		atomic_sub(f->wire_ns, &link->acyclic_ns);
		atomic_dec(&link->acyclic);
	}
}

/**
 * ec_flight_end() - a frame is not in flight any more
 * @c: posts of the master
 * @slot: its slot, not SENT any more
 * @posts: result: its posts that were not cancelled; the caller reports their end
 *
 * Context: Any, with the lock of the posts held. RT-safe.
 */
void ec_flight_end(struct ec_carry *c, const struct ec_slot *slot, struct list_head *posts)
{
	struct ec_flight *f = &c->flight[slot->index];
	struct ec_post *post;

	lockdep_assert_held(&c->lock);
	take_down(c, slot);
	list_splice_init(&f->posts, posts);
	list_for_each_entry(post, posts, list) {
		post->state = EC_POST_IDLE;
		post->running = true;
	}
}

/* The device was full: the posts are the first ones of their class again. */
static void put_back(struct ec_carry *c, struct ec_slot *slot)
{
	struct ec_flight *f = &c->flight[slot->index];
	struct ec_post *post, *next;
	unsigned long flags;

	raw_spin_lock_irqsave(&c->lock, flags);
	take_down(c, slot);
	list_for_each_entry_safe_reverse(post, next, &f->posts, list) {
		post->state = EC_POST_READY;
		list_move(&post->list, &c->ready[f->class]);
		WRITE_ONCE(c->n_ready, c->n_ready + 1);
	}
	if (!ec_read64(&c->full_ns))
		ec_write64(&c->full_ns, ktime_get_ns());
	raw_spin_unlock_irqrestore(&c->lock, flags);
	ec_slot_put(slot);
}

/* The device refuses the frame: its posts end. */
static void refused(struct ec_carry *c, struct ec_slot *slot, int err)
{
	unsigned long flags;
	LIST_HEAD(posts);

	raw_spin_lock_irqsave(&c->lock, flags);
	ec_flight_end(c, slot, &posts);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	ec_slot_put(slot);
	ec_post_lost(c, &posts, err);
}

/**
 * ec_flight_send() - send the next post of a class, and others that fit into its frame
 * @c: posts of the master; ec_links_flush() must follow
 * @class: enum ec_post_class
 * @room: limits of the frame for posts after the first one
 * @sent_ns: when it leaves (ktime)
 *
 * Context: The owner of the bus access, in an RCU read section. RT-safe.
 * Return: wire time of the frame, ns; 0: no post is READY; -EBUSY: no slot, or the device is full;
 * or as ec_links_send(): then its posts have ended.
 */
int ec_flight_send(struct ec_carry *c, enum ec_post_class class,
		   const struct ec_flight_room *room, u64 sent_ns)
{
	struct ec_links *l = c->links;
	struct ec_slot *slot = ec_slot_get(&l->slots, ec_post_first(class), sent_ns);
	struct ec_flight *f;
	struct ec_post *first;
	struct ec_tx tx;
	unsigned long flags;
	u32 wire_ns;
	u8 sides = 0, *frame;
	int ret;

	if (!slot)
		return -EBUSY;
	f = &c->flight[slot->index];
	raw_spin_lock_irqsave(&c->lock, flags);
	first = gather(c, class, slot, room);
	if (first)
		sides = first->sides;
	raw_spin_unlock_irqrestore(&c->lock, flags);
	if (!first) {
		ec_slot_put(slot);
		return 0;
	}
	frame = ec_links_tx_get(l, sides, &tx) ?: slot->frame;
	build(f, slot, frame);
	if (class == EC_POST_CLOCK)
		stamp(c, frame + EC_ETH_HDR, slot->eth_len - EC_ETH_HDR, sent_ns);
	/* once it is sent, the reply may be received and the slot reused at any time */
	wire_ns = f->wire_ns;
	slot->done = ec_flight_landed;
	slot->user = c;
	take_off(c, f, slot, sides);
	ret = ec_links_transmit(l, slot, frame, &tx, sent_ns);
	if (ret == -EBUSY) {
		put_back(c, slot);
		return ret;
	}
	if (unlikely(ec_read64(&c->full_ns)))
		ec_write64(&c->full_ns, 0);
	if (ret)
		refused(c, slot, ret);
	return ret ?: wire_ns;
}

/*
 * A copy is missing: is it not known what the slaves have done? One that no slave has processed may
 * have been by that copy, and what is written to all of them may have reached one side of a break.
 */
static bool is_unknown(const struct ec_slot *slot, const struct ec_dg *dg)
{
	const struct ec_carry *c = slot->user;

	if (slot->back == slot->sides)
		return false;
	return !dg->wkc || (dg->cmd == EC_CMD_BWR && !READ_ONCE(c->links->ring.measured));
}

/*
 * Take the results of a post from the copy of each link. Return: false: that of one of its
 * datagrams is not known.
 */
static bool take_results(const struct ec_slot *slot, struct ec_post *post)
{
	bool known = true;
	unsigned long copies = slot->back & ~slot->blank;
	struct ec_frame_iter it[EC_MAX_LINKS];
	struct ec_dgram d;
	unsigned long left;
	unsigned int i;

	for (left = copies; left; left &= left - 1) {
		/* posts are never kept: the iterator has no const form */
		u8 *copy = (u8 *)slot->got[__ffs(left)];

		it[__ffs(left)] = (struct ec_frame_iter){
			.p = copy + post->at, .end = copy + slot->eth_len - EC_ETH_HDR,
			.more = true,
		};
	}
	for (i = 0; i < post->n; i++) {
		if (post->dg[i].err != -EINPROGRESS)
			continue;
		for (left = slot->blank; left; left &= left - 1)
			ec_dg_take_blank(&post->dg[i], __ffs(left));
		for (left = copies; left; left &= left - 1)
			/* compared with what was sent when the frame was matched */
			if (ec_frame_iter_next(&it[__ffs(left)], &d) == 1)
				ec_dg_take(&post->dg[i], &d, __ffs(left), post->shift);
		post->dg[i].crossed = slot->crossed;
		post->dg[i].sent_ns = slot->sent_ns;
		if (post->dg[i].err) {
			post->dg[i].err = -EIO;
		} else if (is_unknown(slot, &post->dg[i])) {
			ec_dg_begin(&post->dg[i]);
			known = false;
		}
	}
	return known;
}

/* The posts of a frame get their results from its reply. */
static void land(struct ec_slot *slot)
{
	struct ec_carry *c = slot->user;
	struct ec_post *post, *next;
	unsigned long flags;
	LIST_HEAD(unknown);
	LIST_HEAD(posts);

	raw_spin_lock_irqsave(&c->lock, flags);
	ec_flight_end(c, slot, &posts);
	raw_spin_unlock_irqrestore(&c->lock, flags);
	list_for_each_entry_safe(post, next, &posts, list)
		if (unlikely(!take_results(slot, post)))
			list_move_tail(&post->list, &unknown);
	ec_links_lost(c->links, slot, slot->sides & ~slot->back);
	ec_slot_put(slot);
	/* the thread sends held posts; the place before @held, pairs with send_ready() */
	smp_mb();
	if (READ_ONCE(c->held))
		ec_carry_kick(c);
	ec_post_finish(c, &posts);
	if (unlikely(!list_empty(&unknown)))
		ec_post_lost(c, &unknown, -ETIMEDOUT);
}

/**
 * ec_flight_landed() - a reply is received: the posts of the frame get their results
 * @slot: in state DONE, free afterwards
 *
 * Patient ones get them by ec_flight_land() if the cycle owner receives, whose process data would
 * leave later otherwise.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_flight_landed(struct ec_slot *slot)
{
	struct ec_carry *c = slot->user;

	if (!READ_ONCE(c->polled) || !c->flight[slot->index].patient) {
		land(slot);
		return;
	}
	set_bit(slot->index, c->landed);
	/* the slot before @has_landed; pairs with ec_flight_land() */
	smp_store_release(&c->has_landed, true);
}

/**
 * ec_flight_land() - end the patient posts whose replies have been received
 * @c: posts of the master
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_flight_land(struct ec_carry *c)
{
	unsigned int i;

	WRITE_ONCE(c->has_landed, false);
	smp_mb();	/* before the slots are read; pairs with ec_flight_landed() */
	for_each_set_bit(i, c->landed, EC_SLOTS)
		/* the thread of the posts may do this at the same time */
		if (test_and_clear_bit(i, c->landed))
			land(&c->links->slots.slot[i]);
}
