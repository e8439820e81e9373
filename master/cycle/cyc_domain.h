/* SPDX-License-Identifier: GPL-2.0-only */
/* What a cycle has received of a domain. */
#ifndef EC_CYC_DOMAIN_H
#define EC_CYC_DOMAIN_H

#include <linux/types.h>
#include "../base/events.h"

/**
 * struct ec_cyc_domain - received data of a domain
 * @expected: working counter if every slave processes its datagrams that does so now
 * @spare: as in its datagrams
 * @send: number of the newest send of which data were received
 * @wkc: sum of the working counters of that send
 * @partial: how many of these are not the expected ones, even if their sum is
 * @age: sends of the domain since @send
 * @max_age: data that are older are stale, 0: none are
 * @stale: age of the oldest stale data received, for the log
 * @stale_logged: @stale was logged; for the monitor only
 * @image: image to which the offsets of its datagrams refer
 * @seen: working counter and its state of the last receive
 * @noted: the counter of the last event about it
 * @noted_state: its state
 * @rate: of these events
 */
struct ec_cyc_domain {
	u8 *image;
	u32 expected;
	u32 spare;
	u32 send;
	u32 wkc;
	u32 age;
	u32 max_age;
	u32 stale;
	bool stale_logged;
	u32 partial;
	u32 seen;
	u32 noted;
	u32 noted_state;
	struct ec_event_rate rate;
};

static inline bool ec_cyc_domain_is_complete(const struct ec_cyc_domain *d, u32 wkc)
{
	/* before what is expected: what is no spare any more is expected already */
	u32 spare = smp_load_acquire(&d->spare);

	return wkc - READ_ONCE(d->expected) <= spare;
}

#endif
