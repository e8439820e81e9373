// SPDX-License-Identifier: LGPL-2.1-or-later
/*
 * Tracing of the measured cycles alone, and a cycle that does what it must not,
 * to show that the trace sees it. What is traced is set up by the caller.
 */
#include "bench.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <uapi/ethercat.h>

#define TRACING_ON	"/sys/kernel/tracing/tracing_on"
#define FAULT_BYTES	4096

static int tracing = -1;

int trace_open(void)
{
	tracing = open(TRACING_ON, O_WRONLY | O_CLOEXEC);
	if (tracing < 0)
		perror("cycle-bench: " TRACING_ON);
	return tracing < 0 ? -1 : 0;
}

void trace_switch(bool on)
{
	if (tracing >= 0 && write(tracing, on ? "1" : "0", 1) != 1)
		perror("cycle-bench: " TRACING_ON);
}

/* A command that sleeps, because it waits for the bus. */
static void ask_the_bus(struct bench *b)
{
	static int fd = -1;
	uint8_t status[2];
	struct ec_ioc_reg arg = {
		.address = 0x0130, .size = sizeof(status), .data = (uintptr_t)status,
	};
	char path[40];

	if (fd < 0) {
		snprintf(path, sizeof(path), "/dev/EtherCAT%u", b->index);
		fd = open(path, O_RDWR | O_CLOEXEC);
	}
	/* nobody sends while we wait: it ends with the time limit or the stall */
	ioctl(fd, EC_IOC_REG_READ, &arg);
}

/* A page that is not there yet. */
static void touch(void)
{
	char *p = mmap(NULL, FAULT_BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS,
		       -1, 0);

	if (p == MAP_FAILED)
		return;
	/* mlockall() has made it present: not any more */
	munlock(p, FAULT_BYTES);
	madvise(p, FAULT_BYTES, MADV_DONTNEED);
	*(volatile char *)p = 1;
	munmap(p, FAULT_BYTES);
}

static void print(void)
{
	int fd = open("/dev/kmsg", O_WRONLY | O_CLOEXEC);

	if (fd >= 0 && write(fd, "cycle-bench", 11) != 11)
		perror("cycle-bench: /dev/kmsg");
	close(fd);
}

/* Each of the things a cycle must not do, some time. */
void trace_violate(struct bench *b, unsigned int cycle)
{
	switch (cycle % 100) {
	case 20:
		touch();
		break;
	case 40:
		print();
		break;
	case 60:
		ask_the_bus(b);
		break;
	}
}
