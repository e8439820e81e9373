// SPDX-License-Identifier: GPL-2.0-only
/* Messages of a slave: which user gets them. */
#include <linux/ktime.h>
#include <linux/sched.h>
#include "../wire/coe.h"
#include "mailbox_int.h"

#define FLOOD_NS	(250 * NSEC_PER_MSEC)	/* of a slave that sends without end */

#define ORDERED		3	/* messages with the next counter in a row */

#define for_each_user(mb, u) list_for_each_entry(u, &(mb)->users, list)

/**
 * ec_mbox_finish() - a user has its result
 * @mb: mailbox of the slave, its lock held
 * @u: user, NULL: it has left
 * @err: result, 0: a message, or its message was sent
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_finish(struct ec_mbox *mb, struct ec_mbox_user *u, int err)
{
	lockdep_assert_held(&mb->lock);
	if (!u)
		return;
	u->err = err;
	/* the result before the phase */
	smp_store_release(&u->phase, EC_MBOX_USER_DONE);
	wake_up_process(u->task);
}

/**
 * ec_mbox_fail() - the slave cannot be reached, or its mailbox not be used
 * @mb: mailbox of the slave, its lock held
 * @err: -errno for all that have a message on its way or wait for one
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_fail(struct ec_mbox *mb, int err)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	mb->fetch = false;
	mb->sending.on = false;
	for_each_user(mb, u)
		if (u->phase == EC_MBOX_USER_WAITING || u->phase == EC_MBOX_USER_SENDING)
			ec_mbox_finish(mb, u, err);
}

/**
 * ec_mbox_awaited() - is a message of the slave waited for?
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_mbox_awaited(const struct ec_mbox *mb)
{
	const struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u)
		if (u->phase == EC_MBOX_USER_WAITING)
			return true;
	return mb->fetch;
}

/**
 * ec_mbox_is_blind() - does a user want SM1 read without a look whether it is full?
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one does.
 */
bool ec_mbox_is_blind(const struct ec_mbox *mb)
{
	const struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u)
		if (u->once && u->phase == EC_MBOX_USER_WAITING)
			return true;
	return false;
}

/**
 * ec_mbox_mark_gap() - a frame was lost that may have had an answer
 * @mb: mailbox of the slave, its lock held
 *
 * A caller that runs into the time limit after that does not know what the slave has done.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_mark_gap(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u)
		if (u->answer)
			u->gap = true;
}

/**
 * ec_mbox_finish_once() - the access to SM1 has brought nothing to those who want one only
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_finish_once(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u)
		if (u->once && u->phase == EC_MBOX_USER_WAITING)
			ec_mbox_finish(mb, u, -ENOMSG);
}

static void end_emptying(struct ec_mbox *mb, int err)
{
	struct ec_mbox_sending *s = &mb->sending;

	lockdep_assert_held(&mb->lock);
	s->emptying = false;
	if (!s->discard)
		return;
	s->on = false;
	ec_mbox_finish(mb, s->user, err);
}

/**
 * ec_mbox_found_empty() - SM1 has no message
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_found_empty(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	mb->sending.blocked = false;
	ec_mbox_finish_once(mb);
	/* what a lost frame had is asked for again */
	if (mb->gap && mb->can_repeat)
		return;
	mb->fetch = false;
	mb->fetched = 0;
	if (!mb->sending.on || !mb->sending.emptying)
		return;
	mb->answered = true;
	end_emptying(mb, 0);
}

/* Is the message in @rx the last one, from a slave that has counted well so far? */
static bool is_twice(struct ec_mbox *mb, u8 counter)
{
	bool same = !memcmp(mb->begin, mb->rx, sizeof(mb->begin));

	lockdep_assert_held(&mb->lock);
	memcpy(mb->begin, mb->rx, sizeof(mb->begin));
	if (counter == mb->seen) {
		same &= mb->in_order >= ORDERED;
		/* of a slave that stops counting one message is discarded, no more */
		mb->in_order -= same;
		return same;
	}
	mb->in_order = counter == ec_mbox_next_counter(mb->seen) ?
		       min(mb->in_order + 1, ORDERED) : 0;
	return false;
}

/*
 * When a slave has repeated its last message although nothing was lost, the counter shows
 * that the message is not a new one; also when a slave sends a message twice.
 */
static bool is_known(struct ec_mbox *mb, u8 counter)
{
	bool twice = is_twice(mb, counter);
	bool again = counter && counter == mb->seen && (mb->repeats || twice);

	lockdep_assert_held(&mb->lock);
	mb->repeats = false;
	if (again)
		return true;
	mb->counts = counter && mb->seen && counter != mb->seen;
	mb->seen = counter;
	return false;
}

/* No answer comes before the request may have arrived. */
static bool may_have(const struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	return u->phase == EC_MBOX_USER_WAITING ||
	       (u == mb->sending.user && mb->sending.on && mb->sending.lost);
}

/*
 * The user that a message of a type is for: of an error reply, which has no type, the one that
 * has sent its request first. One that has not taken its last message has to take that first.
 */
static struct ec_mbox_user *inbox_find(struct ec_mbox *mb, u8 type)
{
	struct ec_mbox_user *u, *reader = NULL;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u) {
		/* it only sends */
		if (!u->rx)
			continue;
		if (type != EC_MBOX_ERR && u->type != type)
			continue;
		if (!may_have(mb, u) && !(u->phase == EC_MBOX_USER_DONE && u->answer))
			continue;
		if (u->answer)
			return u;
		reader = reader ?: u;
	}
	return reader;
}

static void deliver(struct ec_mbox *mb, struct ec_mbox_user *u, const struct ec_mbox_hdr *h)
{
	lockdep_assert_held(&mb->lock);
	u->got = h->len;
	u->got_type = h->type;
	memcpy(u->rx, mb->rx + EC_MBOX_HDR, h->len);
	if (u->answer)
		mb->never_late = false;
	/* its message has arrived, whatever became of the frame */
	if (mb->sending.on && mb->sending.user == u)
		mb->sending.on = false;
	ec_mbox_finish(mb, u, 0);
}

static bool is_emergency(const struct ec_mbox *mb, const struct ec_mbox_hdr *h)
{
	struct ec_coe_emergency e;

	return h->type == EC_MBOX_COE && !ec_coe_emergency_decode(mb->rx + EC_MBOX_HDR, h->len, &e);
}

/* A message without a waiting request: a request gets its reply before such, or never. */
static void mark_heard(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	for_each_user(mb, u)
		if (u->answer && u->phase == EC_MBOX_USER_WAITING)
			u->heard = true;
}

/* Whose message is it? It stays in @rx until it is taken. */
static void inbox_dispatch(struct ec_mbox *mb, const struct ec_mbox_hdr *h)
{
	bool emergency = is_emergency(mb, h);
	struct ec_mbox_user *u = emergency ? NULL : inbox_find(mb, h->type);

	lockdep_assert_held(&mb->lock);
	mb->held = false;
	if (!u && !emergency && h->type != EC_MBOX_VOE && h->type != EC_MBOX_EOE)
		mark_heard(mb);
	if (u && u->phase == EC_MBOX_USER_DONE) {
		mb->held = true;
	} else if (u) {
		deliver(mb, u, h);
	} else if (!mb->sending.on || !mb->sending.discard) {
		mb->held = true;
		mb->handed_over = true;
		queue_work(system_highpri_wq, &mb->unasked);
	}
}

static void count_unasked(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	if (mb->sending.on && mb->sending.emptying && ++mb->sending.read >= EC_MBOX_DRAIN)
		end_emptying(mb, -EBUSY);
	if (mb->fetch && ++mb->fetched >= EC_MBOX_DRAIN) {
		mb->fetch = false;
		mb->fetched = 0;
		mb->flood_ns = ktime_get_ns() + FLOOD_NS;
	}
}

/**
 * ec_mbox_received() - SM1 was read: its content is in @rx
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_received(struct ec_mbox *mb)
{
	struct ec_rbuf r = ec_rbuf(mb->rx, mb->rx_size);
	struct ec_mbox_user *u;
	struct ec_mbox_hdr h;

	lockdep_assert_held(&mb->lock);
	mb->unread = false;
	if (ec_mbox_hdr_decode(&r, &h)) {
		u = inbox_find(mb, EC_MBOX_ERR);
		if (u && u->phase != EC_MBOX_USER_DONE) {
			mb->sending.on &= mb->sending.user != u;
			ec_mbox_finish(mb, u, -EBADMSG);
		}
	} else if (!is_known(mb, h.counter)) {
		inbox_dispatch(mb, &h);
	} else {
		mark_heard(mb);
	}
	count_unasked(mb);
	ec_mbox_finish_once(mb);
}

/**
 * ec_mbox_has_reader() - a user has come for the message in @rx that none was there for
 * @mb: mailbox of the slave, its lock held, @handed_over
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: the user has it.
 */
bool ec_mbox_has_reader(struct ec_mbox *mb)
{
	struct ec_rbuf r = ec_rbuf(mb->rx, mb->rx_size);
	struct ec_mbox_user *u;
	struct ec_mbox_hdr h;

	lockdep_assert_held(&mb->lock);
	if (ec_mbox_hdr_decode(&r, &h) || h.type != EC_MBOX_VOE)
		return false;
	u = inbox_find(mb, EC_MBOX_VOE);
	if (!u)
		return false;
	deliver(mb, u, &h);
	return true;
}

/**
 * ec_mbox_retry_held() - a user may take the message in @rx now, or no user does any more
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_retry_held(struct ec_mbox *mb)
{
	struct ec_rbuf r = ec_rbuf(mb->rx, mb->rx_size);
	struct ec_mbox_hdr h;

	lockdep_assert_held(&mb->lock);
	if (!mb->held || mb->handed_over)
		return;
	if (ec_mbox_hdr_decode(&r, &h))
		mb->held = false;
	else
		inbox_dispatch(mb, &h);
}
