/* SPDX-License-Identifier: GPL-2.0-only */
/* Claims: the right to use protocols of a slave's mailbox. */
#ifndef EC_CLAIM_H
#define EC_CLAIM_H

#include "mbox.h"

struct task_struct;

/** enum ec_claim_state - of a claim; claim.c alone changes it, under the lock of the transport */
enum ec_claim_state {
	/** @EC_CLAIM_IDLE: out of all lists */
	EC_CLAIM_IDLE,
	/** @EC_CLAIM_WAITING: for its turn */
	EC_CLAIM_WAITING,
	/** @EC_CLAIM_HELD: no other user may use its protocols */
	EC_CLAIM_HELD,
};

/**
 * struct ec_claim - protocols of a mailbox for one user
 *
 * It belongs to its user: to a call, to the slave's worker, or to an open file. It must be IDLE
 * before it is freed. Nothing is allocated for it.
 */
struct ec_claim {
	/**
	 * @done: it is HELD, or IDLE again as its owner was released. Once for each
	 * ec_claim_begin(), with the lock of the transport held, possibly in a hard interrupt: it
	 * takes no sleeping lock, is bounded, and calls nothing of the mailbox. Never after
	 * ec_mbox_unclaim() has returned. Set by the user, or by ec_mbox_claim()
	 */
	void (*done)(struct ec_mbox *mb, struct ec_claim *c);
	/** @owner: ec_mbox_release_owner() ends all of its claims; NULL: none; set by the user */
	const void *owner;
	/** @task: caller of ec_mbox_claim() that sleeps */
	struct task_struct *task;
	/** @list: of those that wait, or of those that are HELD; of claim.c */
	struct list_head list;
	/** @types: BIT(enum ec_mbox_type), or EC_MBOX_ALL; of claim.c */
	u16 types;
	/** @state: enum ec_claim_state; may be read without the lock */
	u8 state;
};

void ec_claim_begin(struct ec_mbox *mb, struct ec_claim *c, u16 types, bool first);
int ec_mbox_claim(struct ec_mbox *mb, struct ec_claim *c, u16 types, u32 ms);
int ec_mbox_claim_for(struct ec_mbox *mb, struct ec_claim *c, u8 type,
		      const struct ec_mbox_limit *limit);
void ec_mbox_unclaim(struct ec_mbox *mb, struct ec_claim *c);
void ec_mbox_release_owner(struct ec_mbox *mb, const void *owner);
bool ec_mbox_is_claimed(struct ec_mbox *mb, u16 types);

#endif
