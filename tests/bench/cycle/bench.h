/* SPDX-License-Identifier: LGPL-2.1-or-later */
/* What the files of the cycle benchmark share. */
#ifndef BENCH_H
#define BENCH_H

#include <stdbool.h>
#include <stdint.h>
#include <sys/types.h>
#include <time.h>

#include <ecrt.h>

#define SLAVES_MAX	2000
#define DOMAINS_MAX	64
#define UPLOADS_MAX	1000

/* what one cycle costs, in parts */
enum part {
	PART_RECEIVE,
	PART_PROCESS,
	PART_QUEUE,
	PART_SEND,
	PART_WORK,	/* of the kernel's thread, when it runs the cycle */
	PART_TOTAL,
	PART_LATE,	/* of the wake-up, ns */
	PARTS,
};

/* who runs the cycle, and how its application waits */
enum mode {
	MODE_OWN,	/* the application */
	MODE_WAIT,	/* the kernel; one system call to wait */
	MODE_SPIN,	/* the kernel; a counter in memory */
	MODE_TIMER,	/* the kernel; sleeps until the middle of the period */
};

/* who works while a cycle runs, with the interrupts that come meanwhile or wake it */
enum worker {
	WORKER_APPLICATION,
	WORKER_CARD,		/* interrupt threads of the master's network card */
	WORKER_MASTER,		/* its threads: monitor, the kernel's cycle */
	WORKER_REST,
	WORKER_SIMULATOR,	/* and its network card */
	WORKER_OTHER,		/* a process that computes beside the cycle */
	WORKERS,
};

#define REQUESTS_MAX	16	/* slaves that are asked by requests */

/* options, what is used, and what came out */
struct bench {
	unsigned int index;
	unsigned int cycles;
	unsigned int period_us;
	unsigned int wait_s;
	unsigned int ready;	/* complete cycles at first */
	unsigned int n_domains;
	bool units;	/* each domain is a sync unit */
	bool extras;	/* call what a careful application calls, too */
	bool syscalls;	/* count them instead of instructions */
	bool record;	/* another process records all process data */
	bool trace;	/* switch ftrace on while measuring */
	bool floor;	/* measure nothing but cycles in which nothing is done */
	unsigned int uploads;	/* slaves of which others upload an object meanwhile */
	bool violate;	/* do what a cycle must not do, now and then */
	enum mode mode;
	bool beside;	/* all work is counted while another process computes */
	bool interrupt;	/* the kernel runs the cycle in the interrupt of its timer */
	int cpu;		/* of the kernel's cycle, -1: any */
	bool interrupted;	/* that is where the last cycle was */

	ec_master_t *master;
	ec_domain_t *domains[DOMAINS_MAX];
	ec_slave_config_t *sc[SLAVES_MAX];
	unsigned int slaves;
	ec_sdo_request_t *sdo[REQUESTS_MAX];
	ec_reg_request_t *reg[REQUESTS_MAX];
	unsigned int n_requests;
	bool measuring;
	uint64_t seen;		/* last cycle of the kernel */

	uint32_t *samples[PARTS];	/* of @cycles cycles each */
	uint32_t entry;			/* of a refused system call */
	unsigned int operational;
	unsigned long long recorded;	/* records, with SETTLE cycles before */
	uint64_t record_cycles;		/* cycles in that time, of the application or the kernel */
	unsigned long long lost;	/* frames, while measured */
	unsigned long long late;	/* frames */
	unsigned int wc_errors;
	unsigned int call_errors;
	unsigned int requests_done;
	unsigned int uploads_done;	/* while measured */
	unsigned int upload_errors;
	unsigned int overruns;
	unsigned long long busy_ns;	/* all CPUs, while measured */
	struct work {
		unsigned long long by[WORKERS];	/* ns, which are instructions */
		unsigned long long all, idle;
		long long begin;
	} work;			/* of cycles in which nothing else is measured */
	unsigned int work_cycles;
	bool worked;		/* @work is known */
	unsigned int tick;	/* cost of ticks() */
	uint64_t image_bytes;
};

/* setup.c */
int setup(struct bench *b);
void frame_counters(const struct bench *b, unsigned long long *lost,
		    unsigned long long *late);
uint32_t syscall_entry(const struct bench *b);
bool in_interrupt(const struct bench *b);

/* record.c */
int record_begin(const struct bench *b);
unsigned long long record_end(void);

/* extras.c */
int extras_setup(struct bench *b);
void extras_ask(struct bench *b, long long at);
void extras_queue(struct bench *b, long long at);

/* trace.c */
int trace_open(void);
void trace_switch(bool on);
void trace_violate(struct bench *b, unsigned int cycle);

/* work.c */
bool work_begin(struct work *w, bool spins);
pid_t work_beside(void);
void work_end(struct work *w);
int work_baseline(unsigned int ms);

/* floor.c */
int floor_measure(unsigned int cycles, unsigned int period_us);

/* uploads.c */
int uploads_start(struct bench *b);
bool uploads_running(void);
void uploads_join(struct bench *b);

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
