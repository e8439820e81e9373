// SPDX-License-Identifier: GPL-2.0-only
/*
 * cyclic [SECONDS]: configures every slave with the PDOs of its EEPROM and
 * exchanges them each millisecond, until it is killed. Says when all slaves
 * are in OP, and at the end how many cycles and incomplete ones there were.
 */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <ecrt.h>

#define SLAVES_MAX	128
#define PERIOD_NS	1000000L

static volatile sig_atomic_t stopped;

static void stop(int sig)
{
	(void)sig;
	stopped = 1;
}

static int add_slave(ec_master_t *m, ec_domain_t *d, uint16_t pos, ec_slave_config_t **out)
{
	ec_slave_info_t info;
	ec_slave_config_t *sc;
	ec_sync_info_t sync;
	unsigned int bit;

	if (ecrt_master_get_slave(m, pos, &info))
		return -1;
	sc = ecrt_master_slave_config(m, 0, pos, info.vendor_id, info.product_code);
	if (!sc)
		return -1;
	for (uint8_t i = 0; i < info.sync_count; i++) {
		if (ecrt_master_get_sync_manager(m, pos, i, &sync))
			return -1;
		if (sync.n_pdos && ecrt_slave_config_reg_pdo_entry_pos(sc, i, 0, 0, d, &bit) < 0)
			return -1;
	}
	*out = sc;
	return 0;
}

static unsigned int operational(ec_slave_config_t **sc, unsigned int n)
{
	ec_slave_config_state_t s;
	unsigned int k = 0;

	for (unsigned int i = 0; i < n; i++)
		k += !ecrt_slave_config_state(sc[i], &s) && s.operational;
	return k;
}

static void next_cycle(struct timespec *t)
{
	t->tv_nsec += PERIOD_NS;
	if (t->tv_nsec >= 1000000000L) {
		t->tv_nsec -= 1000000000L;
		t->tv_sec++;
	}
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, t, NULL);
}

static void run(ec_master_t *m, ec_domain_t *d, ec_slave_config_t **sc, unsigned int n,
		unsigned long limit)
{
	unsigned long cycles, incomplete = 0, refused = 0;
	unsigned int shown = ~0U, up;
	ec_domain_state_t state;
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	for (cycles = 0; !stopped && cycles < limit; cycles++) {
		next_cycle(&t);
		refused += ecrt_master_receive(m) != 0;
		ecrt_domain_process(d);
		ecrt_domain_state(d, &state);
		incomplete += state.wc_state != EC_WC_COMPLETE;
		ecrt_domain_queue(d);
		refused += ecrt_master_send(m) != 0;
		up = operational(sc, n);
		if (up != shown) {
			printf("%lu ms: %u of %u in OP\n", cycles, up, n);
			shown = up;
		}
	}
	printf("%lu cycles, %lu incomplete, %lu refused\n", cycles, incomplete, refused);
}

int main(int argc, char **argv)
{
	unsigned long limit = argc > 1 ? strtoul(argv[1], NULL, 10) * 1000 : ~0UL;
	static ec_slave_config_t *sc[SLAVES_MAX];
	ec_master_info_t info;
	ec_master_t *m;
	ec_domain_t *d;

	setvbuf(stdout, NULL, _IOLBF, 0);
	signal(SIGTERM, stop);
	m = ecrt_request_master(0);
	if (!m)
		return 1;
	d = ecrt_master_create_domain(m);
	if (!d || ecrt_master(m, &info) || info.slave_count > SLAVES_MAX)
		return 1;
	for (unsigned int i = 0; i < info.slave_count; i++)
		if (add_slave(m, d, (uint16_t)i, &sc[i]))
			return 1;
	if (ecrt_master_activate(m) || !ecrt_domain_data(d))
		return 1;
	run(m, d, sc, info.slave_count, limit);
	ecrt_release_master(m);
	return 0;
}
