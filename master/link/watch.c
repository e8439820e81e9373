// SPDX-License-Identifier: GPL-2.0-only
/*
 * Drivers do not report at once that a link is down, so callers that wait for frames look
 * at it. Of many only the first one looks often: a timer for each of them would cost more
 * than their frames. A caller that leaves wakes the next one, so that the loss of the link
 * reaches all of them at once. The cycle has no part in this.
 */
#include <linux/hrtimer.h>
#include <linux/minmax.h>
#include <linux/swait.h>
#include "watch.h"

#define FIRST_US	1000	/* between two looks of the first caller */
#define OTHERS_US	10000	/* and of the others, whether their frames have left */

/**
 * ec_watch_begin() - a caller is about to wait for frames
 * @g: callers of the link
 * @me: the caller; ec_watch_end() must follow
 *
 * Context: Process.
 */
void ec_watch_begin(struct ec_gate *g, struct ec_watcher *me)
{
	unsigned long flags;

	me->task = current;
	raw_spin_lock_irqsave(&g->lock, flags);
	list_add_tail(&me->list, &g->watching);
	raw_spin_unlock_irqrestore(&g->lock, flags);
}

static bool is_first(struct ec_gate *g, const struct ec_watcher *me)
{
	unsigned long flags;
	bool first;

	raw_spin_lock_irqsave(&g->lock, flags);
	first = list_first_entry(&g->watching, struct ec_watcher, list) == me;
	raw_spin_unlock_irqrestore(&g->lock, flags);
	return first;
}

/**
 * ec_watch_end() - a caller waits no longer; another one becomes the first
 * @g: callers of the link
 * @me: the caller
 *
 * Context: Process.
 */
void ec_watch_end(struct ec_gate *g, struct ec_watcher *me)
{
	unsigned long flags;
	bool first;

	raw_spin_lock_irqsave(&g->lock, flags);
	first = list_first_entry(&g->watching, struct ec_watcher, list) == me;
	list_del(&me->list);
	/* that one leaves only after it has had the lock */
	if (first && !list_empty(&g->watching))
		wake_up_process(list_first_entry(&g->watching, struct ec_watcher, list)->task);
	raw_spin_unlock_irqrestore(&g->lock, flags);
}

/**
 * ec_watch_wait() - wait until it is time to look at the link
 * @g: callers of the link
 * @me: the caller
 * @done: what it waits for
 * @us: at most, microseconds
 *
 * Context: Process, after ec_watch_begin(). Sleeps.
 * Return: true: @done is complete, and taken.
 */
bool ec_watch_wait(struct ec_gate *g, const struct ec_watcher *me, struct completion *done,
		   unsigned int us)
{
	DECLARE_SWAITQUEUE(wait);
	ktime_t limit;

	prepare_to_swait_exclusive(&done->wait, &wait, TASK_UNINTERRUPTIBLE);
	/* who becomes the first one from now on is woken */
	us = min_t(unsigned int, us, is_first(g, me) ? FIRST_US : OTHERS_US);
	limit = ns_to_ktime((u64)us * NSEC_PER_USEC);
	if (!completion_done(done))
		schedule_hrtimeout(&limit, HRTIMER_MODE_REL);
	finish_swait(&done->wait, &wait);
	return try_wait_for_completion(done);
}
