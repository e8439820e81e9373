// SPDX-License-Identifier: GPL-2.0-only
/* Requests through a mailbox and their answers, for callers that sleep. */
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "../wire/fmmu.h"
#include "caller.h"
#include "mailbox.h"

#define ONCE_MS	1000	/* for one access: the slave may pass INIT, for example */
#define LAST_NS		(75 * NSEC_PER_MSEC)	/* for a message that ends a transfer */

/**
 * ec_mbox_init() - prepare the mailbox of a slave
 * @mb: zeroed structure whose immutable members are set
 *
 * Context: Any.
 */
void ec_mbox_init(struct ec_mbox *mb)
{
	struct ec_desk *desk = &mb->desk;

	ec_box_init(&mb->box, &ec_desk_ops);
	INIT_WORK(&desk->unasked, ec_mbox_unasked);
	INIT_LIST_HEAD(&desk->queue);
	INIT_LIST_HEAD(&desk->users);
	INIT_LIST_HEAD(&desk->claims);
	INIT_LIST_HEAD(&desk->holders);
	spin_lock_init(&desk->unasked_lock);
	raw_spin_lock_init(&desk->last_lock);
	INIT_LIST_HEAD(&desk->kept);
}

/**
 * ec_mbox_exit() - the slave is being freed
 * @mb: mailbox without users
 *
 * Context: Process. Waits for the datagram that may be in flight.
 */
void ec_mbox_exit(struct ec_mbox *mb)
{
	ec_box_stop(&mb->box);
	cancel_work_sync(&mb->desk.unasked);
	ec_mbox_keep_voe(mb, false);
	ec_box_free(&mb->box);
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
	const struct ec_sii_mbox *area = boot ? &mb->box.sii->boot : &mb->box.sii->std;
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
 * For the reply a smaller mailbox is sufficient: it has to hold EC_MBOX_REPLY bytes of @message.
 *
 * Context: Process.
 * Return: 0; -EPROTONOSUPPORT when the slave does not have it; -EAGAIN in BOOT, unless it is
 * FoE; -EMSGSIZE for a mailbox that is too small or larger than a datagram.
 */
int ec_mbox_check(const struct ec_mbox *mb, u16 protocol, size_t message)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);

	if (!ec_mbox_present(mb) || !(mb->box.sii->protocols & protocol))
		return -EPROTONOSUPPORT;
	/* BOOT is for files only */
	if (area != &mb->box.sii->std && protocol != EC_SII_PROTO_FOE)
		return -EAGAIN;
	/* the EEPROM may contain any size; a message is one datagram */
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

static int answer(struct ec_mbox *mb, const struct ec_mbox_request *r,
		  const struct ec_mbox_user *u)
{
	if (u->err)
		return u->err;
	if (u->got_type == EC_MBOX_ERR)
		return ec_mbox_error_reply(mb, u->rx, u->got);
	return r->rx(r->ctx, u->rx, u->got);
}

/* Exchange a request for its answer, within the time limit. */
static int mailbox_exchange(struct ec_mbox *mb, const struct ec_mbox_request *r,
			    const struct ec_mbox_limit *limit, struct ec_caller *c)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	int ret, end;

	for (;;) {
		ret = ec_caller_wait(mb, c, limit, &until) ?: answer(mb, r, &c->user);
		if (ret != EC_WAIT && ret != EC_STALE)
			return ret;
		c->user.heard = true;
		if (ret == EC_WAIT)
			until = ec_mbox_until(&r->limit);
		/* also a slave that sends messages without end has to answer in time */
		end = ec_mbox_over(mb, &until);
		if (end)
			return end;
		ec_desk_wait_on(mb, &c->user);
	}
}

/* The slave has the request, and its reply is late: a patient caller waits, others check once. */
static int mailbox_go_on(struct ec_mbox *mb, const struct ec_mbox_request *r,
			 struct ec_caller *c)
{
	struct ec_mbox_limit more = r->limit;
	int ret;

	more.timeout_ms = r->limit.patient ? EC_MBOX_LATE_MS : 0;
	if (r->limit.patient)
		ec_mbox_warn(mb, "no reply within %u ms to a request that the slave has accepted; waiting %u s more\n",
			      r->limit.timeout_ms, EC_MBOX_LATE_MS / 1000);
	ret = mailbox_exchange(mb, r, &more, c);
	if (ret == -ETIMEDOUT && !r->limit.patient)
		ec_mbox_mark_late(mb, &c->user);
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
	struct ec_caller c = { .user = {
		.type = r->type, .answer = true, .first = r->first, .tx = b->tx, .len = len,
		.rx = b->rx,
	} };
	int ret = ec_box_get_memory(&mb->box) ?: ec_mbox_over(mb, &now);

	lockdep_assert(ec_mbox_is_claimed(mb, BIT(r->type)));
	if (!ret && r->late && r->first)
		ret = ec_mbox_await_late(mb, r, b);
	if (ret)
		return ret;
	ec_caller_enter(mb, &c);
	ret = mailbox_exchange(mb, r, &r->limit, &c);
	if (ret == -ETIMEDOUT && r->late && ec_mbox_is_late(mb, &c.user))
		ret = mailbox_go_on(mb, r, &c);
	ec_desk_leave(mb, &c.user, ret >= 0);
	return ret == -ETIMEDOUT && (c.user.lost || c.user.gap) ? -ENOTRECOVERABLE : ret;
}

static int mailbox_give(struct ec_mbox *mb, struct ec_caller *c, const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	int ret;

	ec_caller_enter(mb, c);
	ret = ec_caller_wait(mb, c, limit, &until) ?: c->user.err;
	ec_desk_leave(mb, &c->user, false);
	return ret == -ETIMEDOUT && c->user.lost ? -ENOTRECOVERABLE : ret;
}

/**
 * ec_mbox_send() - send one message that has no answer
 * @mb: mailbox that ec_mbox_check() has accepted
 * @type: enum ec_mbox_type
 * @b: message in @tx
 * @len: bytes of the message
 * @limit: time limits
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, -EAGAIN in INIT, -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED; -ENOTRECOVERABLE when
 * its frame was lost, so that the slave may have it or not; -ENOMEM; or as ec_xfer().
 */
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	struct ec_caller c = { .user = { .type = type, .tx = b->tx, .len = len } };
	int ret = ec_box_get_memory(&mb->box) ?: ec_mbox_over(mb, &until);

	return ret ?: mailbox_give(mb, &c, limit);
}

/**
 * ec_mbox_send_part() - send a message of a request that only its last message has an answer to
 * @mb: mailbox that ec_mbox_check() has accepted
 * @r: request; its protocol is claimed
 * @b: message in @tx; before the first one, replies to earlier requests may use @rx
 * @len: bytes of the message
 *
 * Context: Process. Waits for bus traffic.
 * Return: as ec_mbox_send().
 */
int ec_mbox_send_part(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		      size_t len)
{
	struct ec_mbox_until until = ec_mbox_until(&r->limit);
	struct ec_caller c = { .user = {
		.type = r->type, .first = r->first, .tx = b->tx, .len = len,
	} };
	int ret = ec_box_get_memory(&mb->box) ?: ec_mbox_over(mb, &until);

	lockdep_assert(ec_mbox_is_claimed(mb, BIT(r->type)));
	if (!ret && r->late && r->first)
		ret = ec_mbox_await_late(mb, r, b);
	return ret ?: mailbox_give(mb, &c, &r->limit);
}

/**
 * ec_mbox_send_last() - try to send a message that ends a transfer at the slave
 * @mb: mailbox that ec_mbox_check() has accepted
 * @type: enum ec_mbox_type
 * @b: message in @tx
 * @len: bytes of the message
 *
 * Also for a caller that was killed, so it only waits for the mailbox, 75 ms at most.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_mbox_send_last(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len)
{
	struct ec_caller c = { .user = { .type = type, .tx = b->tx, .len = len } };
	u64 until = ktime_get_ns() + LAST_NS;
	ktime_t at = ns_to_ktime(until);

	if (ec_box_get_memory(&mb->box))
		return;
	ec_caller_enter(mb, &c);
	while (!ec_stop_all(mb->stop) && ktime_get_ns() < until) {
		set_current_state(TASK_UNINTERRUPTIBLE);
		if (READ_ONCE(c.user.phase) == EC_MBOX_USER_DONE)
			break;
		schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
	}
	__set_current_state(TASK_RUNNING);
	ec_desk_leave(mb, &c.user, false);
}

/**
 * ec_mbox_forget() - empty the mailbox for a new application
 * @mb: mailbox of a slave with mailbox, in PREOP
 *
 * Messages that the slave has sent before, emergencies and VoE as well, are not for the new
 * application. Answers that a caller waits for are delivered.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -ENOMEM; -ECANCELED; -EBUSY when it cannot be emptied; -EMSGSIZE when it is
 * larger than a datagram; or as ec_xfer().
 */
int ec_mbox_forget(struct ec_mbox *mb)
{
	const struct ec_mbox_limit limit = { .timeout_ms = 10000 };
	struct ec_mbox_until until = ec_mbox_until(&limit);
	struct ec_caller c = { .user = { .discard = true } };
	int ret = ec_box_get_memory(&mb->box);

	if (ret)
		return ret;
	ec_caller_enter(mb, &c);
	ret = ec_caller_wait(mb, &c, &limit, &until) ?: c.user.err;
	ec_desk_leave(mb, &c.user, false);
	ec_mbox_flush_kept(mb);
	return ret;
}

/**
 * ec_mbox_wait_voe() - wait for a VoE message
 * @mb: mailbox that ec_mbox_check() has accepted
 * @b: the message is in @rx
 * @blind: one access to the mailbox without a poll of its status
 * @limit: time limits; @timeout_ms 0: no wait
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
	struct ec_caller c = { .user = { .type = EC_MBOX_VOE, .once = blind, .rx = b->rx } };
	int ret = ec_box_get_memory(&mb->box) ?: ec_mbox_take_kept(mb, b->rx), kept;

	if (ret != -ENOMSG)
		return ret;
	ec_caller_enter(mb, &c);
	do {
		if (ec_box_is_off(&mb->box))
			ret = -EAGAIN;
		else
			ret = ec_mbox_over(mb, &until);
		/* pairs with desk_finish(): the result is complete */
		if (smp_load_acquire(&c.user.phase) == EC_MBOX_USER_DONE) {
			ret = c.user.err ?: c.user.got_type == EC_MBOX_ERR ?
			      ec_mbox_error_reply(mb, b->rx, c.user.got) : c.user.got;
			break;
		}
		kept = ec_mbox_take_kept(mb, b->rx);
		if (kept != -ENOMSG) {
			ret = kept;
			break;
		}
		if (!ret)
			ec_mbox_sleep(mb, &c.user.phase, EC_MBOX_USER_DONE, &until);
	} while (!ret);
	ec_desk_leave(mb, &c.user, false);
	if (ret != -ENOMSG && ret != -ETIMEDOUT)
		return ret;
	/* one may have been received before this caller entered */
	kept = ec_mbox_take_kept(mb, b->rx);
	return kept != -ENOMSG ? kept : blind ? -ENOMSG : ret;
}
