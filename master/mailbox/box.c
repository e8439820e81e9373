// SPDX-License-Identifier: GPL-2.0-only
/*
 * The mailbox transport of a slave: it writes messages to the slave and reads those of the slave.
 * It advances when its datagram is received, in the context that receives, so with a cycle its
 * next datagram leaves with the send of the same cycle. With nothing but frames of EoE it advances
 * in that send, behind the process data. It has at most one datagram in flight, and none while
 * there is nothing to do.
 *
 * A slave with the repeat mechanism (EEPROM, general category) drops a message whose counter is
 * that of the one before, and puts its own last message into SM1 again on request. So with it no
 * lost frame loses a message or doubles it.
 */
#include <linux/ktime.h>
#include "../kernel/trace.h"
#include "../link/links.h"
#include "../wire/fmmu.h"
#include "../wire/regs.h"
#include "box.h"
#include "box_repeat.h"
#include "box_state.h"
#include "mail_tap.h"

#define AWAY_NS	(20 * NSEC_PER_MSEC)	/* a slave that does not reply for longer has failed */

/* states --------------------------------------------------------------------*/

/* SM1 was read or is empty, so it does not keep the slave from emptying SM0. */
static void unblock(struct ec_box *box)
{
	if (box->job == EC_BOX_BLOCKED)
		ec_box_set_job(box, EC_BOX_WRITING);
}

static bool is_emptying(const struct ec_box *box)
{
	return box->job == EC_BOX_EMPTYING || box->job == EC_BOX_DISCARDING;
}

static void end_emptying(struct ec_box *box, int err)
{
	if (box->job == EC_BOX_DISCARDING)
		ec_box_end_job(box, err);
	else
		ec_box_set_job(box, EC_BOX_WRITING);
}

/* Begin to read SM1, or REST if it does not fit: its size changes with the state of the slave. */
static enum ec_box_step begin_read(struct ec_box *box)
{
	u16 size = ec_box_area(box)->tx_size;

	if (size > box->rx_room || size < EC_MBOX_HDR) {
		ec_box_fail(box, -EMSGSIZE);
		return EC_BOX_REST;
	}
	box->size = size;
	box->at = 0;
	return EC_BOX_READ;
}

/* Fill @tx up to the size of SM0; false: SM0 is too small for the message. */
static bool begin_write(struct ec_box *box)
{
	u16 size = ec_box_area(box)->rx_size;

	lockdep_assert_held(&box->lock);
	if (size > box->tx_room || box->tx_len > size)
		return false;
	memset(box->tx + box->tx_len, 0, size - box->tx_len);
	box->size = size;
	box->at = 0;
	return true;
}

static void renew(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	box->renew = false;
	box->counter = 0;
	box->seen = 0;
	box->in_order = 0;
	box->counts = false;
	ec_box_set_gap(box, EC_BOX_WHOLE);
	box->asked = false;
	box->repeats = false;
	box->ops->event(box, EC_BOX_ON_RENEWED, 0);
}

static void begin_job(struct ec_box *box, enum ec_box_job job)
{
	ec_box_set_job(box, job);
	box->doubtful = false;
	box->orphan = false;
	box->drained = 0;
	ec_box_progress(box);
}

/**
 * ec_box_give() - begin a job with a message for the slave
 * @box: mailbox of a slave without a job, its lock held
 * @type: enum ec_mbox_type
 * @data: message behind the mailbox header
 * @len: bytes of it, with the header at most @box->tx_room
 * @emptying: first read SM1 until it is empty
 *
 * Context: Only struct ec_box_ops.next. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_give(struct ec_box *box, u8 type, const u8 *data, u16 len, bool emptying)
{
	struct ec_mbox_hdr h = { .len = len, .type = type };
	struct ec_wbuf w = ec_wbuf(box->tx, EC_MBOX_HDR + len);

	lockdep_assert_held(&box->lock);
	begin_job(box, emptying ? EC_BOX_EMPTYING : EC_BOX_WRITING);
	box->counter = ec_mbox_next_counter(box->counter);
	box->tx_len = EC_MBOX_HDR + len;
	h.counter = box->counter;
	ec_mbox_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, data, len);
}

/**
 * ec_box_discard() - begin a job that discards what the slave has sent so far
 * @box: mailbox of a slave without a job, its lock held
 *
 * Context: Only struct ec_box_ops.next. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_discard(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	begin_job(box, EC_BOX_DISCARDING);
}

/**
 * ec_box_take_back() - the job is not wanted any more
 * @box: mailbox of a slave, its lock held
 *
 * A datagram in flight is still awaited.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: true: a frame with its message was lost, so the slave may have it.
 */
bool ec_box_take_back(struct ec_box *box)
{
	bool doubtful = ec_box_is_doubtful(box);

	lockdep_assert_held(&box->lock);
	if (box->step == EC_BOX_WRITE)
		box->orphan = true;
	else
		ec_box_set_job(box, EC_BOX_NO_JOB);
	return doubtful;
}

/**
 * ec_box_arrived() - the answer to the message of the job has come
 * @box: mailbox of a slave, its lock held
 *
 * So the slave has the message, even if its frame was lost.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_arrived(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	ec_box_set_job(box, EC_BOX_NO_JOB);
}

/* Does the job wait until SM1 is empty? */
static bool must_be_known_empty(const struct ec_box *box)
{
	return is_emptying(box) || box->job == EC_BOX_BLOCKED;
}

static enum ec_box_step box_choose(struct ec_box *box)
{
	enum ec_box_want want;
	bool read;

	for (;;) {
		if (READ_ONCE(box->renew) && box->job == EC_BOX_NO_JOB)
			renew(box);
		if (box->job == EC_BOX_NO_JOB)
			box->ops->next(box);
		want = box->ops->want(box);
		read = !box->held && (is_emptying(box) || box->job == EC_BOX_BLOCKED ||
				      want != EC_BOX_NOTHING);
		if (read && box->gap == EC_BOX_GAP)
			return EC_BOX_REPEAT_GET;
		if (box->job != EC_BOX_WRITING || (read && want == EC_BOX_FIRST))
			break;
		if (begin_write(box))
			return EC_BOX_WRITE;
		ec_box_end_job(box, -EMSGSIZE);
	}
	if (!read)
		return EC_BOX_REST;
	if (want != EC_BOX_BLIND && (box->gap == EC_BOX_UNREAD || must_be_known_empty(box) ||
				     !ec_box_reads_at_once(box)))
		return EC_BOX_STATUS;
	return begin_read(box);
}

/**
 * ec_box_go() - send the next datagram, if there is anything to do
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any, but no call of struct ec_box_ops. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_go(struct ec_box *box)
{
	enum ec_box_step step;

	lockdep_assert_held(&box->lock);
	if (box->step != EC_BOX_REST || box->dead || !box->rx || box->closed)
		return;
	step = box_choose(box);
	box->post.patient = box->ops->streams(box);
	ec_box_post(box, step);
}

/**
 * ec_box_hurry() - withdraw a poll that is not due, so that it does not delay other steps
 * @box: mailbox of a slave, its lock held; ec_box_go() follows
 *
 * Context: Any, but no call of struct ec_box_ops. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_hurry(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	if ((box->step == EC_BOX_STATUS || (box->step == EC_BOX_READ && !box->at)) &&
	    ec_post_recall(&box->post))
		ec_box_post(box, EC_BOX_REST);
}

/* messages of the slave -----------------------------------------------------*/

/**
 * ec_box_message() - the message of the slave in @rx
 * @box: mailbox of a slave whose message stays: with its lock, or until it is dropped
 * @h: result: its header
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: 0; -EBADMSG when the header is wrong.
 */
int ec_box_message(const struct ec_box *box, struct ec_mbox_hdr *h)
{
	struct ec_rbuf r = ec_rbuf(box->rx, box->rx_size);

	return ec_mbox_hdr_decode(&r, h);
}

/**
 * ec_box_drop() - the message of the slave in @rx is not needed any more
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any; ec_box_go() follows, but not in a call of struct ec_box_ops. RT-safe: bounded, no
 * sleep, no allocation.
 */
void ec_box_drop(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	box->held = false;
}

static void trace_message(const struct ec_box *box, bool to_slave, const struct ec_mbox_hdr *h)
{
	trace_ec_mailbox(box->links->base->index, box->station, to_slave, h->type, h->counter,
			 h->len);
}

/* For the readers of messages, if there are any. */
static void show_message(const struct ec_box *box, u32 flags, const u8 *bytes, u16 size)
{
	if (ec_mail_tap_wanted(box->links->base))
		ec_mail_tap_put(box->links->base, box->station, flags, bytes, size);
}

/* SM1 was read: its content is in @rx. */
static void box_received(struct ec_box *box)
{
	struct ec_mbox_hdr h;

	lockdep_assert_held(&box->lock);
	if (box->gap == EC_BOX_UNREAD)
		ec_box_set_gap(box, EC_BOX_WHOLE);
	if (ec_box_message(box, &h)) {
		show_message(box, EC_MAIL_MALFORMED, box->rx, box->rx_size);
		box->ops->event(box, EC_BOX_ON_MALFORMED, 0);
	} else if (ec_box_is_known(box, h.counter)) {
		box->ops->event(box, EC_BOX_ON_REPEATED, 0);
	} else {
		box->held = true;
		trace_message(box, false, &h);
		show_message(box, 0, box->rx, EC_MBOX_HDR + h.len);
		box->ops->event(box, EC_BOX_ON_RECEIVED, 0);
	}
	if (is_emptying(box) && ++box->drained >= EC_BOX_DRAIN)
		end_emptying(box, -EBUSY);
	box->ops->event(box, EC_BOX_ON_NOTHING, 0);
}

/* SM1 has no message. The next access to it can wait, but not a message that can be written. */
static void found_empty(struct ec_box *box)
{
	if (box->job != EC_BOX_WRITING)
		ec_box_pause(box);
	unblock(box);
	box->ops->event(box, EC_BOX_ON_NOTHING, 0);
	/* the slave has to repeat what a lost frame has carried */
	if (box->gap == EC_BOX_GAP)
		return;
	box->ops->event(box, EC_BOX_ON_EMPTY, 0);
	if (!is_emptying(box))
		return;
	box->ops->event(box, EC_BOX_ON_EMPTIED, 0);
	end_emptying(box, 0);
}

/* results: each returns the next step, REST: what there is to do ------------*/

/* A trial that met an event may have given the slave another address, for some cycles. */
static bool is_back_soon(struct ec_box *box)
{
	u64 cycles_ns = 8 * NSEC_PER_USEC * ec_access_interval_us(&box->links->access);
	u64 now = ktime_get_ns();

	box->away_ns = box->away_ns ?: now;
	return now - box->away_ns < max_t(u64, AWAY_NS, cycles_ns);
}

static enum ec_box_step on_status(struct ec_box *box, int ret)
{
	ec_box_looked(box);
	if ((ret == -ETIMEDOUT && !is_emptying(box)) || (ret == -EIO && is_back_soon(box))) {
		ec_box_pause(box);
		return EC_BOX_REST;
	}
	if (ret) {
		ec_box_fail(box, ret);
		return EC_BOX_REST;
	}
	if (box->gap == EC_BOX_UNREAD)
		ec_box_set_gap(box, EC_BOX_WHOLE);
	if (box->status[0] & EC_SM_ST_FULL) {
		box->took_ns = ktime_get_ns() - box->since_ns;
		box->due_ns = 0;
		return begin_read(box);
	}
	found_empty(box);
	return EC_BOX_REST;
}

/*
 * The frame that read SM1 is lost. A full SM1 was not read, or has the next message by now: only
 * a repetition shows which.
 */
static void read_lost(struct ec_box *box)
{
	ec_box_set_gap(box, box->can_repeat ? EC_BOX_GAP : EC_BOX_UNREAD);
	box->ops->event(box, EC_BOX_ON_GAP, 0);
	box->ops->event(box, EC_BOX_ON_NOTHING, 0);
}

static enum ec_box_step on_read(struct ec_box *box, int ret)
{
	ec_box_looked(box);
	if (!ret) {
		box->at += box->dg.len;
		if (box->at < box->size)
			return EC_BOX_READ;
		ec_box_progress(box);
		unblock(box);
		box->rx_size = box->size;
		box_received(box);
		return EC_BOX_REST;
	}
	if (ret == -EIO) {
		found_empty(box);
		return EC_BOX_REST;
	}
	ec_box_pause(box);
	/* also when the link is down: it may have been read */
	read_lost(box);
	if (ret != -ETIMEDOUT)
		ec_box_fail(box, ret);
	return EC_BOX_REST;
}

static void trace_written(const struct ec_box *box)
{
	struct ec_rbuf r = ec_rbuf(box->tx, box->tx_len);
	struct ec_mbox_hdr h;

	if (trace_ec_mailbox_enabled() && !ec_mbox_hdr_decode(&r, &h))
		trace_message(box, true, &h);
}

static enum ec_box_step on_written(struct ec_box *box, int ret)
{
	/* its answer was received before */
	if (box->job == EC_BOX_NO_JOB)
		return EC_BOX_REST;
	if (!ret) {
		box->at += box->dg.len;
		if (box->at < box->size)
			return EC_BOX_WRITE;
		box->doubtful = false;
		trace_written(box);
		show_message(box, EC_MAIL_TO_SLAVE, box->tx, box->tx_len);
		ec_box_written(box);
	} else if (ret == -ETIMEDOUT) {
		/* the slave may have it; if it can repeat, it drops a second one: send it again */
		box->doubtful = true;
		if (!box->can_repeat || box->orphan) {
			show_message(box, EC_MAIL_TO_SLAVE | EC_MAIL_UNSURE, box->tx, box->tx_len);
			ec_box_written(box);
		}
	} else if (ret == -EIO) {
		/* SM0 is full, until the message of the slave is read */
		ec_box_set_job(box, box->orphan ? EC_BOX_NO_JOB : EC_BOX_BLOCKED);
		ec_box_pause(box);
	} else {
		ec_box_fail(box, ret);
	}
	return EC_BOX_REST;
}

/* The datagram was not sent: the same step again, perhaps with a shorter piece. */
static enum ec_box_step again(const struct ec_box *box)
{
	bool over = box->step == EC_BOX_STATUS ||
		    (box->step == EC_BOX_WRITE && box->job == EC_BOX_NO_JOB);

	return over ? EC_BOX_REST : box->step;
}

static enum ec_box_step on_step(struct ec_box *box, int ret)
{
	if (box->dead)
		return EC_BOX_REST;
	if (ret == -EAGAIN)
		return again(box);
	switch (box->step) {
	case EC_BOX_STATUS:
		return on_status(box, ret);
	case EC_BOX_READ:
		return on_read(box, ret);
	case EC_BOX_WRITE:
		return on_written(box, ret);
	case EC_BOX_REST:
		return EC_BOX_REST;
	default:
		return ec_box_on_repeat(box, ret);
	}
}

/* The datagram is received, or lost. */
static void box_done(struct ec_post *post)
{
	struct ec_box *box = container_of(post, struct ec_box, post);
	unsigned long flags;

	raw_spin_lock_irqsave(&box->lock, flags);
	if (!box->dg.err && box->dg.wkc == 1)
		box->away_ns = 0;
	ec_box_post(box, on_step(box, box->dg.err ?: box->dg.wkc == 1 ? 0 : -EIO));
	ec_box_go(box);
	raw_spin_unlock_irqrestore(&box->lock, flags);
}

/**
 * ec_box_init() - prepare the mailbox transport
 * @box: zeroed structure whose immutable members are set
 * @ops: calls
 *
 * Context: Any.
 */
void ec_box_init(struct ec_box *box, const struct ec_box_ops *ops)
{
	box->ops = ops;
	raw_spin_lock_init(&box->lock);
	ec_post_init(&box->post, box->links, box_done);
	box->post.dg = &box->dg;
	box->post.n = 1;
}
