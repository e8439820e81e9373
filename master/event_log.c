// SPDX-License-Identifier: GPL-2.0-only
/* Lines of the kernel log for what the cycle finds: it must not print, so the monitor does. */
#include <linux/sched.h>
#include "base/base.h"
#include "base/report.h"
#include "event_log.h"
#include "wire/event.h"

/**
 * ec_event_log() - log new events that have no line of their own
 * @base: of a master
 * @at: number of the first new event, then of the next one
 *
 * Context: The monitor.
 */
void ec_event_log(struct ec_base *base, u64 *at)
{
	struct ec_event e = { };

	while (ec_event_ring_get(&base->events.ring, at, &e)) {
		cond_resched();
		if (ec_event_is_later(e.kind))
			ec_report_print(base, &e, NULL);
	}
}
