// SPDX-License-Identifier: GPL-2.0-only
#include <linux/delay.h>
#include "../master.h"
#include "session.h"

#define WAIT_US	100	/* between two attempts to get session_lock */
#define TRIES	20

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
	ec_change_begin(&m->base->show);
}

/**
 * ec_session_unlock() - release session_lock after ec_session_lock()
 * @m: master
 *
 * Context: Process.
 */
void ec_session_unlock(struct ec_master *m)
{
	ec_change_end(&m->base->show);
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
