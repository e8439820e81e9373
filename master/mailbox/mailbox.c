// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/sched/signal.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../link/xfer.h"
#include "../wire/al.h"
#include "../wire/coe.h"
#include "../wire/fmmu.h"
#include "../wire/mbox.h"
#include "../wire/regs.h"
#include "emerg.h"
#include "mailbox.h"

#define DRAIN	16	/* messages at most that no transfer expects */
#define LAST_TRIES	50	/* one a millisecond */

/* a message that waits for its reader */
struct kept {
	struct list_head list;
	u16 len;
	u8 data[];
};

/* when a waiting caller has to give up */
struct until {
	u64 ns;
	const bool *cancel;
};

static struct until until_limit(const struct ec_mbox_limit *l)
{
	return (struct until){ ktime_get_ns() + (u64)l->timeout_ms * NSEC_PER_MSEC, l->cancel };
}

/**
 * ec_mbox_init() - prepare the mailbox of a slave
 * @mb: zeroed structure whose immutable members are set
 *
 * Context: Any.
 */
void ec_mbox_init(struct ec_mbox *mb)
{
	sema_init(&mb->sdo_lock, 1);
	sema_init(&mb->lock, 1);
	init_waitqueue_head(&mb->turn);
	spin_lock_init(&mb->unasked_lock);
	INIT_LIST_HEAD(&mb->kept);
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

/* A semaphore has no owner: what can be checked is that there is a holder. */
static void assert_locked(const struct ec_mbox *mb)
{
	lockdep_assert(!READ_ONCE(mb->lock.count));
}

/* For each holder of the lock, before it uses the mailbox. */
static void renew(struct ec_mbox *mb)
{
	assert_locked(mb);
	if (!READ_ONCE(mb->renew))
		return;
	WRITE_ONCE(mb->renew, false);
	mb->counter = 0;
	mb->counts = false;
	mb->answered = false;
}

/**
 * ec_mbox_sms() - SyncManager pages of a mailbox
 * @area: standard or bootstrap mailbox
 * @page: result, SM0 and SM1, 2 * EC_SM_PAGE bytes
 *
 * Context: Any.
 * Return: bytes of @page, 0 without mailbox.
 */
unsigned int ec_mbox_sms(const struct ec_sii_mbox *area, u8 *page)
{
	struct ec_sm out = { .start = area->rx_offset, .len = area->rx_size, .control = 0x26,
			     .activate = EC_SM_ACT_ENABLE };
	struct ec_sm in = { .start = area->tx_offset, .len = area->tx_size, .control = 0x22,
			    .activate = EC_SM_ACT_ENABLE };

	if (!area->rx_size || !area->tx_size)
		return 0;
	ec_sm_encode(&out, page);
	ec_sm_encode(&in, page + EC_SM_PAGE);
	return 2 * EC_SM_PAGE;
}

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

/* Why an exchange has to end now; 0: go on. */
static int over(const struct ec_mbox *mb, const struct until *u)
{
	if (ec_stop_all(mb->stop) || ec_stop_interrupted(mb->stop) ||
	    (u->cancel && READ_ONCE(*u->cancel)))
		return -ECANCELED;
	if (signal_pending(current))
		return -EINTR;
	return ktime_get_ns() > u->ns ? -ETIMEDOUT : 0;
}

/* Short waits first: most slaves answer within a few hundred microseconds. */
static void pause_us(unsigned int *us)
{
	usleep_range(*us, *us + *us / 4 + 1);
	*us = min(*us * 2, 1000u);
}

/*
 * A slow slave is polled ever less often: at most an eighth of the time it has taken so far
 * passes until the master sees its reply.
 */
static void pause_longer(unsigned int *us)
{
	unsigned int next = *us < 1000 ? *us * 2 : min(*us + *us / 8, 5000u);

	usleep_range(*us, *us + *us / 8 + 1);
	*us = next;
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

static int full(struct ec_mbox *mb)
{
	u8 status;
	int ret = ec_xfer_fprd(mb->links, mb->station, EC_REG_SM(1) + EC_SM_OFS_STATUS,
			       &status, 1);

	return ret ? ret : !!(status & EC_SM_ST_FULL);
}

/*
 * The frame that fetched a message is lost, and with it the message: let the
 * slave put it there again (ETG.1000.4 clause 6.7.3, registers 0x080E, 0x080F).
 */
static int repeat_request(struct ec_mbox *mb)
{
	u16 ado = EC_REG_SM(1) + EC_SM_OFS_ACTIVATE;
	unsigned int i;
	u8 b[2];
	int ret = ec_xfer_fprd(mb->links, mb->station, ado, b, 2);

	if (ret)
		return ret;
	b[0] ^= EC_SM_ACT_REPEAT;
	ret = ec_xfer_fpwr(mb->links, mb->station, ado, b, 1);
	for (i = 0; i < 50 && !ret; i++) {
		ret = ec_xfer_fprd(mb->links, mb->station, ado, b, 2);
		if (!ret && !(b[0] & EC_SM_ACT_REPEAT) == !(b[1] & EC_SM_PDI_REPEAT_ACK))
			return 0;
		usleep_range(200, 400);
	}
	return ret ?: -ETIMEDOUT;
}

/*
 * When a slave has repeated its last message although nothing was lost, the counter shows
 * that the message is not a new one; only for slaves that count their messages.
 */
static bool is_known(struct ec_mbox *mb, u8 counter)
{
	bool again = mb->repeats && mb->counts && counter == mb->seen;

	assert_locked(mb);
	mb->repeats = false;
	if (again)
		return true;
	mb->counts = counter && mb->seen && counter != mb->seen;
	mb->seen = counter;
	return false;
}

/*
 * Beside a cycle each look takes one or two of its periods. Where the mailbox has room on
 * the wire it is read at once: an empty one gives nothing.
 */
static bool read_at_once(const struct ec_mbox *mb)
{
	u32 slack = ec_access_slack_ns(mb->links);
	u32 ns = ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD +
				  ec_mbox_area(mb)->tx_size);

	return mb->counts && slack != ~0u &&
	       ec_links_acyclic_ns(mb->links) + ns <= slack / 2;
}

/*
 * Take one message out of the slave's mailbox: bytes behind the header, or 0:
 * empty. @blind: without a look whether there is one.
 */
static int fetch(struct ec_mbox *mb, struct ec_mbox_buf *b, struct ec_mbox_hdr *h, bool blind)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);
	u16 size = area->tx_size;
	struct ec_rbuf r;
	int ret;

	assert_locked(mb);
	if (size > EC_MBOX_MAX)
		return -EMSGSIZE;
	ret = blind ? 1 : full(mb);
	if (ret <= 0)
		return ret;
	ret = once(mb, EC_CMD_FPRD, area->tx_offset, b->raw, size);
	if (ret == -ETIMEDOUT && !full(mb)) {
		repeat_request(mb);
		mb->repeats = true;
	}
	if (ret)
		return ret == -EIO || ret == -ETIMEDOUT ? 0 : ret;
	r = ec_rbuf(b->raw, size);
	if (ec_mbox_hdr_decode(&r, h))
		return -EBADMSG;
	if (is_known(mb, h->counter))
		return 0;
	memcpy(b->rx, r.p, h->len);
	return h->len;
}

static bool emergency(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_coe_emergency e;

	if (h->type != EC_MBOX_COE || ec_coe_emergency_decode(rx, h->len, &e))
		return false;
	ec_mbox_warn(mb, "CoE emergency: code 0x%04x, error register 0x%02x\n", e.code,
		      e.reg);
	ec_emerg_push(mb, rx + EC_COE_HDR);
	return true;
}

static void flush(struct ec_mbox *mb, unsigned int left)
{
	lockdep_assert_held(&mb->unasked_lock);
	while (mb->n_kept > left) {
		struct kept *k = list_first_entry(&mb->kept, struct kept, list);

		list_del(&k->list);
		mb->n_kept--;
		kfree(k);
	}
}

/* Keep a VoE message for its reader; of too many the oldest are dropped. */
static void keep(struct ec_mbox *mb, const u8 *rx, u16 len)
{
	struct kept *k;

	if (!READ_ONCE(mb->keep_voe))
		return;
	k = kmalloc(struct_size(k, data, len), GFP_KERNEL);
	if (!k)
		return;
	k->len = len;
	memcpy(k->data, rx, len);
	spin_lock(&mb->unasked_lock);
	if (mb->keep_voe && mb->n_kept == EC_MBOX_KEPT)
		ec_mbox_warn(mb, "VoE buffer full, %u message(s) not read; the oldest is dropped\n",
			      EC_MBOX_KEPT);
	flush(mb, EC_MBOX_KEPT - 1);
	list_add_tail(&k->list, &mb->kept);
	mb->n_kept++;
	if (!mb->keep_voe)
		flush(mb, 0);
	spin_unlock(&mb->unasked_lock);
}

/**
 * ec_mbox_keep_voe() - are there readers of VoE messages?
 * @mb: mailbox of the slave
 * @on: keep those that arrive while another caller uses the mailbox; false: drop
 *	them, and those that are kept
 *
 * Context: Process.
 */
void ec_mbox_keep_voe(struct ec_mbox *mb, bool on)
{
	spin_lock(&mb->unasked_lock);
	WRITE_ONCE(mb->keep_voe, on);
	if (!on)
		flush(mb, 0);
	spin_unlock(&mb->unasked_lock);
}

/* The oldest kept message to @rx: its length; -ENOMSG: there is none. */
static int take_kept(struct ec_mbox *mb, u8 *rx)
{
	struct kept *k;
	int len;

	spin_lock(&mb->unasked_lock);
	k = list_first_entry_or_null(&mb->kept, struct kept, list);
	if (k) {
		list_del(&k->list);
		mb->n_kept--;
	}
	spin_unlock(&mb->unasked_lock);
	if (!k)
		return -ENOMSG;
	len = k->len;
	memcpy(rx, k->data, len);
	kfree(k);
	return len;
}

/* Keep a message without a request. True: it was one. */
static bool unasked(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	if (h->type == EC_MBOX_VOE) {
		keep(mb, rx, h->len);
		return true;
	}
	return emergency(mb, h, rx);
}

static int error_reply(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_rbuf r = ec_rbuf(rx, h->len);
	u16 detail;

	if (ec_mbox_error_decode(&r, &detail))
		return -EBADMSG;
	ec_mbox_warn(mb, "mailbox error reply 0x%04x (%s)\n", detail, ec_mbox_error_text(detail));
	return ec_mbox_error_errno(detail);
}

/**
 * ec_mbox_drain() - empty the mailbox of messages that no caller waits for
 * @mb: mailbox of a slave with mailbox, @lock held
 * @b: buffers
 *
 * Emergencies and VoE messages are kept, replies to earlier requests are discarded.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0 or as ec_xfer().
 */
int ec_mbox_drain(struct ec_mbox *mb, struct ec_mbox_buf *b)
{
	struct ec_mbox_hdr h;
	unsigned int i;
	int ret = 1;

	assert_locked(mb);
	for (i = 0; i < DRAIN && ret; i++) {
		ret = fetch(mb, b, &h, false);
		if (ret < 0 && ret != -EBADMSG)
			return ret;
		if (ret > 0)
			unasked(mb, &h, b->rx);
	}
	return 0;
}

/* Read the mailbox until it is empty; -EBUSY: the slave fills it without end. */
static int discard_all(struct ec_mbox *mb, struct ec_mbox_buf *b)
{
	struct ec_mbox_hdr h;
	unsigned int i;
	int ret;

	for (i = 0; i < DRAIN; i++) {
		ret = full(mb);
		if (ret <= 0)
			return ret;
		ret = fetch(mb, b, &h, true);
		if (ret < 0 && ret != -EBADMSG)
			return ret;
	}
	return -EBUSY;
}

/**
 * ec_mbox_forget() - empty the mailbox for a new application
 * @mb: mailbox of a slave with mailbox, in PREOP
 *
 * What the slave has sent before, emergencies and VoE messages too, is none of it.
 *
 * Context: The slave's worker. Waits for bus traffic.
 * Return: 0; -ENOMEM; -ECANCELED; -EBUSY when it cannot be emptied; -EMSGSIZE when it is
 * larger than a datagram; or as ec_xfer().
 */
int ec_mbox_forget(struct ec_mbox *mb)
{
	struct ec_mbox_buf *b = kmalloc(sizeof(*b), GFP_KERNEL);
	int ret;

	if (!b)
		return -ENOMEM;
	ret = ec_mbox_lock(mb, &mb->lock, 0);
	if (ret)
		goto out;
	renew(mb);
	ret = discard_all(mb, b);
	mb->answered = !ret;
	spin_lock(&mb->unasked_lock);
	flush(mb, 0);
	spin_unlock(&mb->unasked_lock);
	up(&mb->lock);
out:
	kfree(b);
	return ret;
}

static void encode(struct ec_mbox_buf *b, const struct ec_mbox_hdr *h, u16 size)
{
	struct ec_wbuf w = ec_wbuf(b->raw, size);

	ec_mbox_hdr_encode(&w, h);
	ec_wbuf_bytes(&w, b->tx, h->len);
	ec_wbuf_zero(&w, w.end - w.p);
}

/*
 * A full mailbox (working counter 0) is tried again; the slave may wait until its own
 * message is read. A lost frame is not: the message may have arrived, and the answer shows that.
 */
static int send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		const struct until *until)
{
	const struct ec_sii_mbox *area = ec_mbox_area(mb);
	u16 size = area->rx_size;
	struct ec_mbox_hdr h = { .len = len, .type = type };
	unsigned int us = 50;
	int ret;

	assert_locked(mb);
	if (size > EC_MBOX_MAX || len + EC_MBOX_HDR > size)
		return -EMSGSIZE;
	mb->counter = ec_mbox_next_counter(mb->counter);
	h.counter = mb->counter;
	for (;;) {
		encode(b, &h, size);
		ret = once(mb, EC_CMD_FPWR, area->rx_offset, b->raw, size);
		if (ret != -EIO)
			return ret == -ETIMEDOUT ? 0 : ret;
		ret = over(mb, until) ?: ec_mbox_drain(mb, b);
		if (ret)
			return ret;
		pause_us(&us);
	}
}

/*
 * Wait for a message of one protocol: bytes behind the mailbox header; or
 * -errno, also that of a mailbox error reply. Messages without a request are kept;
 * answers of other protocols are late and discarded, since a requester holds the lock.
 */
static int recv(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, const struct until *until)
{
	struct ec_mbox_hdr h;
	unsigned int us = 20;
	int ret;

	for (;;) {
		ret = fetch(mb, b, &h, read_at_once(mb));
		if (ret < 0 && ret != -ETIMEDOUT)
			return ret;
		if (ret > 0) {
			if (h.type == EC_MBOX_ERR)
				return error_reply(mb, &h, b->rx);
			if (!unasked(mb, &h, b->rx) && h.type == type)
				return ret;
			us = 20;
		}
		/* also a slave that sends messages without end has to answer in time */
		ret = over(mb, until);
		if (ret)
			return ret;
		pause_longer(&us);
	}
}

/**
 * ec_mbox_check() - can this protocol be used with the slave, in PREOP or above?
 * @mb: mailbox of the slave
 * @protocol: EC_SII_PROTO_*
 * @message: bytes behind the mailbox header it needs at least
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

/* In INIT there is no mailbox. The lock is held: a slave that only passes INIT is waited for. */
static int off(const struct ec_mbox *mb)
{
	assert_locked(mb);
	return (READ_ONCE(*mb->al_status) & EC_AL_STATE_MASK) < EC_AL_PREOP ? -EAGAIN : 0;
}

/**
 * ec_mbox_request() - send one message, wait for the answer
 * @mb: mailbox that ec_mbox_check() has accepted
 * @r: request
 * @b: message in @tx, the answer will be in @rx
 * @len: bytes of the message
 *
 * The mailbox is locked meanwhile. Emergencies and VoE messages that arrive before the
 * answer are kept.
 *
 * Context: Process. Waits for bus traffic.
 * Return: the last value of @r->rx; -EAGAIN in INIT; -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED;
 * -EBADMSG for a message whose header is wrong; the errno of a mailbox error
 * reply; or as ec_xfer().
 */
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len)
{
	struct until until;
	int ret = ec_mbox_lock(mb, &mb->lock, 0);

	if (ret)
		return ret;
	renew(mb);
	ret = off(mb);
	/* after an answer nothing of an earlier exchange can come any more */
	if (!ret && r->first && !mb->answered)
		ret = ec_mbox_drain(mb, b);
	mb->answered = false;
	until = until_limit(&r->limit);
	/* also where a slave always has a message ready */
	ret = ret ?: over(mb, &until);
	if (!ret)
		ret = send(mb, r->type, b, len, &until);
	if (ret)
		goto out;
	do {
		ret = recv(mb, r->type, b, &until);
		if (ret >= 0)
			ret = r->rx(r->ctx, b->rx, ret);
		if (ret == EC_WAIT)
			until = until_limit(&r->limit);
		if (ret == EC_WAIT || ret == EC_STALE)
			ret = over(mb, &until) ?: ret;
	} while (ret == EC_WAIT || ret == EC_STALE);
	mb->answered = ret >= 0;
out:
	up(&mb->lock);
	return ret;
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
 * Return: 0, -EAGAIN in INIT, -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED, or as
 * ec_xfer().
 */
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit)
{
	struct until until = until_limit(limit);
	int ret = ec_mbox_lock(mb, &mb->lock, 0);

	if (ret)
		return ret;
	renew(mb);
	ret = over(mb, &until) ?: off(mb) ?: send(mb, type, b, len, &until);
	up(&mb->lock);
	return ret;
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
	unsigned int i;

	for (i = 0; i < LAST_TRIES && !ec_stop_all(mb->stop); i++) {
		if (!down_trylock(&mb->lock)) {
			struct until now = { .ns = 0 };
			int ret;

			renew(mb);
			/* over after the first attempt */
			ret = off(mb) ?: send(mb, type, b, len, &now);
			/* it may be full until its own message is read */
			if (ret == -ETIMEDOUT || ret == -EINTR)
				ec_mbox_drain(mb, b);
			up(&mb->lock);
			if (ret != -ETIMEDOUT && ret != -EINTR)
				return;
		}
		usleep_range(1000, 1500);
	}
}

/* Poll for a VoE message with the lock held: its length, or -ENOMSG, or -errno. */
static int poll_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind)
{
	struct ec_mbox_hdr h;
	int ret = take_kept(mb, b->rx);

	assert_locked(mb);
	if (ret != -ENOMSG)
		return ret;
	ret = fetch(mb, b, &h, blind);
	if (ret == -ETIMEDOUT || !ret)
		return -ENOMSG;
	if (ret < 0 || h.type == EC_MBOX_VOE)
		return ret;
	if (h.type == EC_MBOX_ERR)
		return error_reply(mb, &h, b->rx);
	unasked(mb, &h, b->rx);
	return -ENOMSG;
}

/**
 * ec_mbox_wait_voe() - wait for a VoE message
 * @mb: mailbox that ec_mbox_check() has accepted
 * @b: the message is in @rx
 * @blind: one access to the mailbox without a look whether it is full, no wait
 * @limit: when to give up; @timeout_ms 0: no wait
 *
 * The message may have arrived earlier, during the exchange of another caller. Others can
 * use the mailbox meanwhile.
 *
 * Context: Process. Waits for bus traffic.
 * Return: bytes behind the mailbox header; -ENOMSG, when @blind and there is
 * none; -ETIMEDOUT, -EINTR, -ECANCELED; -EBADMSG; the errno of a mailbox error
 * reply; -EAGAIN in INIT; or as ec_xfer().
 */
int ec_mbox_wait_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind,
		     const struct ec_mbox_limit *limit)
{
	struct until until = until_limit(limit);
	unsigned int us = 20;
	int ret, end;

	for (;;) {
		ret = take_kept(mb, b->rx);
		/* another holder of the lock keeps our messages */
		if (ret == -ENOMSG && !down_trylock(&mb->lock)) {
			renew(mb);
			ret = off(mb) ?: poll_voe(mb, b, blind);
			up(&mb->lock);
		}
		if (ret != -ENOMSG || blind)
			return ret;
		end = over(mb, &until);
		if (end)
			return end;
		pause_us(&us);
	}
}

/**
 * ec_mbox_poll() - fetch emergencies and VoE messages that no transfer expects
 * @mb: mailbox of the slave
 *
 * Nothing to do while another caller uses the mailbox: its exchange fetches them as well.
 *
 * Context: Process. Waits for bus traffic.
 */
void ec_mbox_poll(struct ec_mbox *mb)
{
	struct ec_mbox_buf *b;

	if (!ec_mbox_present(mb) || ec_stop_all(mb->stop) || down_trylock(&mb->lock))
		return;
	renew(mb);
	b = off(mb) ? NULL : kmalloc(sizeof(*b), GFP_KERNEL);
	if (b)
		ec_mbox_drain(mb, b);
	kfree(b);
	up(&mb->lock);
}
