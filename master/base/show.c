// SPDX-License-Identifier: GPL-2.0-only
#include <linux/preempt.h>
#include <linux/processor.h>
#include <linux/sched/signal.h>
#include "show.h"

/**
 * ec_show_init() - no readers, no change
 * @show: zeroed structure
 *
 * Context: Any.
 */
void ec_show_init(struct ec_show *show)
{
	init_waitqueue_head(&show->over);
}

static bool show_enter(struct ec_show *show)
{
	if (atomic_read(&show->changing))
		return false;
	preempt_disable();
	atomic_inc(&show->showing);
	/* either the change sees this reader, or this reader sees the change */
	smp_mb__after_atomic();
	if (!atomic_read_acquire(&show->changing))
		return true;
	atomic_dec(&show->showing);
	preempt_enable();
	return false;
}

/**
 * ec_show_begin() - read session and slaves, which do not change meanwhile
 * @show: of the master
 *
 * What is in the section must not sleep and takes some microseconds at most.
 *
 * Context: Process. Sleeps while a change is in progress. Preemption is off when 0
 * is returned.
 * Return: 0, then ec_show_end() must follow; -ERESTARTSYS a signal.
 */
int ec_show_begin(struct ec_show *show)
{
	int ret = 0;

	while (!ret && !show_enter(show))
		ret = wait_event_interruptible(show->over, !atomic_read(&show->changing));
	return ret;
}

/**
 * ec_show_end() - end of the section
 * @show: of the master
 *
 * Context: After ec_show_begin().
 */
void ec_show_end(struct ec_show *show)
{
	lockdep_assert(ec_show_begun(show));
	atomic_dec_return_release(&show->showing);
	preempt_enable();
}

/**
 * ec_show_pause() - leave the section for a moment
 * @show: of the master
 *
 * For what takes longer than some microseconds.
 *
 * Context: After ec_show_begin().
 * Return: 0: what was found is still valid, the section continues; else the section
 * has ended: -EAGAIN begin again, -ERESTARTSYS a signal.
 */
int ec_show_pause(struct ec_show *show)
{
	int ret, seen = atomic_read(&show->changes);

	lockdep_assert(ec_show_begun(show));
	ec_show_end(show);
	ret = ec_show_begin(show);
	if (ret || atomic_read(&show->changes) == seen)
		return ret;
	ec_show_end(show);
	return -EAGAIN;
}

/**
 * ec_show_change_announce() - readers that come now wait outside
 * @show: of the master
 *
 * The first half of ec_show_change_begin().
 *
 * Context: Any.
 */
void ec_show_change_announce(struct ec_show *show)
{
	atomic_inc(&show->changing);
	/* pairs with show_enter() */
	smp_mb__after_atomic();
}

/**
 * ec_show_change_begin() - wait for the readers before a change of session or slaves
 * @show: of the master
 *
 * The caller has the lock of what it changes: session lock, or topo for writing. Waits for
 * readers that are in a section now: no longer than one section takes, as they cannot be
 * preempted.
 *
 * Context: Process.
 */
void ec_show_change_begin(struct ec_show *show)
{
	ec_show_change_announce(show);
	while (atomic_read_acquire(&show->showing))
		cpu_relax();
}

/**
 * ec_show_change_end() - readers may look again
 * @show: of the master
 *
 * Context: Process, after ec_show_change_begin().
 */
void ec_show_change_end(struct ec_show *show)
{
	lockdep_assert(atomic_read(&show->changing) > 0);
	/*
	 * Not when it begins: it may have been waiting for a section that pauses now, and
	 * must not be taken for a change that was over before that section.
	 */
	atomic_inc(&show->changes);
	if (!atomic_dec_return_release(&show->changing) && wq_has_sleeper(&show->over))
		wake_up_all(&show->over);
}
