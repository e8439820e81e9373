/* SPDX-License-Identifier: GPL-2.0-only */
/* A simulated segment with a bus whose ops are NULL, for "bus" and the layers above it. */
#ifndef EC_SCANNED_H
#define EC_SCANNED_H

#include <linux/delay.h>
#include "master/bus/bus.h"
#include "master/bus/bus_list.h"
#include "master/bus/scan.h"
#include "master/bus/slave.h"
#include "segment.h"

/**
 * struct scanned - a segment and its slaves
 * @seg: segment
 * @bus: slaves
 */
struct scanned {
	struct segment seg;
	struct ec_bus bus;
};

static inline void scanned_end(struct scanned *s)
{
	ec_bus_stop(&s->bus);
	segment_end(&s->seg);
	ec_bus_exit(&s->bus);
}

/* @s is zeroed; scanned_end() must follow when it returns true */
static inline bool scanned_begin(struct scanned *s, const char *text)
{
	if (!segment_begin(&s->seg, text))
		return false;
	if (CHECK_EQ(ec_bus_init(&s->bus, &s->seg.base, &s->seg.links, NULL), 0))
		return true;
	segment_end(&s->seg);
	return false;
}

/* all slaves are in PREOP then */
static inline bool scanned_scan(struct scanned *s, unsigned int slaves)
{
	struct ec_scan_result result = { 0 };

	if (!CHECK_EQ(ec_scan(&s->bus, slaves, &result), 0) || !CHECK(result.changed) ||
	    !CHECK_EQ(s->bus.n_slaves, slaves))
		return false;
	WRITE_ONCE(s->bus.responding, slaves);
	WRITE_ONCE(s->bus.looked, true);
	return true;
}

static inline void scanned_wait(const struct ec_slave *s)
{
	while (ec_slave_busy(s))
		usleep_range(100, 200);
}

#endif
