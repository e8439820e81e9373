// SPDX-License-Identifier: LGPL-2.1-or-later
/* A reader of records beside the cycle, which never reads: what the cycle alone pays for it. */
#include "bench.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <uapi/ethercat.h>

static int fd = -1;
static unsigned long long next;

/* All process data. Return: 0 or -1. */
int record_begin(const struct bench *b)
{
	size_t mask = (size_t)(b->image_bytes + 7) / 8;
	struct ec_ioc_recorder arg = { .size = (uint32_t)(2 * mask) };
	char path[40];
	void *all = malloc(2 * mask);

	snprintf(path, sizeof(path), "/dev/EtherCAT%u", b->index);
	fd = all ? open(path, O_RDONLY | O_CLOEXEC) : -1;
	if (fd < 0)
		return -1;
	memset(all, 0xff, 2 * mask);
	arg.data = (uintptr_t)all;
	if (ioctl(fd, EC_IOC_RECORDER, &arg)) {
		perror("cycle-bench: cannot record");
		return -1;
	}
	free(all);
	next = arg.next;
	return 0;
}

/* Return: records so far. */
unsigned long long record_end(void)
{
	static char buf[1 << 20];
	unsigned long long n = 0;
	struct ec_record last;
	ssize_t got;

	/* the last one that was read has the number of all */
	fcntl(fd, F_SETFL, O_NONBLOCK);
	while ((got = read(fd, buf, sizeof(buf))) > 0) {
		memcpy(&last, buf, sizeof(last));
		n = last.number + (unsigned long long)got / last.size - next;
	}
	close(fd);
	return n;
}
