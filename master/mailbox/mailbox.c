// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "../link/links.h"
#include "../wire/fmmu.h"
#include "mailbox_int.h"

#define LAST_TRIES	50	/* one a millisecond */

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
 * Give a message that has no answer to the slave, which may wait until its own message is
 * read.
 */
static int send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		const struct ec_mbox_until *until)
{
	struct ec_mbox_message m = { .lost = false };
	unsigned int us = 50;
	int ret = ec_mbox_message(mb, &m, type, len);

	while (!ret) {
		ret = ec_mbox_put(mb, &m, b);
		if (ret || m.sent)
			break;
		ret = ec_mbox_over(mb, until) ?: ec_mbox_drain(mb, b);
		ec_mbox_pause(&us);
	}
	return (!ret || ret == -ETIMEDOUT) && m.lost ? -ENOTRECOVERABLE : ret;
}

/*
 * Take in one message of the slave, the answer or not: what @r->rx returns; -ENOMSG: there is
 * none; EC_STALE: it is for another reader. Answers of other protocols are late and discarded,
 * since a requester holds the lock.
 */
static int take(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		const struct ec_mbox_message *m)
{
	bool expected = m->sent || m->lost;
	struct ec_mbox_hdr h;
	int ret = ec_mbox_fetch(mb, b, &h, m->sent && read_at_once(mb));

	if (!ret || ret == -ETIMEDOUT)
		return -ENOMSG;
	/* no answer comes before the request has arrived */
	if (ret == -EBADMSG && !expected)
		return EC_STALE;
	if (ret < 0)
		return ret;
	if (expected && h.type == EC_MBOX_ERR)
		return ec_mbox_error_reply(mb, &h, b->rx);
	if (ec_mbox_unasked(mb, &h, b->rx) || !expected || h.type != r->type)
		return EC_STALE;
	return r->rx(r->ctx, b->rx, ret);
}

/* Has a frame been lost, with a request or an answer that was in it? */
static bool unknown(const struct ec_mbox *mb, const struct ec_mbox_message *m)
{
	ec_mbox_assert_locked(mb);
	return m->lost || mb->gap;
}

/* The request, until its answer is here or it is too late. */
static int exchange(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    struct ec_mbox_message *m)
{
	struct ec_mbox_until until = ec_mbox_until(&r->limit);
	unsigned int us = 20;

	for (;;) {
		int ret = 0, end;

		if (!m->sent) {
			ret = ec_mbox_put(mb, m, b);
			us = m->sent ? 20 : us;
		}
		ret = ret ?: take(mb, r, b, m);
		if (ret != EC_WAIT && ret != EC_STALE && ret != -ENOMSG)
			return ret;
		if (ret == EC_WAIT)
			until = ec_mbox_until(&r->limit);
		/* also a slave that sends messages without end has to answer in time */
		end = ec_mbox_over(mb, &until);
		if (end)
			return end == -ETIMEDOUT && unknown(mb, m) ? -ENOTRECOVERABLE : end;
		if (ret == -ENOMSG)
			pause_longer(&us);
		else
			us = 20;
	}
}

/**
 * ec_mbox_request() - send one message, wait for the answer
 * @mb: mailbox that ec_mbox_check() has accepted
 * @r: request
 * @b: message in @tx, the answer will be in @rx
 * @len: bytes of the message
 *
 * The mailbox is locked meanwhile. Emergencies and VoE messages that arrive before the
 * answer are kept. What a lost frame loses is repeated, if the slave can do that.
 *
 * Context: Process. Waits for bus traffic.
 * Return: the last value of @r->rx; -EAGAIN in INIT; -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED;
 * -ENOTRECOVERABLE when a lost frame was the reason, so that the slave may have done what was
 * requested; -EBADMSG for a message whose header is wrong; the errno of a mailbox error
 * reply; or as ec_xfer().
 */
int ec_mbox_request(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b,
		    size_t len)
{
	struct ec_mbox_until now = { .ns = U64_MAX, .cancel = r->limit.cancel };
	struct ec_mbox_message m;
	int ret = ec_mbox_lock(mb, &mb->lock, 0);

	if (ret)
		return ret;
	ec_mbox_begin(mb);
	ret = ec_mbox_off(mb);
	/* after an answer nothing of an earlier exchange can come any more */
	if (!ret && r->first && !mb->answered)
		ret = ec_mbox_drain(mb, b);
	mb->answered = false;
	/* also where a slave always has a message ready */
	ret = ret ?: ec_mbox_over(mb, &now);
	ret = ret ?: ec_mbox_message(mb, &m, r->type, len);
	ret = ret ?: exchange(mb, r, b, &m);
	mb->answered = ret >= 0;
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
 * Return: 0, -EAGAIN in INIT, -EMSGSIZE, -ETIMEDOUT, -EINTR, -ECANCELED; -ENOTRECOVERABLE when
 * its frame was lost, so that the slave may have it or not; or as ec_xfer().
 */
int ec_mbox_send(struct ec_mbox *mb, u8 type, struct ec_mbox_buf *b, size_t len,
		 const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = ec_mbox_until(limit);
	int ret = ec_mbox_lock(mb, &mb->lock, 0);

	if (ret)
		return ret;
	ec_mbox_begin(mb);
	ret = ec_mbox_over(mb, &until) ?: ec_mbox_off(mb) ?: send(mb, type, b, len, &until);
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
	struct ec_mbox_message m = { .len = 0 };
	unsigned int i;
	int ret = 0;

	for (i = 0; i < LAST_TRIES && !ret && !m.sent && !ec_stop_all(mb->stop); i++) {
		if (!down_trylock(&mb->lock)) {
			ec_mbox_begin(mb);
			ret = ec_mbox_off(mb);
			if (!ret && !m.len)
				ret = ec_mbox_message(mb, &m, type, len);
			ret = ret ?: ec_mbox_put(mb, &m, b);
			/* it may be full until its own message is read */
			if (!ret && !m.sent)
				ec_mbox_drain(mb, b);
			up(&mb->lock);
		}
		if (!m.sent)
			usleep_range(1000, 1500);
	}
}
