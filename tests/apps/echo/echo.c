// SPDX-License-Identifier: GPL-2.0-only
/*
 * One slave whose outputs are wired to its inputs. Each cycle sends its number and expects an
 * earlier one back: the same number of cycles earlier each time (--exact), or a little.
 *
 * usage: echo [--exact|--trips] CYCLES PERIOD_US
 *
 * --trips: waits for its own value after each send and prints how long that took. It is no
 * real-time task then, or a device with interrupts could not deliver the frame.
 *
 * Says "operational" when the exchange has begun; from then on cycles count. Every 100 ms a line
 * with the counters. Exit code 0: no wrong value, and with --exact no incomplete cycle.
 */
#include <errno.h>
#include <sched.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <ecrt.h>

#define SETTLE	5	/* complete cycles in a row until values of before are out of the slave */
#define TRIP_NS	5000000	/* lost after that */
#define OLDEST	20	/* cycles; frames of a device that is interrupted come back late */

static volatile sig_atomic_t stopped;
static bool exact;
static ec_slave_config_t *sc;
static unsigned int out, in;

/* since all is in OP for the first time */
static struct {
	unsigned long cycles, complete, incomplete, wrong, late;
	unsigned int age, oldest;	/* first one with --exact; largest one */
} seen;

static void stop(int sig)
{
	(void)sig;
	stopped = 1;
}

static void show(void)
{
	printf("cycles=%lu complete=%lu incomplete=%lu wrong=%lu late=%lu oldest=%u\n",
	       seen.cycles, seen.complete, seen.incomplete, seen.wrong, seen.late, seen.oldest);
}

/* the value that has come back in cycle @now; @row: complete cycles in a row */
static void judge(uint32_t now, uint32_t value, unsigned int row)
{
	uint32_t age = now - value;

	if (row < SETTLE)
		return;
	if (!seen.age)
		seen.age = age;
	if (!age || age > OLDEST || (exact && age != seen.age)) {
		if (seen.wrong++ < 5)
			printf("wrong: in cycle %u came %u\n", now, value);
		return;
	}
	if (age > seen.oldest)
		seen.oldest = age;
}

static int64_t now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * 1000000000LL + t.tv_nsec;
}

static void sleep_until(int64_t ns)
{
	const struct timespec t = { .tv_sec = ns / 1000000000, .tv_nsec = ns % 1000000000 };

	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
}

static void run(ec_master_t *m, ec_domain_t *d, unsigned long limit, int64_t period)
{
	uint8_t *data = ecrt_domain_data(d);
	bool operational = false, complete;
	int64_t next = now_ns();
	ec_slave_config_state_t slave;
	ec_domain_state_t state;
	unsigned int row = 0;

	for (uint32_t n = 1; !stopped && seen.cycles < limit; n++) {
		next += period;
		sleep_until(next);
		if (now_ns() - next > period) {
			seen.late += operational;
			next = now_ns();
		}
		ecrt_master_receive(m);
		ecrt_domain_process(d);
		ecrt_domain_state(d, &state);
		complete = state.wc_state == EC_WC_COMPLETE;
		/* in SAFEOP it takes no outputs */
		ecrt_slave_config_state(sc, &slave);
		row = complete && slave.operational ? row + 1 : 0;
		if (row && !operational) {
			puts("operational");
			operational = true;
		}
		if (operational) {
			seen.cycles++;
			seen.complete += complete;
			seen.incomplete += !complete;
			judge(n, EC_READ_U32(data + in), row);
			if (seen.cycles % (100000000 / period) == 0)
				show();
		}
		EC_WRITE_U32(data + out, n);
		ecrt_domain_queue(d);
		ecrt_master_send(m);
	}
	show();
}

static int ascending(const void *a, const void *b)
{
	uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

	return (x > y) - (x < y);
}

/* ns until the program has the inputs of the frame that it sends with value @n; 0: lost */
static uint32_t trip(ec_master_t *m, ec_domain_t *d, uint32_t n)
{
	const uint8_t *data = ecrt_domain_data(d);
	int64_t begin = now_ns(), took;

	ecrt_master_send(m);
	do {
		ecrt_master_receive(m);
		ecrt_domain_process(d);
		took = now_ns() - begin;
		/* the slave had the value of the frame before when this one passed */
		if (EC_READ_U32(data + in) == n - 1)
			return (uint32_t)took;
	} while (took < TRIP_NS);
	return 0;
}

static bool run_trips(ec_master_t *m, ec_domain_t *d, unsigned long limit, int64_t period)
{
	uint32_t *took = calloc(limit, sizeof(*took));
	int64_t next = now_ns();
	ec_slave_config_state_t slave = { 0 };
	unsigned long lost = 0, count = 0;
	unsigned int row = 0;

	for (uint32_t n = 1; took && !stopped && count < limit; n++) {
		uint32_t t;

		next += period;
		sleep_until(next);
		EC_WRITE_U32(ecrt_domain_data(d) + out, n);
		ecrt_domain_queue(d);
		t = trip(m, d, n);
		ecrt_slave_config_state(sc, &slave);
		row = slave.operational && (t || row >= SETTLE) ? row + 1 : 0;
		if (row < SETTLE)
			continue;
		took[count++] = t;
		lost += !t;
	}
	if (!took || count < limit)
		return false;
	qsort(took, count, sizeof(*took), ascending);
	printf("trips %lu\nlost %lu\nmin_ns %u\nmedian_ns %u\np99_ns %u\nmax_ns %u\n", count, lost,
	       took[0], took[count / 2], took[count * 99 / 100], took[count - 1]);
	free(took);
	return !lost;
}

/* The PDOs of the slave's EEPROM. */
static int configure(ec_master_t *m, ec_domain_t *d)
{
	ec_slave_info_t info;
	ec_sync_info_t sync;
	int ret;

	if (ecrt_master_get_slave(m, 0, &info))
		return -1;
	sc = ecrt_master_slave_config(m, 0, 0, info.vendor_id, info.product_code);
	if (!sc)
		return -1;
	for (uint8_t i = 0; i < info.sync_count; i++) {
		if (ecrt_master_get_sync_manager(m, 0, i, &sync))
			return -1;
		if (!sync.n_pdos)
			continue;
		ret = ecrt_slave_config_reg_pdo_entry_pos(sc, i, 0, 0, d, NULL);
		if (ret < 0)
			return ret;
		*(sync.dir == EC_DIR_OUTPUT ? &out : &in) = (unsigned int)ret;
	}
	return 0;
}

int main(int argc, char **argv)
{
	const struct sched_param priority = { .sched_priority = 80 };
	bool trips = argc > 1 && !strcmp(argv[1], "--trips"), ok;
	unsigned long cycles, period_us;
	ec_master_t *m;
	ec_domain_t *d;

	exact = argc > 1 && !strcmp(argv[1], "--exact");
	if (argc != 3 + (exact || trips))
		return 2;
	cycles = strtoul(argv[argc - 2], NULL, 10);
	period_us = strtoul(argv[argc - 1], NULL, 10);
	if (!cycles || cycles > 100000000 || !period_us || period_us > 100000)
		return 2;
	setvbuf(stdout, NULL, _IOLBF, 0);
	signal(SIGTERM, stop);
	m = ecrt_request_master(0);
	d = m ? ecrt_master_create_domain(m) : NULL;
	if (!d || configure(m, d) || ecrt_master_set_send_interval(m, period_us) ||
	    ecrt_master_activate(m)) {
		fprintf(stderr, "echo: cannot start: %s\n", strerror(errno));
		return 1;
	}
	mlockall(MCL_CURRENT | MCL_FUTURE);
	if (trips) {
		ok = run_trips(m, d, cycles, (int64_t)period_us * 1000);
	} else {
		sched_setscheduler(0, SCHED_FIFO, &priority);
		run(m, d, cycles, (int64_t)period_us * 1000);
		ok = !seen.wrong && seen.complete &&
		     (!exact || (!seen.incomplete && !seen.late));
	}
	ecrt_release_master(m);
	return !ok;
}
