// SPDX-License-Identifier: GPL-2.0-only
/*
 * The two mailboxes of a slave: a machine that gives messages to the slave and reads those of
 * the slave. It advances when its datagram is back, in the context that receives, so with a
 * cycle its next datagram leaves with the send of the same cycle. It has one datagram on its way
 * at most, and none while there is nothing to do.
 *
 * A slave with the repeat mechanism (EEPROM, general category) drops a message whose counter is
 * that of the one before, and puts its own last message into SM1 again when it is asked to. So
 * with it no lost frame loses a message or doubles it.
 */
#include <linux/ktime.h>
#include "../link/links.h"
#include "../wire/al.h"
#include "../wire/fmmu.h"
#include "../wire/regs.h"
#include "mailbox_int.h"

#define ACK_POLLS	50	/* of a repeat request */
#define ACK_NS		(300 * NSEC_PER_USEC)	/* between them */
#define UNSEEN_NS	(5 * NSEC_PER_MSEC)	/* for one that the slave cannot acknowledge */
#define POLL_SLACK_NS	(20 * NSEC_PER_USEC)	/* free in a cycle that carries polls at will */
#define SHORT_NS	(200 * NSEC_PER_USEC)	/* most slaves reply within that time */
#define PAUSE_MIN_NS	(10 * NSEC_PER_USEC)
#define PAUSE_MAX_NS	(5 * NSEC_PER_MSEC)

/**
 * ec_mbox_off() - is the slave in a state without mailbox?
 * @mb: mailbox of the slave
 *
 * Context: Any. RT-safe.
 * Return: whether it is in INIT.
 */
bool ec_mbox_off(const struct ec_mbox *mb)
{
	return (READ_ONCE(*mb->al_status) & EC_AL_STATE_MASK) < EC_AL_PREOP;
}

/* sending -------------------------------------------------------------------*/

static void post(struct ec_mbox *mb, enum ec_mbox_step step, u8 cmd, u16 ado, void *data, u16 len,
		 bool repeat)
{
	lockdep_assert_held(&mb->lock);
	WRITE_ONCE(mb->step, step);
	mb->dg = EC_DG(cmd, mb->station, ado, len, data);
	mb->dg.repeat = repeat;
	ec_post_send(&mb->post, mb->due_ns);
}

/*
 * A piece of a mailbox. What does not fit beside the process data of a short cycle goes in
 * pieces: the first byte opens the mailbox, the last byte hands it over (ETG.1000.4 clause
 * 6.7.2). That one must not happen twice.
 */
static void post_piece(struct ec_mbox *mb, enum ec_mbox_step step, u16 offset, u8 *box)
{
	u16 n = min_t(u16, mb->size - mb->at, ec_access_room(mb->links));

	post(mb, step, step == EC_MBOX_READ ? EC_CMD_FPRD : EC_CMD_FPWR, offset + mb->at,
	     box + mb->at, n, mb->at + n < mb->size);
}

static void read_on(struct ec_mbox *mb)
{
	post_piece(mb, EC_MBOX_READ, ec_mbox_area(mb)->tx_offset, mb->rx);
}

static void write_on(struct ec_mbox *mb)
{
	post_piece(mb, EC_MBOX_WRITE, ec_mbox_area(mb)->rx_offset, mb->tx);
}

static void post_status(struct ec_mbox *mb)
{
	post(mb, EC_MBOX_STATUS, EC_CMD_FPRD, EC_REG_SM(1) + EC_SM_OFS_STATUS, mb->status, 1, true);
}

static void post_repeat(struct ec_mbox *mb, enum ec_mbox_step step)
{
	bool set = step == EC_MBOX_REPEAT_SET;

	post(mb, step, set ? EC_CMD_FPWR : EC_CMD_FPRD, EC_REG_SM(1) + EC_SM_OFS_ACTIVATE,
	     mb->status, set ? 1 : 2, true);
}

/* Something has happened: the next access is made at once. */
static void box_progress(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	mb->since_ns = ktime_get_ns();
	mb->due_ns = 0;
}

/*
 * A slow slave is polled ever less often: at most an eighth of the time it has taken so far
 * passes until the master sees its reply, or a millisecond. The polls of a cycle are rare enough,
 * where there is wire time for them.
 */
static void pause(struct ec_mbox *mb)
{
	u64 now = ktime_get_ns(), took = now - mb->since_ns, ns = took / 8;

	lockdep_assert_held(&mb->lock);
	if (!ec_access_is_cyclic(&mb->links->access) ||
	    ec_access_slack_ns(mb->links) < POLL_SLACK_NS)
		ns = max(ns, took < SHORT_NS ? took / 4 : min_t(u64, took, NSEC_PER_MSEC));
	mb->due_ns = now + clamp_t(u64, ns, PAUSE_MIN_NS, PAUSE_MAX_NS);
}

/* Most slaves take as long as last time: the first poll is not long before that. */
static void expect_reply(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	if (!ec_access_is_cyclic(&mb->links->access))
		mb->due_ns = mb->since_ns + min_t(u64, mb->took_ns / 4 * 3, SHORT_NS / 2);
}

static void on_message(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	mb->took_ns = ktime_get_ns() - mb->since_ns;
	mb->due_ns = 0;
}

/*
 * Beside a cycle each look takes a period. Where the mailbox has room on the wire it is
 * read at once: an empty one gives nothing.
 */
static bool read_at_once(const struct ec_mbox *mb)
{
	u32 slack = ec_access_slack_ns(mb->links);
	u32 ns = ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD +
				  ec_mbox_area(mb)->tx_size);

	return mb->counts && slack != ~0u &&
	       ec_links_acyclic_ns(mb->links) + ns <= slack / 2;
}

static void begin_read(struct ec_mbox *mb)
{
	u16 size = ec_mbox_area(mb)->tx_size;

	if (size > mb->rx_room || size < EC_MBOX_HDR) {
		ec_mbox_fail(mb, -EMSGSIZE);
		return;
	}
	mb->size = size;
	mb->at = 0;
	read_on(mb);
}

/* The message in @sending, as it is in SM0: the mailbox changes with the state. */
static bool begin_write(struct ec_mbox *mb)
{
	u16 size = ec_mbox_area(mb)->rx_size;

	if (size > mb->tx_room || mb->sending.len + EC_MBOX_HDR > size) {
		mb->sending.on = false;
		ec_mbox_finish(mb, mb->sending.user, -EMSGSIZE);
		return false;
	}
	memset(mb->tx + EC_MBOX_HDR + mb->sending.len, 0, size - EC_MBOX_HDR - mb->sending.len);
	mb->size = size;
	mb->at = 0;
	write_on(mb);
	return true;
}

static void renew(struct ec_mbox *mb)
{
	mb->renew = false;
	mb->counter = 0;
	mb->seen = 0;
	mb->in_order = 0;
	mb->counts = false;
	mb->gap = false;
	mb->unread = false;
	mb->asked = false;
	mb->repeats = false;
	mb->answered = false;
	mb->late = 0;
	mb->never_late = false;
}

/* The user whose message is the next one; NULL: none. */
static struct ec_mbox_user *next_user(struct ec_mbox *mb)
{
	struct ec_mbox_user *u;

	lockdep_assert_held(&mb->lock);
	while ((u = list_first_entry_or_null(&mb->queue, struct ec_mbox_user, list))) {
		list_move_tail(&u->list, &mb->users);
		u->phase = EC_MBOX_USER_SENDING;
		/* a slave that only passes INIT is waited for: its worker claims the mailbox */
		if (ec_mbox_off(mb))
			ec_mbox_finish(mb, u, -EAGAIN);
		else if (u->len + EC_MBOX_HDR > mb->tx_room && !u->discard)
			ec_mbox_finish(mb, u, -EMSGSIZE);
		else
			break;
	}
	return u;
}

/* The next message of the queue. */
static void take_message(struct ec_mbox *mb)
{
	struct ec_mbox_user *u = mb->sending.on ? NULL : next_user(mb);
	struct ec_mbox_hdr h;
	struct ec_wbuf w;

	lockdep_assert_held(&mb->lock);
	if (!u)
		return;
	mb->sending = (struct ec_mbox_sending){
		.on = true, .user = u, .type = u->type, .len = u->len, .discard = u->discard,
		.emptying = u->discard || (u->first && !mb->answered),
	};
	box_progress(mb);
	if (u->discard)
		return;
	mb->counter = ec_mbox_next_counter(mb->counter);
	mb->sending.counter = mb->counter;
	mb->answered = false;
	h = (struct ec_mbox_hdr){ .len = u->len, .type = u->type, .counter = mb->counter };
	w = ec_wbuf(mb->tx, EC_MBOX_HDR + u->len);
	ec_mbox_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, u->tx, u->len);
}

/* One datagram; false: the message does not fit, and there may be another. */
static bool send_step(struct ec_mbox *mb)
{
	struct ec_mbox_sending *s = &mb->sending;
	bool read;

	lockdep_assert_held(&mb->lock);
	if (READ_ONCE(mb->renew) && !s->on)
		renew(mb);
	take_message(mb);
	read = !mb->held && ((s->on && (s->emptying || s->blocked)) || ec_mbox_awaited(mb));
	if (read && mb->gap && mb->can_repeat && !mb->failed)
		post_repeat(mb, EC_MBOX_REPEAT_GET);
	else if (s->on && !s->emptying && !s->blocked)
		return begin_write(mb);
	else if (read && !ec_mbox_is_blind(mb) && (mb->unread || s->on || !read_at_once(mb)))
		post_status(mb);
	else if (read)
		begin_read(mb);
	return true;
}

/**
 * ec_mbox_go() - send the next datagram, if there is anything to do
 * @mb: mailbox of the slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_go(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	if (mb->step != EC_MBOX_REST || mb->dead || !mb->rx || mb->claimed == EC_MBOX_ALL)
		return;
	while (!send_step(mb))
		;
}

/**
 * ec_mbox_hurry() - there is more to do: the next poll that waits for its time must not delay it
 * @mb: mailbox of the slave, its lock held; ec_mbox_go() follows
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_hurry(struct ec_mbox *mb)
{
	lockdep_assert_held(&mb->lock);
	if ((mb->step == EC_MBOX_STATUS || (mb->step == EC_MBOX_READ && !mb->at)) &&
	    ec_post_recall(&mb->post))
		WRITE_ONCE(mb->step, EC_MBOX_REST);
}

/* results -------------------------------------------------------------------*/

/*
 * The frame that read a mailbox is lost. Was it read? It is full if not, or if the slave has
 * put in the next one by now: then only a repetition shows which.
 */
static void read_lost(struct ec_mbox *mb)
{
	mb->gap = true;
	mb->unread = !mb->can_repeat;
	ec_mbox_mark_gap(mb);
	ec_mbox_finish_once(mb);
}

static void on_status(struct ec_mbox *mb, int ret)
{
	bool full = mb->status[0] & EC_SM_ST_FULL;

	mb->failed = false;
	if (ret == -ETIMEDOUT && !mb->sending.emptying) {
		pause(mb);
		return;
	}
	if (ret) {
		ec_mbox_fail(mb, ret);
		return;
	}
	if (mb->unread) {
		mb->unread = false;
		mb->gap = false;
	}
	if (full) {
		on_message(mb);
		begin_read(mb);
		return;
	}
	pause(mb);
	ec_mbox_found_empty(mb);
}

static void on_read(struct ec_mbox *mb, int ret)
{
	mb->failed = false;
	if (!ret) {
		mb->at += mb->dg.len;
		if (mb->at < mb->size) {
			read_on(mb);
			return;
		}
		box_progress(mb);
		mb->sending.blocked = false;
		mb->rx_size = mb->size;
		ec_mbox_received(mb);
		return;
	}
	pause(mb);
	if (ret == -EIO) {
		ec_mbox_found_empty(mb);
		return;
	}
	/* also when the link is down: it may have been read */
	read_lost(mb);
	if (ret != -ETIMEDOUT)
		ec_mbox_fail(mb, ret);
}

/* It is in SM0, or may be and must not be sent again. */
static void sent(struct ec_mbox *mb)
{
	struct ec_mbox_user *u = mb->sending.user;

	lockdep_assert_held(&mb->lock);
	mb->sending.on = false;
	box_progress(mb);
	/* its answer may have come before */
	if (!u || u->phase != EC_MBOX_USER_SENDING)
		return;
	u->lost |= mb->sending.lost;
	if (u->answer) {
		u->phase = EC_MBOX_USER_WAITING;
		expect_reply(mb);
	} else {
		ec_mbox_finish(mb, u, u->lost ? -ENOTRECOVERABLE : 0);
	}
}

static void on_written(struct ec_mbox *mb, int ret)
{
	struct ec_mbox_sending *s = &mb->sending;

	/* its answer has come before */
	if (!s->on)
		return;
	if (!ret) {
		mb->at += mb->dg.len;
		if (mb->at < mb->size) {
			write_on(mb);
			return;
		}
		s->lost = false;
		sent(mb);
	} else if (ret == -ETIMEDOUT) {
		/* it may have it: with repetition it gets it again, until it has it */
		s->lost = true;
		if (!mb->can_repeat || !s->user)
			sent(mb);
	} else if (ret == -EIO) {
		/* full, until its own message is read */
		s->blocked = true;
		s->on = s->user;
		pause(mb);
	} else {
		ec_mbox_fail(mb, ret);
	}
}

/*
 * Let the slave put its last message into SM1 again (ETG.1000.4 clause 6.7.3, registers
 * 0x080E, 0x080F). A request that is written once more after a lost frame is no second one.
 */
static void on_repeat(struct ec_mbox *mb)
{
	u8 *b = mb->status;

	if (!mb->asked) {
		mb->asked = true;
		mb->want = !(b[0] & EC_SM_ACT_REPEAT);
		/* left from before INIT: the slave cannot show that it has done it */
		mb->unseen = !!(b[1] & EC_SM_PDI_REPEAT_ACK) == mb->want;
	}
	b[0] &= ~EC_SM_ACT_REPEAT;
	if (mb->want)
		b[0] |= EC_SM_ACT_REPEAT;
	mb->acks = 0;
	post_repeat(mb, EC_MBOX_REPEAT_SET);
}

static void no_repetition(struct ec_mbox *mb, bool silent)
{
	mb->failed = true;
	mb->due_ns = 0;
	if (!silent || ++mb->ack_fails < EC_MBOX_ACK_FAILS)
		return;
	mb->can_repeat = false;
	mb->gap = false;
	if (mb->sending.on && mb->sending.lost)
		sent(mb);
	/* for the log */
	queue_work(system_highpri_wq, &mb->unasked);
}

static void on_ack(struct ec_mbox *mb)
{
	if (!!(mb->status[1] & EC_SM_PDI_REPEAT_ACK) == mb->want) {
		mb->gap = false;
		mb->asked = false;
		mb->repeats = true;
		mb->ack_fails = 0;
		mb->due_ns = 0;
	} else if (++mb->acks < ACK_POLLS) {
		mb->due_ns = ktime_get_ns() + ACK_NS;
		post_repeat(mb, EC_MBOX_REPEAT_ACK);
	} else {
		no_repetition(mb, true);
	}
}

/* It has not left: the same again, which may be shorter now. */
static void again(struct ec_mbox *mb, enum ec_mbox_step step)
{
	if (step == EC_MBOX_READ)
		read_on(mb);
	else if (step == EC_MBOX_WRITE && mb->sending.on)
		write_on(mb);
	else if (step >= EC_MBOX_REPEAT_GET)
		post_repeat(mb, step);
}

static void on_step(struct ec_mbox *mb, enum ec_mbox_step step, int ret)
{
	if (ret == -EAGAIN) {
		again(mb, step);
		return;
	}
	switch (step) {
	case EC_MBOX_STATUS:
		on_status(mb, ret);
		break;
	case EC_MBOX_READ:
		on_read(mb, ret);
		break;
	case EC_MBOX_WRITE:
		on_written(mb, ret);
		break;
	case EC_MBOX_REPEAT_GET:
	case EC_MBOX_REPEAT_SET:
	case EC_MBOX_REPEAT_ACK:
		if (ret) {
			no_repetition(mb, false);
		} else if (step == EC_MBOX_REPEAT_GET) {
			on_repeat(mb);
		} else if (step == EC_MBOX_REPEAT_SET) {
			mb->due_ns = mb->unseen ? ktime_get_ns() + UNSEEN_NS : 0;
			post_repeat(mb, EC_MBOX_REPEAT_ACK);
		} else {
			on_ack(mb);
		}
		break;
	case EC_MBOX_REST:
		break;
	}
}

/**
 * ec_mbox_done() - the datagram of a mailbox is back, or lost
 * @post: in the mailbox
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_done(struct ec_post *post)
{
	struct ec_mbox *mb = container_of(post, struct ec_mbox, post);
	enum ec_mbox_step step;
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->lock, flags);
	step = mb->step;
	WRITE_ONCE(mb->step, EC_MBOX_REST);
	if (!mb->dead)
		on_step(mb, step, mb->dg.err ?: mb->dg.wkc == 1 ? 0 : -EIO);
	ec_mbox_go(mb);
	raw_spin_unlock_irqrestore(&mb->lock, flags);
}
