// SPDX-License-Identifier: GPL-2.0-only
/*
 * Configures slaves with the arrays of 'ethercat cstruct' and nothing else, and
 * waits until all of them are in OP and exchange their data.
 *
 * pdos.h: output of cstruct; slaves.h: X(position, vendor, product) for each
 * slave in it.
 */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include <ecrt.h>

#include "pdos.h"

#define CYCLE_NS	1000000
#define CYCLES_MAX	30000

static struct slave {
	unsigned int position;
	uint32_t vendor;
	uint32_t product;
	const ec_sync_info_t *syncs;
	ec_slave_config_t *sc;
} slaves[] = {
#define X(position, vendor, product) \
	{ position, vendor, product, slave_##position##_syncs, NULL },
#include "slaves.h"
#undef X
};

#define N	(sizeof(slaves) / sizeof(slaves[0]))

/* all entries of the arrays that are no gaps; Return: how many, or negative */
static int register_all(const struct slave *s, ec_domain_t *domain)
{
	int n = 0;

	for (const ec_sync_info_t *sm = s->syncs; sm->index != 0xff; sm++)
		for (unsigned int p = 0; p < sm->n_pdos; p++)
			for (unsigned int e = 0; e < sm->pdos[p].n_entries; e++) {
				const ec_pdo_entry_info_t *x = &sm->pdos[p].entries[e];
				unsigned int bit;

				if (!x->index)
					continue;
				if (ecrt_slave_config_reg_pdo_entry(s->sc, x->index, x->subindex,
								    domain, &bit) < 0)
					return -1;
				n++;
			}
	return n;
}

static int configure(ec_master_t *master, ec_domain_t *domain, struct slave *s)
{
	int n;

	s->sc = ecrt_master_slave_config(master, 0, s->position, s->vendor, s->product);
	if (!s->sc)
		return -1;
	if (ecrt_slave_config_pdos(s->sc, EC_END, s->syncs))
		return -1;
	n = register_all(s, domain);
	if (n >= 0)
		printf("slave %u: %d entries\n", s->position, n);
	return n < 0 ? -1 : 0;
}

static unsigned int operational(void)
{
	ec_slave_config_state_t state;
	unsigned int n = 0;

	for (size_t i = 0; i < N; i++)
		if (!ecrt_slave_config_state(slaves[i].sc, &state))
			n += state.operational;
	return n;
}

static int cycle(ec_master_t *master, ec_domain_t *domain)
{
	ec_domain_state_t state = { 0 };
	struct timespec next;

	clock_gettime(CLOCK_MONOTONIC, &next);
	for (unsigned int i = 0; i < CYCLES_MAX; i++) {
		next.tv_nsec += CYCLE_NS;
		if (next.tv_nsec >= 1000000000) {
			next.tv_nsec -= 1000000000;
			next.tv_sec++;
		}
		clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
		ecrt_master_receive(master);
		ecrt_domain_process(domain);
		ecrt_domain_state(domain, &state);
		if (operational() == N && state.wc_state == EC_WC_COMPLETE) {
			printf("all %zu slaves in OP after %u cycles, working counter %u\n", N, i,
			       state.working_counter);
			return 0;
		}
		ecrt_domain_queue(domain);
		ecrt_master_send(master);
	}
	printf("%u of %zu slaves in OP, working counter state %d\n", operational(), N,
	       state.wc_state);
	return 1;
}

int main(void)
{
	ec_master_t *master = ecrt_request_master(0);
	ec_domain_t *domain = master ? ecrt_master_create_domain(master) : NULL;
	int ret = 1;

	if (!domain)
		return 1;
	for (size_t i = 0; i < N; i++)
		if (configure(master, domain, &slaves[i])) {
			printf("slave %u: not configured\n", slaves[i].position);
			goto out;
		}
	if (ecrt_master_activate(master) || !ecrt_domain_data(domain))
		goto out;
	ret = cycle(master, domain);
out:
	ecrt_release_master(master);
	return ret;
}
