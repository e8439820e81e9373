// SPDX-License-Identifier: GPL-2.0-only
/*
 * Who may use a protocol of a slave's mailbox: one transfer of each at a time, several protocols
 * side by side. The way through INIT claims all, so that it aborts no transfer.
 */
#include <linux/ktime.h>
#include <linux/sched.h>
#include "caller.h"
#include "claim.h"

#define EVER_NS	(U64_MAX - 1)	/* one more is a time as well */

/* a caller that waits for protocols */
struct claim {
	struct list_head list;
	u16 types;
	u8 got;
	struct task_struct *task;
};

/* With all protocols claimed the machine is left alone as well. */
static void claim_set(struct ec_mbox *mb, u16 claimed)
{
	lockdep_assert_held(&mb->box.lock);
	WRITE_ONCE(mb->desk.claimed, claimed);
	mb->box.closed = claimed == EC_MBOX_ALL;
}

/* Give free protocols to those who wait, in their order. */
static void claim_admit(struct ec_mbox *mb)
{
	struct claim *c, *next;
	u16 taken = mb->desk.claimed;

	lockdep_assert_held(&mb->box.lock);
	list_for_each_entry_safe(c, next, &mb->desk.claims, list) {
		if (!(taken & c->types)) {
			list_del_init(&c->list);
			claim_set(mb, mb->desk.claimed | c->types);
			smp_store_release(&c->got, true);	/* see ec_mbox_sleep() */
			wake_up_process(c->task);
		}
		/* later ones do not overtake */
		taken |= c->types;
	}
}

static int claim(struct ec_mbox *mb, u16 types, const struct ec_mbox_until *until)
{
	struct claim c = { .types = types, .task = current };
	unsigned long flags;
	int ret = 0;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (READ_ONCE(mb->stop->worker) == current)
		list_add(&c.list, &mb->desk.claims);
	else
		list_add_tail(&c.list, &mb->desk.claims);
	claim_admit(mb);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	/* the lock below orders all else */
	while (!READ_ONCE(c.got)) {
		ret = ec_mbox_over(mb, until);
		if (ret)
			break;
		ec_mbox_sleep(mb, &c.got, true, until);
	}
	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (c.got) {
		ret = 0;
	} else {
		list_del(&c.list);
		claim_admit(mb);
	}
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	return ret;
}

/**
 * ec_mbox_claim() - wait for one's turn
 * @mb: mailbox of the slave
 * @types: BIT(enum ec_mbox_type), or EC_MBOX_ALL
 * @ms: the wait ends after that time; 0: as long as it takes
 *
 * The slave's worker comes before other callers that wait.
 *
 * Context: Process. May sleep.
 * Return: 0; -EINTR; -ECANCELED when the caller has to leave; -ETIMEDOUT.
 */
int ec_mbox_claim(struct ec_mbox *mb, u16 types, u32 ms)
{
	struct ec_mbox_until until = {
		.ns = ms ? ktime_get_ns() + (u64)ms * NSEC_PER_MSEC : EVER_NS,
	};

	return claim(mb, types, &until);
}

/**
 * ec_mbox_claim_for() - wait for the turn of a transfer
 * @mb: mailbox of the slave
 * @type: enum ec_mbox_type
 * @limit: of the transfer
 *
 * A protocol that is free is claimed even after @limit->begin_ns.
 *
 * Context: Process. May sleep.
 * Return: as ec_mbox_claim(); -ECANCELED also for a transfer that is cancelled.
 */
int ec_mbox_claim_for(struct ec_mbox *mb, u8 type, const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = {
		.ns = limit->begin_ns ?: EVER_NS, .cancel = limit->cancel,
	};

	return claim(mb, BIT(type), &until);
}

/**
 * ec_mbox_unclaim() - let others use protocols
 * @mb: mailbox of the slave
 * @types: of ec_mbox_claim()
 *
 * Context: Process.
 */
void ec_mbox_unclaim(struct ec_mbox *mb, u16 types)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	claim_set(mb, mb->desk.claimed & ~types);
	claim_admit(mb);
	ec_box_go(&mb->box);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/**
 * ec_mbox_is_claimed() - is a protocol in use?
 * @mb: mailbox of the slave
 * @types: BIT(enum ec_mbox_type)
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether one of them is.
 */
bool ec_mbox_is_claimed(struct ec_mbox *mb, u16 types)
{
	return READ_ONCE(mb->desk.claimed) & types;
}
