/* SPDX-License-Identifier: GPL-2.0-only */
/* Sync units: domains that are judged together, and what is done when they fail. */
#ifndef EC_UNIT_H
#define EC_UNIT_H

#include <linux/types.h>
#include "../include/uapi/ethercat.h"

struct ec_domain;
struct ec_wanted;

#define EC_UNIT_LIMIT	3	/* incomplete receives, when none are configured */

/**
 * struct ec_unit - a sync unit, under the lock of the session; the cycle copies it
 * @what: as created, its index and limit included
 * @domains: bit n: domain n
 */
struct ec_unit {
	struct ec_ioc_unit what;
	u64 domains;
};

struct ec_unit *ec_unit_create(struct ec_wanted *w, const struct ec_ioc_unit *what);
int ec_unit_add(struct ec_wanted *w, struct ec_domain *d, u32 unit);
int ec_units_check(const struct ec_wanted *w, bool by_kernel, char *why, size_t size);
u8 ec_unit_repeats(const struct ec_wanted *w, const struct ec_domain *d);
bool ec_unit_differs(const struct ec_unit *a, const struct ec_unit *b);
void ec_units_free(struct ec_wanted *w);

#endif
