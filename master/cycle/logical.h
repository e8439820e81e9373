/* SPDX-License-Identifier: GPL-2.0-only */
/* Logical addresses of process data; the image has offsets of its own. */
#ifndef EC_LOGICAL_H
#define EC_LOGICAL_H

#include <linux/types.h>
#include "../config/domain.h"

/**
 * struct ec_stretch - a piece of a domain's logical addresses that becomes one
 *	datagram, or LRD plus LWR
 * @start: first byte, from the domain's base
 * @end: behind the last one
 * @first: first of its FMMUs in struct ec_logical.refs
 * @last: behind the last one
 */
struct ec_stretch {
	u32 start;
	u32 end;
	unsigned int first;
	unsigned int last;
};

/**
 * struct ec_logical - the FMMUs of a domain in the order of their addresses
 * @refs: FMMUs; those with an unknown place in the ring stand alone
 * @n: entries in @refs
 * @stretches: what becomes datagrams
 * @n_stretches: entries in @stretches
 * @separate: LRD and LWR instead of LRW
 */
struct ec_logical {
	struct ec_domain_fmmu *refs;
	unsigned int n;
	struct ec_stretch *stretches;
	unsigned int n_stretches;
	bool separate;
};

int ec_logical_place(struct ec_domain *d, struct ec_logical *l);
void ec_logical_free(struct ec_logical *l);

#endif
