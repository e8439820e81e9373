// SPDX-License-Identifier: GPL-2.0-only
/*
 * What users do who may open the device for reading only, and what an application
 * sees of that.
 *
 *   readers epoll ENTRIES    an epoll entry each for so many copies of the descriptor
 *   readers show THREADS     so many threads call every command, without a pause
 *   readers spin THREADS     so many threads call nothing of the master, to compare with
 *   readers updates COUNT    an application that asks for a change of an AL state so
 *                            often, and looks in its status page for each of them
 *   readers cycles COUNT     an application that runs the cycle and prints what so many
 *                            of them cost, again and again
 *   readers waits COUNT      the same, the kernel runs the cycle
 *
 * All but "updates" go on until they are killed. With SIGTERM "show" prints how often each
 * command was called, how often it succeeded, and what came that must not.
 */
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <fcntl.h>
#include <unistd.h>
#include "fault.h"
#include "readers.h"

#define CMDS_MAX	128
#define MAX_ARG		1024

/* of one command, by all threads */
static struct {
	unsigned int calls, good, bad;
	int err;	/* the last one that was not expected */
} seen[CMDS_MAX];

static int entries(unsigned int n)
{
	struct rlimit files = { .rlim_cur = n + 64, .rlim_max = n + 64 };
	int fd = open_master(O_RDONLY), ep = epoll_create1(EPOLL_CLOEXEC);

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

/* The argument of the @k-th call: all there is comes up, and what there is not. */
static void fill(unsigned long nr, uint64_t *arg, unsigned int k)
{
	static const uint8_t sms[] = { 0, 2, 1, 3 };
	uint8_t sm = sms[k % 4];

	switch (nr) {
	case EC_IOC_SLAVE:
		((struct ec_ioc_slave *)arg)->slave.position = k % 2;
		break;
	case EC_IOC_SM:
		((struct ec_ioc_sm *)arg)->sm = sm;
		break;
	case EC_IOC_PDO:
		((struct ec_ioc_pdo *)arg)->sm = sm;
		break;
	case EC_IOC_PDO_ENTRY:
		((struct ec_ioc_pdo_entry *)arg)->sm = sm;
		((struct ec_ioc_pdo_entry *)arg)->entry_pos = (uint16_t)(k % 3);
		break;
	case EC_IOC_CONFIG:
		((struct ec_ioc_config *)arg)->index = k % APP_CONFIGS;
		break;
	case EC_IOC_CONFIG_SM:
		((struct ec_ioc_config_sm *)arg)->sm = sm;
		break;
	case EC_IOC_CONFIG_PDO:
		((struct ec_ioc_config_pdo *)arg)->sm = sm;
		break;
	case EC_IOC_CONFIG_ENTRY:
		((struct ec_ioc_config_entry *)arg)->sm = sm;
		break;
	case EC_IOC_CONFIG_SDO:
		((struct ec_ioc_config_sdo *)arg)->index = 1;
		/* the last ones are the farthest away */
		((struct ec_ioc_config_sdo *)arg)->sdo_pos = APP_SDOS - 1 - k % 4;
		break;
	case EC_IOC_CONFIG_IDN:
		((struct ec_ioc_config_idn *)arg)->index = 1;
		((struct ec_ioc_config_idn *)arg)->idn_pos = k % 2;
		break;
	case EC_IOC_VERSION:
		((struct ec_ioc_version *)arg)->abi = EC_UAPI_VERSION;
		break;
	case EC_IOC_CONFIG_FLAG:
		((struct ec_ioc_config_flag *)arg)->index = 1;
		((struct ec_ioc_config_flag *)arg)->flag_pos = k % 2;
		break;
	case EC_IOC_CONFIG_GROUP:
		((struct ec_ioc_config_group *)arg)->index = APP_CONFIGS - k % 2;
		break;
	case EC_IOC_CONFIG_WRITE:
		((struct ec_ioc_config_write *)arg)->write_pos = k % 2;
		break;
	case EC_IOC_CONFIG_COMMAND:
		((struct ec_ioc_config_command *)arg)->index = 1;
		((struct ec_ioc_config_command *)arg)->command_pos = k % 2;
		break;
	case EC_IOC_CONFIG_IP:
		((struct ec_ioc_sc_ip *)arg)->config = k % 2;
		break;
	case EC_IOC_CONFIG_WHY:
		((struct ec_ioc_config_why *)arg)->index = k % APP_CONFIGS;
		break;
	case EC_IOC_EVENTS:
		((struct ec_ioc_events *)arg)->size = sizeof(struct ec_event);
		break;
	case EC_IOC_MAIL:
		((struct ec_ioc_mail *)arg)->size = sizeof(struct ec_mail);
		break;
	case EC_IOC_DOMAIN_FMMU:
		((struct ec_ioc_domain_fmmu *)arg)->fmmu = k % 2;
		break;
	}
}

/* The cycle writes records: what these cost is a figure of its own, cycle.sh --record. */
static int is_apart(const struct cmd *c)
{
	return c->nr == EC_IOC_RECORDER;
}

/* Is this an answer to what has no fault but that something is not there? */
static int allowed(const struct cmd *c, int err)
{
	if (c->write)
		return err == EPERM;
	/* with the capability the file reads events already */
	if (c->raw)
		return err == EPERM || err == EBUSY;
	switch (c->nr) {
	case EC_IOC_VERSION:
	case EC_IOC_REASON:
	case EC_IOC_MASTER:
	case EC_IOC_DEVICE:
	case EC_IOC_CYCLE_STATS:
	case EC_IOC_EVENTS:
		return !err;
	case EC_IOC_SM:
	case EC_IOC_PDO:
	case EC_IOC_PDO_ENTRY:
		return !err || err == ENOENT || err == EINVAL;
	default:
		return !err || err == ENOENT;
	}
}

static void *show(void *unused)
{
	int fd = open_master(O_RDONLY);
	uint8_t *some = malloc(SOME_BYTES);

	(void)unused;
	for (unsigned int k = 0;; k++)
		for (unsigned int i = 0; i < n_cmds; i++) {
			const struct cmd *c = &cmds[i];
			uint64_t arg[MAX_ARG / sizeof(uint64_t)] = { 0 };
			int err;

			if (is_apart(c))
				continue;
			/* what is refused at once takes the time of what is not */
			if (c->write && k % 32)
				continue;
			if (c->data && !c->write) {
				uint64_t to = (uintptr_t)some;
				uint32_t size = SOME_BYTES;

				memcpy((char *)arg + c->data, &to, sizeof(to));
				memcpy((char *)arg + c->size, &size, sizeof(size));
			}
			fill(c->nr, arg, k);
			err = call(fd, c->nr, arg);
			__atomic_add_fetch(&seen[i].calls, 1, __ATOMIC_RELAXED);
			__atomic_add_fetch(&seen[i].good, !err, __ATOMIC_RELAXED);
			if (allowed(c, err))
				continue;
			__atomic_add_fetch(&seen[i].bad, 1, __ATOMIC_RELAXED);
			seen[i].err = err;
		}
	return NULL;
}

/* r, w or n: needs CAP_NET_RAW; how often called, how often with success, name, what was wrong */
static int report(void)
{
	int ret = 0;

	for (unsigned int i = 0; i < n_cmds; i++) {
		char kind = cmds[i].write ? 'w' : cmds[i].raw ? 'n' : 'r';

		if (is_apart(&cmds[i]))
			continue;
		printf("%c %u %u %s", kind, seen[i].calls, seen[i].good,
		       cmds[i].name);
		if (seen[i].bad) {
			printf(" failed %u times: %s", seen[i].bad, strerror(seen[i].err));
			ret = 1;
		}
		printf("\n");
	}
	return ret;
}

/* To compare with: as much work, and as many system calls, with nothing of the master. */
static void *spin(void *unused)
{
	(void)unused;
	for (;;) {
		char buf[64];
		int fd = open("/proc/version", O_RDONLY | O_CLOEXEC);

		if (read(fd, buf, sizeof(buf)) < 0)
			abort();
		close(fd);
	}
	return NULL;
}

static int threads(void *(*fn)(void *), unsigned int n)
{
	sigset_t term;
	pthread_t t;
	int sig;

	if (n_cmds > CMDS_MAX)
		return 2;
	sigemptyset(&term);
	sigaddset(&term, SIGTERM);
	pthread_sigmask(SIG_BLOCK, &term, NULL);
	while (n--)
		if (pthread_create(&t, NULL, fn, NULL))
			return 2;
	printf("reading\n");
	sigwait(&term, &sig);
	return fn == show ? report() : 0;
}

int main(int argc, char **argv)
{
	unsigned int n = argc == 3 ? (unsigned int)strtoul(argv[2], NULL, 10) : 0;

	setvbuf(stdout, NULL, _IOLBF, 0);
	if (n && !strcmp(argv[1], "epoll"))
		return entries(n);
	if (n && !strcmp(argv[1], "show"))
		return threads(show, n);
	if (n && !strcmp(argv[1], "spin"))
		return threads(spin, n);
	if (n && !strcmp(argv[1], "updates"))
		return updates(n);
	if (n && !strcmp(argv[1], "cycles"))
		return cycles(n, 0);
	if (n && !strcmp(argv[1], "waits"))
		return cycles(n, 1);
	fprintf(stderr, "usage: readers epoll|show|spin|updates|cycles|waits NUMBER\n");
	return 2;
}
