/* SPDX-License-Identifier: GPL-2.0-only */
/* Copies from inputs to outputs that the master makes before each send. */
#ifndef EC_COPY_H
#define EC_COPY_H

#include <linux/types.h>
#include "ethercat.h"
#include "cyc_domain.h"

struct ec_copying;
struct ec_wanted;

/** struct ec_copies - the copies an application has set; under the lock of the configuration */
struct ec_copies {
	/** @list: copies, or NULL */
	struct ec_ioc_copy *list;
	/** @n: entries in @list */
	unsigned int n;
};

int ec_copy_add(struct ec_copies *c, const struct ec_wanted *w, const struct ec_ioc_copy *copy);
int ec_copy_begin(const struct ec_copies *c, const struct ec_wanted *w,
		  struct ec_copying **copying);
void ec_copy_run(struct ec_copying *k, const struct ec_status *st,
		 const struct ec_cyc_domain *domains);

#endif
