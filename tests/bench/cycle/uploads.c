// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Others that use the mailboxes while a cycle runs: threads, one for each slave, that read an
 * object of it all the time.
 */
#include "bench.h"

#include <errno.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#define STACK_BYTES	(64 * 1024)	/* mlockall() locks all of it */
#define IDENTITY	0x1018

static atomic_bool ends;
static atomic_uint done, failed, running;

static struct upload {
	pthread_t thread;
	ec_master_t *master;
	uint16_t slave;
} uploads[UPLOADS_MAX];

static void *upload(void *arg)
{
	struct upload *u = arg;
	uint8_t value[4];
	uint32_t abort;
	size_t size;

	while (!ends) {
		if (ecrt_master_sdo_upload(u->master, u->slave, IDENTITY, 1, value, sizeof(value),
					   &size, &abort))
			failed++;
		else
			done++;
	}
	running--;
	return NULL;
}

/* In threads without real-time priority. */
int uploads_start(struct bench *b)
{
	struct sched_param param = { 0 };
	pthread_attr_t attr;
	unsigned int i;
	int ret = 0;

	pthread_attr_init(&attr);
	pthread_attr_setstacksize(&attr, STACK_BYTES);
	pthread_attr_setinheritsched(&attr, PTHREAD_EXPLICIT_SCHED);
	pthread_attr_setschedpolicy(&attr, SCHED_OTHER);
	pthread_attr_setschedparam(&attr, &param);
	for (i = 0; i < b->uploads && !ret; i++) {
		uploads[i].slave = (uint16_t)i;
		uploads[i].master = ecrt_open_master(b->index);
		ret = !uploads[i].master ? errno :
		      pthread_create(&uploads[i].thread, &attr, upload, &uploads[i]);
		running += !ret;
	}
	if (!ret)
		return 0;
	fprintf(stderr, "cycle-bench: upload %u: %s\n", i, strerror(ret));
	return -1;
}

/* Ends them; until it returns false the cycle has to carry the last ones. */
bool uploads_running(void)
{
	ends = true;
	return running;
}

void uploads_join(struct bench *b)
{
	unsigned int i;

	for (i = 0; i < b->uploads; i++) {
		pthread_join(uploads[i].thread, NULL);
		ecrt_release_master(uploads[i].master);
	}
	b->upload_errors = failed;
	b->uploads_done = done;
}
