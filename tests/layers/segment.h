/* SPDX-License-Identifier: GPL-2.0-only */
/* Links of a master at a simulated segment, for the layers above "link". */
#ifndef EC_SEGMENT_H
#define EC_SEGMENT_H

#include "alone.h"
#include "devices/sim/sim.h"
#include "master/carry/carry.h"
#include "master/carry/rider.h"

struct ec_sim_link;

/**
 * struct segment - links, and what is at their other end
 * @base: of the master
 * @links: way to the slaves
 * @sim: slaves
 * @device: virtual device in between
 */
struct segment {
	struct ec_base base;
	struct ec_links links;
	struct ec_carry carry;
	struct ec_riders riders;
	struct ec_sim *sim;
	struct ec_sim_link *device;
};

bool segment_begin(struct segment *s, const char *text);
void segment_end(struct segment *s);
void segment_fault(struct segment *s, const char *what);

#endif
