/* SPDX-License-Identifier: GPL-2.0-only */
/* What a cycle has received of a domain. */
#ifndef EC_CYC_DOMAIN_H
#define EC_CYC_DOMAIN_H

#include <linux/types.h>
#include "../base/events.h"

/** struct ec_cyc_domain - received data of a domain */
struct ec_cyc_domain {
	/** @image: image to which the offsets of its datagrams refer */
	u8 *image;
	/** @expected: working counter if every slave processes its datagrams that does so now */
	u32 expected;
	/** @spare: as in its datagrams */
	u32 spare;
	/** @send: number of the newest send of which data were received */
	u32 send;
	/** @wkc: sum of the working counters of that send */
	u32 wkc;
	/** @age: sends of the domain since @send */
	u32 age;
	/** @max_age: data that are older are stale, 0: none are */
	u32 max_age;
	/** @stale: age of the oldest stale data received, for the log */
	u32 stale;
	/** @stale_logged: @stale was logged; for the monitor only */
	bool stale_logged;
	/** @partial: how many working counters are not the expected ones, even if @wkc is */
	u32 partial;
	/** @seen: working counter and its state of the last receive */
	u32 seen;
	/** @noted: the counter of the last event about it */
	u32 noted;
	/** @noted_state: its state */
	u32 noted_state;
	/** @rate: of these events */
	struct ec_event_rate rate;
};

static inline bool ec_cyc_domain_is_complete(const struct ec_cyc_domain *d, u32 wkc)
{
	/* before what is expected: what is no spare any more is expected already */
	u32 spare = smp_load_acquire(&d->spare);

	return wkc - READ_ONCE(d->expected) <= spare;
}

#endif
