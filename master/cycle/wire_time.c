// SPDX-License-Identifier: GPL-2.0-only
/* Wire time that a cycle leaves to acyclic frames. */
#include <linux/math64.h>
#include "../base/once64.h"
#include "../base/report.h"
#include "wire_time.h"

#define MEASURED	1000	/* sends after which the measured interval is right */

/* Does an acyclic frame fit beside a cycle of @interval_ns? Log it if not. */
static bool leaves_room(struct ec_cycle *c, u64 interval_ns, u32 wire_ns)
{
	u64 budget = div_u64(interval_ns * 9, 10);
	u32 slack = budget > wire_ns ? min_t(u64, budget - wire_ns, ~0u) : 0;

	if (slack >= ec_layout_need_ns())
		return true;
	c->watch.wire_logged = true;
	ec_report(c->base, EC_EVENT_WIRE_TIME, wire_ns, min_t(u64, interval_ns, ~0u), slack,
		  ec_layout_need_ns());
	return false;
}

/**
 * ec_wire_time_check() - do acyclic frames fit beside the cycle?
 * @c: cycle with a layout
 * @clocks: the application uses distributed clocks
 *
 * Without them no slave gets to OP. An interval that is not configured is not
 * known yet; ec_wire_time_log() checks it later.
 *
 * Context: Process, lock of the configuration held. May sleep.
 * Return: 0; -ENOSPC: they do not, and may delay no cycle.
 */
int ec_wire_time_check(struct ec_cycle *c, bool clocks)
{
	u64 interval = c->setup.kernel.period_ns ?:
		       ec_access_interval_us(&c->links->access) * (u64)NSEC_PER_USEC;
	const struct ec_cyc_wire *w = clocks ? &c->layout.clocked : &c->layout.plain;

	lockdep_assert_held(c->wanted->lock);
	c->watch.wire_logged = false;
	c->links->access.wire_ns = w->ns;
	WRITE_ONCE(c->carry->share.late_per_s, c->setup.late_per_s);
	c->carry->share.late_cycles = 0;
	if (!c->setup.kernel.period_ns && !c->links->access.interval_set)
		return 0;
	return leaves_room(c, interval, w->ns) || c->setup.late_per_s ? 0 : -ENOSPC;
}

/**
 * ec_wire_time_log() - log it if acyclic frames do not fit, once the interval is measured
 * @c: active cycle
 *
 * Context: The monitor thread, lock of the configuration held. May sleep.
 */
void ec_wire_time_log(struct ec_cycle *c)
{
	lockdep_assert_held(c->wanted->lock);
	if (!c->watch.wire_logged && !c->links->access.interval_set &&
	    ec_read64(&c->sends) > MEASURED)
		leaves_room(c, ec_access_interval_us(&c->links->access) * (u64)NSEC_PER_USEC,
			    READ_ONCE(c->links->access.wire_ns));
}
