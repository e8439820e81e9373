// SPDX-License-Identifier: GPL-2.0-only
/*
 * A 64-bit value of the status page is read whole while it is written in two halves, as
 * a kernel of 32 bits does. With "-" it is read without the sequence, and must be torn:
 * else this test could not fail.
 *
 * usage: torn [-]		the last line is "N reads, M torn"
 */
#include <pthread.h>
#include <stdio.h>
#include <time.h>

#include "../../lib/internal.h"

#define READ_S	2
#define TORN_S	20	/* two CPUs that share one see it late */

static struct ec_status status;
static volatile bool done;

static void pause_a_little(unsigned int n)
{
	for (volatile unsigned int i = 0; i < n; i++)
		;
}

/* 0 and ~0 in turn, as ec_status_begin() and ec_status_end() of the module */
static void *writer(void *unused)
{
	volatile __u32 *half = (volatile __u32 *)&status.dc_time64;

	for (unsigned int n = 0; !done; n++) {
		__u32 value = n & 1 ? ~0U : 0;

		__atomic_store_n(&status.sequence, status.sequence + 1, __ATOMIC_RELAXED);
		__atomic_thread_fence(__ATOMIC_SEQ_CST);
		half[0] = value;
		pause_a_little(n % 64);
		half[1] = value;
		__atomic_thread_fence(__ATOMIC_SEQ_CST);
		__atomic_store_n(&status.sequence, status.sequence + 1, __ATOMIC_RELAXED);
		pause_a_little(n % 64);
	}
	return unused;
}

static __u64 read_value(bool plain)
{
	return plain ? *(volatile __u64 *)&status.dc_time64 :
		       ec_status_read64(&status, &status.dc_time64);
}

int main(int argc, char **argv)
{
	bool plain = argc > 1;
	unsigned long reads, torn = 0;
	time_t end = time(NULL) + (plain ? TORN_S : READ_S);
	pthread_t thread;
	__u64 v;

	(void)argv;
	if (pthread_create(&thread, NULL, writer, NULL))
		return 2;
	for (reads = 0; !(plain && torn); reads++) {
		v = read_value(plain);
		torn += v && v != ~0ULL;
		if (reads % 1024 == 0 && time(NULL) > end)
			break;
	}
	done = true;
	pthread_join(thread, NULL);
	printf("%lu reads, %lu torn\n", reads, torn);
	return plain == !torn;
}
