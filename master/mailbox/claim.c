// SPDX-License-Identifier: GPL-2.0-only
/*
 * Claims: the right to use protocols of a slave's mailbox. One transfer of each protocol at a time,
 * several protocols side by side. The way through INIT claims all, so that it aborts no transfer.
 */
#include <linux/ktime.h>
#include <linux/sched.h>
#include "caller.h"
#include "claim.h"

#define EVER_NS	(U64_MAX - 1)	/* ec_mbox_sleep() adds 1 */

/* With all protocols claimed the transport begins no step. */
static void claim_set(struct ec_mbox *mb, u16 claimed)
{
	lockdep_assert_held(&mb->box.lock);
	WRITE_ONCE(mb->desk.claimed, claimed);
	mb->box.closed = claimed == EC_MBOX_ALL;
}

/* Give free protocols to the claims that wait, in their order. */
static void claim_admit(struct ec_mbox *mb)
{
	u16 taken = mb->desk.claimed;
	struct ec_claim *c, *next;

	lockdep_assert_held(&mb->box.lock);
	list_for_each_entry_safe(c, next, &mb->desk.claims, list) {
		/* later claims do not overtake */
		if (taken & c->types) {
			taken |= c->types;
			continue;
		}
		taken |= c->types;
		list_move_tail(&c->list, &mb->desk.holders);
		claim_set(mb, mb->desk.claimed | c->types);
		smp_store_release(&c->state, EC_CLAIM_HELD);	/* see ec_mbox_sleep() */
		c->done(mb, c);
	}
}

/* End a claim; claim_admit() must follow. */
static void claim_end(struct ec_mbox *mb, struct ec_claim *c)
{
	lockdep_assert_held(&mb->box.lock);
	if (c->state == EC_CLAIM_IDLE)
		return;
	if (c->state == EC_CLAIM_HELD)
		claim_set(mb, mb->desk.claimed & ~c->types);
	list_del(&c->list);
	WRITE_ONCE(c->state, EC_CLAIM_IDLE);
}

/**
 * ec_claim_begin() - claim protocols of a mailbox, now or when they are free
 * @mb: mailbox of the slave
 * @c: IDLE, its @done and @owner set
 * @types: BIT(enum ec_mbox_type), or EC_MBOX_ALL
 * @first: before all others that wait
 *
 * @c->done may be called before this returns.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_claim_begin(struct ec_mbox *mb, struct ec_claim *c, u16 types, bool first)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	c->types = types;
	c->state = EC_CLAIM_WAITING;
	if (first)
		list_add(&c->list, &mb->desk.claims);
	else
		list_add_tail(&c->list, &mb->desk.claims);
	claim_admit(mb);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

static void claim_wake(struct ec_mbox *mb, struct ec_claim *c)
{
	wake_up_process(c->task);
}

/* The wait has ended: a claim that is HELD by now is valid, another one ends. */
static int claim_result(struct ec_mbox *mb, struct ec_claim *c, int ret)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	if (c->state == EC_CLAIM_HELD) {
		ret = 0;
	} else {
		ret = ret ?: -ECANCELED;
		claim_end(mb, c);
		claim_admit(mb);
	}
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
	return ret;
}

static int claim(struct ec_mbox *mb, struct ec_claim *c, u16 types,
		 const struct ec_mbox_until *until)
{
	int ret = 0;

	c->task = current;
	c->done = claim_wake;
	ec_claim_begin(mb, c, types, READ_ONCE(mb->stop->worker) == current);
	/* claim_result() orders all else by the lock */
	while (!ret && READ_ONCE(c->state) == EC_CLAIM_WAITING) {
		ret = ec_mbox_over(mb, until);
		if (!ret)
			ec_mbox_sleep(mb, &c->state, EC_CLAIM_HELD, until);
	}
	return claim_result(mb, c, ret);
}

/**
 * ec_mbox_claim() - claim protocols, and sleep until the claim is HELD
 * @mb: mailbox of the slave
 * @c: IDLE, its @owner set
 * @types: BIT(enum ec_mbox_type), or EC_MBOX_ALL
 * @ms: the wait ends after that time; 0: as long as it takes
 *
 * The slave's worker comes before other callers that wait.
 *
 * Context: Process. May sleep.
 * Return: 0; -EINTR; -ECANCELED when the caller has to leave, or the owner of @c was released;
 * -ETIMEDOUT.
 */
int ec_mbox_claim(struct ec_mbox *mb, struct ec_claim *c, u16 types, u32 ms)
{
	struct ec_mbox_until until = {
		.ns = ms ? ktime_get_ns() + (u64)ms * NSEC_PER_MSEC : EVER_NS,
	};

	return claim(mb, c, types, &until);
}

/**
 * ec_mbox_claim_for() - claim the protocol of a transfer, and sleep until the claim is HELD
 * @mb: mailbox of the slave
 * @c: IDLE, its @owner set
 * @type: enum ec_mbox_type
 * @limit: of the transfer
 *
 * A protocol that is free is claimed even after @limit->begin_ns.
 *
 * Context: Process. May sleep.
 * Return: as ec_mbox_claim(); -ECANCELED also for a transfer that is cancelled.
 */
int ec_mbox_claim_for(struct ec_mbox *mb, struct ec_claim *c, u8 type,
		      const struct ec_mbox_limit *limit)
{
	struct ec_mbox_until until = {
		.ns = limit->begin_ns ?: EVER_NS, .cancel = limit->cancel,
	};

	return claim(mb, c, BIT(type), &until);
}

/**
 * ec_mbox_unclaim() - end a claim
 * @mb: mailbox of the slave
 * @c: in any state; IDLE afterwards
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_unclaim(struct ec_mbox *mb, struct ec_claim *c)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	claim_end(mb, c);
	claim_admit(mb);
	ec_box_go(&mb->box);
	raw_spin_unlock_irqrestore(&mb->box.lock, flags);
}

/* End the claims of an owner in a list; @done is called for claims that wait. */
static void end_claims_of(struct ec_mbox *mb, struct list_head *claims, const void *owner)
{
	struct ec_claim *c, *next;
	bool waits;

	lockdep_assert_held(&mb->box.lock);
	list_for_each_entry_safe(c, next, claims, list) {
		if (c->owner != owner)
			continue;
		waits = c->state == EC_CLAIM_WAITING;
		claim_end(mb, c);
		if (waits)
			c->done(mb, c);
	}
}

/**
 * ec_mbox_release_owner() - end all claims of an owner, for example of an open file
 * @mb: mailbox of the slave
 * @owner: not NULL; its claims are IDLE afterwards, those that are HELD and those that wait
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_mbox_release_owner(struct ec_mbox *mb, const void *owner)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&mb->box.lock, flags);
	end_claims_of(mb, &mb->desk.claims, owner);
	end_claims_of(mb, &mb->desk.holders, owner);
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
