// SPDX-License-Identifier: GPL-2.0-only
/* Cycles of a master: which one runs, and its owner. */
#include <linux/delay.h>
#include <linux/ktime.h>
#include <linux/mm.h>
#include <linux/rcupdate.h>
#include "../config/domain.h"
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
	c->setup.late_per_s = EC_LATE_PER_S;
}

/**
 * ec_cycle_clear() - forget the settings of an application
 * @c: not active
 *
 * Context: Process; no other caller uses @c. May sleep.
 */
void ec_cycle_clear(struct ec_cycle *c)
{
	kvfree(c->setup.copies.list);
	c->setup = (struct ec_cycle_setup){ .late_per_s = EC_LATE_PER_S };
	c->watch = (struct ec_cycle_watch){ };
	c->place = EC_CYCLE_PLACE_THREAD;
}

/**
 * ec_cycle_layout() - lay out the datagrams of a cycle and prepare its parts, once
 * @c: cycle whose domains have offsets, with @shared; ec_cycle_free() must follow, also after an
 *	error
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -EOVERFLOW and -ENOMEM as ec_layout_make().
 */
int ec_cycle_layout(struct ec_cycle *c)
{
	int ret;

	lockdep_assert_held(c->wanted->lock);
	ret = ec_layout_make(&c->layout, c->wanted, c->links->max_datagrams, c->shared->image_size);
	if (ret)
		return ret;
	ec_for_each_domain(d, c->wanted)
		c->domains[d->index] = (struct ec_cyc_domain){
			.expected = d->expected, .max_age = d->max_age,
			/* offsets count from the image of all domains; a thread exchanges that */
			.image = d->memory && !c->setup.kernel.period_ns ? d->memory - d->offset :
									   c->shared->image,
		};
	c->clock = (struct ec_dc_datagrams){
		.dc = c->dc, .access = &c->links->access, .clocked_ns = c->layout.clocked.ns,
	};
	c->late = (struct ec_late){ .status = c->shared->status, .access = &c->links->access };
	return ec_copy_begin(&c->setup.copies, c->wanted, &c->copying);
}

/* Cancel the frames in flight: their replies will not be received. */
static void forget_flights(struct ec_cycle *c)
{
	unsigned int i;

	for (i = 0; i < c->n_flight; i++) {
		struct ec_slot *slot = c->flight[i].slot;

		while (!ec_slot_cancel(slot, ktime_get_ns())) {
			if (atomic_read_acquire(&slot->state) == EC_SLOT_DONE) {
				ec_slot_put(slot);
				break;
			}
			/* being copied at this moment */
			usleep_range(20, 50);
		}
	}
	c->n_flight = 0;
}

/**
 * ec_cycle_free() - free what a layout and its frames occupy
 * @c: cycle that does not run any more, whose units are freed
 *
 * Context: Process. May sleep.
 */
void ec_cycle_free(struct ec_cycle *c)
{
	forget_flights(c);
	ec_layout_free(&c->layout);
	kvfree(c->copying);
	memset_startat(c, 0, layout);
}

/**
 * ec_cycle_set_active() - a cycle may be run from now on, or none
 * @cycles: of the master
 * @c: cycle with a layout, or NULL: the cycle owner has left when this returns
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
 * ec_cycle_set_owner() - change the owner of the active cycle
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

/* Also for applications that check nothing but working counters. */
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
 * ec_cycles_nothing_back() - the device was detached: no frame in flight will be received
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
