// SPDX-License-Identifier: GPL-2.0-only
/*
 * Data for pages that are not there yet, while another thread maps: the kernel
 * holds the memory of the process for both, and the session for one at a time.
 */
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#include "fault.h"

#define PAGE	4096
#define LOOKS	20	/* so often it must have gone on, so long it may stand still */
#define LOOK_US	250000

static struct counts {
	volatile unsigned long sdos;
	volatile unsigned long domains;
	volatile unsigned long maps;
} *done;

static int fd;

static void *page(void)
{
	return mmap(NULL, PAGE, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
}

static void *read_sdos(void *unused)
{
	for (;;) {
		void *p = page();
		struct ec_ioc_config_sdo c = { .size = 4, .data = (uintptr_t)p };

		done->sdos += !call(fd, EC_IOC_CONFIG_SDO, &c);
		munmap(p, PAGE);
	}
	return unused;
}

static void *read_domains(void *unused)
{
	for (;;) {
		void *p = page();
		struct ec_ioc_domain_data d = { .size = 1, .data = (uintptr_t)p };

		done->domains += !call(fd, EC_IOC_DOMAIN_DATA, &d);
		munmap(p, PAGE);
	}
	return unused;
}

/* Two threads that may never end: nobody waits for this process then. */
static void child(void *(*reader)(void *))
{
	pthread_t t;

	for (int i = 0; i < 64; i++)
		if (i != fd)
			close(i);
	if (pthread_create(&t, NULL, reader, NULL))
		_exit(2);
	for (;;) {
		void *p = mmap(NULL, PAGE, PROT_READ, MAP_SHARED, fd, EC_MMAP_STATUS);

		if (p == MAP_FAILED)
			_exit(3);
		done->maps++;
		munmap(p, PAGE);
	}
}

static bool both_go_on(const char *what, void *(*reader)(void *), volatile unsigned long *reads)
{
	unsigned int moved = 0, still = 0;
	unsigned long r = 0, m = 0;
	pid_t pid = fork();
	bool good = pid > 0;

	if (!pid)
		child(reader);
	while (good && moved < LOOKS) {
		usleep(LOOK_US);
		/* on a busy machine it may not have had its turn; a deadlock stays */
		if (*reads == r || done->maps == m) {
			good = ++still < LOOKS;
			continue;
		}
		moved++;
		still = 0;
		r = *reads;
		m = done->maps;
	}
	expect(good, "%s beside mmap: it stands still after %lu reads and %lu maps", what, r, m);
	kill(pid, SIGKILL);
	if (good)
		waitpid(pid, NULL, 0);
	return good;
}

void check_pages(void)
{
	static unsigned char value[4];
	struct ec_ioc_sc_sdo sdo = { .index = 0x8000, .size = sizeof(value),
				     .data = (uintptr_t)value };
	struct ec_ioc_activate a = { 0 };

	done = mmap(NULL, PAGE, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
	expect(done != MAP_FAILED, "memory for counts");
	if (done == MAP_FAILED)
		return;
	fd = open_master(O_RDWR);
	session(fd);
	expect_errno(call(fd, EC_IOC_SC_SDO, &sdo), 0, "startup SDO");
	expect_errno(call(fd, EC_IOC_ACTIVATE, &a), 0, "activate");
	/* where the first one hangs, the session is lost */
	if (both_go_on("CONFIG_SDO", read_sdos, &done->sdos))
		both_go_on("DOMAIN_DATA", read_domains, &done->domains);
	close(fd);
	munmap(done, PAGE);
}
