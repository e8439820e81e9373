// SPDX-License-Identifier: GPL-2.0-only
/* The application waits for the cycle that the kernel runs. */
#include <linux/hrtimer.h>
#include <linux/rcupdate.h>
#include <linux/sched/signal.h>
#include "../base/once64.h"
#include "cycle_run.h"
#include "cycle_wait.h"
#include "waiters.h"

/* The cycle that the kernel runs for @owner, or NULL. RCU read side. */
static const struct ec_cycle *owned_by(const struct ec_cycles *cycles, const void *owner)
{
	const struct ec_cycle *c = rcu_dereference(cycles->by_kernel);

	return c && READ_ONCE(c->owner) == owner ? c : NULL;
}

/**
 * ec_cycle_thread_poll() - has the cycle new inputs for the application?
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

/* what a caller of ec_cycle_thread_wait() waits for */
struct wanted {
	const struct ec_cycles *cycles;
	const void *owner;
	u64 cycle;	/* a newer one */
	u32 run;	/* of this run */
};

static bool cycle_wait_is_over(const struct wanted *w)
{
	return !(w->run & 1) || READ_ONCE(w->cycles->run) != w->run ||
	       READ_ONCE(w->cycles->owner) != w->owner;
}

/*
 * Not by a wait queue: under PREEMPT_RT a hard interrupt cannot wake one. Returns 0,
 * -ETIMEDOUT or -ERESTARTNOHAND.
 */
static int cycle_wait_sleep(const struct wanted *w, u32 timeout_us)
{
	ktime_t until = timeout_us ? ktime_add_us(ktime_get(), timeout_us) : KTIME_MAX;
	bool expired = false;
	int ret = 0;

	while (1) {
		set_current_state(TASK_INTERRUPTIBLE);
		if (cycle_wait_is_over(w) || ec_read64(&w->cycles->number) > w->cycle)
			break;
		/* a signal handler runs first, and ends it; kthread_stop() in the same way */
		ret = expired ? -ETIMEDOUT : signal_pending(current) ? -ERESTARTNOHAND : 0;
		if (ret)
			break;
		expired = !schedule_hrtimeout(timeout_us ? &until : NULL, HRTIMER_MODE_ABS);
	}
	__set_current_state(TASK_RUNNING);
	return ret;
}

/**
 * ec_cycle_thread_wait() - wait for the next cycle
 * @cycles: of the master
 * @owner: open file that asks
 * @w: its callers
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
	struct wanted wanted = { .cycles = cycles, .owner = owner, .cycle = *cycle };
	struct ec_sleeper me;
	bool ours;
	int ret;

	rcu_read_lock();
	ours = owned_by(cycles, owner);
	wanted.run = READ_ONCE(cycles->run);
	rcu_read_unlock();
	if (!ours)
		return -EPERM;
	if (!ec_waiters_join(w, &me))
		return -EBUSY;
	ret = cycle_wait_sleep(&wanted, timeout_us);
	ec_waiters_part(w, &me);
	if (ret)
		return ret;
	if (cycle_wait_is_over(&wanted))
		return -ECANCELED;
	*cycle = ec_read64(&cycles->number);
	return 0;
}
