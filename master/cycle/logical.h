/* SPDX-License-Identifier: GPL-2.0-only */
/* Logical addresses of process data; the image has offsets of its own. */
#ifndef EC_LOGICAL_H
#define EC_LOGICAL_H

#include <linux/types.h>
#include "../config/domain.h"

/**
 * struct ec_stretch - a piece of a domain's logical addresses that becomes one
 * datagram, or LRD plus LWR
 */
struct ec_stretch {
	/** @start: first byte, from the domain's base */
	u32 start;
	/** @end: behind the last one */
	u32 end;
	/** @first: first of its FMMUs in struct ec_logical.refs */
	unsigned int first;
	/** @last: behind the last one */
	unsigned int last;
};

/** struct ec_logical - the FMMUs of a domain in the order of their addresses */
struct ec_logical {
	/** @refs: FMMUs; those with an unknown place in the ring stand alone */
	struct ec_domain_fmmu *refs;
	/** @n: entries in @refs */
	unsigned int n;
	/** @stretches: what becomes datagrams */
	struct ec_stretch *stretches;
	/** @n_stretches: entries in @stretches */
	unsigned int n_stretches;
	/** @separate: LRD and LWR instead of LRW */
	bool separate;
};

int ec_logical_place(struct ec_domain *d, struct ec_logical *l);
void ec_logical_free(struct ec_logical *l);

#endif
