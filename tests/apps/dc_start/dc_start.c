// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * dc_start: time from activation until all drives with SYNC0 are in OP, in turns without and with
 * ecrt_master_sync_reference_clock() in each cycle; otherwise the calls are those of dc_motion.
 *
 * usage: dc_start DRIVES PERIOD_US TIMES
 * prints the shortest time of each kind: "without_us N", "with_us N"
 */
#include <ecrt.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>

#define NS_PER_S	1000000000L
#define LIMIT_S		60

static unsigned int drives;
static long period_ns;

static int64_t now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (int64_t)t.tv_sec * NS_PER_S + t.tv_nsec;
}

static void sleep_until(int64_t ns)
{
	struct timespec t = { .tv_sec = ns / NS_PER_S, .tv_nsec = ns % NS_PER_S };

	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
}

static int all_in(ec_master_t *master, unsigned int state)
{
	ec_master_state_t s;

	return !ecrt_master_state(master, &s) && s.slaves_responding == drives &&
	       s.al_states == state;
}

static int configure(ec_master_t *master, ec_domain_t *domain, unsigned int i)
{
	ec_slave_config_t *sc;
	ec_slave_info_t info;

	if (ecrt_master_get_slave(master, (uint16_t)i, &info))
		return -1;
	sc = ecrt_master_slave_config(master, 0, (uint16_t)i, info.vendor_id, info.product_code);
	if (!sc || ecrt_slave_config_reg_pdo_entry(sc, 0x6040, 0, domain, NULL) < 0 ||
	    ecrt_slave_config_reg_pdo_entry(sc, 0x6041, 0, domain, NULL) < 0)
		return -1;
	return ecrt_slave_config_dc(sc, 0x0300, (uint32_t)period_ns, (int32_t)period_ns / 3, 0, 0);
}

/* Cycles until all are in OP. Returns us since @began, -1: not in time. */
static long cycles(ec_master_t *master, ec_domain_t *domain, int leads, int64_t began)
{
	int64_t next = now_ns();

	while (now_ns() - began < LIMIT_S * NS_PER_S) {
		/* cycles that have passed are left out */
		do
			next += period_ns;
		while (next < now_ns());
		sleep_until(next);
		ecrt_master_receive(master);
		ecrt_domain_process(domain);
		if (all_in(master, EC_AL_STATE_OP))
			return (long)((now_ns() - began) / 1000);
		ecrt_domain_queue(domain);
		ecrt_master_application_time(master, (uint64_t)next);
		if (leads)
			ecrt_master_sync_reference_clock(master);
		ecrt_master_sync_slave_clocks(master);
		ecrt_master_send(master);
	}
	return -1;
}

/* One start from PREOP; us, or -1. */
static long start(int leads)
{
	ec_master_t *master = ecrt_request_master(0);
	ec_domain_t *domain = master ? ecrt_master_create_domain(master) : NULL;
	int64_t began = now_ns();
	long us = -1;
	unsigned int i;

	if (!domain)
		return -1;
	while (!all_in(master, EC_AL_STATE_PREOP) && now_ns() - began < LIMIT_S * NS_PER_S)
		sleep_until(now_ns() + NS_PER_S / 100);
	for (i = 0; i < drives; i++)
		if (configure(master, domain, i))
			goto out;
	if (ecrt_master_set_send_interval(master, (size_t)period_ns / 1000))
		goto out;
	began = now_ns();
	if (!ecrt_master_activate(master))
		us = cycles(master, domain, leads, began);
out:
	ecrt_release_master(master);
	return us;
}

int main(int argc, char **argv)
{
	struct sched_param param = { .sched_priority = 80 };
	long best[2] = { -1, -1 }, us;
	int i;

	if (argc != 4) {
		fprintf(stderr, "usage: dc_start DRIVES PERIOD_US TIMES\n");
		return 2;
	}
	drives = (unsigned int)strtoul(argv[1], NULL, 0);
	period_ns = strtol(argv[2], NULL, 0) * 1000;
	mlockall(MCL_CURRENT | MCL_FUTURE);
	pthread_setschedparam(pthread_self(), SCHED_FIFO, &param);
	for (i = 0; i < 2 * atoi(argv[3]); i++) {
		us = start(i % 2);
		if (us < 0) {
			fprintf(stderr, "drives not in OP\n");
			return 1;
		}
		if (best[i % 2] < 0 || us < best[i % 2])
			best[i % 2] = us;
	}
	printf("without_us %ld\nwith_us %ld\n", best[0], best[1]);
	return 0;
}
