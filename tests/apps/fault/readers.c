// SPDX-License-Identifier: GPL-2.0-only
/*
 * What users do who may open the device for reading only, and what an application
 * sees of that.
 *
 *   readers epoll ENTRIES    an epoll entry each for so many copies of the descriptor
 *   readers show THREADS     so many threads show all there is, without a pause
 *   readers updates COUNT    an application that asks for a change of an AL state so
 *                            often, and looks in its status page for each of them
 *
 * The first two go on until they are killed.
 */
#include <ecrt.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>
#include <uapi/ethercat.h>

#define DEVICE		"/dev/EtherCAT0"
#define LIMIT_MS	1000	/* for an update; one takes 20 ms and what the slave needs */
#define OP_MS		60000

static int open_to_read(void)
{
	int fd = open(DEVICE, O_RDONLY | O_CLOEXEC);

	if (fd < 0) {
		perror(DEVICE);
		exit(2);
	}
	return fd;
}

static int entries(unsigned int n)
{
	struct rlimit files = { .rlim_cur = n + 64, .rlim_max = n + 64 };
	int fd = open_to_read(), ep = epoll_create1(EPOLL_CLOEXEC);

	setrlimit(RLIMIT_NOFILE, &files);
	for (unsigned int i = 0; i < n; i++) {
		struct epoll_event e = { .events = EPOLLIN };
		int copy = dup(fd);

		if (copy < 0 || epoll_ctl(ep, EPOLL_CTL_ADD, copy, &e)) {
			perror("entry");
			return 2;
		}
	}
	printf("%u entries\n", n);
	for (;;)
		pause();
}

static void *show(void *arg)
{
	int fd = open_to_read();

	(void)arg;
	for (;;) {
		static uint8_t some[4096];
		struct ec_ioc_master m = { 0 };
		struct ec_ioc_slave s = { 0 };
		struct ec_ioc_config c = { 0 };
		struct ec_ioc_config_why why = { 0 };
		struct ec_ioc_domain d = { 0 };
		struct ec_ioc_cycle_stats stats = { 0 };
		struct ec_ioc_domain_data data = {
			.data = (uintptr_t)some, .size = sizeof(some),
		};

		ioctl(fd, EC_IOC_MASTER, &m);
		ioctl(fd, EC_IOC_SLAVE, &s);
		ioctl(fd, EC_IOC_CONFIG, &c);
		ioctl(fd, EC_IOC_CONFIG_WHY, &why);
		ioctl(fd, EC_IOC_DOMAIN, &d);
		ioctl(fd, EC_IOC_CYCLE_STATS, &stats);
		ioctl(fd, EC_IOC_DOMAIN_DATA, &data);
		/* refused */
		ioctl(fd, EC_IOC_RECEIVE);
	}
	return NULL;
}

static int shows(unsigned int n)
{
	pthread_t t;

	while (n--)
		if (pthread_create(&t, NULL, show, NULL))
			return 2;
	printf("reading\n");
	for (;;)
		pause();
}

static uint64_t now_ms(void)
{
	struct timespec t;

	clock_gettime(CLOCK_MONOTONIC, &t);
	return (uint64_t)t.tv_sec * 1000 + (uint64_t)t.tv_nsec / 1000000;
}

static int reaches(const ec_slave_config_t *sc, unsigned int state, unsigned int limit_ms)
{
	static const struct timespec pause_ms = { .tv_nsec = 1000000 };
	uint64_t end = now_ms() + limit_ms;
	ec_slave_config_state_t s;

	do {
		if (!ecrt_slave_config_state(sc, &s) && s.al_state == state)
			return 1;
		nanosleep(&pause_ms, NULL);
	} while (now_ms() < end);
	return 0;
}

static ec_slave_config_t *configure(ec_master_t *m)
{
	static const ec_cycle_config_t cycle = { .period_ns = 1000000 };
	ec_domain_t *d = ecrt_master_create_domain(m);
	ec_slave_config_t *sc;
	ec_slave_info_t info;
	unsigned int bit;

	if (!d || ecrt_master_get_slave(m, 0, &info))
		return NULL;
	sc = ecrt_master_slave_config(m, 0, 0, info.vendor_id, info.product_code);
	if (!sc || ecrt_slave_config_reg_pdo_entry_pos(sc, 0, 0, 0, d, &bit) < 0 ||
	    ecrt_master_set_cycle(m, &cycle) || ecrt_master_activate(m))
		return NULL;
	return sc;
}

static int updates(unsigned int count)
{
	int fd = open(DEVICE, O_RDWR | O_CLOEXEC);
	ec_master_t *m = ecrt_request_master(0);
	ec_slave_config_t *sc = m ? configure(m) : NULL;
	unsigned int seen = 0;

	if (fd < 0 || !sc || !reaches(sc, EC_AL_STATE_OP, OP_MS)) {
		fprintf(stderr, "the slave does not reach OP\n");
		return 2;
	}
	printf("in OP\n");
	for (unsigned int i = 0; i < count; i++) {
		struct ec_ioc_state s = { .state = i % 2 ? EC_AL_STATE_OP : EC_AL_STATE_SAFEOP };

		if (ioctl(fd, EC_IOC_STATE, &s)) {
			perror("state");
			return 2;
		}
		seen += (unsigned int)reaches(sc, s.state, LIMIT_MS);
	}
	printf("updates: %u of %u\n", seen, count);
	return 0;
}

int main(int argc, char **argv)
{
	unsigned int n = argc == 3 ? (unsigned int)strtoul(argv[2], NULL, 10) : 0;

	setvbuf(stdout, NULL, _IOLBF, 0);
	if (n && !strcmp(argv[1], "epoll"))
		return entries(n);
	if (n && !strcmp(argv[1], "show"))
		return shows(n);
	if (n && !strcmp(argv[1], "updates"))
		return updates(n);
	fprintf(stderr, "usage: readers epoll|show|updates NUMBER\n");
	return 2;
}
