// SPDX-License-Identifier: GPL-2.0-only
#include <linux/slab.h>
#include "../link/links.h"
#include "bus.h"

#define WORKERS	64	/* at least */
#define SLAVES_PER_WORKER	16	/* while nothing is to be done */

/**
 * ec_bus_init() - no slaves yet
 * @bus: zeroed structure
 * @base: of the master
 * @links: way to the slaves
 * @ops: what the layer needs of higher ones; stays
 *
 * Context: Process. May sleep.
 * Return: 0 or -ENOMEM.
 */
int ec_bus_init(struct ec_bus *bus, struct ec_base *base, struct ec_links *links,
		const struct ec_bus_ops *ops)
{
	bus->base = base;
	bus->links = links;
	bus->ops = ops;
	init_rwsem(&bus->topo);
	spin_lock_init(&bus->scan_lock);
	mutex_init(&bus->begun_lock);
	init_waitqueue_head(&bus->settled);
	ec_known_init(&bus->known);
	ec_border_init(&bus->border);
	/* what one waits for is not done by another one */
	return ec_workers_init(&bus->workers, base);
}

/**
 * ec_bus_need_workers() - so many workers at once from now on, if they were less
 * @bus: bus
 * @n: workers
 *
 * A worker takes 33 KB. On the way to PREOP they wait for the wire, where one for every second
 * slave is as fast as one for each; on the way to OP for their slaves. One for 16 slaves stays.
 *
 * Context: Process.
 */
void ec_bus_need_workers(struct ec_bus *bus, unsigned int n)
{
	ec_workers_need(&bus->workers, max_t(unsigned int, n, WORKERS),
			DIV_ROUND_UP(READ_ONCE(bus->n_slaves), SLAVES_PER_WORKER));
}

/**
 * ec_bus_stop() - wait for all workers
 * @bus: bus; no worker is started any more
 *
 * Context: Process. May sleep.
 */
void ec_bus_stop(struct ec_bus *bus)
{
	ec_workers_exit(&bus->workers);
}

/**
 * ec_bus_settled() - a scan has ended, or a slave may have settled: waiters look
 * @bus: bus
 *
 * Context: Any.
 */
void ec_bus_settled(struct ec_bus *bus)
{
	/* a waiter that sees the new count sees what the caller has written */
	atomic_inc_return_release(&bus->settles);
	if (wq_has_sleeper(&bus->settled))
		wake_up_all(&bus->settled);
}

/**
 * ec_bus_scan_busy() - is the bus scanned, or about to be?
 * @bus: bus
 *
 * While the list of slaves is held, a scan that is due is not about to run.
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 * Return: whether it is.
 */
bool ec_bus_scan_busy(const struct ec_bus *bus)
{
	bool due = READ_ONCE(bus->rescan) || READ_ONCE(bus->due);

	/* in this order: a request disappears only after @scan_busy is set */
	smp_rmb();
	due |= READ_ONCE(bus->n_slaves) != READ_ONCE(bus->responding);
	return READ_ONCE(bus->scan_busy) || (due && !READ_ONCE(bus->held));
}

/**
 * ec_bus_begin_scan() - the monitor begins a scan, unless the list of slaves is held
 * @bus: bus
 *
 * Context: The monitor. It clears @bus->scan_busy at the end.
 * Return: whether the scan begins.
 */
bool ec_bus_begin_scan(struct ec_bus *bus)
{
	bool ok;

	spin_lock(&bus->scan_lock);
	ok = !bus->held;
	if (ok)
		WRITE_ONCE(bus->scan_busy, true);
	spin_unlock(&bus->scan_lock);
	return ok;
}

/**
 * ec_bus_hold() - hold the list of slaves: no scan changes it
 * @bus: bus
 * @always: also during a scan, whose result is thrown away
 *
 * Meanwhile the monitor counts slaves and notes which slaves of the list do not reply.
 *
 * Context: Process. May sleep. ec_bus_unhold() follows.
 * Return: false: a scan is in progress or due, wait for its end.
 */
bool ec_bus_hold(struct ec_bus *bus, bool always)
{
	bool ok;

	/* a scan that has ended already shows its result first */
	down_write(&bus->topo);
	spin_lock(&bus->scan_lock);
	ok = always || !ec_bus_scan_busy(bus);
	if (ok)
		WRITE_ONCE(bus->held, true);
	spin_unlock(&bus->scan_lock);
	up_write(&bus->topo);
	return ok;
}

/**
 * ec_bus_unhold() - the list of slaves may change again
 * @bus: bus
 *
 * A scan that is due begins with the next poll of the monitor; ec_bus_scan_busy() at once.
 *
 * Context: Process.
 */
void ec_bus_unhold(struct ec_bus *bus)
{
	WRITE_ONCE(bus->held, false);
}

/**
 * ec_bus_scan_progress() - how far the scan has come
 * @bus: bus
 * @index: result: slaves that have been read
 * @count: result: slaves that the scan will find; @index is less until it has
 *	ended, unless there are none
 *
 * Context: Any. RT-safe: bounded, no sleep, no allocation.
 */
void ec_bus_scan_progress(const struct ec_bus *bus, u32 *index, u32 *count)
{
	*count = READ_ONCE(bus->n_slaves);
	*index = *count;
	if (!ec_bus_scan_busy(bus))
		return;
	*count = READ_ONCE(bus->responding);
	*index = 0;
	if (!READ_ONCE(bus->scan_busy))
		return;
	smp_rmb();	/* written before */
	*count = READ_ONCE(bus->scan_slaves);
	/* what was read is yet to be shown to the others */
	if (*count)
		*index = min(READ_ONCE(bus->scan_index), *count - 1);
}

/**
 * ec_bus_rescan() - ask for a scan
 * @bus: bus
 *
 * Context: Process.
 */
void ec_bus_rescan(struct ec_bus *bus)
{
	WRITE_ONCE(bus->rescan, true);
	if (bus->ops && bus->ops->wake)
		bus->ops->wake(bus);
}
