/* SPDX-License-Identifier: GPL-2.0-only */
/* Receive of the cycle owner. */
#ifndef EC_RECEIVE_H
#define EC_RECEIVE_H

#include "cycle.h"
#include "units_run.h"

int ec_cycle_do_receive(struct ec_cycle *c);
void ec_cycle_log_stale(struct ec_cycle *c);

/**
 * ec_cycle_receive() - ec_cycle_do_receive(), with the links entered and left
 * @c: active cycle
 *
 * Context: The cycle owner. RT-safe; sleeps after a cycle timeout only.
 * Return: 0 or -ENODEV.
 */
static inline int ec_cycle_receive(struct ec_cycle *c)
{
	int ret = ec_links_enter(c->links);

	if (ret) {
		if (ret == -ENODEV && c->units)
			ec_units_outage(c);
		return ret;
	}
	ret = ec_cycle_do_receive(c);
	ec_links_leave(c->links);
	return ret;
}

#endif
