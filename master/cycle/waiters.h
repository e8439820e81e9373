/* SPDX-License-Identifier: GPL-2.0-only */
/* Callers of one open file that wait for a cycle the kernel runs. */
#ifndef EC_WAITERS_H
#define EC_WAITERS_H

#include <linux/atomic.h>
#include <linux/list.h>
#include <linux/poll.h>
#include <linux/spinlock.h>
#include <linux/types.h>
#include <linux/wait.h>

/* The cycle wakes all of them in each cycle; this bounds the time it takes. */
#define EC_MAX_WAITERS	16

struct task_struct;

/** struct ec_sleeper - a caller that sleeps until the next cycle; on its stack */
struct ec_sleeper {
	/** @list: in struct ec_waiters.sleepers */
	struct list_head list;
	/** @task: the caller */
	struct task_struct *task;
};

/** struct ec_waiters - callers of one open file, which frees this after an RCU grace period */
struct ec_waiters {
	/**
	 * @wq: entries of poll(), and readers of events; under PREEMPT_RT not for hard interrupts
	 */
	wait_queue_head_t wq;
	/** @adding: poll() calls that are about to add an entry to @wq */
	atomic_t adding;
	/** @sleeping: callers that sleep */
	atomic_t sleeping;
	/** @lock: for @sleepers */
	raw_spinlock_t lock;
	/** @sleepers: &struct ec_sleeper, callers of EC_IOC_WAIT */
	struct list_head sleepers;
};

void ec_waiters_init(struct ec_waiters *w);
bool ec_waiters_poll(struct ec_waiters *w, struct file *filp, poll_table *table);
bool ec_waiters_enter(struct ec_waiters *w);
void ec_waiters_leave(struct ec_waiters *w);
bool ec_waiters_join(struct ec_waiters *w, struct ec_sleeper *s);
void ec_waiters_part(struct ec_waiters *w, struct ec_sleeper *s);
void ec_waiters_rouse(struct ec_waiters *w);

/**
 * ec_waiters_wake_sleepers() - wake callers that have joined
 * @w: callers of a file
 *
 * Context: Any, also hard interrupt; RCU read side. RT-safe: bounded by %EC_MAX_WAITERS.
 */
static inline void ec_waiters_wake_sleepers(struct ec_waiters *w)
{
	smp_mb();	/* what they wait for, then the list; pairs with set_current_state() */
	if (!list_empty(&w->sleepers))
		ec_waiters_rouse(w);
}

/**
 * ec_waiters_polled() - would ec_waiters_wake() wake a caller of poll()?
 * @w: callers of a file
 *
 * Context: Any, also hard interrupt; RCU read side. RT-safe.
 * Return: whether it would.
 */
static inline bool ec_waiters_polled(struct ec_waiters *w)
{
	return wq_has_sleeper(&w->wq);
}

/**
 * ec_waiters_wake() - wake all waiting callers
 * @w: callers of a file
 *
 * Context: Any but hard interrupt under PREEMPT_RT; RCU read side. Bounded by
 * twice %EC_MAX_WAITERS.
 */
static inline void ec_waiters_wake(struct ec_waiters *w)
{
	ec_waiters_wake_sleepers(w);
	if (ec_waiters_polled(w))
		wake_up_all(&w->wq);
}

#endif
