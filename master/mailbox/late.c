// SPDX-License-Identifier: GPL-2.0-only
/*
 * Replies after their time limit. A slave that stores parameters has accepted a request and
 * replies many seconds later. Until then it accepts no other request of that protocol, and its
 * reply must not be taken for that to another request.
 */
#include <linux/ktime.h>
#include "../carry/xfer.h"
#include "../wire/fmmu.h"
#include "../wire/regs.h"
#include "caller.h"
#include "desk_enter.h"
#include "late.h"

/**
 * ec_mbox_is_late() - has the slave accepted a request that it has not replied to?
 * @mb: mailbox of the slave
 * @u: user with the request, among the users
 *
 * Context: Process. Waits for bus traffic.
 * Return: false also where it is not known: a lost frame may have had the request or reply.
 */
bool ec_mbox_is_late(struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	u8 status = EC_SM_ST_FULL;
	unsigned long flags;
	bool waits;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	waits = u->phase == EC_MBOX_USER_WAITING && !u->lost && !u->gap && !u->heard;
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	return waits && !ec_box_is_off(&mb->box) &&
	       !ec_xfer_fprd(mb->box.links, mb->box.station, EC_REG_SM(0) + EC_SM_OFS_STATUS,
			     &status, 1) &&
	       !(status & EC_SM_ST_FULL);
}

/**
 * ec_mbox_mark_late() - let the next request of a protocol wait for a late reply
 * @mb: mailbox of the slave
 * @u: user with the request, among the users
 *
 * Context: Process.
 */
void ec_mbox_mark_late(struct ec_mbox *mb, const struct ec_mbox_user *u)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (u->phase == EC_MBOX_USER_WAITING && !mb->desk.never_late) {
		mb->desk.late |= BIT(u->type);
		mb->desk.late_ns = ktime_get_ns() + (u64)EC_MBOX_LATE_MS * NSEC_PER_MSEC;
	}
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

static bool is_awaited(struct ec_mbox *mb, u16 types)
{
	return READ_ONCE(mb->desk.late) & types && !READ_ONCE(mb->box.renew) &&
	       !ec_box_is_off(&mb->box);
}

/**
 * ec_mbox_forget_late() - wait for no late reply any more
 * @mb: mailbox of the slave
 * @types: BIT(enum ec_mbox_type)
 *
 * Context: Any.
 */
void ec_mbox_forget_late(struct ec_mbox *mb, u16 types)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	mb->desk.late &= ~types;
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/**
 * ec_mbox_took_late() - a message is received that no request waits for
 * @mb: mailbox of the slave
 * @type: enum ec_mbox_type
 *
 * Context: Process.
 */
void ec_mbox_took_late(struct ec_mbox *mb, u8 type)
{
	u16 types = type == EC_MBOX_ERR ? EC_MBOX_ALL : BIT(type);
	u64 ms = EC_MBOX_LATE_MS, now = ktime_get_ns();
	unsigned long flags;
	bool late;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	late = mb->desk.late & types;
	mb->desk.late &= ~types;
	if (late && now < mb->desk.late_ns)
		ms -= div_u64(mb->desk.late_ns - now, NSEC_PER_MSEC);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	if (late)
		ec_mbox_warn(mb, "mailbox reply %llu ms after its time limit discarded; allow more time: --timeout, ecrt_slave_config_sdo_timeout()\n",
			      ms);
}

/* No late reply was received: this slave may not reply to some requests at all. */
static void late_give_up(struct ec_mbox *mb, u8 type)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (mb->desk.late & BIT(type))
		mb->desk.never_late = true;
	mb->desk.late &= ~BIT(type);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/**
 * ec_mbox_await_late() - before a request: wait for the late reply to an earlier one
 * @mb: mailbox of the slave
 * @r: request; its protocol is claimed
 * @b: its reply is in @rx, to be discarded
 *
 * It waits as long as for a reply of its own. Other protocols use the mailbox meanwhile.
 *
 * Context: Process. Waits for bus traffic.
 * Return: 0: there is none to wait for (any more); -EINTR; -ECANCELED; -ETIMEDOUT when the
 * request cannot begin in time.
 */
int ec_mbox_await_late(struct ec_mbox *mb, const struct ec_mbox_request *r, struct ec_mbox_buf *b)
{
	const struct ec_mbox_limit *l = &r->limit;
	u64 begin = min(l->begin_ns ?: U64_MAX - 1, l->end_ns ?: U64_MAX - 1), last;
	struct ec_caller c = { .user = { .type = r->type, .rx = b->rx } };
	struct ec_mbox_until until = { .cancel = l->cancel };
	unsigned long flags;
	int ret = 0;

	if (!is_awaited(mb, BIT(r->type)))
		return 0;
	raw_spin_lock_irqsave(&mb->box.lock, flags);
	last = mb->desk.late_ns;
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	/* a caller waits no longer than it allows for a reply */
	until.ns = min3(begin, last, ktime_get_ns() + (u64)l->timeout_ms * NSEC_PER_MSEC);
	ec_caller_enter(mb, &c);
	while (!ret && is_awaited(mb, BIT(r->type))) {
		ret = ec_mbox_over(mb, &until);
		/* pairs with desk_finish(): the result is complete */
		if (smp_load_acquire(&c.user.phase) == EC_MBOX_USER_DONE)
			break;
		if (!ret)
			ec_mbox_sleep(mb, &c.user.phase, EC_MBOX_USER_DONE, &until);
	}
	ec_desk_leave(mb, &c.user, false);
	if (c.user.got) {
		ec_mbox_took_late(mb, c.user.got_type);
	} else if (ret == -ETIMEDOUT && until.ns == last) {
		late_give_up(mb, r->type);
		return 0;
	} else if (ret && (ret != -ETIMEDOUT || until.ns == begin)) {
		return ret;
	}
	/* also after an error of the bus, which the request itself will get */
	ec_mbox_forget_late(mb, BIT(r->type));
	return 0;
}
