/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of the cycle benchmark share. */
#ifndef BENCH_H
#define BENCH_H

#include <stdbool.h>
#include <stdint.h>
#include <time.h>

#include <ecrt.h>

#define SLAVES_MAX	2000
#define DOMAINS_MAX	64

/* what one cycle costs, in parts */
enum part {
	PART_RECEIVE,
	PART_PROCESS,
	PART_QUEUE,
	PART_SEND,
	PART_TOTAL,
	PART_LATE,	/* of the wake-up, ns */
	PARTS,
};

/* options, what is used, and what came out */
struct bench {
	unsigned int index;
	unsigned int cycles;
	unsigned int period_us;
	unsigned int wait_s;
	unsigned int n_domains;
	bool extras;	/* call what a careful application calls, too */
	bool syscalls;	/* count them instead of instructions */

	ec_master_t *master;
	ec_domain_t *domains[DOMAINS_MAX];
	ec_slave_config_t *sc[SLAVES_MAX];
	unsigned int slaves;

	uint32_t *samples[PARTS];	/* of @cycles cycles each */
	uint32_t entry;			/* of a refused system call */
	unsigned int operational;
	unsigned long long lost;	/* frames, while measured */
	unsigned long long late;	/* frames */
	unsigned int wc_errors;
	unsigned int call_errors;
	unsigned int overruns;
	unsigned long long busy_ns;	/* all CPUs, while measured */
	uint64_t image_bytes;
};

/* setup.c */
int setup(struct bench *b);
void frame_counters(const struct bench *b, unsigned long long *lost,
		    unsigned long long *late);
uint32_t syscall_entry(const struct bench *b);

/* syscalls.c */
int syscalls_run(int (*child)(void *), void *arg);
void syscalls_mark(bool begin);

/* Instructions under -icount, else some constant rate of the CPU. */
static inline uint64_t ticks(void)
{
#ifdef __x86_64__
	return __builtin_ia32_rdtsc();
#else
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC_RAW, &t);
	return t.tv_sec * 1000000000ULL + t.tv_nsec;
#endif
}

#endif
