// SPDX-License-Identifier: GPL-2.0-only
/*
 * A counting semaphore whose count may change, with a wait that a fatal signal ends
 * and an attempt without queueing that overtakes no waiting caller.
 */
#include <linux/errno.h>
#include <linux/jiffies.h>
#include <linux/sched/signal.h>
#include "gate.h"

struct waiter {
	struct list_head list;
	struct task_struct *task;
	bool in;
};

/**
 * ec_gate_init() - prepare a gate
 * @g: gate
 * @limit: places
 *
 * Context: Any.
 */
void ec_gate_init(struct ec_gate *g, unsigned int limit)
{
	raw_spin_lock_init(&g->lock);
	g->limit = limit;
	g->used = 0;
	INIT_LIST_HEAD(&g->waiting);
	INIT_LIST_HEAD(&g->watching);
}

/* Give free places to those who wait, in their order. */
static void admit(struct ec_gate *g)
{
	lockdep_assert_held(&g->lock);
	while (g->used < g->limit && !list_empty(&g->waiting)) {
		struct waiter *w = list_first_entry(&g->waiting, struct waiter, list);

		list_del(&w->list);
		g->used++;
		w->in = true;
		/* it leaves only after it has had the lock */
		wake_up_process(w->task);
	}
}

/**
 * ec_gate_set_limit() - change the number of places
 * @g: gate
 * @limit: places; those taken beyond it stay taken
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_gate_set_limit(struct ec_gate *g, unsigned int limit)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&g->lock, flags);
	g->limit = limit;
	admit(g);
	raw_spin_unlock_irqrestore(&g->lock, flags);
}

static bool enter_now(struct ec_gate *g)
{
	lockdep_assert_held(&g->lock);
	if (g->used >= g->limit || !list_empty(&g->waiting))
		return false;
	WRITE_ONCE(g->used, g->used + 1);
	return true;
}

/**
 * ec_gate_try() - take a place if one is free and no caller waits for it
 * @g: gate
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether a place was taken.
 */
bool ec_gate_try(struct ec_gate *g)
{
	unsigned long flags;
	bool in;

	raw_spin_lock_irqsave(&g->lock, flags);
	in = enter_now(g);
	raw_spin_unlock_irqrestore(&g->lock, flags);
	return in;
}

/**
 * ec_gate_enter() - take a place, wait for it in the queue
 * @g: gate
 * @timeout_ms: how long
 *
 * Context: Process. May sleep.
 * Return: 0, -EINTR when the caller is killed, -EBUSY after @timeout_ms.
 */
int ec_gate_enter(struct ec_gate *g, unsigned int timeout_ms)
{
	struct waiter w = { .task = current };
	long left = msecs_to_jiffies(timeout_ms);
	unsigned long flags;
	int ret = 0;

	raw_spin_lock_irqsave(&g->lock, flags);
	if (enter_now(g))
		goto out;
	list_add_tail(&w.list, &g->waiting);
	while (!w.in) {
		if (fatal_signal_pending(current) || left <= 0) {
			ret = left > 0 ? -EINTR : -EBUSY;
			list_del(&w.list);
			break;
		}
		__set_current_state(TASK_KILLABLE);
		raw_spin_unlock_irqrestore(&g->lock, flags);
		left = schedule_timeout(left);
		raw_spin_lock_irqsave(&g->lock, flags);
	}
out:
	raw_spin_unlock_irqrestore(&g->lock, flags);
	return ret;
}

/**
 * ec_gate_leave() - give a place back
 * @g: gate
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_gate_leave(struct ec_gate *g)
{
	unsigned long flags;

	raw_spin_lock_irqsave(&g->lock, flags);
	WRITE_ONCE(g->used, g->used - 1);
	admit(g);
	raw_spin_unlock_irqrestore(&g->lock, flags);
}
