// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include "sessions.h"
#include "../clock/dc.h"

#define WAIT_US	100	/* between two attempts to get the session lock */
#define TRIES	20

/**
 * ec_sessions_init() - prepare the sessions of a master, without an application
 * @ss: sessions of a master, zeroed but for the pointers to lower layers
 * @again: work that lets slaves that failed begin again, of @ss->again
 * @units: work that takes slaves where sync units want them, of @ss->units
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM; ec_sessions_exit() must follow both.
 */
int ec_sessions_init(struct ec_sessions *ss, work_func_t again, work_func_t units)
{
	mutex_init(&ss->lock);
	INIT_WORK(&ss->again, again);
	INIT_WORK(&ss->units, units);
	/* what a request waits for is in another queue, see ec_bus_init() */
	ss->lanes = alloc_workqueue("ethercat%u-req", WQ_UNBOUND, WQ_UNBOUND_MAX_ACTIVE,
				    ss->base->index);
	ss->service = alloc_workqueue("ethercat%u-srv", WQ_UNBOUND, 0, ss->base->index);
	return ss->lanes && ss->service ? 0 : -ENOMEM;
}

/**
 * ec_sessions_exit() - end the workers
 * @ss: sessions of a master; there are none
 *
 * Context: Process. May sleep.
 */
void ec_sessions_exit(struct ec_sessions *ss)
{
	/* service begins requests, and kicks slaves */
	if (ss->service)
		destroy_workqueue(ss->service);
	if (ss->lanes)
		destroy_workqueue(ss->lanes);
}

/**
 * ec_sessions_lock() - take the session lock to change what readers show
 * @ss: sessions of a master
 *
 * A caller that changes none of it takes the mutex alone.
 *
 * Context: Process. May sleep.
 */
void ec_sessions_lock(struct ec_sessions *ss)
{
	mutex_lock(&ss->lock);
	ec_show_change_begin(&ss->base->show);
}

/**
 * ec_sessions_unlock() - release the session lock after ec_sessions_lock()
 * @ss: sessions of a master
 *
 * Context: Process.
 */
void ec_sessions_unlock(struct ec_sessions *ss)
{
	ec_show_change_end(&ss->base->show);
	mutex_unlock(&ss->lock);
}

/**
 * ec_sessions_pause() - let no application reserve the master
 * @ss: sessions of a master
 * @why: the reason, see struct ec_sessions @paused
 *
 * Context: Process. May sleep.
 * Return: 0, then ec_sessions_resume() must follow; -EBUSY when there is a session, also one
 * without application, or another caller has paused them.
 */
int ec_sessions_pause(struct ec_sessions *ss, const char *why)
{
	int ret = 0;

	mutex_lock(&ss->lock);
	if (ss->paused || ss->session || ss->candidate)
		ret = -EBUSY;
	else
		WRITE_ONCE(ss->paused, why);
	mutex_unlock(&ss->lock);
	return ret;
}

/**
 * ec_sessions_resume() - applications may reserve the master after ec_sessions_pause()
 * @ss: sessions of a master
 *
 * Context: Process. May sleep.
 */
void ec_sessions_resume(struct ec_sessions *ss)
{
	mutex_lock(&ss->lock);
	WRITE_ONCE(ss->paused, NULL);
	mutex_unlock(&ss->lock);
}

/**
 * ec_sessions_trylock() - take the session lock, unless another thread keeps it
 * @ss: sessions of a master
 *
 * Commands have it for a moment only; an activation may have it for seconds.
 *
 * Context: The monitor thread. Sleeps for some milliseconds at most.
 * Return: true: the caller has it.
 */
bool ec_sessions_trylock(struct ec_sessions *ss)
{
	unsigned int i;

	for (i = 0; i < TRIES; i++) {
		if (mutex_trylock(&ss->lock))
			return true;
		/* a mutex has no wait with a time limit */
		usleep_range(WAIT_US, 2 * WAIT_US);
	}
	return false;
}

/**
 * ec_sessions_forget_times() - forget time and interval of an application
 * @ss: sessions of a master
 *
 * Context: Process, session lock held. May sleep.
 */
void ec_sessions_forget_times(struct ec_sessions *ss)
{
	lockdep_assert_held(&ss->lock);
	ec_dc_end(ss->dc);
	WRITE_ONCE(ss->links->access.interval_us, EC_INTERVAL_US);
	ss->links->access.interval_set = false;
}
