// SPDX-License-Identifier: GPL-2.0-only
/*
 * ioctl_fuzz SEED SECONDS: random commands with random arguments from several
 * threads, through a writable and a read-only descriptor. Whether the kernel
 * survived is for the caller to see; same seed, same arguments per thread.
 */
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>
#include "fault.h"

#define THREADS	4

struct worker {
	pthread_t thread;
	uint64_t rnd;
	unsigned long calls;
	unsigned long taken;
};

static int fd[2];
static time_t end;
static unsigned char data[1 << 16];

static time_t now(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return t.tv_sec;
}

static uint32_t rnd(struct worker *w)
{
	w->rnd ^= w->rnd << 13;
	w->rnd ^= w->rnd >> 7;
	w->rnd ^= w->rnd << 17;
	return (uint32_t)(w->rnd >> 16);
}

/* Mostly small, sometimes at the ends: what counts and indexes break on. */
static uint32_t value(struct worker *w)
{
	static const uint32_t ends[] = { 0, 1, 0x7f, 0xff, 0x100, 0x7fff, 0xffff, 0x10000,
					 0x7fffffff, 0x80000000, 0xffffffff };

	switch (rnd(w) % 4) {
	case 0:
		return ends[rnd(w) % (sizeof(ends) / sizeof(ends[0]))];
	case 1:
		return rnd(w);
	default:
		return rnd(w) % 5;
	}
}

/* With random names no slave would be asked, and a random address might be one of ours. */
static void fill_file(struct worker *w, struct ec_ioc_foe *f)
{
	f->data = (uint64_t)(unsigned long)(rnd(w) % 4 ? data : bad_pointers[rnd(w) % BAD_POINTERS]);
	f->done = (uint64_t)(unsigned long)bad_pointers[rnd(w) % BAD_POINTERS];
	f->size = rnd(w) % 64;
	if (rnd(w) % 4)
		memset(f->name, 0, sizeof(f->name));
	if (rnd(w) % 8)
		f->name[0] = 'a' + rnd(w) % 4;
}

static void fill(struct worker *w, const struct cmd *c, unsigned char *arg, size_t size)
{
	unsigned int fields = 1 + rnd(w) % 8;
	uint64_t p = (uint64_t)(unsigned long)data;
	uint32_t n = rnd(w) % 64;

	memset(arg, 0, size);
	for (unsigned int i = 0; i < fields && size > 4; i++) {
		uint32_t v = value(w);
		size_t len = 1u << rnd(w) % 3, at = (4 + rnd(w) % (size - 4)) & ~(len - 1);

		memcpy(arg + at, &v, len);
	}
	/* nothing else is reached with reserved bytes or flags set */
	if (rnd(w) % 16)
		for (unsigned int r = 0; r < 2; r++)
			memset(arg + c->reserved[r].offset, 0, c->reserved[r].size);
	n = rnd(w) % 16 ? c->flags & rnd(w) : rnd(w);
	memcpy(arg, &n, size < 4 ? size : 4);
	if (c->nr == EC_IOC_FOE_READ || c->nr == EC_IOC_FOE_WRITE)
		fill_file(w, (struct ec_ioc_foe *)arg);
	/* a random image would be the end of its slave */
	if (c->nr == EC_IOC_SII_WRITE) {
		((struct ec_ioc_sii_write *)arg)->flags |= EC_SII_FLAG_DRY_RUN;
		((struct ec_ioc_sii_write *)arg)->done =
			(uint64_t)(unsigned long)bad_pointers[rnd(w) % BAD_POINTERS];
	}
	if (!c->data)
		return;
	if (!(rnd(w) % 16))
		p = (uint64_t)(unsigned long)bad_pointers[rnd(w) % BAD_POINTERS];
	memcpy(arg + c->data, &p, sizeof(p));
	n = rnd(w) % 8 ? rnd(w) % 64 : value(w);
	memcpy(arg + c->size, &n, sizeof(n));
}

/* A slave that is switched to another address space would end the fun. */
static bool too_long(const struct cmd *c, unsigned char *arg)
{
	if (c->nr == EC_IOC_SDO_UPLOAD || c->nr == EC_IOC_SDO_DOWNLOAD)
		((struct ec_ioc_sdo *)arg)->timeout_ms = 5;
	if (c->nr == EC_IOC_SDO_INFO)
		((struct ec_ioc_sdo_info *)arg)->timeout_ms = 5;
	if (c->nr == EC_IOC_SOE_READ || c->nr == EC_IOC_SOE_WRITE)
		((struct ec_ioc_soe *)arg)->timeout_ms = 5;
	if (c->nr == EC_IOC_FOE_READ || c->nr == EC_IOC_FOE_WRITE)
		((struct ec_ioc_foe *)arg)->timeout_ms = 5;
	if (c->nr == EC_IOC_WAIT)
		((struct ec_ioc_wait *)arg)->timeout_us = 1000;
	/* a shorter cycle would take the only CPU */
	if (c->nr == EC_IOC_CYCLE)
		((struct ec_ioc_cycle *)arg)->period_ns |= 0x100000;
	return c->nr == EC_IOC_DEBUG;	/* would fill the log */
}

static void map_something(struct worker *w)
{
	size_t size = (size_t)(1 + rnd(w) % 64) * 4096;
	static const off_t base[] = { EC_MMAP_IMAGE, EC_MMAP_STATUS, EC_MMAP_REQUESTS,
				      EC_MMAP_EXCHANGE };
	off_t offset = base[rnd(w) % 4] + (off_t)(rnd(w) % 3) * 4096;
	unsigned char *p = mmap(NULL, size, rnd(w) % 8, rnd(w) % 4 ? MAP_SHARED : MAP_PRIVATE,
				fd[rnd(w) % 2], offset);

	if (p != MAP_FAILED)
		munmap(p, size);
}

static void *work(void *arg)
{
	struct worker *w = arg;
	unsigned char *buf = calloc(1, 1 << _IOC_SIZEBITS);

	while (buf && now() < end) {
		const struct cmd *c = &cmds[rnd(w) % n_cmds];
		size_t size = _IOC_SIZE(c->nr);
		unsigned long nr = c->nr;

		fill(w, c, buf, size);
		if (too_long(c, buf))
			continue;
		if (!(rnd(w) % 64)) {
			size = rnd(w) % (1 << _IOC_SIZEBITS);
			nr = _IOC(rnd(w) % 4, _IOC_TYPE(nr), _IOC_NR(nr), size);
		}
		w->calls++;
		w->taken += !ioctl(fd[!(rnd(w) % 16)], nr, rnd(w) % 64 ? buf : bad_pointers[1]);
		if (!(rnd(w) % 64))
			map_something(w);
	}
	free(buf);
	return NULL;
}

int main(int argc, char **argv)
{
	static struct worker w[THREADS];
	unsigned long calls = 0, taken = 0;
	unsigned int i;

	if (argc != 3) {
		fprintf(stderr, "usage: ioctl_fuzz SEED SECONDS\n");
		return 2;
	}
	fd[0] = open_master(O_RDWR);
	fd[1] = open_master(O_RDONLY);
	end = now() + atoi(argv[2]);
	for (i = 0; i < THREADS; i++) {
		w[i].rnd = strtoull(argv[1], NULL, 0) * 0x9e3779b97f4a7c15ULL + i + 1;
		if (pthread_create(&w[i].thread, NULL, work, &w[i]))
			return 2;
	}
	for (i = 0; i < THREADS; i++) {
		pthread_join(w[i].thread, NULL);
		calls += w[i].calls;
		taken += w[i].taken;
	}
	/* one that was told to survive its application */
	ioctl(fd[0], EC_IOC_RELEASE);
	ioctl(fd[0], EC_IOC_END_DETACHED);
	printf("seed %s: %lu calls, %lu taken\n", argv[1], calls, taken);
	/* all refused would mean that nothing was tried */
	return !(taken > calls / 100 && taken < calls);
}
