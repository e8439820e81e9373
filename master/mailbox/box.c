// SPDX-License-Identifier: GPL-2.0-only
/*
 * The two mailboxes of a slave: who may use them, one message in, one message out.
 *
 * A slave with the repeat mechanism (EEPROM, general category) drops a message whose counter is
 * that of the one before, and puts its own last message into SM1 again when it is asked to. So
 * with it no lost frame loses a message or doubles it.
 */
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include "../link/links.h"
#include "../link/xfer.h"
#include "../wire/al.h"
#include "../wire/fmmu.h"
#include "../wire/regs.h"
#include "mailbox_int.h"

#define ACK_POLLS	50	/* of a repeat request */
#define UNSEEN_US	5000	/* for a repetition that the slave cannot acknowledge */
#define ACK_FAILS	3	/* repeat requests without acknowledgement */

/**
 * ec_mbox_lock() - wait for one's turn
 * @mb: mailbox of the slave
 * @lock: its @sdo_lock or @lock
 * @ms: the slave's worker waits at most so long; 0: as long as it takes
 *
 * Callers that come later than the worker let it in first, so that steady callers do not
 * keep it off.
 *
 * Context: Process. May sleep.
 * Return: 0; -EINTR; the slave's worker: -ECANCELED when it shall leave, -ETIMEDOUT.
 */
int ec_mbox_lock(struct ec_mbox *mb, struct semaphore *lock, u32 ms)
{
	u64 until = ktime_get_ns() + (u64)ms * NSEC_PER_MSEC;
	int ret = 0;

	if (READ_ONCE(mb->stop->worker) != current) {
		ret = wait_event_interruptible(mb->turn, READ_ONCE(mb->awaits) != lock);
		return ret ? -EINTR : down_interruptible(lock);
	}
	WRITE_ONCE(mb->awaits, lock);
	while (!ret && down_timeout(lock, msecs_to_jiffies(20))) {
		if (ec_stop_interrupted(mb->stop))
			ret = -ECANCELED;
		else if (ms && ktime_get_ns() > until)
			ret = -ETIMEDOUT;
	}
	WRITE_ONCE(mb->awaits, NULL);
	wake_up_all(&mb->turn);
	return ret;
}

/**
 * ec_mbox_begin() - a new holder of the lock begins
 * @mb: mailbox of the slave, @lock held
 *
 * Context: Process.
 */
void ec_mbox_begin(struct ec_mbox *mb)
{
	ec_mbox_assert_locked(mb);
	/* what a slave without repetition has lost is of no use to the next */
	mb->gap &= mb->can_repeat;
	if (!READ_ONCE(mb->renew))
		return;
	WRITE_ONCE(mb->renew, false);
	mb->counter = 0;
	mb->seen = 0;
	mb->counts = false;
	mb->gap = false;
	mb->asked = false;
	mb->repeats = false;
	mb->answered = false;
}

/**
 * ec_mbox_off() - is the slave in a state without mailbox?
 * @mb: mailbox of the slave, @lock held: a slave that only passes INIT is waited for
 *
 * Context: Process.
 * Return: 0, or -EAGAIN in INIT.
 */
int ec_mbox_off(const struct ec_mbox *mb)
{
	ec_mbox_assert_locked(mb);
	return (READ_ONCE(*mb->al_status) & EC_AL_STATE_MASK) < EC_AL_PREOP ? -EAGAIN : 0;
}

/**
 * ec_mbox_over() - why an exchange has to end now
 * @mb: mailbox of the slave
 * @u: when it has to, anyway
 *
 * Context: Process.
 * Return: 0: go on; -ECANCELED, -EINTR, -ETIMEDOUT.
 */
int ec_mbox_over(const struct ec_mbox *mb, const struct ec_mbox_until *u)
{
	if (ec_stop_all(mb->stop) || ec_stop_interrupted(mb->stop) ||
	    (u->cancel && READ_ONCE(*u->cancel)))
		return -ECANCELED;
	if (signal_pending(current))
		return -EINTR;
	return ktime_get_ns() > u->ns ? -ETIMEDOUT : 0;
}

/*
 * One access to a mailbox: 0, or -EIO when the slave took no part. What does not
 * fit beside the process data of a short cycle goes in pieces: the first byte
 * opens the mailbox, the last byte hands it over (ETG.1000.4 clause 6.7.2).
 * That one must not happen twice.
 */
static int once(struct ec_mbox *mb, u8 cmd, u16 ado, void *data, u16 len)
{
	u16 room = ec_access_room(mb->links), at, n;

	for (at = 0; at < len; at += n) {
		struct ec_dg dg;
		int ret;

		n = min_t(u16, len - at, room);
		dg = EC_DG(cmd, mb->station, ado + at, n, data + at);
		dg.repeat = at + n < len;
		ret = ec_xfer(mb->links, &dg, 1);
		if (ret || dg.wkc != 1)
			return ret ?: -EIO;
	}
	return 0;
}

/**
 * ec_mbox_full() - does the slave have a message for the master?
 * @mb: mailbox of the slave
 *
 * Context: Process. Waits for bus traffic.
 * Return: 1 or 0; -EIO when the slave takes no part, or as ec_xfer().
 */
int ec_mbox_full(struct ec_mbox *mb)
{
	u8 status;
	int ret = ec_xfer_fprd(mb->links, mb->station, EC_REG_SM(1) + EC_SM_OFS_STATUS,
			       &status, 1);

	return ret ? ret : !!(status & EC_SM_ST_FULL);
}

/* Wait until the slave has acknowledged a repeat request. */
static int acknowledged(struct ec_mbox *mb, u16 ado)
{
	unsigned int i;
	int ret = 0;
	u8 b[2];

	for (i = 0; i < ACK_POLLS && !ret; i++) {
		ret = ec_xfer_fprd(mb->links, mb->station, ado, b, 2);
		if (!ret && !!(b[1] & EC_SM_PDI_REPEAT_ACK) == mb->want)
			return 0;
		usleep_range(200, 400);
	}
	return ret ?: -ETIME;
}

/*
 * Let the slave put its last message into SM1 again (ETG.1000.4 clause 6.7.3, registers
 * 0x080E, 0x080F). A request that is written once more after a lost frame is no second one.
 */
static int repeat_request(struct ec_mbox *mb)
{
	u16 ado = EC_REG_SM(1) + EC_SM_OFS_ACTIVATE;
	u8 b[2];
	int ret = ec_xfer_fprd(mb->links, mb->station, ado, b, 2);

	ec_mbox_assert_locked(mb);
	if (ret)
		return ret;
	if (!mb->asked) {
		mb->asked = true;
		mb->want = !(b[0] & EC_SM_ACT_REPEAT);
		/* left from before INIT: the slave cannot show that it has done it */
		mb->unseen = !!(b[1] & EC_SM_PDI_REPEAT_ACK) == mb->want;
	}
	b[0] &= ~EC_SM_ACT_REPEAT;
	if (mb->want)
		b[0] |= EC_SM_ACT_REPEAT;
	ret = ec_xfer_fpwr(mb->links, mb->station, ado, b, 1);
	if (!ret && mb->unseen)
		usleep_range(UNSEEN_US, UNSEEN_US + 500);
	return ret ?: acknowledged(mb, ado);
}

/* A message may be lost: get it again, if the slave can do that. */
static void close_gap(struct ec_mbox *mb)
{
	int ret;

	ec_mbox_assert_locked(mb);
	if (!mb->gap || !mb->can_repeat)
		return;
	ret = repeat_request(mb);
	if (!ret) {
		mb->gap = false;
		mb->asked = false;
		mb->repeats = true;
		mb->ack_fails = 0;
	} else if (ret == -ETIME && ++mb->ack_fails == ACK_FAILS) {
		mb->can_repeat = false;
		ec_mbox_warn(mb, "does not repeat mailbox messages, although its EEPROM has that flag; what a lost frame loses is lost\n");
	}
}

/*
 * When a slave has repeated its last message although nothing was lost, the counter shows
 * that the message is not a new one.
 */
static bool is_known(struct ec_mbox *mb, u8 counter)
{
	bool again = mb->repeats && counter && counter == mb->seen;

	ec_mbox_assert_locked(mb);
	mb->repeats = false;
	if (again)
		return true;
	mb->counts = counter && mb->seen && counter != mb->seen;
	mb->seen = counter;
	return false;
}

/*
 * The frame that read a mailbox is lost. Was it read? It is full if not, or if the slave has
 * put in the next one by now: then only a repetition shows which.
 */
static int read_lost(struct ec_mbox *mb)
{
	int ret;

	ec_mbox_assert_locked(mb);
	mb->gap = true;
	ret = mb->can_repeat ? 0 : ec_mbox_full(mb);
	if (ret == 1)
		mb->gap = false;
	return ret < 0 ? ret : 0;
}

/**
 * ec_mbox_fetch() - take one message out of the slave's mailbox
 * @mb: mailbox of the slave, @lock held
 * @b: buffers; the message will be in @rx
 * @h: its header
 * @blind: without a look whether there is one
 *
 * Context: Process. Waits for bus traffic.
 * Return: bytes behind the header; 0: none, for now; -EBADMSG for a header that is wrong;
 * -EMSGSIZE for a mailbox larger than a datagram; or as ec_xfer().
 */
int ec_mbox_fetch(struct ec_mbox *mb, struct ec_mbox_buf *b, struct ec_mbox_hdr *h, bool blind)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);
	u16 size = area->tx_size;
	struct ec_rbuf r;
	int ret;

	ec_mbox_assert_locked(mb);
	if (size > EC_MBOX_MAX)
		return -EMSGSIZE;
	close_gap(mb);
	ret = blind ? 1 : ec_mbox_full(mb);
	if (ret <= 0)
		return ret;
	ret = once(mb, EC_CMD_FPRD, area->tx_offset, b->raw, size);
	if (ret == -ETIMEDOUT)
		return read_lost(mb);
	if (ret)
		return ret == -EIO ? 0 : ret;
	r = ec_rbuf(b->raw, size);
	if (ec_mbox_hdr_decode(&r, h))
		return -EBADMSG;
	if (is_known(mb, h->counter))
		return 0;
	memcpy(b->rx, r.p, h->len);
	return h->len;
}

static void encode(struct ec_mbox_buf *b, const struct ec_mbox_message *m, u16 size)
{
	struct ec_mbox_hdr h = { .len = m->len, .type = m->type, .counter = m->counter };
	struct ec_wbuf w = ec_wbuf(b->raw, size);

	ec_mbox_hdr_encode(&w, &h);
	ec_wbuf_bytes(&w, b->tx, m->len);
	ec_wbuf_zero(&w, w.end - w.p);
}

/**
 * ec_mbox_message() - a new message to the slave
 * @mb: mailbox of the slave, @lock held
 * @m: result
 * @type: enum ec_mbox_type
 * @len: bytes behind the header
 *
 * Context: Process.
 * Return: 0, -EMSGSIZE when it does not fit, or the mailbox not into a datagram.
 */
int ec_mbox_message(struct ec_mbox *mb, struct ec_mbox_message *m, u8 type, size_t len)
{
	u16 size = ec_mbox_area(mb)->rx_size;

	ec_mbox_assert_locked(mb);
	if (size > EC_MBOX_MAX || len + EC_MBOX_HDR > size)
		return -EMSGSIZE;
	mb->counter = ec_mbox_next_counter(mb->counter);
	*m = (struct ec_mbox_message){ .type = type, .counter = mb->counter, .len = len };
	return 0;
}

/**
 * ec_mbox_put() - try to give a message to the slave
 * @mb: mailbox of the slave, @lock held
 * @m: message; @m->sent when there is nothing more to do
 * @b: buffers; the message is in @tx
 *
 * A full mailbox is no error. After a lost frame a slave with repetition gets the message
 * again, until it has it; another one may have it already.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0, or as ec_xfer().
 */
int ec_mbox_put(struct ec_mbox *mb, struct ec_mbox_message *m, struct ec_mbox_buf *b)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);
	int ret;

	ec_mbox_assert_locked(mb);
	/* the slave has turned out not to repeat */
	if (m->lost && !mb->can_repeat) {
		m->sent = true;
		return 0;
	}
	/* the mailbox changes with the state */
	if (m->len + EC_MBOX_HDR > area->rx_size || area->rx_size > EC_MBOX_MAX)
		return -EMSGSIZE;
	encode(b, m, area->rx_size);
	ret = once(mb, EC_CMD_FPWR, area->rx_offset, b->raw, area->rx_size);
	if (!ret) {
		m->sent = true;
		m->lost = false;
	} else if (ret == -ETIMEDOUT) {
		m->lost = true;
		m->sent = !mb->can_repeat;
	}
	return ret == -EIO || ret == -ETIMEDOUT ? 0 : ret;
}

/**
 * ec_mbox_error_reply() - the errno of a mailbox error reply, which is logged
 * @mb: mailbox of the slave
 * @h: header of the message
 * @rx: message behind the header
 *
 * Context: Process.
 * Return: -errno.
 */
int ec_mbox_error_reply(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_rbuf r = ec_rbuf(rx, h->len);
	u16 detail;

	if (ec_mbox_error_decode(&r, &detail))
		return -EBADMSG;
	ec_mbox_warn(mb, "mailbox error reply 0x%04x (%s)\n", detail, ec_mbox_error_text(detail));
	return ec_mbox_error_errno(detail);
}
