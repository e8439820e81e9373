// SPDX-License-Identifier: GPL-2.0-only
/*
 * Each open file has a wait queue of its own. So a file that does not own the cycle
 * adds no work to the cycle thread, and an epoll entry never outlives its queue.
 */
#include <linux/sched.h>
#include "waiters.h"

/**
 * ec_waiters_init() - prepare the wait queue of a file
 * @w: wait queue
 *
 * Context: Any.
 */
void ec_waiters_init(struct ec_waiters *w)
{
	init_waitqueue_head(&w->wq);
	atomic_set(&w->adding, 0);
	atomic_set(&w->sleeping, 0);
	raw_spin_lock_init(&w->lock);
	INIT_LIST_HEAD(&w->sleepers);
}

/* May @more entries be added to those in the queue? */
static bool has_place(struct ec_waiters *w, int more)
{
	struct wait_queue_entry *e;
	int n = more;

	spin_lock_irq(&w->wq.lock);
	list_for_each_entry(e, &w->wq.head, entry)
		if (++n > EC_MAX_WAITERS)
			break;
	spin_unlock_irq(&w->wq.lock);
	return n <= EC_MAX_WAITERS;
}

/**
 * ec_waiters_poll() - poll_wait() with a limit
 * @w: wait queue of @filp
 * @filp: file
 * @table: argument of its poll()
 *
 * Context: Process. May sleep.
 * Return: false when %EC_MAX_WAITERS entries wait already.
 */
bool ec_waiters_poll(struct ec_waiters *w, struct file *filp, poll_table *table)
{
	bool ok;

	/* poll_wait() would do nothing; newer kernels have no name for it */
	if (!table || !table->_qproc)
		return true;
	/* an entry is counted here until it is in the queue, so the limit is exact */
	ok = has_place(w, atomic_inc_return(&w->adding));
	if (ok)
		poll_wait(filp, &w->wq, table);
	atomic_dec(&w->adding);
	return ok;
}

/**
 * ec_waiters_enter() - one more caller is about to sleep
 * @w: wait queue
 *
 * Context: Any.
 * Return: false when %EC_MAX_WAITERS callers sleep already, else
 * ec_waiters_leave() must follow.
 */
bool ec_waiters_enter(struct ec_waiters *w)
{
	if (atomic_inc_return(&w->sleeping) <= EC_MAX_WAITERS)
		return true;
	ec_waiters_leave(w);
	return false;
}

/**
 * ec_waiters_leave() - a caller of ec_waiters_enter() does not sleep any more
 * @w: wait queue
 *
 * Context: Any.
 */
void ec_waiters_leave(struct ec_waiters *w)
{
	atomic_dec(&w->sleeping);
}

/**
 * ec_waiters_join() - the caller wants to be woken by the cycle
 * @w: callers of a file
 * @s: on the stack of the caller
 *
 * Context: Process.
 * Return: as ec_waiters_enter(); ec_waiters_part() must follow then.
 */
bool ec_waiters_join(struct ec_waiters *w, struct ec_sleeper *s)
{
	unsigned long flags;

	if (!ec_waiters_enter(w))
		return false;
	s->task = current;
	raw_spin_lock_irqsave(&w->lock, flags);
	list_add_tail(&s->list, &w->sleepers);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	return true;
}

/**
 * ec_waiters_part() - the caller sleeps no more
 * @w: callers of a file
 * @s: as for ec_waiters_join()
 *
 * Context: Process.
 */
void ec_waiters_part(struct ec_waiters *w, struct ec_sleeper *s)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	list_del(&s->list);
	raw_spin_unlock_irqrestore(&w->lock, flags);
	ec_waiters_leave(w);
}

/**
 * ec_waiters_rouse() - ec_waiters_wake_sleepers() when there are some
 * @w: callers of a file
 *
 * Context: As there.
 */
void ec_waiters_rouse(struct ec_waiters *w)
{
	struct ec_sleeper *s;
	unsigned long flags;

	raw_spin_lock_irqsave(&w->lock, flags);
	/* a caller that parts waits for the lock: its task stays */
	list_for_each_entry(s, &w->sleepers, list)
		wake_up_process(s->task);
	raw_spin_unlock_irqrestore(&w->lock, flags);
}
