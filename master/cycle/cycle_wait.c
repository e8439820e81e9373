// SPDX-License-Identifier: GPL-2.0-only
/* The application waits for the cycle that the kernel runs. */
#include <linux/rcupdate.h>
#include <linux/wait.h>
#include "../base/once64.h"
#include "cycle_run.h"
#include "cycle_thread.h"
#include "waiters.h"

/* The cycle that the kernel runs for @owner, or NULL. RCU read side. */
static const struct ec_cycle *owned_by(const struct ec_cycles *cycles, const void *owner)
{
	const struct ec_cycle *c = rcu_dereference(cycles->by_kernel);

	return c && READ_ONCE(c->owner) == owner ? c : NULL;
}

/**
 * ec_cycle_thread_poll() - are there new inputs for the application?
 * @cycles: of the master
 * @owner: open file that asks
 *
 * Context: Any. Takes no lock.
 * Return: EPOLLIN: inputs that the application has not taken; EPOLLHUP: the cycle has
 * stopped; EPOLLERR: the kernel runs no cycle for @owner.
 */
__poll_t ec_cycle_thread_poll(const struct ec_cycles *cycles, const void *owner)
{
	const struct ec_cycle *c;
	__poll_t mask = EPOLLERR;

	rcu_read_lock();
	c = owned_by(cycles, owner);
	if (c) {
		mask = 0;
		if (READ_ONCE(ec_cycle_run_exchange(c->thread)->inputs) & EC_EXCHANGE_NEW)
			mask |= EPOLLIN | EPOLLRDNORM;
		if (READ_ONCE(ec_cycle_run_status(c->thread)->state) == EC_CYCLE_STATE_STOPPED)
			mask |= EPOLLHUP;
	}
	rcu_read_unlock();
	return mask;
}

/**
 * ec_cycle_thread_wait() - wait for the next cycle
 * @cycles: of the master
 * @owner: open file that asks
 * @w: its wait queue
 * @cycle: in: the last cycle the caller has seen; out: a newer one
 * @timeout_us: limit, 0: none
 *
 * Context: Process. Sleeps; nothing of the cycle is touched, so it may end.
 * Return: 0; -EPERM the kernel runs no cycle for @owner; -ETIMEDOUT; -ERESTARTNOHAND a
 * signal or kthread_stop(); -ECANCELED the cycle has stopped or changed its owner; -EBUSY too
 * many callers wait.
 */
int ec_cycle_thread_wait(struct ec_cycles *cycles, const void *owner, struct ec_waiters *w,
			 u64 *cycle, u32 timeout_us)
{
	ktime_t limit = timeout_us ? ns_to_ktime((u64)timeout_us * NSEC_PER_USEC) : KTIME_MAX;
	bool ours;
	u32 run;
	int ret;

	rcu_read_lock();
	ours = owned_by(cycles, owner);
	run = READ_ONCE(cycles->run);
	rcu_read_unlock();
	if (!ours)
		return -EPERM;
	if (!ec_waiters_enter(w))
		return -EBUSY;
	ret = wait_event_interruptible_hrtimeout(w->wq,
						 READ_ONCE(cycles->run) != run || !(run & 1) ||
						 READ_ONCE(cycles->owner) != owner ||
						 ec_read64(&cycles->number) > *cycle, limit);
	ec_waiters_leave(w);
	if (ret == -ETIME)
		return -ETIMEDOUT;
	/* a signal handler runs first, and ends it; kthread_stop() ends the wait in the same way */
	if (ret)
		return -ERESTARTNOHAND;
	if (!(run & 1) || READ_ONCE(cycles->run) != run || READ_ONCE(cycles->owner) != owner)
		return -ECANCELED;
	if (ec_read64(&cycles->number) <= *cycle)
		return -ERESTARTNOHAND;
	*cycle = ec_read64(&cycles->number);
	return 0;
}
