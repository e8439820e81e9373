/* SPDX-License-Identifier: GPL-2.0-only */
/* What line_errors.c remembers of the bus. */
#ifndef EC_LINE_WATCH_H
#define EC_LINE_WATCH_H

#include <linux/types.h>

/**
 * struct ec_line_watch - where the reading of error counters is; the monitor's
 * @next: ring position of the slave to be read next
 * @turn_ns: when some were read (ktime)
 * @period_ns: when the counts of the present period began (ktime)
 * @links: changes of links that the monitor has seen
 */
struct ec_line_watch {
	unsigned int next;
	u64 turn_ns;
	u64 period_ns;
	u32 links;
};

#endif
