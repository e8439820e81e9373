// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * When did the machine stand still? A thread of the highest priority on each CPU wants to run every
 * 10 ms. No other thread delays it, those of the master neither, so when it runs late the CPU
 * itself has not run: a virtual machine whose host was busy, or firmware.
 */
#include "demo.h"

#include <sched.h>
#include <stdlib.h>
#include <time.h>

#define CPUS_MAX	64
#define PRIORITY	99
#define NS_PER_S	1000000000LL
#define STEP_NS		(STILL_MS * 1000000LL)

static pthread_t threads[CPUS_MAX];
static unsigned int n_threads;
static atomic_bool run;
static atomic_uint count;
static atomic_llong longest_ns;		/* none: 0 */
static atomic_llong last_end_ns;
/* by CPU: when its thread wants to run next */
static atomic_llong due_ns[CPUS_MAX];

static long long now_ns(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec * NS_PER_S + t.tv_nsec;
}

static void stood_still(long long ns, long long end)
{
	long long longest = longest_ns;

	while (ns > longest && !atomic_compare_exchange_weak(&longest_ns, &longest, ns))
		;
	last_end_ns = end;
	count++;
}

static void *watch(void *arg)
{
	atomic_llong *due = arg;
	struct timespec t;
	long long now;

	while (run) {
		t.tv_sec = *due / NS_PER_S;
		t.tv_nsec = *due % NS_PER_S;
		clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, NULL);
		now = now_ns();
		if (now - *due > STEP_NS)
			stood_still(now - *due, now);
		*due = now + STEP_NS;
	}
	return NULL;
}

/* A thread for CPU @cpu, with a small stack, as all memory is locked. */
static bool start(int cpu)
{
	const struct sched_param param = { .sched_priority = PRIORITY };
	pthread_attr_t attr;
	cpu_set_t set;
	bool ok;

	CPU_ZERO(&set);
	CPU_SET(cpu, &set);
	due_ns[n_threads] = now_ns() + STEP_NS;
	pthread_attr_init(&attr);
	ok = !pthread_attr_setstacksize(&attr, 65536) &&
	     !pthread_attr_setaffinity_np(&attr, sizeof(set), &set) &&
	     !pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED) &&
	     !pthread_attr_setschedpolicy(&attr, SCHED_FIFO) &&
	     !pthread_attr_setschedparam(&attr, &param) &&
	     !pthread_create(&threads[n_threads], &attr, watch, &due_ns[n_threads]);
	pthread_attr_destroy(&attr);
	n_threads += ok;
	return ok;
}

/* Begin to watch the CPUs of this process. Returns whether all are watched. */
bool still_watch(void)
{
	cpu_set_t set;
	int cpu;

	run = true;
	if (sched_getaffinity(0, sizeof(set), &set))
		return false;
	for (cpu = 0; cpu < CPU_SETSIZE; cpu++)
		if (CPU_ISSET(cpu, &set) && (n_threads == CPUS_MAX || !start(cpu)))
			return false;
	return true;
}

void still_end(void)
{
	run = false;
	while (n_threads)
		pthread_join(threads[--n_threads], NULL);
}

/*
 * Does a CPU stand still at @now, or has it within the last two seconds? The thread of a CPU runs
 * before that of the cycle there; another CPU may still stand.
 */
bool still_lately(long long now)
{
	unsigned int i;

	for (i = 0; i < n_threads; i++)
		if (now - due_ns[i] > STEP_NS)
			return true;
	return count && now - last_end_ns < STILL_AFTER_MS * 1000000LL;
}

unsigned int still_count(void)
{
	return count;
}

double still_longest_ms(void)
{
	return (double)longest_ns / 1e6;
}
