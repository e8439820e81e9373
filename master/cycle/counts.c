// SPDX-License-Identifier: GPL-2.0-only
/*
 * A slave of an optional group counts once it is in OP, and until its loss was seen. Before, from
 * SAFEOP on, it adds to the counters of the cycle some or all of what it will: more than expected
 * by up to that is complete as well, so that the others are not disturbed.
 */
#include "../config/config.h"
#include "../config/domain.h"
#include "../config/why.h"
#include "counts.h"
#include "cycle.h"

struct sums {
	u32 expected;
	u32 spare;
};

/* What the shares of datagram @n add up to: of slaves that count, and of others on the bus */
static struct sums sum_shares(const struct ec_layout *l, unsigned int n, u32 *all)
{
	struct sums s = { 0 };
	unsigned int i;

	*all = 0;
	for (i = 0; i < l->n_shares; i++) {
		const struct ec_cyc_share *share = &l->shares[i];

		if (share->dgram != n)
			continue;
		*all += share->wkc;
		if (ec_config_status(share->config) & EC_STATUS_SC_OP)
			s.expected += share->wkc;
		else if (share->config->slave)
			s.spare += share->wkc;
	}
	return s;
}

/**
 * ec_counts_update() - bring the expected working counters up to date
 * @c: cycle with its layout; it may run
 *
 * Context: Process, lock of the configuration held.
 */
void ec_counts_update(struct ec_cycle *c)
{
	struct sums of[EC_STATUS_DOMAINS] = { };
	struct ec_layout *l = &c->layout;
	struct sums now;
	unsigned int i;
	u32 all;

	lockdep_assert_held(c->wanted->lock);
	if (!l->n_shares)
		return;
	for (i = 0; i < l->n_dgrams; i++) {
		struct ec_cyc_dgram *d = &l->dgrams[i];

		now = sum_shares(l, i, &all);
		now.expected += d->full - all;
		WRITE_ONCE(d->expected, now.expected);
		WRITE_ONCE(d->spare, now.spare);
		of[d->domain].expected += now.expected;
		of[d->domain].spare += now.spare;
	}
	ec_for_each_domain(d, c->wanted) {
		i = d->index;
		d->expected = of[i].expected;
		WRITE_ONCE(c->domains[i].expected, of[i].expected);
		WRITE_ONCE(c->domains[i].spare, of[i].spare);
		WRITE_ONCE(c->shared->status->domains[i].expected, of[i].expected);
	}
}
