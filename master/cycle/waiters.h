/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers of one open file that wait for a cycle the kernel runs. */
#ifndef EC_WAITERS_H
#define EC_WAITERS_H

#include <linux/atomic.h>
#include <linux/poll.h>
#include <linux/types.h>
#include <linux/wait.h>

/* The cycle thread wakes all of them in each cycle; this bounds the time it takes. */
#define EC_MAX_WAITERS	16

/**
 * struct ec_waiters - wait queue of one open file, which frees it after an RCU
 *	grace period
 * @wq: queue; only the cycle that the file owns wakes it
 * @adding: poll() calls that are about to add an entry to @wq
 * @sleeping: callers of EC_IOC_WAIT
 */
struct ec_waiters {
	wait_queue_head_t wq;
	atomic_t adding;
	atomic_t sleeping;
};

void ec_waiters_init(struct ec_waiters *w);
bool ec_waiters_poll(struct ec_waiters *w, struct file *filp, poll_table *table);
bool ec_waiters_enter(struct ec_waiters *w);
void ec_waiters_leave(struct ec_waiters *w);

/**
 * ec_waiters_wake() - wake all waiting callers
 * @w: wait queue of a file
 *
 * Context: Any but hard interrupt under PREEMPT_RT; RCU read side. Bounded by
 * %EC_MAX_WAITERS.
 */
static inline void ec_waiters_wake(struct ec_waiters *w)
{
	if (wq_has_sleeper(&w->wq))
		wake_up_all(&w->wq);
}

#endif
