// SPDX-License-Identifier: GPL-2.0-only
/* Users of the mailbox queue enter, wait and leave. */
#include <linux/ktime.h>
#include "box_state.h"
#include "desk.h"
#include "desk_enter.h"

/* A user with a message enters the queue, another one the list of users. */
static void line_up(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	bool sends = u->len || u->discard;

	lockdep_assert_held(&mb->box.lock);
	u->phase = sends ? EC_MBOX_USER_QUEUED : EC_MBOX_USER_WAITING;
	list_add_tail(&u->list, sends ? &mb->desk.queue : &mb->desk.users);
	if (!sends)
		ec_box_progress(&mb->box);
}

/**
 * ec_desk_enter() - a user has a message for the slave, or waits for one
 * @mb: mailbox of the slave, with memory
 * @u: IDLE, its members set up to @once
 *
 * @u->done may be called before this returns.
 *
 * Context: Any, but @u->done. RT-safe: bounded, no sleep, no allocation.
 */
void ec_desk_enter(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	u->exchange = u->answer || u->once || u->discard;
	WRITE_ONCE(mb->desk.exchanges, mb->desk.exchanges + u->exchange);
	line_up(mb, u);
	ec_box_hurry(&mb->box);
	ec_box_go(&mb->box);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	/* the user before the count */
	if (u->exchange && mb->changes)
		atomic_inc_return_release(mb->changes);
}

/**
 * ec_desk_again() - a user that has its result has another message, or waits for the next one
 * @mb: mailbox of the slave
 * @u: DONE, its members up to @once set again; after another error than -EBADMSG, which concerns
 *	one message alone, it has to leave instead
 *
 * Context: Only @u->done. RT-safe: bounded, no sleep, no allocation.
 * Return: false: it has to leave.
 */
bool ec_desk_again(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	lockdep_assert_held(&mb->box.lock);
	if (u->err && u->err != -EBADMSG)
		return false;
	list_del(&u->list);
	u->lost = false;
	u->gap = false;
	u->heard = false;
	line_up(mb, u);
	return true;
}

/**
 * ec_desk_wait_on() - the message was not the expected one: wait for another
 * @mb: mailbox of the slave
 * @u: DONE
 *
 * Context: Any, but @u->done. RT-safe: bounded, no sleep, no allocation.
 */
void ec_desk_wait_on(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	u->phase = EC_MBOX_USER_WAITING;
	ec_box_expect_more(&mb->box);
	ec_desk_retry(mb);
	ec_box_go(&mb->box);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/**
 * ec_desk_leave() - a user has its result, or ends its wait
 * @mb: mailbox of the slave
 * @u: user that has entered; afterwards IDLE, and @u->done does not run any more
 * @answered: no message of its exchange can follow any more
 *
 * Context: Any, but @u->done. RT-safe: bounded, no sleep, no allocation.
 */
void ec_desk_leave(struct ec_mbox *mb, struct ec_mbox_user *u, bool answered)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (mb->desk.sending == u) {
		u->lost |= ec_box_take_back(&mb->box);
		mb->desk.sending = NULL;
	}
	list_del(&u->list);
	WRITE_ONCE(mb->desk.exchanges, mb->desk.exchanges - u->exchange);
	u->phase = EC_MBOX_USER_IDLE;
	if (u->answer)
		mb->desk.answered = answered;
	ec_desk_retry(mb);
	ec_box_go(&mb->box);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/**
 * ec_mbox_in_use() - does a caller exchange messages with the slave now?
 * @mb: mailbox of the slave
 *
 * One that only reads what the slave sends, or sends what has no answer, does not.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one does. A caller that enters or leaves at this moment, or whose datagram is
 * just received, may be missed.
 */
bool ec_mbox_in_use(const struct ec_mbox *mb)
{
	return READ_ONCE(mb->desk.exchanges) ||
	       (list_empty(&mb->desk.users) && READ_ONCE(mb->box.step) != EC_BOX_REST);
}

/**
 * ec_mbox_is_read() - is all read that the slave sends?
 * @mb: mailbox of the slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether a caller waits for a message of it, or exchanges messages with it; as for
 * ec_mbox_in_use() one may be missed.
 */
bool ec_mbox_is_read(const struct ec_mbox *mb)
{
	return ec_mbox_in_use(mb) || !list_empty(&mb->desk.users);
}

/**
 * ec_mbox_reset() - the slave is in INIT: its mailbox forgets all messages
 * @mb: mailbox of a slave
 *
 * A caller of the mailbox may still wait for a reply that the slave will not send any more.
 *
 * Context: The slave's worker.
 */
void ec_mbox_reset(struct ec_mbox *mb)
{
	WRITE_ONCE(mb->box.renew, true);
}

/**
 * ec_mbox_fetch() - read messages of the slave although no caller waits for them
 * @mb: mailbox of the slave
 *
 * Emergencies and VoE messages are kept. Returns at once.
 *
 * Context: Process. May sleep.
 * Return: false: not now: the slave has no mailbox in its state, or sends without end.
 */
bool ec_mbox_fetch(struct ec_mbox *mb)
{
	unsigned long flags;
	bool flood;

	if (!ec_mbox_present(mb) || ec_stop_all(mb->stop) || ec_box_is_off(&mb->box) ||
	    ec_box_get_memory(&mb->box))
		return false;
	raw_spin_lock_irqsave(&mb->box.lock, flags);
	flood = ktime_get_ns() < mb->desk.flood_ns;
	if (!flood && !mb->desk.fetch) {
		mb->desk.fetch = true;
		ec_box_progress(&mb->box);
		ec_box_go(&mb->box);
	}
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	return !flood;
}
