// SPDX-License-Identifier: GPL-2.0-only
/*
 * The cycle in the interrupt of its timer, for devices that need no thread. The thread of the
 * cycle sleeps meanwhile. At any time one of both has the cycle: the thread gives it to the timer,
 * and an interrupt that cannot continue gives it back, since only a thread may sleep.
 */
#include <linux/kthread.h>
#include <linux/panic_notifier.h>
#include <linux/sched.h>
#include <linux/smp.h>
#include "../kernel/compat.h"
#include "cycle_timer.h"

#define LONG_CYCLES	1000	/* in the thread, after an interrupt that took too long */
#define LONG_NS		NSEC_PER_MSEC	/* more than that, or half of the period, is too long */
#define TIGHT_CYCLES	4	/* that many in a row may end in the second half of their period */

/*
 * Enter the links if the cycle may run in an interrupt of this CPU, and return
 * EC_CYCLE_PLACE_INTERRUPT. With all other places the cycle runs in the thread.
 */
static u32 cycle_timer_enter(const struct ec_cycle_thread *t)
{
	struct ec_cycle *c = t->cycle;

	if (!READ_ONCE(c->setup.may_interrupt))
		return EC_CYCLE_PLACE_RIGHT;
	if (c->setup.kernel.cpu >= 0 && c->setup.kernel.cpu != raw_smp_processor_id())
		return EC_CYCLE_PLACE_CPU;
	if (t->in_thread)
		return EC_CYCLE_PLACE_LONG;
	/* the console may be slow */
	if (unlikely(READ_ONCE(c->base->debug) >= 2))
		return EC_CYCLE_PLACE_DEBUG;
	if (ec_cycle_run_status(t)->state > EC_CYCLE_STATE_STALLED ||
	    !ec_links_attached(c->links) || ec_access_try_enter(c->links))
		return EC_CYCLE_PLACE_QUIET;
	if (!ec_links_need_thread(c->links))
		return EC_CYCLE_PLACE_INTERRUPT;
	ec_links_leave(c->links);
	return EC_CYCLE_PLACE_DEVICE;
}

/* For readers, and for the log of the monitor. */
static void note_place(struct ec_cycle *c, u32 place)
{
	WRITE_ONCE(c->place, place);
	WRITE_ONCE(c->places, c->places | BIT(place));
}

/*
 * Does the interrupt leave time to the threads of its CPU? If it and other interrupts take all
 * of the time, each cycle begins later than the previous one.
 */
static bool leaves_time(struct ec_cycle_thread *t, u64 due)
{
	u32 half = t->cycle->setup.kernel.period_ns / 2;

	/* against its due time: a cycle that began after its period has skipped others */
	t->tight = t->end_ns > due + half ? t->tight + 1 : 0;
	return ec_cycle_run_status(t)->work_ns <= min_t(u32, half, LONG_NS) &&
	       t->tight < TIGHT_CYCLES;
}

/* The thread has the cycle from now on; @place says why. */
static enum hrtimer_restart give_back(struct ec_cycle_thread *t, u32 place)
{
	note_place(t->cycle, place);
	/* all that the interrupt has done; pairs with ec_cycle_timer_run() */
	smp_store_release(&t->timed, false);
	wake_up_process(t->task);	/* it waits for the end of this function */
	return HRTIMER_NORESTART;
}

static enum hrtimer_restart tick(struct hrtimer *timer)
{
	struct ec_cycle_thread *t = container_of(timer, struct ec_cycle_thread, timer);
	u64 due = t->next_ns;
	u32 place;

	/* if timers continue after a panic, outputs would never end */
	if (unlikely(READ_ONCE(t->stopped)))
		return HRTIMER_NORESTART;
	place = cycle_timer_enter(t);
	if (unlikely(place != EC_CYCLE_PLACE_INTERRUPT))
		return give_back(t, place);
	t->ended = !ec_cycle_run_once(t, true);
	ec_links_leave(t->cycle->links);
	if (unlikely(t->ended))
		return give_back(t, EC_CYCLE_PLACE_QUIET);
	if (unlikely(!leaves_time(t, due))) {
		t->in_thread = LONG_CYCLES;
		return give_back(t, EC_CYCLE_PLACE_LONG);
	}
	hrtimer_set_expires(timer, ns_to_ktime(t->next_ns));
	return HRTIMER_RESTART;
}

static int on_panic(struct notifier_block *nb, unsigned long event, void *data)
{
	struct ec_cycle_thread *t = container_of(nb, struct ec_cycle_thread, panic);

	WRITE_ONCE(t->stopped, true);
	return NOTIFY_DONE;
}

/**
 * ec_cycle_timer_init() - prepare the timer of a cycle
 * @t: cycle; ec_cycle_timer_exit() must follow
 *
 * Context: Any.
 */
void ec_cycle_timer_init(struct ec_cycle_thread *t)
{
	hrtimer_setup(&t->timer, tick, CLOCK_MONOTONIC, HRTIMER_MODE_ABS_PINNED_HARD);
	t->panic.notifier_call = on_panic;
	if (t->cycle->setup.kernel.flags & EC_CYCLE_FLAG_INTERRUPT)
		atomic_notifier_chain_register(&panic_notifier_list, &t->panic);
}

/**
 * ec_cycle_timer_exit() - end of the timer of a cycle
 * @t: cycle whose thread has ended
 *
 * Context: Process. May sleep.
 */
void ec_cycle_timer_exit(struct ec_cycle_thread *t)
{
	if (t->cycle->setup.kernel.flags & EC_CYCLE_FLAG_INTERRUPT)
		atomic_notifier_chain_unregister(&panic_notifier_list, &t->panic);
}

static void wake_polled(struct ec_cycle_thread *t)
{
	if (!READ_ONCE(t->polled))
		return;
	WRITE_ONCE(t->polled, false);
	ec_cycle_run_wake(t->cycle, false);
}

/* Sleep until the interrupt gives the cycle back, or the thread has to end. */
static void wait_for_cycle(struct ec_cycle_thread *t)
{
	while (1) {
		set_current_state(TASK_IDLE);
		/* pairs with give_back() */
		if (!smp_load_acquire(&t->timed) || kthread_should_stop())
			break;
		if (!READ_ONCE(t->polled)) {
			schedule();
			continue;
		}
		__set_current_state(TASK_RUNNING);
		wake_polled(t);
	}
	__set_current_state(TASK_RUNNING);
}

/**
 * ec_cycle_timer_run() - run cycles in the interrupt of the timer while that is possible
 * @t: cycle; its schedule is that of the next cycle afterwards
 *
 * Returns at once when the next cycle has to run in the thread.
 *
 * Context: The cycle thread. Sleeps.
 * Return: false: the last cycle was run.
 */
bool ec_cycle_timer_run(struct ec_cycle_thread *t)
{
	u32 place;

	if (likely(!(t->cycle->setup.kernel.flags & EC_CYCLE_FLAG_INTERRUPT)))
		return true;
	place = cycle_timer_enter(t);
	note_place(t->cycle, place);
	if (t->in_thread)
		t->in_thread--;
	if (place != EC_CYCLE_PLACE_INTERRUPT)
		return true;
	ec_links_leave(t->cycle->links);
	t->tight = 0;
	t->timed = true;
	hrtimer_start(&t->timer, ns_to_ktime(t->next_ns), HRTIMER_MODE_ABS_PINNED_HARD);
	wait_for_cycle(t);
	hrtimer_cancel(&t->timer);
	wake_polled(t);	/* of the last cycle */
	return !t->ended;
}
