/* SPDX-License-Identifier: GPL-2.0-only */
/* What a cycle has received of a domain. */
#ifndef EC_CYC_DOMAIN_H
#define EC_CYC_DOMAIN_H

#include <linux/types.h>
#include "../base/events.h"

/**
 * struct ec_cyc_domain - received data of a domain
 * @expected: working counter when every slave takes part
 * @send: number of the newest send of which data were received
 * @wkc: sum of the working counters of that send
 * @partial: one of them was not the expected one; others may make up for it in @wkc
 * @age: sends of the domain since that one
 * @max_age: data that are older are stale, 0: none are
 * @stale: age of the oldest stale data that came back, for the log
 * @stale_logged: the log has said so; only the monitor's
 * @image: what the offsets of its datagrams count from
 * @seen: working counter and its state of the last receive
 * @noted: the counter of the last event about it
 * @noted_state: its state
 * @rate: of these events
 */
struct ec_cyc_domain {
	u8 *image;
	u32 expected;
	u32 send;
	u32 wkc;
	u32 age;
	u32 max_age;
	u32 stale;
	bool stale_logged;
	bool partial;
	u32 seen;
	u32 noted;
	u32 noted_state;
	struct ec_event_rate rate;
};

#endif
