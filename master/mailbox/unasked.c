// SPDX-License-Identifier: GPL-2.0-only
/* Messages that a slave sends without a request: emergencies, VoE. */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../wire/coe.h"
#include "emerg.h"
#include "mailbox_int.h"

#define FETCH_NS	(10 * NSEC_PER_MSEC)	/* a message is being fetched, at most */
#define DRAIN	16	/* messages at most that no transfer expects */

/* a message that waits for its reader */
struct kept {
	struct list_head list;
	u16 len;
	u8 data[];
};

static bool emergency(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	struct ec_coe_emergency e;

	if (h->type != EC_MBOX_COE || ec_coe_emergency_decode(rx, h->len, &e))
		return false;
	ec_mbox_warn(mb, "CoE emergency: code 0x%04x, error register 0x%02x (%s)\n", e.code,
		     e.reg, ec_coe_emergency_text(e.code));
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

/**
 * ec_mbox_unasked() - keep a message without a request
 * @mb: mailbox of the slave
 * @h: header of the message
 * @rx: message behind the header
 *
 * Context: Process.
 * Return: true, or false when it is an answer.
 */
bool ec_mbox_unasked(struct ec_mbox *mb, const struct ec_mbox_hdr *h, const u8 *rx)
{
	if (h->type == EC_MBOX_VOE) {
		keep(mb, rx, h->len);
		return true;
	}
	return emergency(mb, h, rx);
}

/* 0: it is empty now; 1: not even after so many messages; or -errno. */
static int drain(struct ec_mbox *mb, struct ec_mbox_buf *b)
{
	struct ec_mbox_hdr h;
	unsigned int i;

	for (i = 0; i < DRAIN; i++) {
		int ret = ec_mbox_fetch(mb, b, &h, false);

		/* one that is lost is asked for again */
		if (!ret && mb->gap && mb->can_repeat)
			continue;
		if (!ret || (ret < 0 && ret != -EBADMSG))
			return ret;
		if (ret > 0)
			ec_mbox_unasked(mb, &h, b->rx);
	}
	return 1;
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
	ec_mbox_assert_locked(mb);
	return min(drain(mb, b), 0);
}

/* Read the mailbox until it is empty; -EBUSY: the slave fills it without end. */
static int discard_all(struct ec_mbox *mb, struct ec_mbox_buf *b)
{
	struct ec_mbox_hdr h;
	unsigned int i;
	int ret;

	for (i = 0; i < DRAIN; i++) {
		ret = ec_mbox_full(mb);
		if (ret <= 0)
			return ret;
		ret = ec_mbox_fetch(mb, b, &h, true);
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
	ec_mbox_begin(mb);
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

/* Poll for a VoE message with the lock held: its length, or -ENOMSG, or -errno. */
static int poll_voe(struct ec_mbox *mb, struct ec_mbox_buf *b, bool blind)
{
	struct ec_mbox_hdr h;
	int ret = take_kept(mb, b->rx);

	ec_mbox_assert_locked(mb);
	if (ret != -ENOMSG)
		return ret;
	ret = ec_mbox_fetch(mb, b, &h, blind);
	if (ret == -ETIMEDOUT || !ret)
		return -ENOMSG;
	if (ret < 0 || h.type == EC_MBOX_VOE)
		return ret;
	if (h.type == EC_MBOX_ERR)
		return ec_mbox_error_reply(mb, &h, b->rx);
	ec_mbox_unasked(mb, &h, b->rx);
	return -ENOMSG;
}

/**
 * ec_mbox_wait_voe() - wait for a VoE message
 * @mb: mailbox that ec_mbox_check() has accepted
 * @b: the message is in @rx
 * @blind: one access to the mailbox without a look whether it is full, no wait but for a holder
 *	of the lock that may fetch it just now
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
	struct ec_mbox_until until = ec_mbox_until(limit);
	u64 blind_ns = ktime_get_ns() + FETCH_NS;
	unsigned int us = 20;
	bool looked = false;
	int ret, end;

	for (;;) {
		ret = take_kept(mb, b->rx);
		/* another holder of the lock keeps our messages */
		if (ret == -ENOMSG && !down_trylock(&mb->lock)) {
			ec_mbox_begin(mb);
			ret = ec_mbox_off(mb) ?: poll_voe(mb, b, blind);
			looked = true;
			up(&mb->lock);
		}
		if (ret != -ENOMSG || (blind && (looked || ktime_get_ns() > blind_ns)))
			return ret;
		end = ec_mbox_over(mb, &until);
		if (end && !(blind && end == -ETIMEDOUT))
			return end;
		ec_mbox_pause(&us);
	}
}

/**
 * ec_mbox_poll() - fetch emergencies and VoE messages that no transfer expects
 * @mb: mailbox of the slave
 *
 * Nothing to do while another caller uses the mailbox: its exchange fetches them as well.
 *
 * Context: Process. Waits for bus traffic.
 * Return: true: the slave has sent very many, and there are more.
 */
bool ec_mbox_poll(struct ec_mbox *mb)
{
	struct ec_mbox_buf *b;
	int ret = 0;

	if (!ec_mbox_present(mb) || ec_stop_all(mb->stop) || down_trylock(&mb->lock))
		return false;
	ec_mbox_begin(mb);
	b = ec_mbox_off(mb) ? NULL : kmalloc(sizeof(*b), GFP_KERNEL);
	if (b)
		ret = drain(mb, b);
	kfree(b);
	up(&mb->lock);
	return ret > 0;
}
