// SPDX-License-Identifier: GPL-2.0-only
/* The list of slaves: one of it, all of it, and until they have settled. */
#include "bus_list.h"
#include "owed.h"
#include "ring_place.h"
#include "slave.h"
#include "../link/links.h"

/**
 * ec_bus_slave() - a slave by its ring position
 * @bus: bus
 * @position: ring position
 *
 * Context: Process. May sleep.
 * Return: the slave with a reference for the caller, or NULL.
 */
struct ec_slave *ec_bus_slave(struct ec_bus *bus, unsigned int position)
{
	struct ec_slave *s = NULL;

	down_read(&bus->topo);
	if (position < bus->n_slaves)
		s = ec_slave_ref(bus->slaves[position]);
	up_read(&bus->topo);
	return s;
}

/* Its worker is idle, and its PDOs were read, or tried; or it was disconnected. */
static bool slave_settled(struct ec_slave *s)
{
	return READ_ONCE(s->stop.gone) ||
	       (!ec_slave_busy(s) && (READ_ONCE(s->pdos.known) || !ec_slave_pdos_pending(s)));
}

static bool slaves_settled(struct ec_bus *bus)
{
	bool ok = true;

	down_read(&bus->topo);
	ec_for_each_slave(s, bus)
		ok = ok && slave_settled(s);
	up_read(&bus->topo);
	return ok;
}

static bool bus_settled(struct ec_bus *bus)
{
	/* a bus that answers is scanned first */
	return !ec_bus_scan_busy(bus) && READ_ONCE(bus->looked) && slaves_settled(bus);
}

/* @there takes a lock and may sleep, so the condition of the wait is the count of wake-ups. */
static int bus_wait_until(struct ec_bus *bus, bool (*there)(struct ec_bus *bus), unsigned int ms)
{
	long left = msecs_to_jiffies(ms);
	int seen;

	for (;;) {
		seen = atomic_read_acquire(&bus->settles);
		if (there(bus))
			return 0;
		if (left <= 0)
			return left ? -EINTR : -ETIMEDOUT;
		left = wait_event_interruptible_timeout(bus->settled,
							atomic_read(&bus->settles) != seen, left);
	}
}

/* A program that asks for scans all the time must not keep these callers waiting. */
static int wait_scans(struct ec_bus *bus, bool (*there)(struct ec_bus *bus), unsigned int ms)
{
	int ret;

	atomic_inc(&bus->awaited);
	ret = bus_wait_until(bus, there, ms);
	atomic_dec(&bus->awaited);
	return ret;
}

/**
 * ec_bus_scan_awaited() - does a caller wait for the end of scans?
 * @bus: bus
 *
 * Context: Any.
 * Return: whether one does.
 */
bool ec_bus_scan_awaited(const struct ec_bus *bus)
{
	return atomic_read(&bus->awaited);
}

/**
 * ec_bus_wait_scan() - wait until the bus is scanned and has settled
 * @bus: bus
 *
 * Context: Process. May sleep, at most 30 s.
 * Return: 0, -EINTR, or -ETIMEDOUT.
 */
int ec_bus_wait_scan(struct ec_bus *bus)
{
	return wait_scans(bus, bus_settled, EC_SCAN_WAIT_MS);
}

static bool no_scan(struct ec_bus *bus)
{
	return !ec_bus_scan_busy(bus);
}

/**
 * ec_bus_wait_due() - wait until no scan is in progress or due
 * @bus: bus
 * @ms: limit, ms
 *
 * Context: Process. May sleep, at most @ms.
 * Return: 0, -EINTR, or -ETIMEDOUT.
 */
int ec_bus_wait_due(struct ec_bus *bus, unsigned int ms)
{
	return wait_scans(bus, no_scan, ms);
}

/**
 * ec_bus_wait_slaves() - wait until all slaves have settled: workers idle, PDOs read or tried
 * @bus: bus
 *
 * Context: Process. May sleep, at most 10 s.
 * Return: 0, -EINTR, or -ETIMEDOUT.
 */
int ec_bus_wait_slaves(struct ec_bus *bus)
{
	return bus_wait_until(bus, slaves_settled, 10000);
}

/**
 * ec_bus_wait_slave() - wait until a slave is in its state and its PDOs are known
 * @slave: slave
 *
 * Without link it does not wait: no PDOs are read then.
 *
 * Context: Process. May sleep, at most 5 s.
 */
void ec_bus_wait_slave(struct ec_slave *slave)
{
	struct ec_bus *bus = slave->bus;

	wait_event_killable_timeout(bus->settled,
				    slave_settled(slave) || !ec_links_seen_up(bus->links),
				    msecs_to_jiffies(5000));
}

/**
 * ec_bus_exit() - forget all slaves
 * @bus: bus after ec_bus_stop()
 *
 * Context: Process. May sleep.
 */
void ec_bus_exit(struct ec_bus *bus)
{
	ec_for_each_slave(s, bus)
		ec_slave_unref(s);
	kvfree(bus->slaves);
	bus->slaves = NULL;
	WRITE_ONCE(bus->n_slaves, 0);
	ec_ring_places_exit(&bus->places);
	ec_known_exit(&bus->known);
	ec_border_clear(&bus->border);
	ec_owed_exit(bus);
}
