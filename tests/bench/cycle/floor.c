// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * The floor of a cycle: what the CPU executes when nothing is done in it. A real-time thread that
 * only sleeps until the next period, one that wakes another each time, and one that interrupts
 * another which never sleeps. Of the last, that other one does not count.
 */
#include "bench.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>

#define PRIORITY	80
#define SETTLE		50	/* cycles before the first one that counts */

struct floor {
	unsigned int cycles;
	unsigned int period_us;
	sem_t *wake;	/* NULL: there is no other thread */
	bool spins;	/* the other never sleeps */
	atomic_bool done;
	struct work work;
	bool worked;
};

static void sleep_until(struct timespec *t, unsigned int period_us)
{
	t->tv_nsec += period_us * 1000L;
	while (t->tv_nsec >= 1000000000L) {
		t->tv_nsec -= 1000000000L;
		t->tv_sec++;
	}
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, t, NULL) == EINTR)
		;
}

static void *sleeper(void *arg)
{
	struct floor *f = arg;
	struct timespec t;
	unsigned int i;

	if (f->spins)
		pthread_setname_np(pthread_self(), "sleeper");
	clock_gettime(CLOCK_MONOTONIC, &t);
	for (i = 0; i < SETTLE + f->cycles; i++) {
		if (i == SETTLE)
			f->worked = work_begin(&f->work, f->spins);
		sleep_until(&t, f->period_us);
		if (f->wake)
			sem_post(f->wake);
	}
	if (f->worked)
		work_end(&f->work);
	f->done = true;
	return NULL;
}

/* sleeper() in a thread of higher priority than the caller */
static int measure(struct floor *f)
{
	struct sched_param own = { .sched_priority = f->spins ? 0 : PRIORITY },
			   higher = { .sched_priority = PRIORITY + 1 };
	pthread_attr_t attr;
	pthread_t thread;
	unsigned int i;

	f->done = false;
	if (mlockall(MCL_CURRENT | MCL_FUTURE) ||
	    sched_setscheduler(0, f->spins ? SCHED_OTHER : SCHED_FIFO, &own))
		return errno;
	pthread_attr_init(&attr);
	pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
	pthread_attr_setschedpolicy(&attr, SCHED_FIFO);
	pthread_attr_setschedparam(&attr, &higher);
	if (pthread_create(&thread, &attr, sleeper, f))
		return errno;
	for (i = 0; f->wake && i < SETTLE + f->cycles; i++)
		while (sem_wait(f->wake))
			;
	while (f->spins && !f->done)
		;
	return pthread_join(thread, NULL);
}

static void report(const struct floor *f, const char *name)
{
	unsigned long long own = f->work.by[WORKER_APPLICATION], all = 0;
	unsigned int i;

	for (i = 0; i < WORKERS; i++)
		all += f->work.by[i];
	printf("%s_own %llu\n%s_rest %llu\n", name, own / f->cycles, name,
	       (all - own) / f->cycles);
}

/* cycles without and with another thread, which sleeps or spins */
int floor_measure(unsigned int cycles, unsigned int period_us)
{
	struct floor f = { .cycles = cycles, .period_us = period_us };
	sem_t wake;
	int ret;

	sem_init(&wake, 0, 0);
	/* what the machine does by itself, 100,000 instructions in some runs, is spread */
	f.cycles = 4 * cycles;
	ret = measure(&f);
	if (!ret && f.worked) {
		report(&f, "floor_sleep");
		f.cycles = cycles;
		f.wake = &wake;
		ret = measure(&f);
		report(&f, "floor_wake");
	}
	if (!ret && f.worked) {
		f.wake = NULL;
		f.spins = true;
		ret = measure(&f);
		report(&f, "floor_spin");
	}
	if (ret || !f.worked)
		fprintf(stderr, "cycle-bench: %s\n",
			ret ? strerror(ret) : "bench_split.ko is not loaded");
	return ret || !f.worked;
}
