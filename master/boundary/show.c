// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include <linux/preempt.h>
#include <linux/processor.h>
#include <linux/sched/signal.h>
#include "../master.h"
#include "show.h"

#define WAIT_US	100	/* between two looks whether a change is over */
#define TRIES	20	/* to get session_lock, that far apart */

static bool enter(struct ec_show *show)
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
 * ec_show_begin() - look at session and slaves, which stay as they are
 * @m: master
 *
 * What is in the section must not sleep and takes some microseconds at most.
 *
 * Context: Process. Sleeps while a change is in progress. Preemption is off when 0
 * is returned.
 * Return: 0, then ec_show_end() must follow; -ERESTARTSYS a signal.
 */
int ec_show_begin(struct ec_master *m)
{
	while (!enter(&m->show)) {
		if (signal_pending(current))
			return -ERESTARTSYS;
		usleep_range(WAIT_US, 2 * WAIT_US);
	}
	return 0;
}

/**
 * ec_show_end() - end of the section
 * @m: master
 *
 * Context: After ec_show_begin().
 */
void ec_show_end(struct ec_master *m)
{
	lockdep_assert(atomic_read(&m->show.showing) > 0);
	atomic_dec_return_release(&m->show.showing);
	preempt_enable();
}

/**
 * ec_show_pause() - leave the section for a moment
 * @m: master
 *
 * For what takes longer than some microseconds.
 *
 * Context: After ec_show_begin().
 * Return: 0: what was found is still there, the section goes on; else the section
 * has ended: -EAGAIN begin anew, -ERESTARTSYS a signal.
 */
int ec_show_pause(struct ec_master *m)
{
	int ret, seen = atomic_read(&m->show.changes);

	ec_show_end(m);
	ret = ec_show_begin(m);
	if (ret || atomic_read(&m->show.changes) == seen)
		return ret;
	ec_show_end(m);
	return -EAGAIN;
}

/**
 * ec_change_announce() - readers that come now wait outside
 * @m: master; its session_lock or topo is held
 *
 * The first half of ec_change_begin().
 *
 * Context: Any.
 */
void ec_change_announce(struct ec_master *m)
{
	atomic_inc(&m->show.changing);
	/* pairs with enter() */
	smp_mb__after_atomic();
}

/**
 * ec_change_begin() - what readers look at is about to change
 * @m: master; its session_lock or topo is held
 *
 * Waits for readers that are in a section now: no longer than one section takes, as
 * they cannot be preempted.
 *
 * Context: Process.
 */
void ec_change_begin(struct ec_master *m)
{
	ec_change_announce(m);
	while (atomic_read_acquire(&m->show.showing))
		cpu_relax();
}

/**
 * ec_change_end() - readers may look again
 * @m: master
 *
 * Context: Process, after ec_change_begin().
 */
void ec_change_end(struct ec_master *m)
{
	/*
	 * Not when it begins: it may have been waiting for a section that pauses now, and
	 * must not be taken for a change that was over before that section.
	 */
	atomic_inc(&m->show.changes);
	atomic_dec_return_release(&m->show.changing);
}

/**
 * ec_session_lock() - take session_lock to change what readers look at
 * @m: master
 *
 * Who changes nothing of that takes the mutex alone.
 *
 * Context: Process. May sleep.
 */
void ec_session_lock(struct ec_master *m)
{
	mutex_lock(&m->session_lock);
	ec_change_begin(m);
}

void ec_session_unlock(struct ec_master *m)
{
	ec_change_end(m);
	mutex_unlock(&m->session_lock);
}

/**
 * ec_session_trylock() - take session_lock, unless it is held for long
 * @m: master
 *
 * Commands hold it for a moment only; an activation may hold it for seconds.
 *
 * Context: The monitor thread. Sleeps for some milliseconds at most.
 * Return: true when it is held.
 */
bool ec_session_trylock(struct ec_master *m)
{
	unsigned int i;

	for (i = 0; i < TRIES; i++) {
		if (mutex_trylock(&m->session_lock))
			return true;
		usleep_range(WAIT_US, 2 * WAIT_US);
	}
	return false;
}
