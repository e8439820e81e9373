// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Asks the slave for its analog output by SDO, while the cycle runs, and looks
 * whether it is what the cycle has just written. A second opened master, from
 * a thread of its own: blocking calls do not disturb the cycle.
 */
#include "demo.h"

#include <time.h>

#define SLACK	16	/* cycles an output may be old */
#define STACK_BYTES	(128 * 1024)

static bool was_written(struct readback *rb, int16_t value, unsigned int from,
			unsigned int to)
{
	unsigned int i;

	if (to - from >= RECENT)	/* overtaken: cannot tell */
		return true;
	for (i = from; i != to; i++)
		if (rb->recent[i % RECENT] == value)
			return true;
	return false;
}

static void *read_back(void *arg)
{
	struct timespec pause = { .tv_nsec = 50000000 };
	struct readback *rb = arg;
	ec_master_t *m = ecrt_open_master(rb->master);
	unsigned int head, from;
	uint32_t code;
	uint8_t b[2];
	size_t size;

	rb->unavailable = !m;
	while (m && rb->run) {
		head = rb->head;
		from = head > SLACK ? head - SLACK : 0;
		if (ecrt_master_sdo_upload(m, rb->slave, rb->index,
					   rb->subindex, b, sizeof(b), &size,
					   &code) || size != sizeof(b)) {
			rb->unavailable = true;
			break;
		}
		if (was_written(rb, EC_READ_S16(b), from, rb->head))
			rb->same++;
		else
			rb->other++;
		nanosleep(&pause, NULL);
	}
	ecrt_release_master(m);
	return NULL;
}

/* With a small stack: all of it is locked, and that takes its time in the cycle. */
bool readback_start(struct readback *rb, pthread_t *thread)
{
	pthread_attr_t attr;
	bool started;

	if (pthread_attr_init(&attr))
		return false;
	started = !pthread_attr_setstacksize(&attr, STACK_BYTES) &&
		  !pthread_create(thread, &attr, read_back, rb);
	pthread_attr_destroy(&attr);
	return started;
}
