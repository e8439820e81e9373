// SPDX-License-Identifier: GPL-2.0-only
/* Callers of the transport: requests and their answers. */
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../wire/fmmu.h"
#include "mailbox_int.h"

#define ONCE_MS	1000	/* for one look: as long as the slave passes INIT, say */
#define LAST_NS		(75 * NSEC_PER_MSEC)	/* for a message that ends a transfer */

/**
 * ec_mbox_init() - prepare the mailbox of a slave
 * @mb: zeroed structure whose immutable members are set
 *
 * Context: Any.
 */
void ec_mbox_init(struct ec_mbox *mb)
{
	raw_spin_lock_init(&mb->lock);
	ec_post_init(&mb->post, mb->links, ec_mbox_done);
	mb->post.dg = &mb->dg;
	mb->post.n = 1;
	INIT_WORK(&mb->unasked, ec_mbox_unasked);
	INIT_LIST_HEAD(&mb->queue);
	INIT_LIST_HEAD(&mb->users);
	INIT_LIST_HEAD(&mb->claims);
	spin_lock_init(&mb->unasked_lock);
	raw_spin_lock_init(&mb->last_lock);
	INIT_LIST_HEAD(&mb->kept);
}

/**
 * ec_mbox_exit() - the slave is being freed
 * @mb: mailbox without users
 *
 * Context: Process. Waits for the datagram that may be on its way.
 */
void ec_mbox_exit(struct ec_mbox *mb)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->lock, flags);
	mb->dead = true;
	raw_spin_unlock_irqrestore(&mb->lock, flags);
	ec_post_cancel(&mb->post);
	cancel_work_sync(&mb->unasked);
	ec_mbox_keep_voe(mb, false);
	kfree(mb->tx);
	kfree(mb->rx);
}

/* Memory of the mailboxes, when they are used first. The sizes may be anything. */
static int get_memory(struct ec_mbox *mb)
{
	u16 tx = clamp_t(u16, max(mb->sii->std.rx_size, mb->sii->boot.rx_size), EC_MBOX_HDR,
			 EC_MBOX_MAX);
	u16 rx = clamp_t(u16, max(mb->sii->std.tx_size, mb->sii->boot.tx_size), EC_MBOX_BEGIN,
			 EC_MBOX_MAX);
	unsigned long flags;
	u8 *t, *r;

	if (READ_ONCE(mb->rx))
		return 0;
	t = kmalloc(tx, GFP_KERNEL);
	r = kzalloc(rx, GFP_KERNEL);
	raw_spin_lock_irqsave(&mb->lock, flags);
	if (t && r && !mb->rx) {
		swap(mb->tx, t);
		swap(mb->rx, r);
		mb->tx_room = tx;
		mb->rx_room = rx;
	}
	raw_spin_unlock_irqrestore(&mb->lock, flags);
	kfree(t);
	kfree(r);
	return READ_ONCE(mb->rx) ? 0 : -ENOMEM;
}

/**
 * ec_mbox_reset() - the slave is in INIT: its mailbox forgets all messages
 * @mb: mailbox of a slave
 *
 * A caller of the mailbox may still wait for a reply that cannot come any more.
 *
 * Context: The slave's worker.
 */
void ec_mbox_reset(struct ec_mbox *mb)
{
	WRITE_ONCE(mb->renew, true);
}

/**
 * ec_mbox_in_use() - does a caller exchange messages with the slave now?
 * @mb: mailbox of the slave
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one does; it gets all that the slave sends. One that begins or changes its
 * queue just now, or whose datagram is just back, may be missed.
 */
bool ec_mbox_in_use(const struct ec_mbox *mb)
{
	return !list_empty(&mb->queue) || !list_empty(&mb->users) ||
	       READ_ONCE(mb->step) != EC_MBOX_REST;
}

/**
 * ec_mbox_sms() - SyncManager pages of a mailbox
 * @mb: mailbox of the slave
 * @boot: of BOOT
 * @page: result, SM0 and SM1, 2 * EC_SM_PAGE bytes
 *
 * A full SM1 is an ECAT event (register 0x0200), unless the slave wants its usual control byte.
 *
 * Context: Any.
 * Return: bytes of @page, 0 without mailbox.
 */
unsigned int ec_mbox_sms(const struct ec_mbox *mb, bool boot, u8 *page)
{
	const struct ec_sii_mbox *area = boot ? &mb->sii->boot : &mb->sii->std;
	struct ec_sm out = { .start = area->rx_offset, .len = area->rx_size, .control = 0x26,
			     .activate = EC_SM_ACT_ENABLE };
	struct ec_sm in = { .start = area->tx_offset, .len = area->tx_size, .control = 0x22,
			    .activate = EC_SM_ACT_ENABLE };

	if (!mb->strict)
		in.control |= EC_SM_ECAT_IRQ;
	if (!area->rx_size || !area->tx_size)
		return 0;
	ec_sm_encode(&out, page);
	ec_sm_encode(&in, page + EC_SM_PAGE);
	return 2 * EC_SM_PAGE;
}

/**
 * ec_mbox_check() - can this protocol be used with the slave, in PREOP or above?
 * @mb: mailbox of the slave
 * @protocol: EC_SII_PROTO_*
 * @message: bytes behind the mailbox header it needs at least
 *
 * The reply needs less than some requests, but not nothing: it has at least a header.
 *
 * Context: Process.
 * Return: 0; -EPROTONOSUPPORT when the slave does not have it; -EAGAIN in BOOT, unless it is
 * FoE; -EMSGSIZE for a mailbox that is too small or larger than a datagram.
 */
int ec_mbox_check(const struct ec_mbox *mb, u16 protocol, size_t message)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);

	if (!ec_mbox_present(mb) || !(mb->sii->protocols & protocol))
		return -EPROTONOSUPPORT;
	/* BOOT is for files only */
	if (area != &mb->sii->std && protocol != EC_SII_PROTO_FOE)
		return -EAGAIN;
	/* the EEPROM may say anything; a message is one datagram */
	if (area->rx_size < EC_MBOX_HDR + message || area->rx_size > EC_MBOX_MAX ||
	    area->tx_size < EC_MBOX_HDR + min_t(size_t, message, EC_MBOX_REPLY) ||
	    area->tx_size > EC_MBOX_MAX)
		return -EMSGSIZE;
	return 0;
}

/**
 * ec_mbox_alloc() - check that a protocol can be used, and allocate buffers for it
 * @mb: mailbox of the slave
 * @protocol: EC_SII_PROTO_*
 * @message: bytes behind the mailbox header it needs at least
 *
 * Context: Process. May sleep.
 * Return: buffers, for kfree(); ERR_PTR(): as ec_mbox_check(), or -ENOMEM.
 */
struct ec_mbox_buf *ec_mbox_alloc(const struct ec_mbox *mb, u16 protocol, size_t message)
{
	int ret = ec_mbox_check(mb, protocol, message);
	struct ec_mbox_buf *b = ret ? ERR_PTR(ret) : kmalloc(sizeof(*b), GFP_KERNEL);

	return b ?: ERR_PTR(-ENOMEM);
}

/* users ---------------------------------------------------------------------*/

/**
 * ec_mbox_enter() - a caller has a message for the slave, or waits for one
 * @mb: mailbox of the slave, with memory
 * @u: caller
 *
 * Context: Process.
 */
void ec_mbox_enter(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->lock, flags);
	u->task = current;
	if (u->len || u->discard) {
		u->phase = EC_MBOX_USER_QUEUED;
		list_add_tail(&u->list, &mb->queue);
	} else {
		u->phase = EC_MBOX_USER_WAITING;
		list_add_tail(&u->list, &mb->users);
		mb->since_ns = ktime_get_ns();
		mb->due_ns = 0;
	}
	ec_mbox_hurry(mb);
	ec_mbox_go(mb);
	raw_spin_unlock_irqrestore(&mb->lock, flags);
	/* the caller before the count */
	if (mb->changes)
		atomic_inc_return_release(mb->changes);
}

/* The message was not the one: wait for another. */
static void wait_on(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->lock, flags);
	u->phase = EC_MBOX_USER_WAITING;
	mb->since_ns = ktime_get_ns();
	ec_mbox_retry_held(mb);
	ec_mbox_go(mb);
	raw_spin_unlock_irqrestore(&mb->lock, flags);
}

/**
 * ec_mbox_leave() - a caller has its result, or has given up
 * @mb: mailbox of the slave
 * @u: caller that has entered
 * @answered: nothing of its exchange can come any more
 *
 * Context: Process.
 */
void ec_mbox_leave(struct ec_mbox *mb, struct ec_mbox_user *u, bool answered)
{
	struct ec_mbox_sending *s = &mb->sending;
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->lock, flags);
	if (s->user == u) {
		u->lost |= s->on && s->lost;
		s->user = NULL;
		/* what is on its way goes on */
		s->on &= mb->step == EC_MBOX_WRITE;
	}
	list_del(&u->list);
	u->phase = EC_MBOX_USER_IDLE;
	if (u->answer)
		mb->answered = answered;
	ec_mbox_retry_held(mb);
	ec_mbox_go(mb);
	raw_spin_unlock_irqrestore(&mb->lock, flags);
}

/* Until it is DONE: 0, or why not. The limit begins when its message has its turn. */
static int wait_done(struct ec_mbox *mb, struct ec_mbox_user *u, const struct ec_mbox_limit *limit,
		     struct ec_mbox_until *until)
{
	int ret;

	for (;;) {
		if (READ_ONCE(u->phase) == EC_MBOX_USER_QUEUED)
			*until = ec_mbox_until(limit);
		ret = ec_mbox_over(mb, until);
		/* the result is there: see ec_mbox_finish() */
		if (smp_load_acquire(&u->phase) == EC_MBOX_USER_DONE)
			return ret == -ETIMEDOUT ? 0 : ret;
		if (ret)
			return ret;
		ec_mbox_sleep(mb, &u->phase, EC_MBOX_USER_DONE, until);
	}
}

static int answer(struct ec_mbox *mb, const struct ec_mbox_request *r,
		  const struct ec_mbox_user *u)
{
	if (u->err)
		return u->err;
	if (u->got_type == EC_MBOX_ERR)
		return ec_mbox_error_reply(mb, u->rx, u->got);
	return r->rx(r->ctx, u->rx, u->got);
}

/* The request, until its answer is here or it is too late. */
static int mailbox_exchange(struct ec_mbox *mb, const struct ec_mbox_request *r,
			    const struct ec_mbox_limit *limit, struct ec_mbox_user *u)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	int ret, end;

	for (;;) {
		ret = wait_done(mb, u, limit, &until) ?: answer(mb, r, u);
		if (ret != EC_WAIT && ret != EC_STALE)
			return ret;
		u->heard = true;
		if (ret == EC_WAIT)
			until = ec_mbox_until(&r->limit);
		/* also a slave that sends messages without end has to answer in time */
		end = ec_mbox_over(mb, &until);
		if (end)
			return end;
		wait_on(mb, u);
	}
}

/* The slave has the request, and its reply is late. It may come just now. */
static int mailbox_go_on(struct ec_mbox *mb, const struct ec_mbox_request *r,
			 struct ec_mbox_user *u)
{
	struct ec_mbox_limit more = r->limit;
	int ret;

	more.timeout_ms = r->limit.patient ? EC_MBOX_LATE_MS : 0;
	if (r->limit.patient)
		ec_mbox_warn(mb, "no reply within %u ms to a request that the slave has accepted; waiting %u s more\n",
			      r->limit.timeout_ms, EC_MBOX_LATE_MS / 1000);
	ret = mailbox_exchange(mb, r, &more, u);
	if (ret == -ETIMEDOUT && !r->limit.patient)
		ec_mbox_mark_late(mb, u);
	return ret;
}

/**
 * ec_mbox_request() - send one message, wait for the answer
 * @mb: mailbox that ec_mbox_check() has accepted
 * @r: request; its protocol is claimed
 * @b: message in @tx, the answer will be in @rx
 * @len: bytes of the message
 *
 * Other protocols may be used meanwhile. What a lost frame loses is repeated, if the slave can
 * do that. With @r->late the request first waits for the reply that an earlier one did not get
 * in time, as long as the slave may be working on that.
 *
 * Context: Process. Waits for bus traffic.
 * Return: the last value of @r->rx; -EAGAIN in INIT; -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED;
 * -ENOTRECOVERABLE when a lost frame was the reason, so that the slave may have done what was
 * requested; -EBADMSG for a message whose header is wrong; the errno of a mailbox error
 * reply; -ENOMEM; or as ec_xfer().
 */
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len)
{
	struct ec_mbox_until now = { .ns = U64_MAX, .cancel = r->limit.cancel };
	struct ec_mbox_user u = {
		.type = r->type, .answer = true, .first = r->first, .tx = b->tx, .len = len,
		.rx = b->rx,
	};
	int ret = get_memory(mb) ?: ec_mbox_over(mb, &now);

	lockdep_assert(ec_mbox_is_claimed(mb, BIT(r->type)));
	if (!ret && r->late && r->first)
		ret = ec_mbox_await_late(mb, r, b);
	if (ret)
		return ret;
	ec_mbox_enter(mb, &u);
	ret = mailbox_exchange(mb, r, &r->limit, &u);
	if (ret == -ETIMEDOUT && r->late && ec_mbox_is_late(mb, &u))
		ret = mailbox_go_on(mb, r, &u);
	ec_mbox_leave(mb, &u, ret >= 0);
	return ret == -ETIMEDOUT && (u.lost || u.gap) ? -ENOTRECOVERABLE : ret;
}

/**
 * ec_mbox_send() - send one message that has no answer
 * @mb: mailbox that ec_mbox_check() has accepted
 * @type: enum ec_mbox_type
 * @b: message in @tx
 * @len: bytes of the message
 * @limit: when to give up
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EAGAIN in INIT, -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED; -ENOTRECOVERABLE when
 * its frame was lost, so that the slave may have it or not; -ENOMEM; or as ec_xfer().
 */
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	struct ec_mbox_user u = { .type = type, .tx = b->tx, .len = len };
	int ret = get_memory(mb) ?: ec_mbox_over(mb, &until);

	if (ret)
		return ret;
	ec_mbox_enter(mb, &u);
	ret = wait_done(mb, &u, limit, &until) ?: u.err;
	ec_mbox_leave(mb, &u, false);
	return ret == -ETIMEDOUT && u.lost ? -ENOTRECOVERABLE : ret;
}

/**
 * ec_mbox_send_last() - end a transfer at the slave, as well as it can be done
 * @mb: mailbox that ec_mbox_check() has accepted
 * @type: enum ec_mbox_type
 * @b: message in @tx
 * @len: bytes of the message
 *
 * Also for a caller that has been killed, so nothing is waited for but the mailbox.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_mbox_send_last(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len)
{
	struct ec_mbox_user u = { .type = type, .tx = b->tx, .len = len };
	u64 until = ktime_get_ns() + LAST_NS;
	ktime_t at = ns_to_ktime(until);

	if (get_memory(mb))
		return;
	ec_mbox_enter(mb, &u);
	while (!ec_stop_all(mb->stop) && ktime_get_ns() < until) {
		set_current_state(TASK_UNINTERRUPTIBLE);
		if (READ_ONCE(u.phase) == EC_MBOX_USER_DONE)
			break;
		schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
	}
	__set_current_state(TASK_RUNNING);
	ec_mbox_leave(mb, &u, false);
}

/**
 * ec_mbox_forget() - empty the mailbox for a new application
 * @mb: mailbox of a slave with mailbox, in PREOP
 *
 * What the slave has sent before, emergencies and VoE messages too, is none of it. Answers
 * that a caller waits for are delivered.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -ENOMEM; -ECANCELED; -EBUSY when it cannot be emptied; -EMSGSIZE when it is
 * larger than a datagram; or as ec_xfer().
 */
int ec_mbox_forget(struct ec_mbox *mb)
{
	const struct ec_mbox_limit limit = { .timeout_ms = 10000 };
	struct ec_mbox_until until = ec_mbox_until(&limit);
	struct ec_mbox_user u = { .discard = true };
	int ret = get_memory(mb);

	if (ret)
		return ret;
	ec_mbox_enter(mb, &u);
	ret = wait_done(mb, &u, &limit, &until) ?: u.err;
	ec_mbox_leave(mb, &u, false);
	ec_mbox_flush_kept(mb);
	return ret;
}

/**
 * ec_mbox_fetch() - let the slave's messages be read, although no caller waits for them
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

	if (!ec_mbox_present(mb) || ec_stop_all(mb->stop) || ec_mbox_off(mb) || get_memory(mb))
		return false;
	raw_spin_lock_irqsave(&mb->lock, flags);
	if (ktime_get_ns() < mb->flood_ns) {
		raw_spin_unlock_irqrestore(&mb->lock, flags);
		return false;
	}
	if (!mb->fetch) {
		mb->fetch = true;
		mb->since_ns = ktime_get_ns();
		mb->due_ns = 0;
		ec_mbox_go(mb);
	}
	raw_spin_unlock_irqrestore(&mb->lock, flags);
	return true;
}

/**
 * ec_mbox_wait_voe() - wait for a VoE message
 * @mb: mailbox that ec_mbox_check() has accepted
 * @b: the message is in @rx
 * @blind: one access to the mailbox without a look whether it is full
 * @limit: when to give up; @timeout_ms 0: no wait
 *
 * The message may have arrived earlier. Others can use the mailbox meanwhile.
 *
 * Context: Process. Waits for bus traffic.
 * Return: bytes behind the mailbox header; -ENOMSG, when @blind and there is
 * none; -ETIMEDOUT, -EINTR, -ECANCELED; -EBADMSG; the errno of a mailbox error
 * reply; -EAGAIN in INIT; -ENOMEM; or as ec_xfer().
 */
int ec_mbox_wait_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind,
		     const struct ec_mbox_limit *limit)
{
	const struct ec_mbox_limit now = { .timeout_ms = ONCE_MS, .cancel = limit->cancel };
	struct ec_mbox_until until = ec_mbox_until(blind ? &now : limit);
	struct ec_mbox_user u = { .type = EC_MBOX_VOE, .once = blind, .rx = b->rx };
	int ret = get_memory(mb) ?: ec_mbox_take_kept(mb, b->rx), kept;

	if (ret != -ENOMSG)
		return ret;
	ec_mbox_enter(mb, &u);
	do {
		if (ec_mbox_off(mb))
			ret = -EAGAIN;
		else
			ret = ec_mbox_over(mb, &until);
		/* the result is there: see ec_mbox_finish() */
		if (smp_load_acquire(&u.phase) == EC_MBOX_USER_DONE) {
			ret = u.err ?: u.got_type == EC_MBOX_ERR ?
			      ec_mbox_error_reply(mb, b->rx, u.got) : u.got;
			break;
		}
		kept = ec_mbox_take_kept(mb, b->rx);
		if (kept != -ENOMSG) {
			ret = kept;
			break;
		}
		if (!ret)
			ec_mbox_sleep(mb, &u.phase, EC_MBOX_USER_DONE, &until);
	} while (!ret);
	ec_mbox_leave(mb, &u, false);
	if (ret != -ENOMSG && ret != -ETIMEDOUT)
		return ret;
	/* one that has come before this caller was one of the users */
	kept = ec_mbox_take_kept(mb, b->rx);
	return kept != -ENOMSG ? kept : blind ? -ENOMSG : ret;
}
