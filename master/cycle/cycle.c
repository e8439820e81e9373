// SPDX-License-Identifier: GPL-2.0-only
/* Cycles of a master: which one runs, and for whom. */
#include <linux/mm.h>
#include <linux/rcupdate.h>
#include "cycle.h"
#include "waiters.h"

/**
 * ec_cycles_init() - no cycle runs
 * @cycles: of a master, zeroed
 * @base: name and log
 * @carry: what others send beside the cycle, with the way to the slaves
 * @riders: datagrams in its frames
 * @dc: distributed clocks
 *
 * Context: Any.
 */
void ec_cycles_init(struct ec_cycles *cycles, struct ec_base *base, struct ec_carry *carry,
		    struct ec_riders *riders, struct ec_dc *dc)
{
	cycles->base = base;
	cycles->links = carry->links;
	cycles->carry = carry;
	cycles->riders = riders;
	cycles->dc = dc;
	mutex_init(&cycles->lock);
}

/**
 * ec_cycle_init() - the cycle of an application that has just reserved a master
 * @c: zeroed
 * @cycles: of the master
 * @wanted: its slave configurations and domains
 *
 * Context: Any.
 */
void ec_cycle_init(struct ec_cycle *c, struct ec_cycles *cycles, struct ec_wanted *wanted)
{
	c->cycles = cycles;
	c->base = cycles->base;
	c->links = cycles->links;
	c->carry = cycles->carry;
	c->riders = cycles->riders;
	c->dc = cycles->dc;
	c->wanted = wanted;
	c->late_per_s = EC_LATE_PER_S;
}

/**
 * ec_cycle_clear() - forget the settings of an application
 * @c: not active
 *
 * Context: Process; no other caller uses @c. May sleep.
 */
void ec_cycle_clear(struct ec_cycle *c)
{
	kvfree(c->copies);
	c->copies = NULL;
	c->n_copies = 0;
	c->late_per_s = EC_LATE_PER_S;
	memset(&c->kernel, 0, sizeof(c->kernel));
	c->priority = 0;
	c->may_interrupt = false;
	c->place = EC_CYCLE_PLACE_THREAD;
	c->cpu_lost = false;
	c->cpu_losses = 0;
}

/**
 * ec_cycle_set_active() - a cycle may be run from now on, or none
 * @cycles: of the master
 * @c: cycle with a layout, or NULL: the cyclic caller has left when this returns
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_set_active(struct ec_cycles *cycles, struct ec_cycle *c)
{
	ec_cycle_assert_held(c ?: cycles->active);
	mutex_lock(&cycles->lock);
	WRITE_ONCE(cycles->active, c);
	WRITE_ONCE(cycles->owner, c ? c->owner : NULL);
	mutex_unlock(&cycles->lock);
}

/**
 * ec_cycle_set_owner() - the active cycle changes hands
 * @c: active
 * @owner: open file, or NULL
 * @waiters: wait queue of that file, or NULL
 *
 * Context: Process, lock of the configuration held. May sleep.
 */
void ec_cycle_set_owner(struct ec_cycle *c, const void *owner, struct ec_waiters *waiters)
{
	struct ec_waiters *before = rcu_dereference_protected(c->waiters,
							      lockdep_is_held(c->wanted->lock));

	mutex_lock(&c->cycles->lock);
	WRITE_ONCE(c->owner, owner);
	rcu_assign_pointer(c->waiters, waiters);
	WRITE_ONCE(c->cycles->owner, owner);
	mutex_unlock(&c->cycles->lock);
	/* no cycle wakes them any more */
	if (before)
		ec_waiters_wake(before);
}

/* Applications that look at working counters only must see it as well. */
static void nothing_back(struct ec_cycle *c)
{
	struct ec_status *st = c->shared->status;
	unsigned int i;

	for (i = 0; i < c->wanted->n_domains; i++) {
		WRITE_ONCE(st->domains[i].working_counter, 0);
		WRITE_ONCE(st->domains[i].wc_state, EC_STATUS_WC_ZERO);
	}
	WRITE_ONCE(st->dc_time_valid, 0);
	WRITE_ONCE(st->dc_time64_valid, 0);
	WRITE_ONCE(st->dc_monitor, ~0u);
}

/**
 * ec_cycles_nothing_back() - the device was detached: no frame on its way will return
 * @cycles: of the master
 *
 * Context: Process. May sleep.
 */
void ec_cycles_nothing_back(struct ec_cycles *cycles)
{
	mutex_lock(&cycles->lock);
	if (cycles->active)
		nothing_back(cycles->active);
	mutex_unlock(&cycles->lock);
}
