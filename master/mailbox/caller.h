/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers of a mailbox that sleep until they have their result. */
#ifndef EC_CALLER_H
#define EC_CALLER_H

#include <linux/ktime.h>
#include "mbox.h"

struct task_struct;

/** struct ec_mbox_until - when the wait of a caller has to end */
struct ec_mbox_until {
	/** @ns: time (ktime) */
	u64 ns;
	/** @cancel: NULL, or becomes true when another thread cancels the transfer */
	const bool *cancel;
};

static inline struct ec_mbox_until ec_mbox_until(const struct ec_mbox_limit *l)
{
	u64 ns = ktime_get_ns() + (u64)l->timeout_ms * NSEC_PER_MSEC;

	return (struct ec_mbox_until){ l->end_ns ? min(ns, l->end_ns) : ns, l->cancel };
}

/** struct ec_caller - user of a mailbox that sleeps */
struct ec_caller {
	/** @user: its message, and what it waits for */
	struct ec_mbox_user user;
	/** @task: woken when @user is DONE, immutable from ec_caller_enter() on */
	struct task_struct *task;
};

int ec_mbox_over(const struct ec_mbox *mb, const struct ec_mbox_until *u);
void ec_mbox_sleep(const struct ec_mbox *mb, const u8 *state, u8 end,
		   const struct ec_mbox_until *u);
void ec_caller_enter(struct ec_mbox *mb, struct ec_caller *c);
int ec_caller_wait(struct ec_mbox *mb, struct ec_caller *c, const struct ec_mbox_limit *limit,
		   struct ec_mbox_until *until);

#endif
