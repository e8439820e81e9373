// SPDX-License-Identifier: GPL-2.0-only
/* Mailboxes of a slave: their memory, the datagram of each step, and when it leaves. */
#include <linux/ktime.h>
#include <linux/slab.h>
#include "../link/links.h"
#include "../wire/fmmu.h"
#include "../wire/regs.h"
#include "box_post.h"

#define POLL_SLACK_NS	(20 * NSEC_PER_USEC)	/* free wire time of a cycle, enough for polls */
#define SHORT_NS	(200 * NSEC_PER_USEC)	/* most slaves reply within that time */
#define PAUSE_MIN_NS	(10 * NSEC_PER_USEC)
#define PAUSE_MAX_NS	(5 * NSEC_PER_MSEC)

static void box_set_step(struct ec_box *box, enum ec_box_step step)
{
	/* steps that may precede */
	static const u8 from[] = {
		[EC_BOX_REST] = U8_MAX,
		[EC_BOX_STATUS] = BIT(EC_BOX_REST),
		[EC_BOX_READ] = BIT(EC_BOX_REST) | BIT(EC_BOX_STATUS) | BIT(EC_BOX_READ),
		[EC_BOX_WRITE] = BIT(EC_BOX_REST) | BIT(EC_BOX_WRITE),
		[EC_BOX_REPEAT_GET] = BIT(EC_BOX_REST) | BIT(EC_BOX_REPEAT_GET),
		[EC_BOX_REPEAT_SET] = BIT(EC_BOX_REPEAT_GET) | BIT(EC_BOX_REPEAT_SET),
		[EC_BOX_REPEAT_ACK] = BIT(EC_BOX_REPEAT_SET) | BIT(EC_BOX_REPEAT_ACK),
	};

	lockdep_assert_held(&box->lock);
	WARN_ON_ONCE(!(from[step] & BIT(box->step)));
	WRITE_ONCE(box->step, step);
}

static void post(struct ec_box *box, u8 cmd, u16 ado, void *data, u16 len, bool repeat)
{
	lockdep_assert_held(&box->lock);
	box->dg = EC_DG(cmd, box->station, ado, len, data);
	box->dg.repeat = repeat;
	ec_post_send(&box->post, box->due_ns);
}

/*
 * A piece of a mailbox. A mailbox that does not fit beside the process data of a short cycle is
 * accessed in pieces: access to the first byte opens it, access to the last byte closes it
 * (ETG.1000.4 clause 6.7.2). The last piece must not be sent twice.
 */
static void post_piece(struct ec_box *box, u8 cmd, u16 offset, u8 *data)
{
	u16 n = min_t(u16, box->size - box->at, ec_access_room(box->links));

	post(box, cmd, offset + box->at, data + box->at, n, box->at + n < box->size);
}

static void post_repeat(struct ec_box *box, u8 cmd, u16 len)
{
	post(box, cmd, EC_REG_SM(1) + EC_SM_OFS_ACTIVATE, box->status, len, true);
}

/**
 * ec_box_post() - make a step: send its datagram
 * @box: mailbox of a slave, its lock held
 * @step: as the table at enum ec_box_step allows
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_post(struct ec_box *box, enum ec_box_step step)
{
	lockdep_assert_held(&box->lock);
	box_set_step(box, step);
	switch (step) {
	case EC_BOX_STATUS:
		post(box, EC_CMD_FPRD, EC_REG_SM(1) + EC_SM_OFS_STATUS, box->status, 1, true);
		break;
	case EC_BOX_READ:
		post_piece(box, EC_CMD_FPRD, ec_box_area(box)->tx_offset, box->rx);
		break;
	case EC_BOX_WRITE:
		post_piece(box, EC_CMD_FPWR, ec_box_area(box)->rx_offset, box->tx);
		break;
	case EC_BOX_REPEAT_GET:
	case EC_BOX_REPEAT_ACK:
		post_repeat(box, EC_CMD_FPRD, 2);
		break;
	case EC_BOX_REPEAT_SET:
		post_repeat(box, EC_CMD_FPWR, 1);
		break;
	case EC_BOX_REST:
		break;
	}
}

/**
 * ec_box_progress() - something has happened: the next access is made at once
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_progress(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	box->since_ns = ktime_get_ns();
	box->due_ns = 0;
}

/**
 * ec_box_pause() - pause before the next access
 * @box: mailbox of a slave, its lock held
 *
 * The longer a slave takes, the longer the pause: an eighth of the time it has taken so far, at
 * most 5 ms. Without a cycle, or with little free wire time, the pause is longer, up to 1 ms. A
 * cycle with enough free wire time makes polls rare enough.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_pause(struct ec_box *box)
{
	u64 now = ktime_get_ns(), took = now - box->since_ns, ns = took / 8;

	lockdep_assert_held(&box->lock);
	if (!ec_access_is_cyclic(&box->links->access) ||
	    ec_access_slack_ns(box->links) < POLL_SLACK_NS)
		ns = max(ns, took < SHORT_NS ? took / 4 : min_t(u64, took, NSEC_PER_MSEC));
	box->due_ns = now + clamp_t(u64, ns, PAUSE_MIN_NS, PAUSE_MAX_NS);
}

/**
 * ec_box_expect_reply() - the message that was written has a reply
 * @box: mailbox of a slave, its lock held
 *
 * Most slaves take as long as for their last message: the first poll is shortly before that.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_expect_reply(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	if (!ec_access_is_cyclic(&box->links->access))
		box->due_ns = box->since_ns + min_t(u64, box->took_ns / 4 * 3, SHORT_NS / 2);
}

/**
 * ec_box_expect_more() - the received message was not the one that its user waits for
 * @box: mailbox of a slave, its lock held
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_box_expect_more(struct ec_box *box)
{
	lockdep_assert_held(&box->lock);
	box->since_ns = ktime_get_ns();
}

/**
 * ec_box_reads_at_once() - is SM1 read without a poll of its status?
 * @box: mailbox of a slave
 *
 * Beside a cycle each poll takes a period. With enough free wire time SM1 is read at once: an
 * empty one is not read, and its working counter is 0.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_box_reads_at_once(const struct ec_box *box)
{
	u32 slack = ec_access_slack_ns(box->links);
	u32 ns = ec_frame_wire_ns(EC_ETH_HDR + EC_FRAME_HDR + EC_DGRAM_OVERHEAD +
				  ec_box_area(box)->tx_size);

	return box->counts && slack != ~0u &&
	       ec_links_acyclic_ns(box->links) + ns <= slack / 2;
}

/**
 * ec_box_get_memory() - allocate the memory of the mailboxes, at their first use
 * @box: mailbox of a slave
 *
 * The EEPROM may contain any sizes, so they are limited here.
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_box_get_memory(struct ec_box *box)
{
	const struct ec_sii_mbox *std = &box->sii->std, *boot = &box->sii->boot;
	u16 tx = clamp_t(u16, max(std->rx_size, boot->rx_size), EC_MBOX_HDR, EC_MBOX_MAX);
	u16 rx = clamp_t(u16, max(std->tx_size, boot->tx_size), EC_BOX_BEGIN, EC_MBOX_MAX);
	unsigned long flags;
	u8 *t, *r;

	if (READ_ONCE(box->rx))
		return 0;
	t = kmalloc(tx, GFP_KERNEL);
	r = kzalloc(rx, GFP_KERNEL);
	raw_spin_lock_irqsave(&box->lock, flags);
	if (t && r && !box->rx) {
		swap(box->tx, t);
		swap(box->rx, r);
		box->tx_room = tx;
		box->rx_room = rx;
	}
	raw_spin_unlock_irqrestore(&box->lock, flags);
	kfree(t);
	kfree(r);
	return READ_ONCE(box->rx) ? 0 : -ENOMEM;
}

/**
 * ec_box_stop() - send nothing any more
 * @box: mailbox of a slave
 *
 * Context: Process. Waits for the datagram that may be in flight.
 */
void ec_box_stop(struct ec_box *box)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&box->lock, flags);
	box->dead = true;
	raw_spin_unlock_irqrestore(&box->lock, flags);
	ec_post_cancel(&box->post);
}

/**
 * ec_box_free() - free the memory of a mailbox
 * @box: mailbox after ec_box_stop(), whose message is not used any more
 *
 * Context: Process.
 */
void ec_box_free(struct ec_box *box)
{
	kfree(box->tx);
	kfree(box->rx);
}
