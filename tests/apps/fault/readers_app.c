// SPDX-License-Identifier: GPL-2.0-only
/* An application beside readers: what it has configured is what they look at. */
#include <ecrt.h>
#include <fcntl.h>
#include <sched.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <time.h>
#include "fault.h"
#include "readers.h"

#define PERIOD_NS	1000000
#define PRIORITY	80
#define LIMIT_MS	1000	/* for an update; one takes 20 ms and what the slave needs */
#define OP_MS		60000
#define CYCLES_MAX	10000

/* what is measured of a cycle */
enum part { RECEIVE, SEND, WORK, LATE, SENT, PARTS };

static const char * const names[PARTS] = { "receive", "send", "work", "late_ns", "sent_ns" };
static uint32_t samples[PARTS][CYCLES_MAX];

static ec_master_t *master;
static ec_domain_t *domain;
static ec_slave_config_t *sc;

static uint64_t now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (uint64_t)t.tv_sec * 1000000000 + (uint64_t)t.tv_nsec;
}

/* Instructions under -icount */
static uint64_t ticks(void)
{
#if defined(__x86_64__) || defined(__i386__)
	return __builtin_ia32_rdtsc();
#else
	return now_ns();
#endif
}

static int reaches(unsigned int state, unsigned int limit_ms)
{
	static const struct timespec pause_ms = { .tv_nsec = 1000000 };
	uint64_t end = now_ns() + limit_ms * 1000000ULL;
	ec_slave_config_state_t s;

	do {
		if (!ecrt_slave_config_state(sc, &s) && s.al_state == state)
			return 1;
		nanosleep(&pause_ms, NULL);
	} while (now_ns() < end);
	return 0;
}

/* All data of the slave in the domain. */
static int configure(void)
{
	ec_slave_info_t info;
	unsigned int bit;

	master = ecrt_request_master(0);
	domain = master ? ecrt_master_create_domain(master) : NULL;
	if (!domain || ecrt_master_get_slave(master, 0, &info))
		return -1;
	sc = ecrt_master_slave_config(master, 0, 0, info.vendor_id, info.product_code);
	return !sc || ecrt_slave_config_reg_pdo_entry_pos(sc, 0, 0, 0, domain, &bit) < 0 ||
	       ecrt_slave_config_reg_pdo_entry_pos(sc, 1, 0, 0, domain, &bit) < 0;
}

static ec_reg_request_t *written;	/* before OP, so that it is recorded */

/* Much to look at, of slaves that are not there. */
static int configure_more(void)
{
	static const uint8_t value[4096];
	static const ec_group_info_t group = { .name = "g", .by = EC_GROUP_ID, .value = 9 };
	static const ec_unit_config_t unit = { .name = "u", .policy = EC_UNIT_ZERO };
	static const ec_command_t command = {
		.kind = EC_COMMAND_SDO, .index = 0x2000, .size = sizeof(value), .data = value,
	};
	struct in_addr address = { .s_addr = 0x0100000a };

	for (uint16_t i = 1; i < APP_CONFIGS; i++) {
		ec_slave_config_t *more = ecrt_master_slave_config(master, 0, 1000 + i, 1, 2);

		if (!more)
			return -1;
		if (i > 1)
			continue;
		for (uint16_t k = 0; k < APP_SDOS; k++)
			if (ecrt_slave_config_sdo(more, 0x2000 + k, 1, value, sizeof(value)))
				return -1;
		if (ecrt_slave_config_idn(more, 0, 1, EC_AL_STATE_PREOP, value, sizeof(value)) ||
		    ecrt_slave_config_flag(more, "RevisionNumber", 1) ||
		    ecrt_slave_config_command(more, EC_STEP_SO, &command) ||
		    ecrt_slave_config_eoe_ip_address(more, address))
			return -1;
	}
	written = ecrt_slave_config_create_reg_request(sc, 1);
	return !written || ecrt_master_group(master, &group) || ecrt_master_unit(master, &unit) ||
	       !ecrt_master_group_config(master, 0, 0, 1, 2);
}

int updates(unsigned int count)
{
	static const ec_cycle_config_t cycle = { .period_ns = PERIOD_NS };
	int fd = open_master(O_RDWR);
	unsigned int seen = 0;

	if (configure() || ecrt_master_set_cycle(master, &cycle) ||
	    ecrt_master_activate(master) || !reaches(EC_AL_STATE_OP, OP_MS)) {
		fprintf(stderr, "the slave does not reach OP\n");
		return 2;
	}
	printf("in OP\n");
	for (unsigned int i = 0; i < count; i++) {
		struct ec_ioc_state s = { .state = i % 2 ? EC_AL_STATE_OP : EC_AL_STATE_SAFEOP };

		if (call(fd, EC_IOC_STATE, &s)) {
			fprintf(stderr, "the state cannot be requested\n");
			return 2;
		}
		seen += (unsigned int)reaches(s.state, LIMIT_MS);
	}
	printf("updates: %u of %u\n", seen, count);
	return 0;
}

/* Until it is time for the next cycle; how late it is then */
static uint32_t sleep_until(uint64_t *at)
{
	struct timespec t;
	uint64_t now;

	*at += PERIOD_NS;
	t.tv_sec = (time_t)(*at / 1000000000);
	t.tv_nsec = (long)(*at % 1000000000);
	clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
	now = now_ns();
	/* what was missed stays missed */
	if (now - *at >= PERIOD_NS) {
		uint32_t late = (uint32_t)(now - *at);

		*at += late / PERIOD_NS * PERIOD_NS;
		return late;
	}
	return (uint32_t)(now - *at);
}

/* One cycle. It ends with a complete working counter, or the answer is 0. */
static int one_cycle(uint64_t *at, int by_kernel, uint32_t *cost)
{
	ec_cycle_state_t cycle = { 0 };
	ec_domain_state_t state;
	uint64_t t[4];

	if (by_kernel)
		ecrt_master_wait_cycle(master, 0);
	else
		cost[LATE] = sleep_until(at);
	t[0] = ticks();
	ecrt_master_receive(master);
	t[1] = ticks();
	ecrt_domain_process(domain);
	ecrt_domain_state(domain, &state);
	if (by_kernel) {
		ecrt_master_cycle_state(master, &cycle);
		cost[LATE] = cycle.late_max;
	}
	ecrt_domain_queue(domain);
	/* the send deviation, where this process makes the schedule */
	cost[SENT] = by_kernel ? 0 : (uint32_t)(now_ns() - *at);
	t[2] = ticks();
	ecrt_master_send(master);
	t[3] = ticks();
	cost[RECEIVE] = (uint32_t)(t[1] - t[0]);
	cost[SEND] = (uint32_t)(t[3] - t[2]);
	cost[WORK] = cycle.work_last;
	return state.wc_state == EC_WC_COMPLETE;
}

static int ascending(const void *a, const void *b)
{
	uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;

	return (x > y) - (x < y);
}

static void report(unsigned int count, unsigned int incomplete)
{
	for (unsigned int p = 0; p < PARTS; p++) {
		uint64_t sum = 0;

		for (unsigned int i = 0; i < count; i++)
			sum += samples[p][i];
		qsort(samples[p], count, sizeof(uint32_t), ascending);
		printf("%s %u %u %u %u ", names[p], (unsigned int)(sum / count),
		       samples[p][count - 1 - count / 100], samples[p][count - 1],
		       samples[p][count - 1 - count / 1000]);
	}
	printf("incomplete %u\n", incomplete);
}

int cycles(unsigned int count, int by_kernel)
{
	static const ec_cycle_config_t cycle = { .period_ns = PERIOD_NS, .priority = PRIORITY };
	struct sched_param prio = { .sched_priority = PRIORITY };
	uint64_t at = now_ns(), end = at + OP_MS * 1000000ULL;
	uint32_t cost[PARTS];
	unsigned int well = 0;

	if (count > CYCLES_MAX || configure() || configure_more() ||
	    (by_kernel ? ecrt_master_set_cycle(master, &cycle) :
			 ecrt_master_set_send_interval(master, PERIOD_NS / 1000)) ||
	    mlockall(MCL_CURRENT | MCL_FUTURE) || sched_setscheduler(0, SCHED_FIFO, &prio) ||
	    ecrt_master_activate(master)) {
		fprintf(stderr, "no cycle\n");
		return 2;
	}
	/* user memory of the controller */
	ecrt_reg_request_write(written, 0x0F80, 1);
	while (well < 100) {
		well = one_cycle(&at, by_kernel, cost) ? well + 1 : 0;
		if (now_ns() > end) {
			fprintf(stderr, "the slave does not reach OP\n");
			return 2;
		}
	}
	printf("in OP\n");
	for (;;) {
		unsigned int incomplete = 0;

		at = now_ns() / PERIOD_NS * PERIOD_NS + PERIOD_NS / 2;
		for (unsigned int i = 0; i < count; i++) {
			incomplete += !one_cycle(&at, by_kernel, cost);
			for (unsigned int p = 0; p < PARTS; p++)
				samples[p][i] = cost[p];
		}
		report(count, incomplete);
	}
}
