// SPDX-License-Identifier: GPL-2.0-only
/* Callers of a mailbox that sleep until they have their result, or their time is over. */
#include <linux/hrtimer.h>
#include <linux/sched/signal.h>
#include "caller.h"
#include "desk_enter.h"

#define SLICE_MS	20	/* between two checks whether a wait has to end */

/**
 * ec_mbox_over() - why a wait has to end now
 * @mb: mailbox of the slave
 * @u: its limit
 *
 * Context: Process.
 * Return: 0: it continues; -ECANCELED, -EINTR, -ETIMEDOUT.
 */
int ec_mbox_over(const struct ec_mbox *mb, const struct ec_mbox_until *u)
{
	if (ec_stop_all(mb->stop) || ec_stop_interrupted(mb->stop) ||
	    (u->cancel && READ_ONCE(*u->cancel)))
		return -ECANCELED;
	if (signal_pending(current))
		return -EINTR;
	return ktime_get_ns() > u->ns ? -ETIMEDOUT : 0;
}

/**
 * ec_mbox_sleep() - sleep until something may have changed
 * @mb: mailbox of the slave
 * @state: has the value @end when the wait is over; wake_up_process() follows
 * @end: value
 * @u: limit of the wait
 *
 * struct ec_stop.wake wakes the caller as well. A flag that another thread sets is seen after
 * 20 ms at most.
 *
 * Context: Process. May sleep.
 */
void ec_mbox_sleep(const struct ec_mbox *mb, const u8 *state, u8 end,
		   const struct ec_mbox_until *u)
{
	u64 slice = ktime_get_ns() + SLICE_MS * NSEC_PER_MSEC;
	/* one more nanosecond, since ec_mbox_over() compares by > */
	ktime_t at = ns_to_ktime(min(slice, u->ns + 1));
	wait_queue_head_t *wq = &mb->stop->wake;
	DEFINE_WAIT(wait);

	prepare_to_wait(wq, &wait, TASK_INTERRUPTIBLE);
	/* pairs with the release of the result */
	if (smp_load_acquire(state) != end && !ec_mbox_over(mb, u))
		schedule_hrtimeout(&at, HRTIMER_MODE_ABS);
	finish_wait(wq, &wait);
}

static void caller_wake(struct ec_mbox *mb, struct ec_mbox_user *u)
{
	wake_up_process(container_of(u, struct ec_caller, user)->task);
}

/**
 * ec_caller_enter() - the present thread has a message for the slave, or waits for one
 * @mb: mailbox of the slave, with memory
 * @c: its @user has what it wants; ec_desk_leave() follows
 *
 * Context: Process.
 */
void ec_caller_enter(struct ec_mbox *mb, struct ec_caller *c)
{
	c->task = current;
	c->user.done = caller_wake;
	ec_desk_enter(mb, &c->user);
}

/**
 * ec_caller_wait() - sleep until a user is DONE
 * @mb: mailbox of the slave
 * @c: caller that has entered
 * @limit: begins when its message has its turn
 * @until: result: when @limit is over
 *
 * Context: Process. May sleep.
 * Return: 0, or why it is not: as ec_mbox_over().
 */
int ec_caller_wait(struct ec_mbox *mb, struct ec_caller *c, const struct ec_mbox_limit *limit,
		   struct ec_mbox_until *until)
{
	const u8 *phase = &c->user.phase;
	int ret;

	for (;;) {
		if (READ_ONCE(*phase) == EC_MBOX_USER_QUEUED)
			*until = ec_mbox_until(limit);
		ret = ec_mbox_over(mb, until);
		/* pairs with desk_finish(): the result is complete */
		if (smp_load_acquire(phase) == EC_MBOX_USER_DONE)
			return ret == -ETIMEDOUT ? 0 : ret;
		if (ret)
			return ret;
		ec_mbox_sleep(mb, phase, EC_MBOX_USER_DONE, until);
	}
}
