// SPDX-License-Identifier: GPL-2.0-only
/*
 * A slave of an optional group counts once its worker has brought it to OP, or has failed to, and
 * until its loss was seen. Before that it adds to the counters of the cycle nothing, some or all of
 * what it will: more than expected by up to that is complete as well, so that the others are not
 * disturbed. One that has failed counts, as with its FMMUs set it would hide the loss of another.
 */
#include "../bus/slave.h"
#include "../config/config.h"
#include "../config/domain.h"
#include "../config/why.h"
#include "counts.h"
#include "cycle.h"

struct sums {
	u32 expected;
	u32 spare;
};

/* Does its worker bring the slave to OP, and has not failed so far? */
static bool is_coming(const struct ec_config *c)
{
	return !(ec_config_status(c) & EC_STATUS_SC_OP) && ec_slave_busy(c->slave) &&
	       READ_ONCE(c->slave->note.error) == EC_SLAVE_OK;
}

/* What the shares of datagram @n add up to: of slaves that count, and of those that will */
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
		if (!share->config->slave)
			continue;
		if (is_coming(share->config))
			s.spare += share->wkc;
		else
			s.expected += share->wkc;
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
		/* after what is expected: a reader of the new spare sees that */
		smp_store_release(&d->spare, now.spare);
		of[d->domain].expected += now.expected;
		of[d->domain].spare += now.spare;
	}
	ec_for_each_domain(d, c->wanted) {
		i = d->index;
		WRITE_ONCE(d->expected, of[i].expected);
		WRITE_ONCE(c->domains[i].expected, of[i].expected);
		/* likewise */
		smp_store_release(&c->domains[i].spare, of[i].spare);
		WRITE_ONCE(c->shared->status->domains[i].expected, of[i].expected);
	}
}
