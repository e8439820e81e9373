// SPDX-License-Identifier: GPL-2.0-only
/*
 * Ports of a slave that is known are read again only if its DL status has changed, and its receive
 * times likewise. If these were wrong once, the graph remains wrong. So when ports or receive times
 * contradict it for a while, all of them are read again. A slave that reports wrong ones all the
 * time causes no more than a few scans.
 */
#include <linux/ktime.h>
#include "../base/once64.h"
#include "doubt.h"
#include "slave.h"

#define FIRST_NS	NSEC_PER_SEC	/* of contradiction; doubles */
#define LOOKS		4		/* then only after a change of the slaves */

/**
 * ec_doubt_is_due() - is the graph to be found again?
 * @bus: bus; then the next scan does so
 *
 * Context: The monitor thread.
 * Return: whether a scan is due.
 */
bool ec_doubt_is_due(struct ec_bus *bus)
{
	struct ec_doubt *d = &bus->doubt;

	if (!d->due_ns || ktime_get_ns() < d->due_ns)
		return false;
	d->due_ns = 0;
	d->looks++;
	d->look = true;
	return true;
}

/**
 * ec_doubt_judge() - a scan has ended: is its graph contradicted?
 * @bus: bus
 * @changed: there are other slaves than before
 * @contradicted: by the receive times
 *
 * Context: The monitor thread.
 */
void ec_doubt_judge(struct ec_bus *bus, bool changed, bool contradicted)
{
	struct ec_doubt *d = &bus->doubt;

	d->look = false;
	ec_for_each_slave(s, bus)
		contradicted |= s->graph.inconsistent;
	if (changed || !contradicted)
		d->looks = 0;
	d->due_ns = contradicted && d->looks < LOOKS ?
		    ktime_get_ns() + ((u64)FIRST_NS << d->looks) : 0;
}
